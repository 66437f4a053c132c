// A cube around each sphere of the scene; the fragments find the sphere itself.
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 sphere_centre;
layout(location = 2) in vec3 sphere_albedo;
layout(location = 3) in float sphere_radius;
layout(location = 4) in float sphere_number;

uniform mat4 to_clip;

out vec3 at;
flat out vec3 centre;
flat out vec3 reflectance;
flat out float radius;
flat out float number;

void main()
{
    at = corner;
    centre = sphere_centre;
    reflectance = sphere_albedo;
    radius = sphere_radius;
    number = sphere_number;
    gl_Position = to_clip * vec4(corner, 1.0);
}
