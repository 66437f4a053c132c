// Does a box with this many photons hold enough? The edge rule of thesis 3.1 and 4.4.

// n: photons that a box has to hold.
uniform uint min_photons;

#ifdef WIDE_PRODUCTS
// a * b as (high word, low word).
uvec2 product(uint a, uint b)
{
    uint a_low = a & 0xFFFFu, a_high = a >> 16;
    uint b_low = b & 0xFFFFu, b_high = b >> 16;
    uint low = a_low * b_low;
    uint middle_a = a_low * b_high;
    uint middle_b = a_high * b_low;
    uint carry = (low >> 16) + (middle_a & 0xFFFFu) + (middle_b & 0xFFFFu);
    return uvec2(a_high * b_high + (middle_a >> 16) + (middle_b >> 16) + (carry >> 16),
                 (carry << 16) | (low & 0xFFFFu));
}

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
