// Listing 4.2 with its faults, each by its own define. Reads outside the texture, which the listing makes and
// GLSL leaves undefined, give 0 here, the border colour that 4.1 relies on.

// The summed-area table.
uniform SUM_SAMPLER table;
// Columns and rows of the table.
uniform ivec2 table_size;

uint entry(ivec2 p)
{
    bool inside = all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, table_size));
    return inside ? to_count(texelFetch(table, p, 0).r) : 0u;
}

ivec2 clamped(ivec2 p)
{
#ifdef FAULT_CLAMP_TO_63
    return clamp(p, 0, 63);
#else
    return clamp(p, ivec2(0), table_size - 1);
#endif
}

uint count_in_box(ivec2 lo, ivec2 hi)
{
    // The listing subtracts what is before the box: its ll is one left of and one below the corner.
    ivec2 ll = lo - 1;
    ivec2 ur = hi;
#ifdef FAULT_BORDER_TEST
    bvec2 cut = greaterThan(ll, ivec2(0));
#else
    bvec2 cut = greaterThanEqual(ll, ivec2(0));
#endif
#ifdef FAULT_CORNER_TEST
    bool corner = !(ll.x < 0 && ll.y < 0);
#else
    bool corner = all(cut);
#endif
    uint value = entry(clamped(ur));
    if (cut.x) {
        value -= entry(clamped(ivec2(ll.x, ur.y)));
    }
    if (cut.y) {
        value -= entry(clamped(ivec2(ur.x, ll.y)));
    }
    if (corner) {
        value += entry(ll);
    }
    // The listing's value is an int; below zero is no photon.
    return uint(max(int(value), 0));
}
