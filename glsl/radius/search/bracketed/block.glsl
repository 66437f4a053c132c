// Boxes around the pixels of a block of SIDE x SIDE. Follows a counter that defines: uint count_in_box(ivec2
// lo, ivec2 hi), both corners included and inside the map.
//
// The boxes of all the block's pixels, together, hold the photons of one box around the block; what all of
// them have in common holds those of another. The first radius at which the one holds enough bounds the radii
// from below, that of the other from above. Without an edge in reach, the other lags behind by SIDE - 1.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;

ivec2 first;
ivec2 last;

void find_block()
{
    ivec2 block = min(ivec2(gl_FragCoord.xy), (map_size - 1) >> SIDE_LOG2);
    first = block << SIDE_LOG2;
    last = min(first + SIDE - 1, map_size - 1);
}

uint bracket_of(int smallest, int largest)
{
    return uint(smallest) | uint(largest) << 16;
}

ivec2 inside(ivec2 center, int r)
{
    return min(center + r, map_size - 1) - max(center - r, ivec2(0)) + 1;
}

uint total_area(int r)
{
    uint side = uint(2 * r + 1);
    return side * side;
}

bool enough_for_some(int r)
{
    // Along an axis, a box has least of its length inside for a pixel at an end of the block.
    uvec2 least = uvec2(min(inside(first, r), inside(last, r)));
    uint count = count_in_box(max(first - r, ivec2(0)), min(last + r, map_size - 1));
    return enough(count, total_area(r), least.x * least.y);
}

bool enough_for_all(int r)
{
    ivec2 lo = max(last - r, ivec2(0));
    ivec2 hi = min(first + r, map_size - 1);
    // It has most for the pixel that is nearest to the middle of the map.
    uvec2 most = uvec2(inside(clamp((map_size - 1) / 2, first, last), r));
    return all(lessThanEqual(lo, hi)) && enough(count_in_box(lo, hi), total_area(r), most.x * most.y);
}

// The smallest radius of any pixel, between `smallest` and `largest`.
int smallest_between(int smallest, int largest)
{
    while (smallest < largest) {
        int middle = (smallest + largest) >> 1;
        if (enough_for_some(middle)) {
            largest = middle;
        } else {
            smallest = middle + 1;
        }
    }
    return smallest;
}

// The largest.
int largest_between(int smallest, int largest)
{
    while (smallest < largest) {
        int middle = (smallest + largest) >> 1;
        if (enough_for_all(middle)) {
            largest = middle;
        } else {
            smallest = middle + 1;
        }
    }
    return largest;
}
