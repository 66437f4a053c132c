// Departures from an even density of radii from 16 on, around one pixel in a square of a quarter of the
// radius: all places of a radius beside those of the one before.

// In steps; 0 where there is no place.
layout(location = 0) out uint steps;

void main()
{
    ivec2 place = ivec2(gl_FragCoord.xy);
    int radius = 0;
    ivec2 center = ivec2(0);
    int first = 0;
    for (int level = NARROW_LEVELS; level < LEVELS; ++level) {
        int apart = 1 << (level - 2);
        ivec2 places = (map_size + apart - 1) / apart;
        ivec2 of_level = place - ivec2(first, 0);
        if (all(greaterThanEqual(of_level, ivec2(0))) && all(lessThan(of_level, places))) {
            radius = 1 << level;
            center = of_level * apart;
        }
        first += places.x;
    }
    steps = radius == 0 ? 0u : departure(held_in(center, radius / 2), held_in(center, radius), radius);
}
