// Departures from an even density of radii 1, 2, 4 and 8 around each pixel, two in a number.

// Of radius 4, and above its bits of radius 1.
layout(location = 0) out uint of_1_and_4;
#ifdef SEVERAL_LEVELS
// Of radius 8, and above its bits of radius 2.
layout(location = 1) out uint of_2_and_8;
#endif

void main()
{
    ivec2 center = min(ivec2(gl_FragCoord.xy), map_size - 1);
    of_1_and_4 = 0u;
#ifdef SEVERAL_LEVELS
    of_2_and_8 = 0u;
#endif
    Held narrow = held_in(center, 0);
    for (int level = 0; level < min(LEVELS, NARROW_LEVELS); ++level) {
        Held wide = held_in(center, 1 << level);
        uint found = departure(narrow, wide, 1 << level) << (level < 2 ? LOWER_BITS : 0);
#ifdef SEVERAL_LEVELS
        if ((level & 1) == 1) {
            of_2_and_8 |= found;
        } else {
            of_1_and_4 |= found;
        }
#else
        of_1_and_4 |= found;
#endif
        narrow = wide;
    }
}
