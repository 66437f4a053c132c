// How far each width's test lets light be mixed with it, at every second pixel of every second row: a box
// that is so much wider than a pixel hardly differs from its neighbour's.

// Sums of the tests' ratios: of radii 1, 2 and 4 at each pixel, and of 8 to 64 at every second one.
uniform usampler2DArray fine_tests;
uniform usampler2DArray coarse_tests;

// Shares of radii 1, 2, 4 and 8, from 0 to 1, none larger than the one before.
layout(location = 0) out vec4 narrow;
// Shares of radii 16, 32 and 64, and nothing.
layout(location = 1) out vec4 wide;

// Between pure widths light is mixed: ratios this far from 1 decide all.
const float SOFT = 0.4;
// Tests are pooled over boxes that are so many times as wide.
const int POOL = 2;

// The mean ratio of the tests around a pixel.
float pooled(ivec2 pixel, ivec4 extent, int level)
{
    ivec4 box = box_at(pixel, extent, POOL << level);
    int channel = level;
    uvec4 sum;
    if (level < 3) {
        sum = sum_of(fine_tests, box);
    } else {
        channel = level - 3;
        // The cells whose pixel is in the box: its own is.
        box = ivec4((box.xy + 1) >> 1, box.zw >> 1);
        sum = sum_of(coarse_tests, box);
    }
    ivec2 sides = box.zw - box.xy + 1;
    return float(sum[channel]) / (8192.0 * float(sides.x * sides.y));
}

void main()
{
    ivec2 pixel = 2 * ivec2(gl_FragCoord.xy);
    ivec4 extent = ivec4(texelFetch(extents, pixel, 0));
    float shares[8] = float[8](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    float share = 1.0;
    for (int level = 0; level < 7 && share > 0.0; ++level) {
        share = min(share, clamp((1.0 + SOFT - pooled(pixel, extent, level)) / (2.0 * SOFT), 0.0, 1.0));
        shares[level] = share;
    }
    narrow = vec4(shares[0], shares[1], shares[2], shares[3]);
    wide = vec4(shares[4], shares[5], shares[6], 0.0);
}
