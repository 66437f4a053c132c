// Elements of the scan along rows: the sums of 4 rows of a tile, which lie in two layers.

// Sums of each tile of 4 x 8: its rows 0 to 3, its rows 4 to 7, its 4 columns.
uniform usampler2DArray tile_sums;

ivec2 place(int along, int across)
{
    return ivec2(along, across);
}

uvec4 element(int along, int across)
{
    return texelFetch(tile_sums, ivec3(along, across >> 1, across & 1), 0);
}
