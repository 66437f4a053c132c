// The test of noise for radii 1, 2 and 4 at each pixel.

// Flux of each pixel.
uniform usampler2D points;
// Area of each pixel; 0 where none counts.
uniform usampler2D areas;

// Ratios in 2^-13, of radii 1, 2, 4, and nothing.
layout(location = 0) out uvec4 ratios;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec4 extent = ivec4(texelFetch(extents, pixel, 0));
    Held fine = held_by(texelFetch(points, pixel, 0), texelFetch(areas, pixel, 0).r);
    ratios = uvec4(0u);
    int radius = 1;
    for (int i = 0; i < 3; ++i) {
        Held coarse = held_in(box_at(pixel, extent, radius));
        ratios[i] = in_units(ratio(fine, coarse, threshold(float(radius / 2), float(radius))));
        fine = coarse;
        radius *= 2;
    }
}
