// Elements of the scan along columns: what a tile adds to its 4 columns of the table, its own sums and those of the
// same rows to the left of it.
uniform usampler2DArray tile_sums;
uniform usampler2DArray rows_before;

ivec2 place(int along, int across)
{
    return ivec2(across, along);
}

uvec4 element(int along, int across)
{
    uvec4 columns = texelFetch(tile_sums, ivec3(across, along, 2), 0);
    uvec4 left = texelFetch(rows_before, ivec3(across >> 3, 2 * along, across & 7), 0)
               + texelFetch(rows_before, ivec3(across >> 3, 2 * along + 1, across & 7), 0);
    columns.yw += columns.xz;
    columns.zw += columns.yy;
    return columns + (left.x + left.y + left.z + left.w);
}
