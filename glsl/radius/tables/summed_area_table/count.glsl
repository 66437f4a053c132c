// Four corners of the table; what lies before the first row or column is nothing (thesis 3.4, Figure 3.6).

// The summed-area table.
uniform SUM_SAMPLER table;

SUM entry(int x, int y)
{
    return texelFetch(table, ivec2(x, y), 0).r;
}

uint count_in_box(ivec2 lo, ivec2 hi)
{
    SUM sum = entry(hi.x, hi.y);
    if (lo.x > 0) {
        sum -= entry(lo.x - 1, hi.y);
    }
    if (lo.y > 0) {
        sum -= entry(hi.x, lo.y - 1);
    }
    if (lo.x > 0 && lo.y > 0) {
        sum += entry(lo.x - 1, lo.y - 1);
    }
    return photons_in(sum, lo, hi);
}
