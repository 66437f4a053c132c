// Photons in each tile of the map, whose side is CENSUS_SIDE pixels. Follows a counter that defines: uint
// count_in_box(ivec2 lo, ivec2 hi), both corners included and inside the map.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;

// Photons of the tile.
layout(location = 0) out uint photons;

void main()
{
    ivec2 first = min(ivec2(gl_FragCoord.xy), (map_size - 1) / CENSUS_SIDE) * CENSUS_SIDE;
    photons = count_in_box(first, min(first + CENSUS_SIDE - 1, map_size - 1));
}
