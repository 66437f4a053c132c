// Every pixel of the box, left to right and row by row (thesis 3.2, 4.1).
uint count_in_box(ivec2 lo, ivec2 hi)
{
    SUM sum = SUM(0);
    for (int y = lo.y; y <= hi.y; ++y) {
        for (int x = lo.x; x <= hi.x; ++x) {
            sum += photons_at(ivec2(x, y));
        }
    }
    return to_count(sum);
}
