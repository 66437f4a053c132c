// The number in which sums are kept: f32 as the thesis, u32, or 16 bits of either, which GLSL computes in 32.
#ifdef SUM_FLOAT
#define SUM float
#define SUM_SAMPLER sampler2D
#else
#define SUM uint
#define SUM_SAMPLER usampler2D
#endif

// The largest f32 below 2^32; converting more to uint is undefined.
const float LARGEST_COUNT = 4294967040.0;

// A sum as it is kept. What a texture of 16 bits would make of more is not defined.
uint wrapped(uint sum)
{
#ifdef SUM_U16
    return sum & 0xFFFFu;
#else
    return sum;
#endif
}

float wrapped(float sum)
{
#ifdef SUM_F16
    // The largest f16: what lies above would become infinite, and the difference of two such no number.
    return min(sum, 65504.0);
#else
    return sum;
#endif
}

// Radii are decided in uint whatever the storage. Differences of rounded sums can be negative.
uint to_count(uint sum)
{
    return sum;
}

uint to_count(float sum)
{
    return uint(clamp(sum, 0.0, LARGEST_COUNT));
}

#ifdef SUM_MINUS_MEAN
// What was taken from each count, so that entries stay small (Hensley et al. 2005).
uniform float mean;
#endif

// The photons of a box, by what the table sums for it.
uint photons_in(SUM sum, ivec2 lo, ivec2 hi)
{
#ifdef SUM_MINUS_MEAN
    ivec2 sides = hi - lo + 1;
    // To the nearest whole number.
    sum = floor(sum + mean * float(sides.x * sides.y) + 0.5);
#endif
    return to_count(wrapped(sum));
}
