// Which of its four neighbours are on the same face as a pixel.

// 1 for each: left, right, down and up.
layout(location = 0) out uvec4 extent;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Surface surface = surface_at(pixel);
    ivec2 ways[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
    extent = uvec4(0u);
    for (int way = 0; way < 4; ++way) {
        ivec2 other = pixel + ways[way];
        bool inside = all(greaterThanEqual(other, ivec2(0))) && all(lessThan(other, map_size));
        if (inside && share_a_face(surface, surface_at(other))) {
            extent[way] = 1u;
        }
    }
}
