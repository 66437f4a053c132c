// The smallest radius whose box holds enough photons (thesis 1.3, 3.5). Follows a counter that defines: uint
// count_in_box(ivec2 lo, ivec2 hi), both corners included and inside the map (BOX_UNCLIPPED: as they come,
// for a counter that clips by itself).

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;
// MR, in pixels.
uniform int max_radius;
#ifdef ORDER_FORWARD
// The first radius that this pass tries, in pixels; one pass tries all unless the renderer limits loops.
uniform int first_radius;
// The last radius that it tries, in pixels.
uniform int last_radius;
#endif
#ifdef CONTINUED
// What the passes over smaller radii found, in pixels, 0 where they found nothing.
uniform usampler2D found_before;
#endif
#ifdef ORDER_BRACKETED
// Radii that the pixels of a block can have: the smallest in the lower 16 bits, the largest in the upper.
uniform usampler2D brackets;
#endif

// The radius in pixels; 0 where the mask is 0.
layout(location = 0) out uint radius;
#ifdef LIMITED_MASK
// 1 where MR ended the search with too few photons, else 0.
layout(location = 1) out uint limited;
#endif

bool enough_within(ivec2 center, int r)
{
    ivec2 lo = max(center - r, ivec2(0));
    ivec2 hi = min(center + r, map_size - 1);
#ifdef BOX_UNCLIPPED
    uint count = count_in_box(center - r, center + r);
#else
    uint count = count_in_box(lo, hi);
#endif
    uint side = uint(2 * r + 1);
    uvec2 inside = uvec2(hi - lo + 1);
    return enough(count, side * side, inside.x * inside.y);
}

void main()
{
    // Helper fragments of a quad may lie outside the map; there they could loop forever.
#ifdef GRID_STEP
    ivec2 center = min(GRID_STEP * ivec2(gl_FragCoord.xy) + GRID_STEP / 2, map_size - 1);
#else
    ivec2 center = min(ivec2(gl_FragCoord.xy), map_size - 1);
#endif
    bool masked = needs_none(center);

#ifdef ORDER_FORWARD
    int r = first_radius;
    bool found = masked;
#ifdef CONTINUED
    uint before = texelFetch(found_before, center, 0).r;
    if (!masked && before != 0u) {
        r = int(before);
        found = true;
    }
#endif
    if (!found) {
        found = enough_within(center, r);
        while (!found && r < last_radius) {
            found = enough_within(center, ++r);
        }
        if (!found && r < max_radius) {
            r = 0;
        }
    }
#elif defined(ORDER_BRACKETED)
    uint bracket = texelFetch(brackets, center >> WIDER_SIDE_LOG2, 0).r;
    int r = int(bracket & 0xFFFFu);
    int last = int(bracket >> 16);
#if CLASS == CLASS_INNER
    // At most two are left.
    r = enough_within(center, r) ? r : last;
#else
    while (r < last && !masked) {
        int middle = (r + last) >> 1;
        if (enough_within(center, middle)) {
            last = middle;
        } else {
            r = middle + 1;
        }
    }
#endif
    // A bracket reaches past MR where the mask of limited pixels needs to know whether MR was enough.
    bool found = r <= max_radius;
    r = min(r, max_radius);
#else
    // Everything below `r` is known to be too small, `last` is known to be enough or is MR.
    int r = 1;
    int last = max_radius;
    bool found = false;
    while (r < last && !masked) {
        int middle = (r + last) >> 1;
        if (enough_within(center, middle)) {
            last = middle;
            found = true;
        } else {
            r = middle + 1;
        }
    }
#ifdef LIMITED_MASK
    // The search never counts MR itself unless MR is 1.
    found = found || enough_within(center, r);
#endif
#endif

    radius = masked ? 0u : uint(r);
#ifdef LIMITED_MASK
    limited = found || masked ? 0u : 1u;
#endif
}
