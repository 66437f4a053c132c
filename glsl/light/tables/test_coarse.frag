// The test of noise for radii 8, 16, 32 and 64 at every second pixel of every second row.

// Ratios in 2^-13, of radii 8, 16, 32 and 64.
layout(location = 0) out uvec4 ratios;

void main()
{
    ivec2 pixel = 2 * ivec2(gl_FragCoord.xy);
    ivec4 extent = ivec4(texelFetch(extents, pixel, 0));
    Held fine = held_in(box_at(pixel, extent, 4));
    int radius = 8;
    for (int i = 0; i < 4; ++i) {
        Held coarse = held_in(box_at(pixel, extent, radius));
        ratios[i] = in_units(ratio(fine, coarse, threshold(float(radius / 2), float(radius))));
        fine = coarse;
        radius *= 2;
    }
}
