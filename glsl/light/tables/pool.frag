// How far each width's test lets light be mixed with it, at every second pixel of every second row: a box
// that is so much wider than a pixel hardly differs from its neighbour's.

// Sums of the tests' ratios of radii 8 to 64 at every second pixel.
uniform usampler2DArray coarse_tests;

// Shares of radii 2, 4, 8 and 16, from 0 to 1, none larger than the one before.
layout(location = 0) out vec4 narrow;
// Shares of radii 32 and 64, and nothing.
layout(location = 1) out vec4 wide;

void main()
{
    ivec2 pixel = 2 * ivec2(gl_FragCoord.xy);
    ivec4 extent = ivec4(texelFetch(extents, pixel, 0));
    float noise = share_of_noise();
    float shares[6] = float[6](0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    float share = 1.0;
    for (int level = 1; level < 7 && share > 0.0; ++level) {
        ivec4 box = box_at(pixel, extent, POOL << level);
        uint sum;
        if (level < 3) {
            sum = sum_of(fine_tests, box)[level];
        } else {
            // The cells whose pixel is in the box: its own is.
            box = ivec4((box.xy + 1) >> 1, box.zw >> 1);
            sum = sum_of(coarse_tests, box)[level - 3];
        }
        share = min(share, share_of(sum, box.zw - box.xy + 1, noise, 1 << level));
        shares[level - 1] = share;
    }
    narrow = vec4(shares[0], shares[1], shares[2], shares[3]);
    wide = vec4(shares[4], shares[5], 0.0, 0.0);
}
