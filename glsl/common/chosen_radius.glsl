// The radius of a pixel, in pixels: from the radius map, or the same everywhere.
#ifdef FIXED_RADIUS
uniform uint fixed_radius;

uint radius_at(ivec2 pixel)
{
    return fixed_radius;
}
#else
uniform usampler2D radii;

uint radius_at(ivec2 pixel)
{
    return texelFetch(radii, pixel, 0).r;
}
#endif
