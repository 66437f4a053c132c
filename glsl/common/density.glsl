// The density map: photons per pixel, whole numbers in R32UI, R8UI or R32F.

// Photons per pixel.
#ifdef DENSITY_F32
uniform sampler2D density;
#else
uniform usampler2D density;
#endif

// Larger counts are taken as this many: n where that keeps the sums exact, else the largest uint.
uniform uint count_limit;

SUM photons_at(ivec2 pixel)
{
    return SUM(min(to_count(texelFetch(density, pixel, 0).r), count_limit));
}
