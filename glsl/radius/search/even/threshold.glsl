// The departure of a box and one of half its radius that is still taken for even, as a fraction.

// Where the wide box is as wrong by its bias, which grows with the square of its side, as the narrow one is
// by its noise.
uvec2 threshold(int wide)
{
    int narrow = wide / 2;
    uint a = uint((2 * narrow + 1) * (2 * narrow + 1));
    uint b = uint((2 * wide + 1) * (2 * wide + 1));
    return uvec2(2u * b, a + b);
}
