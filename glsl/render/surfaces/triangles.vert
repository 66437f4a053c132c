// Triangles of the scene, for the g-buffer and for cube maps.

// A corner of a triangle, in scene units.
layout(location = 0) in vec3 corner;
// The triangle's normal, on either side.
layout(location = 1) in vec3 face_normal;
// Share of light that it reflects: red, green and blue, 0 to 1.
layout(location = 2) in vec3 face_albedo;
// Distance of its plane from `plane_origin` along the normal, in scene units.
layout(location = 3) in float face_distance;
// The surface's number from 1, negative for mirrors and glass; in a cube map, of the primitive.
layout(location = 4) in float face_number;

// From scene units to clip space.
uniform mat4 to_clip;
// From where the distances of planes count, in scene units.
uniform vec3 plane_origin;
// The pinhole or the light's place, in scene units.
uniform vec3 camera;

out vec3 at;
flat out vec3 facing;
flat out vec3 reflectance;
flat out float plane_distance;
flat out float number;

void main()
{
    at = corner;
    facing = face_normal;
    reflectance = face_albedo;
    plane_distance = face_distance - dot(face_normal, camera - plane_origin);
    number = face_number;
    gl_Position = to_clip * vec4(corner, 1.0);
}
