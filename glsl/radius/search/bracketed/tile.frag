// The radii that a tile's pixels can have, and the class of programs that find them.

// MR, or MR + 1 where "not even MR" is to be distinguished from MR; in pixels.
uniform int last_radius;
#ifdef MASKED
// Not 0 where a tile has pixels that need a radius; one texel that is not 0 where all have.
uniform usampler2D tile_mask;
#endif
#ifdef CHANGED
// Brackets of the tiles in the frame before.
uniform usampler2D brackets_before;
// The first column and row whose counts differ from that frame's, in pixels.
uniform ivec2 changed_first;
// The column and row after the last of them.
uniform ivec2 changed_end;
#endif

// The smallest radius in the lower 16 bits, the largest in the upper; in pixels.
layout(location = 0) out uint bracket;
// Which programs find the tile's radii: one of CLASS_...
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
    ivec2 tile = min(ivec2(gl_FragCoord.xy), textureSize(tile_mask, 0) - 1);
    if (texelFetch(tile_mask, tile, 0).r == 0u) {
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
