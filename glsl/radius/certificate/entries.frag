// Draws the pixels whose count is not what the table says: the sum of a box of one pixel. Where there is
// none, the table is the sum of the counts, since it is nothing before the first row and column.

// The summed-area table.
uniform SUM_SAMPLER table;

uint entry(int x, int y)
{
    return to_count(texelFetch(table, ivec2(x, y), 0).r);
}

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    ivec2 before = max(p - 1, ivec2(0));
    uint here = entry(p.x, p.y);
    uint left = entry(before.x, p.y);
    uint below = entry(p.x, before.y);
    uint corner = entry(before.x, before.y);

    bvec2 cut = greaterThan(p, ivec2(0));
    uint sum = here - (cut.x ? left : 0u) - (cut.y ? below : 0u) + (all(cut) ? corner : 0u);
    // An f32 may hold what is no whole number.
    bool whole = SUM(here) == texelFetch(table, p, 0).r;
    if (whole && wrapped(sum) == wrapped(to_count(photons_at(p)))) {
        discard;
    }
}
