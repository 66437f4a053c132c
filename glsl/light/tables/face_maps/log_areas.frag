// Areas that the pixels of a block see: the sum of their logarithms.

// Sum of logarithms to base 2, of areas in squares of a scene unit; g: pixels on diffuse surfaces.
layout(location = 0) out vec4 sum;

void main()
{
    ivec2 first = ivec2(gl_FragCoord.xy) * BLOCK;
    ivec2 end = min(first + BLOCK, map_size);
    sum = vec4(0.0);
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            Surface surface = surface_at(ivec2(x, y));
            if (surface.number > 0.0) {
                float area = area_on(surface, 1e-3);
                sum.xy += vec2(log2(clamp(area, 1e-30, 1e30)), 1.0);
            }
        }
    }
}
