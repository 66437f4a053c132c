// Draws the pixels whose radius two boxes do not prove: one that holds enough, and a smaller one that does
// not. Follows a counter that defines: uint count_in_box(ivec2 lo, ivec2 hi), both corners included and
// inside the map.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;
// MR, in pixels.
uniform uint max_radius;
// The radius map to be proved, in pixels.
uniform usampler2D radii;
#ifdef LIMITED_MASK
// The map's mark of pixels: 1 where MR ended the search with too few photons.
uniform usampler2D limited;
#endif

bool enough_within(ivec2 center, int r)
{
    ivec2 lo = max(center - r, ivec2(0));
    ivec2 hi = min(center + r, map_size - 1);
    uint side = uint(2 * r + 1);
    uvec2 inside = uvec2(hi - lo + 1);
    return enough(count_in_box(lo, hi), side * side, inside.x * inside.y);
}

void main()
{
    ivec2 center = min(ivec2(gl_FragCoord.xy), map_size - 1);
    uint radius = texelFetch(radii, center, 0).r;
    // A value outside of 1 to MR is never proved; its boxes are those of the nearest radius.
    uint r = clamp(radius, 1u, max_radius);
    bool holds = enough_within(center, int(r));
    // A search starts at 1: below there is nothing to prove.
    bool smaller_holds = enough_within(center, int(r) - 1) && r > 1u;
    bool proved = r == radius && !smaller_holds && (holds || r == max_radius);
#ifdef LIMITED_MASK
    proved = proved && texelFetch(limited, center, 0).r == (holds ? 0u : 1u);
#endif
    if (proved) {
        discard;
    }
}
