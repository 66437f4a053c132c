// All four corners of the table first, moved inside it, and only then which of them count (thesis 6.4.5).

// The summed-area table.
uniform SUM_SAMPLER table;

SUM entry(int x, int y)
{
    return texelFetch(table, ivec2(x, y), 0).r;
}

uint count_in_box(ivec2 lo, ivec2 hi)
{
    ivec2 before = max(lo - 1, ivec2(0));
    SUM all_up_to = entry(hi.x, hi.y);
    SUM left = entry(before.x, hi.y);
    SUM below = entry(hi.x, before.y);
    SUM corner = entry(before.x, before.y);

    bvec2 cut = greaterThan(lo, ivec2(0));
    SUM sum = all_up_to;
    sum -= cut.x ? left : SUM(0);
    sum -= cut.y ? below : SUM(0);
    sum += all(cut) ? corner : SUM(0);
    return photons_in(sum, lo, hi);
}
