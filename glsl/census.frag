// Photons in each tile of CENSUS_SIDE x CENSUS_SIDE pixels.
// Follows a counter that defines: uint count_in_box(ivec2 lo, ivec2 hi), both corners included and inside the map.
uniform ivec2 map_size;

layout(location = 0) out uint photons;

void main()
{
    ivec2 first = min(ivec2(gl_FragCoord.xy), (map_size - 1) / CENSUS_SIDE) * CENSUS_SIDE;
    photons = count_in_box(first, min(first + CENSUS_SIDE - 1, map_size - 1));
}
