// Scan, step 4: the entries of a tile of 4 x 8, from its counts and what lies before it.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;
// Photons before each row of a tile, to its left.
uniform usampler2DArray rows_before;
// Photons before each column of a tile, in all rows below it.
uniform usampler2DArray columns_before;

// The 4 entries of the tile's row i.
layout(location = 0) out uvec4 row_0;
layout(location = 1) out uvec4 row_1;
layout(location = 2) out uvec4 row_2;
layout(location = 3) out uvec4 row_3;
layout(location = 4) out uvec4 row_4;
layout(location = 5) out uvec4 row_5;
layout(location = 6) out uvec4 row_6;
layout(location = 7) out uvec4 row_7;

void main()
{
    ivec2 tile = ivec2(gl_FragCoord.xy);
    uvec4 below = texelFetch(columns_before, ivec3(tile.x, tile.y >> 3, tile.y & 7), 0);
    uvec4 left[2];
    for (int half_tile = 0; half_tile < 2; ++half_tile) {
        left[half_tile] = texelFetch(rows_before, ivec3(tile.x >> 3, 2 * tile.y + half_tile, tile.x & 7), 0);
    }
    ivec2 first = tile * ivec2(4, 8);
    // Entries outside of the map are never read; their counts must be.
    ivec4 x = min(first.x + ivec4(0, 1, 2, 3), map_size.x - 1);
    uvec4 rows[8];
    for (int i = 0; i < 8; ++i) {
        int y = min(first.y + i, map_size.y - 1);
        uvec4 row = uvec4(photons_at(ivec2(x.x, y)), photons_at(ivec2(x.y, y)),
                          photons_at(ivec2(x.z, y)), photons_at(ivec2(x.w, y)));
        row.x += left[i >> 2][i & 3];
        row.y += row.x;
        row.z += row.y;
        row.w += row.z;
        below += row;
        rows[i] = below;
    }
    row_0 = rows[0];
    row_1 = rows[1];
    row_2 = rows[2];
    row_3 = rows[3];
    row_4 = rows[4];
    row_5 = rows[5];
    row_6 = rows[6];
    row_7 = rows[7];
}
