// A cube around each sphere of the scene; the fragments find the sphere itself.

// A corner of the cube around the sphere, in scene units.
layout(location = 0) in vec3 corner;
// The sphere's centre, in scene units.
layout(location = 1) in vec3 sphere_centre;
// Share of light that it reflects: red, green and blue, 0 to 1.
layout(location = 2) in vec3 sphere_albedo;
// Its radius, in scene units.
layout(location = 3) in float sphere_radius;
// The surface's number from 1, negative for mirrors and glass; in a cube map, of the primitive.
layout(location = 4) in float sphere_number;

// From scene units to clip space.
uniform mat4 to_clip;

flat out vec3 centre;
flat out vec3 reflectance;
flat out float radius;
flat out float number;

void main()
{
    centre = sphere_centre;
    reflectance = sphere_albedo;
    radius = sphere_radius;
    number = sphere_number;
    gl_Position = to_clip * vec4(corner, 1.0);
}
