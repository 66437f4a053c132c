// Triangles of the scene, for the g-buffer.
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 face_normal;
layout(location = 2) in vec3 face_albedo;
layout(location = 3) in float face_number;

uniform mat4 to_clip;

out vec3 at;
flat out vec3 facing;
flat out vec3 reflectance;
flat out float number;

void main()
{
    at = corner;
    facing = face_normal;
    reflectance = face_albedo;
    number = face_number;
    gl_Position = to_clip * vec4(corner, 1.0);
}
