// The test of noise, pooled: how far a width's test lets light be mixed with it.

// Sums of the tests' ratios of radii 1, 2 and 4 at each pixel; a: what differs between pixels and their
// neighbours over what noise would make of it, weighed by power.
uniform usampler2DArray fine_tests;

// Between pure widths light is mixed: ratios this far from 1 decide all.
const float SOFT = 0.4;
// Tests are pooled over boxes that are so many times as wide.
const int POOL = 2;
const float NOISE_FLOOR = 0.75;
// So many tests that find noise alone are pooled with those of a box: at the ends of faces it holds few.
const float SUPPOSED = 2.0;

// The picture's noise over that of photons that fall by chance: less where they are emitted evenly, and seen
// in what differs between narrow boxes. Where light itself changes at once it is as by chance, and never less
// than NOISE_FLOOR, since few pixels may hold most of the power.
float share_of_noise()
{
    ivec2 last = map_size - 1;
    float weights = 0.125 * float(entry(flux_table, last.x, last.y).a);
    float found = float(entry(fine_tests, last.x, last.y).a);
    return weights > 0.0 ? clamp(found / weights, NOISE_FLOOR, 1.0) : 1.0;
}

// From 0 to 1, from a sum of ratios of so many tests of boxes of a radius.
float share_of(uint ratios, ivec2 sides, float noise, int radius)
{
    float expected = 1.0 / threshold(float(radius / 2), float(radius));
    float sum = float(ratios) / 8192.0 / noise + SUPPOSED * expected;
    float ratio = sum / (float(sides.x * sides.y) + SUPPOSED);
    return clamp((1.0 + SOFT - ratio) / (2.0 * SOFT), 0.0, 1.0);
}
