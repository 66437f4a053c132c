// Irradiance from one place of a light, through one side of the cube of maps around it (thesis 2.2); blending adds places up.
//
// A map tells which triangle or sphere is nearest to the light in the direction of a texel. Of the four texels around the
// pixel's direction, each primitive is met anew by the way from the pixel to the light: no depth is compared, so there is no
// bias by a slope, and edges of shadows are as sharp as the primitives.

// Place in scene units; w: depth along the view, 0 where nothing is seen.
uniform sampler2D position;
// Towards the camera; w: the surface's number from 1, negative for mirrors and glass, 0 where nothing is seen.
uniform sampler2D normal;
// The nearest primitive, from 1; 0 for none.
uniform usampler2D nearest;
// Three texels for each: corner and two edges of a triangle; centre and radius of a sphere.
uniform sampler2D primitives;
// Of the light.
uniform vec3 place;
// Its normal, or the axis of its cone.
uniform vec3 axis;
// Cosine of its cone's half angle; below -1 for a surface, which shines by the cosine.
uniform float cone_cosine;
// Power per solid angle along the axis.
uniform vec3 intensity;
// 0 and 1 along x, 2 and 3 along y, 4 and 5 along z.
uniform int face;
uniform mat4 to_face;
// In scene units: a place this near to a primitive lies on it.
uniform float margin;

layout(location = 0) out vec4 irradiance;

// The side of the cube that a direction leaves through.
int face_of(vec3 direction)
{
    vec3 size = abs(direction);
    int side = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * side + (direction[side] < 0.0 ? 1 : 0);
}

vec4 texel(int index)
{
    int columns = textureSize(primitives, 0).x;
    return texelFetch(primitives, ivec2(index % columns, index / columns), 0);
}

// Whether the sphere is met between a place and another that is `away` from it.
bool is_sphere_between(vec3 from, vec3 away, vec3 centre, float radius)
{
    vec3 outward = from - centre;
    float squared = dot(away, away);
    float half_linear = dot(outward, away);
    float end = 1.0 - margin * inversesqrt(squared);
    if (abs(length(outward) - radius) <= margin) {
        // From the sphere itself only the way through it counts.
        float through = -2.0 * half_linear / squared;
        return through > margin * inversesqrt(squared) && through < end;
    }
    float closest = -half_linear / squared;
    vec3 beside = outward + closest * away;
    float half_chord_squared = (radius * radius - dot(beside, beside)) / squared;
    if (half_chord_squared <= 0.0) {
        return false;
    }
    float half_chord = sqrt(half_chord_squared);
    float first = closest - half_chord;
    float second = closest + half_chord;
    return (first > 0.0 && first < end) || (second > 0.0 && second < end);
}

// What a primitive does to the light between two places.
const int APART = 0;
// Only the triangle's plane is between them, and not close to the first.
const int BESIDE = 1;
const int BETWEEN = 2;

// What the triangle does to the light between a place and another that is `away` from it.
int triangle_between(vec3 from, vec3 away, vec3 corner, vec3 edge1, vec3 edge2)
{
    vec3 across = cross(edge1, edge2);
    float size = length(across);
    float before = dot(across, from - corner) / size;
    float after = dot(across, from + away - corner) / size;
    if (before * after >= 0.0 || min(abs(before), abs(after)) <= margin) {
        return APART;
    }
    vec3 met = from + before / (before - after) * away - corner;
    float second = dot(cross(met, edge2), across) / (size * size);
    float third = dot(cross(edge1, met), across) / (size * size);
    // A little wide, so that neighbours leave no gap.
    if (min(second, third) >= -1e-5 && second + third <= 1.00001) {
        return BETWEEN;
    }
    // Next to a triangle that is thinner than a texel, planes of its neighbours pass this close to it. It may be lit.
    float two_texels = 4.0 / float(textureSize(nearest, 0).x);
    return before / (before - after) > two_texels ? BESIDE : APART;
}

int between(vec3 from, vec3 away, int primitive)
{
    vec4 first = texel(3 * primitive);
    if (first.w > 0.0) {
        return is_sphere_between(from, away, first.xyz, first.w) ? BETWEEN : APART;
    }
    return triangle_between(from, away, first.xyz, texel(3 * primitive + 1).xyz, texel(3 * primitive + 2).xyz);
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
    // Where all four see triangles before the pixel, a small one of a mesh was between them: no texel's middle saw it.
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
