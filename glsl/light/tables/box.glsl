// Boxes of pixels on one face, and sums of tables over them.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;
// Sums of flux: red, green, blue and squares of power.
uniform usampler2DArray flux_table;
// How many pixels the face goes on to the left, to the right, down and up.
uniform usampler2D extents;

// The box of a radius around a pixel, as far as its face goes: first column and row, last column and row.
ivec4 box_at(ivec2 pixel, ivec4 extent, int radius)
{
    ivec4 reach = min(extent, radius);
    return ivec4(pixel - reach.xz, pixel + reach.yw);
}

uvec4 entry(usampler2DArray table, int x, int y)
{
    return texelFetch(table, ivec3(x, y >> 3, y & 7), 0);
}

// What a table sums over a box; what lies before the first column or row is nothing.
uvec4 sum_of(usampler2DArray table, ivec4 box)
{
    uvec4 sum = entry(table, box.z, box.w);
    if (box.x > 0) {
        sum -= entry(table, box.x - 1, box.w);
    }
    if (box.y > 0) {
        sum -= entry(table, box.z, box.y - 1);
        if (box.x > 0) {
            sum += entry(table, box.x - 1, box.y - 1);
        }
    }
    return sum;
}
