// How far a box and one of half its radius are from an even density. Follows a counter that defines: uint
// count_in_box(ivec2 lo, ivec2 hi).

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;

// What a box holds.
struct Held {
    uint photons;
    uint area;
};

Held held_in(ivec2 center, int r)
{
    ivec2 lo = max(center - r, ivec2(0));
    ivec2 hi = min(center + r, map_size - 1);
#ifdef EDGES_ZERO
    uvec2 sides = uvec2(2 * r + 1);
#else
    uvec2 sides = uvec2(hi - lo + 1);
#endif
    return Held(count_in_box(lo, hi), sides.x * sides.y);
}

// Numbers of 64 bits, as (high word, low word).
bool is_less(uvec2 a, uvec2 b)
{
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

uvec2 sum(uvec2 a, uvec2 b)
{
    uint low = a.y + b.y;
    return uvec2(a.x + b.x + (low < a.y ? 1u : 0u), low);
}

uvec2 difference(uvec2 a, uvec2 b)
{
    return uvec2(a.x - b.x - (a.y < b.y ? 1u : 0u), a.y - b.y);
}

// The square of w p - u q over its variance p q (u + w + 1), in steps: u photons in an area p of the narrow
// box, w in an area q of the ring around it. Whole numbers throughout, cut off as a division does it.
uint departure(Held narrow, Held wide, int wide_radius)
{
    uint ring_area = wide.area - narrow.area;
    if (ring_area == 0u) {
        // The map ends both: nothing is known, which decides nothing.
        uvec2 limit = threshold(wide_radius);
        return (limit.x << EVEN_STEPS_LOG2) / limit.y;
    }
    uvec2 ring = product(wide.photons - narrow.photons, narrow.area);
    uvec2 inside = product(narrow.photons, ring_area);
    uvec2 apart = is_less(ring, inside) ? difference(inside, ring) : difference(ring, inside);
    // Areas of up to 65^2 and 129^2 - 65^2 make a variance of less than 2^58.
    uint areas = narrow.area * ring_area;
    uvec2 variance = sum(product(wide.photons, areas), uvec2(0u, areas));
    uvec2 two = sum(variance, variance);
    uvec2 four = sum(two, two);
    // From 2^32 on, the square is larger than any six variances.
    uvec2 rest = product(apart.y, apart.y);
    if (apart.x != 0u || !is_less(rest, sum(four, two))) {
        return uint(MOST_EVEN_STEPS);
    }
    // Bit by bit: of 4, 2 and 1 variances, then of their halves.
    uint steps = 0u;
    for (int bit = 0; bit < 3 + EVEN_STEPS_LOG2; ++bit) {
        steps <<= 1;
        if (!is_less(rest, four)) {
            rest = difference(rest, four);
            steps |= 1u;
        }
        rest = sum(rest, rest);
    }
    return steps;
}
