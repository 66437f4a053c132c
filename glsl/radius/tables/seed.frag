// Level 0 of a structure: the density map in the structure's number type, 0 where the structure is larger.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;

// Photons of the pixel.
layout(location = 0) out SUM photons;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    photons = all(lessThan(pixel, map_size)) ? wrapped(photons_at(pixel)) : SUM(0);
#ifdef SUM_MINUS_MEAN
    photons -= mean;
#endif
}
