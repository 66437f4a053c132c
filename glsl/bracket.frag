// The smallest and the largest radius that any pixel of a block can have.
// Follows a counter that defines: uint count_in_box(ivec2 lo, ivec2 hi), both corners included and inside the map.
//
// The boxes of all the block's pixels, together, hold the photons of one box around the block; what all of them have in
// common holds those of another. The first radius at which the one holds enough bounds the radii from below, that of the
// other from above. Without an edge in reach, the other lags behind by the block's side less 1.
uniform ivec2 map_size;
uniform int side;
#ifdef INSIDE_WIDER
// What is known of the blocks that this one lies in.
uniform usampler2D wider;
uniform int wider_side;
#else
// Ends every search: MR, or MR + 1 where "not even MR" is to be told from MR.
uniform int last_radius;
#endif

layout(location = 0) out uint bracket;

ivec2 first;
ivec2 last;

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

void main()
{
    ivec2 block = min(ivec2(gl_FragCoord.xy), (map_size - 1) / side);
    first = block * side;
    last = min(first + side - 1, map_size - 1);

#ifdef INSIDE_WIDER
    uint known = texelFetch(wider, first / wider_side, 0).r;
    int smallest = int(known & 0xFFFFu);
    int largest = int(known >> 16);
#else
    int smallest = 1;
    int largest = last_radius;
#endif

    int end = largest;
    while (smallest < end) {
        int middle = (smallest + end) / 2;
        if (enough_for_some(middle)) {
            end = middle;
        } else {
            smallest = middle + 1;
        }
    }

    int lagging = min(smallest + side - 1, largest);
    bool edge_in_reach = false;
#ifndef EDGES_ZERO
    edge_in_reach = any(lessThan(first, ivec2(lagging))) || any(greaterThan(last + lagging, map_size - 1));
#endif
    if (!edge_in_reach) {
        largest = lagging;
    }
    // Radii start at 1, so that the lag can be less there.
    if (edge_in_reach || smallest == 1) {
        int start = smallest;
        while (start < largest) {
            int middle = (start + largest) / 2;
            if (enough_for_all(middle)) {
                largest = middle;
            } else {
                start = middle + 1;
            }
        }
    }
    bracket = uint(smallest) | uint(largest) << 16;
}
