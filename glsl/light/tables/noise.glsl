// The test of noise: whether a box twice as wide has the same light, but for noise.

// Sums of areas.
uniform usampler2DArray area_table;
// The unit of squares over the square of that of power.
uniform float square_unit;
// Square of a photon's power in the mean, in units of squares: where no photon is, one might have been.
uniform float usual_square;

// Larger differences count as this many times their variance, so that one bright photon does not decide
// alone.
const float MOST = 6.0;

// What a box holds.
struct Held {
    // Red, green and blue together, in units.
    float flux;
    float squares;
    float area;
};

Held held_by(uvec4 flux, uint area)
{
    return Held(dot(vec3(flux.rgb), vec3(1.0)), square_unit * (float(flux.a) + usual_square), float(area));
}

Held held_in(ivec4 box)
{
    return held_by(sum_of(flux_table, box), sum_of(area_table, box).r);
}

// The square of the difference of light over what noise alone would make of it, over its threshold: less than
// 1 where the wider box is better, and 0 where it holds nothing.
float ratio(Held fine, Held coarse, float limit)
{
    if (coarse.flux == 0.0) {
        return 0.0;
    }
    if (coarse.area <= fine.area) {
        return 1.0;
    }
    if (fine.area <= 0.0) {
        return 0.0;
    }
    float difference = coarse.flux / coarse.area - fine.flux / fine.area;
    float variance = coarse.squares / coarse.area * (1.0 / fine.area - 1.0 / coarse.area);
    return min(difference * difference / variance, MOST) / limit;
}

uint in_units(float value)
{
    return uint(8192.0 * value + 0.5);
}
