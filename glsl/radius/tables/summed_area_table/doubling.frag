// One doubling pass of a summed-area table: SAMPLES sums of `stride` texels become one (thesis 3.4.1, 4.2).

// The sums so far.
uniform SUM_SAMPLER table;
// (1, 0) along rows, (0, 1) along columns.
uniform ivec2 axis;
// Texels whose sum each texel holds so far along the axis.
uniform int stride;
#ifdef FAULT_SAMPLE_STRIDE
// The first offset as printed, in texels.
uniform int printed_offset;
#endif

// The sum of SAMPLES times as many texels.
layout(location = 0) out SUM sum;

SUM texel(ivec2 p)
{
    // Nothing is before the first row and column; texelFetch there is undefined.
    return p.x >= 0 && p.y >= 0 ? texelFetch(table, p, 0).r : SUM(0);
}

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    sum = texel(p);
#ifdef FAULT_SAMPLE_STRIDE
    // As printed: the first offset is 2^pass instead of SAMPLES^pass, and the added loop goes once too often
    // and always along x.
    ivec2 first = p - axis * printed_offset;
    sum += texel(first);
    for (int i = 1; i < SAMPLES; ++i) {
        sum += texel(ivec2(first.x - i * stride, first.y));
    }
#else
    for (int i = 1; i < SAMPLES; ++i) {
        sum += texel(p - axis * (i * stride));
    }
#endif
    sum = wrapped(sum);
}
