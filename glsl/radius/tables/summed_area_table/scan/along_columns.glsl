// Elements of the scan along columns: what a tile adds to its 4 columns of the table, its own sums and those
// of the same rows to the left of it.

// Sums of each tile of 4 x 8: its rows 0 to 3, its rows 4 to 7, its 4 columns.
uniform usampler2DArray tile_sums;
// What lies before each row of each tile, to its left.
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
