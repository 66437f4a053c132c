// Whether a primitive of the scene is between two places, met exactly.

// The nearest primitive in each direction, from 1; 0 for none.
uniform usampler2D nearest;
// Three texels for each: corner and two edges of a triangle; centre and radius of a sphere.
uniform sampler2D primitives;
// Sizes of the numbers that the pixel's place was found from, in scene units.
float coarseness = 0.0;

// A place this near to a primitive lies on it: several times what f32 loses of the pixel's place, and of the way to it from the
// primitive's corner or middle.
float margin_of(vec3 from_primitive)
{
    return 2e-6 * (coarseness + length(from_primitive));
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
    float margin = margin_of(outward);
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
    float margin = margin_of(from - corner);
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
