// Whether a primitive of the scene is between two places, met exactly.

// The nearest primitive in each direction, from 1; 0 for none.
uniform usampler2D nearest;
// Four texels for each: corner and two edges of a triangle, then its normal and the distance of its plane
// from the origin along that; or centre and radius of a sphere.
uniform sampler2D primitives;
// Sizes of the numbers that the pixel's place and the light's were found from, in scene units.
float coarseness = 0.0;
float coarseness_of_light = 0.0;

// A place this near to a primitive lies on it: several times what f32 loses of it.
const float MARGIN = 2e-6;

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
    float margin = MARGIN * (coarseness + length(outward));
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
int triangle_between(vec3 from, vec3 away, vec3 corner, vec3 edge1, vec3 edge2, vec4 plane)
{
    float before = dot(plane.xyz, from) - plane.w;
    float after = dot(plane.xyz, from + away) - plane.w;
    if (before * after >= 0.0 || abs(before) <= MARGIN * coarseness
        || abs(after) <= MARGIN * coarseness_of_light) {
        return APART;
    }
    vec3 across = cross(edge1, edge2);
    float squared = dot(across, across);
    vec3 met = from + before / (before - after) * away - corner;
    float second = dot(cross(met, edge2), across) / squared;
    float third = dot(cross(edge1, met), across) / squared;
    // A little wide, so that neighbours leave no gap.
    if (min(second, third) >= -1e-5 && second + third <= 1.00001) {
        return BETWEEN;
    }
    // Next to a triangle that is thinner than a texel, planes of its neighbours pass this close to it. It may
    // be lit.
    float two_texels = 4.0 / float(textureSize(nearest, 0).x);
    return before / (before - after) > two_texels ? BESIDE : APART;
}

int between(vec3 from, vec3 away, int primitive)
{
    vec4 first = texel(4 * primitive);
    if (first.w > 0.0) {
        return is_sphere_between(from, away, first.xyz, first.w) ? BETWEEN : APART;
    }
    vec3 edge1 = texel(4 * primitive + 1).xyz;
    vec3 edge2 = texel(4 * primitive + 2).xyz;
    return triangle_between(from, away, first.xyz, edge1, edge2, texel(4 * primitive + 3));
}
