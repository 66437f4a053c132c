// Place, normal and albedo of what is nearest (thesis 2.3.2). Follows render/surfaces/plane.glsl.

flat in vec3 reflectance;
flat in float number;

// Place in scene units; w: depth along the view, 0 where nothing is seen.
layout(location = 0) out vec4 position;
// Towards the camera; w: the surface's number from 1, negative for mirrors and glass.
layout(location = 1) out vec4 normal;
// Share of light that the surface reflects: red, green and blue, 0 to 1.
layout(location = 2) out vec4 albedo;

void main()
{
    vec3 ray = ray_of_pixel();
    vec3 sight = normalize(ray);
    float distance = distance_to_plane(sight);
    position = vec4(camera + distance * sight, distance / length(ray));
    normal = vec4(dot(facing, sight) > 0.0 ? -facing : facing, number);
    albedo = vec4(reflectance, 1.0);
    gl_FragDepth = depth_of(distance);
}
