// The area that each pixel sees, in whole units.
//
// Areas beyond the largest weight count as that: their pixels' light is averaged evenly. Those below two
// thirds of a unit are left out. So are pixels at the edge of a face, which see less of it than their area
// says, where the face has others.
// The widest box of such pixels, 129 x 129, holds less than 2^32.
const float MOST_UNITS = 258095.0;

// 1 where a neighbour is on the same face: left, right, down and up.
uniform usampler2D links;

// Units of area; 0 where nothing is lit.
layout(location = 0) out uint area;
// What the pixel's flux is multiplied with, so that its light stays that over its true area.
layout(location = 1) out float weight;

// Whether a neighbour inside the picture is on another face.
bool is_at_an_edge(ivec2 pixel)
{
    uvec4 linked = texelFetch(links, pixel, 0);
    bvec4 ends = bvec4(pixel.x == 0, pixel.x == map_size.x - 1, pixel.y == 0, pixel.y == map_size.y - 1);
    return (linked.x == 0u && !ends.x) || (linked.y == 0u && !ends.y) || (linked.z == 0u && !ends.z)
        || (linked.w == 0u && !ends.w);
}

// Whether the face has a pixel beside this one that is not at an edge.
bool has_an_inside(ivec2 pixel)
{
    uvec4 linked = texelFetch(links, pixel, 0);
    return (linked.x == 1u && !is_at_an_edge(pixel - ivec2(1, 0)))
        || (linked.y == 1u && !is_at_an_edge(pixel + ivec2(1, 0)))
        || (linked.z == 1u && !is_at_an_edge(pixel - ivec2(0, 1)))
        || (linked.w == 1u && !is_at_an_edge(pixel + ivec2(0, 1)));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Surface surface = surface_at(pixel);
    area = 0u;
    weight = 0.0;
    if (surface.number > 0.0) {
        float exact = area_on(surface, 1e-3) / area_unit();
        float whole = min(floor(exact + 0.5), MOST_UNITS);
        if (3.0 * exact >= 2.0 && !(is_at_an_edge(pixel) && has_an_inside(pixel))) {
            area = uint(whole);
            weight = whole / exact;
        }
    }
}
