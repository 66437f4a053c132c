// A photon as a vertex, and the pixel that it is in.

// Where the photon landed, in scene units.
layout(location = 0) in vec3 photon_position;
// Normal of the surface there, on the side that it came from.
layout(location = 1) in vec3 photon_normal;
// Red, green and blue, in the unit of the lights' power.
layout(location = 2) in vec3 photon_power;
// The surface's number, from 1.
layout(location = 3) in float photon_surface;

// To clip space, with row 0 of the picture at the bottom.
uniform mat4 to_clip;

// Where a place is in the picture, in pixels; behind the camera and far beside the picture: somewhere
// outside.
vec2 pixel_of(vec3 place)
{
    vec4 clip = to_clip * vec4(place, 1.0);
    vec2 at = clip.w > 0.0 ? clamp(clip.xy / clip.w, -4.0, 4.0) : vec2(-4.0);
    return (at * 0.5 + 0.5) * vec2(map_size);
}

// Whether the photon is visible: in the picture, and on the surface that its pixel shows. It may lie half a
// pixel before or behind that surface's plane, which is what a curved surface may bend away within a pixel.
bool contributes(ivec2 pixel, Surface surface)
{
    return (to_clip * vec4(photon_position, 1.0)).w > 0.0
        && all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, map_size))
        && surface.number == photon_surface && dot(surface.normal, photon_normal) > LEAST_AGREEMENT
        && abs(dot(surface.normal, photon_position - surface.position)) <= 0.5 * pixel_side * surface.depth;
}

// The surface of a pixel that may be outside of the picture, where there is nothing.
Surface surface_or_none(ivec2 pixel)
{
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, map_size))) {
        return Surface(vec3(0.0), 0.0, vec3(0.0), 0.0);
    }
    return surface_at(pixel);
}
