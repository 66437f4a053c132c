// Pixels that need no radius are 0 in the mask, and get 0, which no other pixel has.

#ifdef MASKED
// 0 where a pixel needs no radius; one texel that is not 0 where all pixels need one.
uniform usampler2D mask;

bool needs_none(ivec2 pixel)
{
    return texelFetch(mask, min(pixel, textureSize(mask, 0) - 1), 0).r == 0u;
}
#else
bool needs_none(ivec2 pixel)
{
    return false;
}
#endif
