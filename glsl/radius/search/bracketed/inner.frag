// The radii that a block's pixels can have, where no edge is in reach: in as many steps for each block,
// without a loop or a branch.

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
    int end = min(smallest + WIDER_SIDE - SIDE, largest);
    for (int step = 0; step < STEPS; ++step) {
        int middle = (smallest + end) >> 1;
        bool holds = enough_for_some(middle);
        smallest = holds ? smallest : min(middle + 1, end);
        end = holds ? middle : end;
    }
    bracket = bracket_of(smallest, min(smallest + SIDE - 1, largest));
}
