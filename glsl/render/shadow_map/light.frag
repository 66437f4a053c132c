// Irradiance from one place of a light, through one side of the cube of maps around it (thesis 2.2); blending
// adds places up. Follows render/shadow_map/between.glsl.
//
// A map holds which triangle or sphere is nearest to the light in the direction of a texel. Of the four
// texels around the pixel's direction, each primitive is met anew by the way from the pixel to the light: no
// depth is compared, so there is no bias by a slope, and edges of shadows are as sharp as the primitives.

// Place in scene units; w: depth along the view, 0 where nothing is seen.
uniform sampler2D position;
// Towards the camera; w: the surface's number from 1, negative for mirrors and glass, 0 where nothing is
// seen.
uniform sampler2D normal;
// The light's place, in scene units.
uniform vec3 place;
// The light's normal, or the axis of its cone: a unit vector.
uniform vec3 axis;
// Cosine of half the angle of the light's cone; below -1 for a surface, which shines by the cosine.
uniform float cone_cosine;
// Power per solid angle along the axis: red, green and blue.
uniform vec3 intensity;
// The side of the cube: 0 and 1 along x, 2 and 3 along y, 4 and 5 along z, towards + first.
uniform int face;
// From scene units to clip space of that side.
uniform mat4 to_face;

// Irradiance: red, green and blue, in power per square of a scene unit; a: 1 where lit.
layout(location = 0) out vec4 irradiance;

float largest(vec3 place)
{
    return max(max(abs(place.x), abs(place.y)), abs(place.z));
}

// The side of the cube that a direction leaves through.
int face_of(vec3 direction)
{
    vec3 size = abs(direction);
    int side = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * side + (direction[side] < 0.0 ? 1 : 0);
}

bool is_lit(vec3 from)
{
    vec4 clip = to_face * vec4(from, 1.0);
    ivec2 size = textureSize(nearest, 0);
    // A half plane that holds the direction holds the middle of one of the four texels around it.
    ivec2 corner = ivec2(floor((clip.xy / clip.w * 0.5 + 0.5) * vec2(size) - 0.5));
    uint known = 0u;
    int found = APART;
    bool is_crack = true;
    for (int index = 0; index < 4; ++index) {
        ivec2 neighbour = clamp(corner + ivec2(index & 1, index >> 1), ivec2(0), size - 1);
        uint primitive = texelFetch(nearest, neighbour, 0).x;
        if (primitive != known) {
            found = primitive == 0u ? APART : between(from, place - from, int(primitive) - 1);
        }
        if (found == BETWEEN) {
            return false;
        }
        known = primitive;
        is_crack = is_crack && found == BESIDE;
    }
    // Where all four see triangles before the pixel, a small one of a mesh is between them, which no texel's
    // middle hits.
    return !is_crack;
}

void main()
{
    irradiance = vec4(0.0);
    ivec2 pixel = min(ivec2(gl_FragCoord.xy), textureSize(position, 0) - 1);
    vec4 facing = texelFetch(normal, pixel, 0);
    vec3 from = texelFetch(position, pixel, 0).xyz;
    vec3 away = place - from;
    if (facing.w <= 0.0 || face_of(-away) != face) {
        return;
    }
    coarseness = texelFetch(position, pixel, 0).w + largest(from);
    coarseness_of_light = largest(place);
    float squared = dot(away, away);
    vec3 to_light = away * inversesqrt(squared);
    float cosine = dot(facing.xyz, to_light);
    float shines = -dot(axis, to_light);
    if (cone_cosine >= -1.0) {
        shines = clamp(shines, -1.0, 1.0) >= cone_cosine ? 1.0 : 0.0;
    }
    if (cosine > 0.0 && shines > 0.0 && is_lit(from)) {
        irradiance = vec4(intensity * shines * cosine / squared, 1.0);
    }
}
