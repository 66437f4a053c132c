// Where a line of sight meets a sphere, exactly and not as triangles: place, normal and albedo; for a cube
// map, which sphere. Follows render/surfaces/ray.glsl.

flat in vec3 centre;
flat in vec3 reflectance;
flat in float radius;
flat in float number;

#ifdef PRIMITIVES
// The sphere's number, from 1.
layout(location = 0) out uint primitive;
#else
// Place in scene units; w: depth along the view, 0 where nothing is seen.
layout(location = 0) out vec4 position;
// Towards the camera; w: the surface's number from 1, negative for mirrors and glass.
layout(location = 1) out vec4 normal;
// Share of light that the surface reflects: red, green and blue, 0 to 1.
layout(location = 2) out vec4 albedo;
#endif

void main()
{
    vec3 ray = ray_of_pixel();
    vec3 sight = normalize(ray);
    vec3 to_centre = centre - camera;
    float closest = dot(to_centre, sight);
    vec3 beside = to_centre - closest * sight;
    float half_chord_squared = radius * radius - dot(beside, beside);
    if (half_chord_squared < 0.0) {
        discard;
    }
    float half_chord = sqrt(half_chord_squared);
    float away = length(to_centre);
    // Positive outside of the sphere. The nearer place comes from the farther one, without a difference of
    // near equals.
    float outside = (away - radius) * (away + radius);
    float nearest = closest > 0.0 && outside > 0.0 ? outside / (closest + half_chord) : closest + half_chord;
    if (nearest <= 0.0 || (outside > 0.0 && closest <= 0.0)) {
        discard;
    }
    gl_FragDepth = depth_of(nearest);
#ifdef PRIMITIVES
    primitive = uint(number + 0.5);
#else
    vec3 place = camera + nearest * sight;
    vec3 outward = (place - centre) / radius;
    position = vec4(place, nearest / length(ray));
    normal = vec4(dot(outward, sight) > 0.0 ? -outward : outward, number);
    albedo = vec4(reflectance, 1.0);
#endif
}
