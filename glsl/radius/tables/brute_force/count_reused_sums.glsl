// From one radius to the next a box grows by a ring: only the ring is read, and its sum kept (thesis 6.2.5).
// A forward search asks for boxes around one centre by growing radius, and for boxes as they come
// (BOX_UNCLIPPED).
int counted_radius = 0;
SUM counted = SUM(0);

SUM photons_if_inside(ivec2 pixel)
{
    bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, textureSize(density, 0)));
    return inside ? photons_at(pixel) : SUM(0);
}

uint count_in_box(ivec2 lo, ivec2 hi)
{
    ivec2 center = (lo + hi) / 2;
    int r = (hi.x - lo.x) / 2;
    if (counted_radius == 0) {
        counted = photons_at(center);
    }
    // One ring, but for a pass that goes on after smaller radii: its first box is all rings.
    while (counted_radius < r) {
        ++counted_radius;
        // The four sides at once, each from one corner to before the next.
        for (int i = -counted_radius; i < counted_radius; ++i) {
            counted += photons_if_inside(center + ivec2(i, -counted_radius));
            counted += photons_if_inside(center + ivec2(counted_radius, i));
            counted += photons_if_inside(center + ivec2(-i, counted_radius));
            counted += photons_if_inside(center + ivec2(-counted_radius, -i));
        }
    }
    return to_count(counted);
}
