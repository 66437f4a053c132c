// Every pixel of the box, four of a row in each turn of the loop (thesis 6.2.5).
// Those past the end of the row are fetched at its end and not counted, so that no fetch waits for a test.
uint count_in_box(ivec2 lo, ivec2 hi)
{
    SUM sum = SUM(0);
    for (int y = lo.y; y <= hi.y; ++y) {
        for (int x = lo.x; x <= hi.x; x += 4) {
            ivec3 next = x + ivec3(1, 2, 3);
            ivec3 fetched = min(next, ivec3(hi.x));
            SUM first = photons_at(ivec2(x, y));
            SUM second = photons_at(ivec2(fetched.x, y));
            SUM third = photons_at(ivec2(fetched.y, y));
            SUM fourth = photons_at(ivec2(fetched.z, y));
            sum += first;
            sum += next.x <= hi.x ? second : SUM(0);
            sum += next.y <= hi.x ? third : SUM(0);
            sum += next.z <= hi.x ? fourth : SUM(0);
        }
    }
    return to_count(sum);
}
