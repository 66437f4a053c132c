// Sums of blocks, added up.

// Sums of smaller blocks.
uniform sampler2D sums;

// Sum of logarithms to base 2, of areas in squares of a scene unit; g: pixels on diffuse surfaces.
layout(location = 0) out vec4 sum;

void main()
{
    ivec2 first = ivec2(gl_FragCoord.xy) * BLOCK;
    ivec2 end = min(first + BLOCK, textureSize(sums, 0));
    sum = vec4(0.0);
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            sum += texelFetch(sums, ivec2(x, y), 0);
        }
    }
}
