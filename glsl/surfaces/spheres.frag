// Where a line of sight meets a sphere, exactly and not as triangles: place, normal and albedo; for a cube map, which sphere.

// The pinhole or the light's place, in scene units.
uniform vec3 camera;

in vec3 at;
flat in vec3 centre;
flat in vec3 reflectance;
flat in float radius;
flat in float number;

#ifdef PRIMITIVES
// A distance beyond everything, in scene units.
uniform float far;

// The sphere's number, from 1.
layout(location = 0) out uint primitive;
#else
// From scene units to clip space, with row 0 of the picture at the bottom.
uniform mat4 to_clip;
// Unit vector along which depth is measured.
uniform vec3 view_direction;

// Place in scene units; w: depth along the view, 0 where nothing is seen.
layout(location = 0) out vec4 position;
// Towards the camera; w: the surface's number from 1, negative for mirrors and glass.
layout(location = 1) out vec4 normal;
// Share of light that the surface reflects: red, green and blue, 0 to 1.
layout(location = 2) out vec4 albedo;
#endif

void main()
{
    vec3 sight = normalize(at - camera);
    vec3 to_centre = centre - camera;
    float closest = dot(to_centre, sight);
    vec3 beside = to_centre - closest * sight;
    float half_chord_squared = radius * radius - dot(beside, beside);
    if (half_chord_squared < 0.0) {
        discard;
    }
    float half_chord = sqrt(half_chord_squared);
    float nearest = closest > half_chord ? closest - half_chord : closest + half_chord;
    if (nearest <= 0.0) {
        discard;
    }
#ifdef PRIMITIVES
    primitive = uint(number + 0.5);
    gl_FragDepth = min(nearest / far, 1.0);
#else
    vec3 place = camera + nearest * sight;
    vec4 clip = to_clip * vec4(place, 1.0);
    gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
    vec3 outward = (place - centre) / radius;
    position = vec4(place, dot(place - camera, view_direction));
    normal = vec4(dot(outward, sight) > 0.0 ? -outward : outward, number);
    albedo = vec4(reflectance, 1.0);
#endif
}
