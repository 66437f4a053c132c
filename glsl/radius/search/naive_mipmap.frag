// Up one column of the pyramid until a texel holds enough (thesis 3.3.1, Figure 3.3).
// The texel's block is not centred on the pixel: that is the fault which the thesis shows.

// The mipmap of sums.
uniform SUM_SAMPLER pyramid;
// The mipmap's last level.
uniform int top_level;
// Columns and rows of the map, in pixels.
uniform ivec2 map_size;
// MR, in pixels.
uniform int max_radius;

// The radius in pixels; 0 where the mask is 0.
layout(location = 0) out uint radius;
#ifdef LIMITED_MASK
// 1 where MR ended the search with too few photons, else 0.
layout(location = 1) out uint limited;
#endif

void main()
{
    // Helper fragments of a quad may lie outside the map.
    ivec2 pixel = min(ivec2(gl_FragCoord.xy), map_size - 1);
    int level = 0;
    int r = 0;
    bool masked = needs_none(pixel);
    bool found = masked;
    while (!found && r < max_radius) {
        // Level l stands for radius 2^(l - 1): half the side of its block.
        ++level;
        r = min(1 << (level - 1), max_radius);
        ivec2 block = pixel >> level;
        int side = 1 << level;
        ivec2 lo = block * side;
        uvec2 inside = uvec2(min(lo + side, map_size) - lo);
        // Past the top the block only grows outside the map.
        uint count = to_count(texelFetch(pyramid, block, min(level, top_level)).r);
        found = enough(count, uint(side) * uint(side), inside.x * inside.y);
    }
    radius = masked ? 0u : uint(r);
#ifdef LIMITED_MASK
    limited = found ? 0u : 1u;
#endif
}
