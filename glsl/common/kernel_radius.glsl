// The radius of a pixel, in pixels: from the radius map, or the same everywhere.

#ifdef FIXED_RADIUS
// The radius of all kernels, in pixels.
uniform uint fixed_radius;

uint radius_at(ivec2 pixel)
{
    return fixed_radius;
}
#else
// The radius map, in pixels.
uniform usampler2D radii;

uint radius_at(ivec2 pixel)
{
    return texelFetch(radii, pixel, 0).r;
}
#endif
