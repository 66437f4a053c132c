// The unit of areas.

// One texel: the sum of the logarithms of all pixels' areas to base 2, and how many these are.
uniform sampler2D log_areas;

// A power of two: 2^13 of it are the geometric mean of the pixels' areas.
float area_unit()
{
    vec2 sum = texelFetch(log_areas, ivec2(0), 0).xy;
    int exponent = int(floor(sum.x / max(sum.y, 1.0) + 0.5)) - 13;
    return uintBitsToFloat(uint(clamp(exponent, -120, 120) + 127) << 23);
}
