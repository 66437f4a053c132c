// Does a box with this many photons hold enough? The edge rule of thesis 3.1 and 4.4.

// n: photons that a box has to hold.
uniform uint min_photons;

#ifdef WIDE_PRODUCTS
bool at_least(uint a, uint b, uint c, uint d)
{
    uvec2 left = product(a, b);
    uvec2 right = product(c, d);
    return left.x > right.x || (left.x == right.x && left.y >= right.y);
}
#else
// a * b >= c * d, where both fit 32 bits.
bool at_least(uint a, uint b, uint c, uint d)
{
    return a * b >= c * d;
}
#endif

bool enough(uint count, uint total_area, uint inside_area)
{
#if defined(EDGES_ZERO)
    return count >= min_photons;
#elif defined(FAULT_FLOAT_RATIO)
    // 4.4: outside area over inside area, clamped to 0, scales the sum.
    float ratio = max(float(total_area - inside_area) / float(inside_area), 0.0);
    return float(count) + float(count) * ratio >= float(min_photons);
#else
    // count * total / inside >= n without the division. A count of n passes without the products,
    // so they stay below n * total.
    return count >= min_photons || at_least(count, total_area, min_photons, inside_area);
#endif
}
