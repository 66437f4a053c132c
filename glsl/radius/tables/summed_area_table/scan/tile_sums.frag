// Scan, step 1: the sums of each row and each column of a tile of 4 x 8 texels.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;

// Photons of each row.
layout(location = 0) out uvec4 rows_0_to_3;
layout(location = 1) out uvec4 rows_4_to_7;
// Photons of each column.
layout(location = 2) out uvec4 columns;

void main()
{
    ivec2 first = ivec2(gl_FragCoord.xy) * ivec2(4, 8);
    ivec4 x = first.x + ivec4(0, 1, 2, 3);
    uvec4 inside = uvec4(lessThan(x, ivec4(map_size.x)));
    x = min(x, map_size.x - 1);
    uint rows[8];
    columns = uvec4(0);
    for (int i = 0; i < 8; ++i) {
        // Outside of the map there is nothing.
        int y = min(first.y + i, map_size.y - 1);
        uvec4 row = (first.y + i < map_size.y ? inside : uvec4(0))
                  * uvec4(photons_at(ivec2(x.x, y)), photons_at(ivec2(x.y, y)),
                          photons_at(ivec2(x.z, y)), photons_at(ivec2(x.w, y)));
        columns += row;
        rows[i] = row.x + row.y + row.z + row.w;
    }
    rows_0_to_3 = uvec4(rows[0], rows[1], rows[2], rows[3]);
    rows_4_to_7 = uvec4(rows[4], rows[5], rows[6], rows[7]);
}
