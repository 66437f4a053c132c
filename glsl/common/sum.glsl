// The number in which sums are kept: f32 as the thesis, u32, or u16, which GLSL computes in 32 bits.
#ifdef SUM_F32
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
    return sum;
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
