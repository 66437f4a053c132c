// Extents, twice as far: what a pixel reaches, and what the last pixel of that reaches.

// Extents so far: left, right, down and up.
uniform usampler2D shorter;
// The most that they can be so far.
uniform int most;

// In pixels: left, right, down and up.
layout(location = 0) out uvec4 extent;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 ways[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
    extent = texelFetch(shorter, pixel, 0);
    for (int way = 0; way < 4; ++way) {
        if (int(extent[way]) == most) {
            extent[way] += texelFetch(shorter, pixel + most * ways[way], 0)[way];
        }
    }
}
