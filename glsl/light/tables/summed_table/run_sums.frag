// The sum of each run of 8 texels.

// The run's texels together, modulo 2^32.
layout(location = 0) out TEXEL sum;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int first = along(pixel) * 8;
    sum = TEXEL(0u);
    for (int i = first; i < min(first + 8, count); ++i) {
        sum += texel_at(place_of(i, pixel));
    }
}
