// Products of 64 bits.

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
