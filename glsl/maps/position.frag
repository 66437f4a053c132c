// Place and depth along the view of what a host's depth buffer shows.

// Window-space depth, from 0 to 1.
uniform sampler2D depth;
// From clip space to scene units.
uniform mat4 from_clip;
// The pinhole, in scene units.
uniform vec3 camera;
// Unit vector along which depth is measured.
uniform vec3 view_direction;
// Window-space depth where nothing is seen.
uniform float farthest;
// Clip-space depth is this times window-space depth, less the shift.
uniform float depth_scale;
// What is taken off.
uniform float depth_shift;

// Place in scene units; w: depth along the view, 0 where nothing is seen.
layout(location = 0) out vec4 position;

void main()
{
    ivec2 size = textureSize(depth, 0);
    ivec2 pixel = min(ivec2(gl_FragCoord.xy), size - 1);
    float at = texelFetch(depth, pixel, 0).r;
    vec2 clip = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec4 place = from_clip * vec4(clip, at * depth_scale - depth_shift, 1.0);
    place.xyz /= place.w;
    position = at == farthest ? vec4(0.0) : vec4(place.xyz, dot(place.xyz - camera, view_direction));
}
