// Place, normal and albedo of what is nearest (thesis 2.3.2).
uniform vec3 camera;
uniform vec3 view_direction;

in vec3 at;
flat in vec3 facing;
flat in vec3 reflectance;
flat in float number;

layout(location = 0) out vec4 position;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 albedo;

void main()
{
    vec3 sight = at - camera;
    position = vec4(at, dot(sight, view_direction));
    normal = vec4(dot(facing, sight) > 0.0 ? -facing : facing, number);
    albedo = vec4(reflectance, 1.0);
}
