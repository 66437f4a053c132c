// The radii that a block's pixels can have, where counts may be scaled: both bounds are searched.

// Brackets of the blocks that these lie in, as `bracket`.
uniform usampler2D wider;

// The smallest radius in the lower 16 bits, the largest in the upper; in pixels.
layout(location = 0) out uint bracket;

void main()
{
    find_block();
    uint known = texelFetch(wider, first >> WIDER_SIDE_LOG2, 0).r;
    int smallest = int(known & 0xFFFFu);
    int largest = int(known >> 16);
    smallest = smallest_between(smallest, largest);
    bracket = bracket_of(smallest, largest_between(smallest, largest));
}
