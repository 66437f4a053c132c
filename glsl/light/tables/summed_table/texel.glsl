// What is summed: one number a texel, or four.
#ifdef ONE_CHANNEL
#define TEXEL uint

TEXEL value_of(uvec4 texel)
{
    return texel.r;
}
#else
#define TEXEL uvec4

TEXEL value_of(uvec4 texel)
{
    return texel;
}
#endif

// Texels of a line.
uniform int count;

#ifdef LAYERED
// Sums along rows: of eight texels that follow each other, the i-th is in layer i.
uniform usampler2DArray texels;

TEXEL texel_at(ivec2 place)
{
    return value_of(texelFetch(texels, ivec3(place.x >> 3, place.y, place.x & 7), 0));
}
#else
// What is summed.
uniform usampler2D texels;

TEXEL texel_at(ivec2 place)
{
    return value_of(texelFetch(texels, place, 0));
}
#endif

#ifdef ALONG_ROWS
ivec2 place_of(int along, ivec2 pixel)
{
    return ivec2(along, pixel.y);
}

int along(ivec2 pixel)
{
    return pixel.x;
}
#else
ivec2 place_of(int along, ivec2 pixel)
{
    return ivec2(pixel.x, along);
}

int along(ivec2 pixel)
{
    return pixel.y;
}
#endif
