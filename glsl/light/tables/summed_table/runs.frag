// Each texel of a run of 8 with all before it: one draw buffer for each.

// The sums of runs with all runs before them, layered as what is drawn here.
uniform usampler2DArray runs_before;

// All texels of the line up to and with the run's i-th, modulo 2^32.
layout(location = 0) out TEXEL sum_0;
layout(location = 1) out TEXEL sum_1;
layout(location = 2) out TEXEL sum_2;
layout(location = 3) out TEXEL sum_3;
layout(location = 4) out TEXEL sum_4;
layout(location = 5) out TEXEL sum_5;
layout(location = 6) out TEXEL sum_6;
layout(location = 7) out TEXEL sum_7;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int run = along(pixel);
    TEXEL sum = TEXEL(0u);
    if (run > 0) {
        int before = run - 1;
        sum = value_of(texelFetch(runs_before, ivec3(place_of(before >> 3, pixel), before & 7), 0));
    }
    TEXEL sums[8];
    for (int i = 0; i < 8; ++i) {
        // What lies past the end is never read.
        sum += texel_at(place_of(min(run * 8 + i, count - 1), pixel));
        sums[i] = sum;
    }
    sum_0 = sums[0];
    sum_1 = sums[1];
    sum_2 = sums[2];
    sum_3 = sums[3];
    sum_4 = sums[4];
    sum_5 = sums[5];
    sum_6 = sums[6];
    sum_7 = sums[7];
}
