// The test of noise for radii 1, 2 and 4 at each pixel.

// Flux of each pixel.
uniform usampler2D points;
// Area of each pixel; 0 where none counts.
uniform usampler2D areas;

// Ratios in 2^-13, of radii 1, 2 and 4; a: the square of the difference at radius 2 over what noise would make
// of it, weighed by an eighth of the pixel's squares of power, so that the picture's sum fits.
layout(location = 0) out uvec4 ratios;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec4 extent = ivec4(texelFetch(extents, pixel, 0));
    uvec4 own = texelFetch(points, pixel, 0);
    Held fine = held_by(own, texelFetch(areas, pixel, 0).r);
    float departure = 1.0;
    ratios = uvec4(0u);
    int radius = 1;
    for (int i = 0; i < 3; ++i) {
        Held coarse = held_in(box_at(pixel, extent, radius));
        float limit = threshold(float(radius / 2), float(radius));
        float of_noise = ratio(fine, coarse, limit);
        ratios[i] = in_units(of_noise);
        if (radius == 2 && all(greaterThanEqual(extent, ivec4(2)))) {
            departure = of_noise * limit;
        }
        fine = coarse;
        radius *= 2;
    }
    ratios.a = uint(0.125 * float(own.a) * departure + chance(pixel, 3u));
}
