// Radii of all pixels from those of fewer places, straight between them and even beyond the last.

// Radii of the places, in their own pixels.
uniform usampler2D places;
// Columns and rows of places.
uniform ivec2 places_size;
// Pixels from a place to the next.
uniform int spacing;
// Where the first one is, in pixels.
uniform float first_place;
// A radius there times this, plus the summand, is one here.
uniform float factor;
// In pixels.
uniform float summand;
// MR, in pixels.
uniform int max_radius;

// The radius in pixels.
layout(location = 0) out uint radius;

float radius_of(ivec2 place)
{
    return float(texelFetch(places, clamp(place, ivec2(0), places_size - 1), 0).r);
}

void main()
{
    vec2 at = (floor(gl_FragCoord.xy) - first_place) / float(spacing);
    ivec2 place = ivec2(floor(at));
    vec2 share = at - floor(at);
    float below = mix(radius_of(place), radius_of(place + ivec2(1, 0)), share.x);
    float above = mix(radius_of(place + ivec2(0, 1)), radius_of(place + ivec2(1, 1)), share.x);
    // Sides are powers of two, so nothing is rounded before this.
    float wanted = floor(factor * mix(below, above, share.y) + summand + 0.5);
    radius = uint(clamp(wanted, 1.0, float(max_radius)));
}
