// The radii that a tile's pixels can have, and the class of passes that find them.
// MR, or MR + 1 where "not even MR" is to be told from MR.
uniform int last_radius;
#ifdef MASKED
uniform usampler2D tile_mask;
#endif
#ifdef CHANGED
// What the frame before found, and where counts differ from it: `changed_first` to before `changed_end`.
uniform usampler2D brackets_before;
uniform ivec2 changed_first;
uniform ivec2 changed_end;
#endif

layout(location = 0) out uint bracket;
layout(location = 1) out uint tile_class;

void main()
{
    find_block();
    int most = last_radius;
#ifdef CHANGED
    int largest_before = int(texelFetch(brackets_before, ivec2(gl_FragCoord.xy), 0).r >> 16);
#ifdef ONLY_ADDED
    // More photons make no radius larger.
    most = largest_before;
#endif
#endif
    int smallest = smallest_between(1, most);
    int largest = min(smallest + SIDE - 1, most);
    tile_class = uint(CLASS_INNER);
#ifndef EDGES_ZERO
    if (any(lessThan(first, ivec2(largest))) || any(greaterThan(last + largest, map_size - 1))) {
        tile_class = uint(CLASS_EDGE);
        largest = largest_between(smallest, most);
    }
#endif
    // With n in 16 pixels on the average, most radii are 1, some 2: what a forward search finds soonest.
    uvec2 extent = uvec2(last - first + 1);
    if (count_in_box(first, last) / (extent.x * extent.y / 16u + 1u) >= min_photons) {
        tile_class = uint(CLASS_DENSE);
    }
    if (smallest == last_radius) {
        tile_class = uint(CLASS_UNREACHED);
    }
#ifdef MASKED
    if (texelFetch(tile_mask, ivec2(gl_FragCoord.xy), 0).r == 0u) {
        tile_class = uint(CLASS_UNREACHED);
    }
#endif
#ifdef CHANGED
    // A box that held enough, without a changed pixel in it, still does, and a smaller one still does not.
    ivec2 distance = max(changed_first - last, first - (changed_end - 1));
    if (max(distance.x, distance.y) > largest_before) {
        tile_class = uint(CLASS_KEPT);
    }
#endif
    bracket = bracket_of(smallest, largest);
}
