// What one radius costs a summed-area table at least: four fetches and their sum. The corners are those of a
// box of radius 3, moved to the border where they would lie outside.

// Photons per pixel.
uniform usampler2D density;
// Columns and rows of the map, in pixels.
uniform ivec2 map_size;

// The sum, which means nothing.
layout(location = 0) out uint photons;

void main()
{
    ivec2 center = ivec2(gl_FragCoord.xy);
    ivec2 lo = max(center - 4, ivec2(0));
    ivec2 hi = min(center + 3, map_size - 1);
    photons = texelFetch(density, hi, 0).r - texelFetch(density, ivec2(lo.x, hi.y), 0).r
            - texelFetch(density, ivec2(hi.x, lo.y), 0).r + texelFetch(density, lo, 0).r;
}
