// A kernel: a disc on a surface, flat as the surface is, whose weight falls from its middle to its edge
// (thesis 2.6.2).
//
// A box of (2 R + 1)^2 pixels, as the radius map counts them, covers some area of the surface, and the disc
// has the same: so it holds about as many photons. It is at least as wide as a pixel wherever it is seen
// edge-on.

// The kernel's extent along the normal, as a share of its radius.
const float THICKNESS = 0.2;
// A disc is as large as if it were seen at this cosine where it is seen at a smaller one.
const float LEAST_COSINE = 0.1;
const float PI = 3.14159265;

struct Kernel {
    vec3 position;
    vec3 normal;
    float number;
    // Axes over their half lengths: a place is inside where the squares of its three products with them sum
    // to less than 1.
    vec3 across;
    vec3 along;
    vec3 through;
};

// The kernel around `position` on the surface of a pixel, for a radius in pixels.
Kernel kernel_on(vec3 position, Surface surface, uint radius)
{
    vec3 sight = normalize(surface.position - camera);
    vec3 flat_sight = sight - dot(sight, surface.normal) * surface.normal;
    vec3 other = abs(surface.normal.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 along = dot(flat_sight, flat_sight) > 1e-8 ? normalize(flat_sight)
                                                    : normalize(cross(surface.normal, other));
    vec3 across = cross(surface.normal, along);
    float pixel = pixel_side * surface.depth;
    float disc = float(2u * radius + 1u) * sqrt(area_on(surface, LEAST_COSINE) / PI);
    disc = min(disc, float(MAX_REACH - 2) * pixel);
    float lying = max(disc, pixel / max(abs(dot(sight, surface.normal)), LEAST_COSINE * 0.1));
    return Kernel(position, surface.normal, surface.number, across / disc, along / lying,
                  surface.normal / (THICKNESS * disc));
}

// Columns and rows that the kernel may reach, first and last, inside the map.
ivec4 reach(Kernel kernel, mat4 to_clip, ivec2 middle)
{
    vec2 extent = vec2(0.0);
    vec3 axes[2] = vec3[2](kernel.across / dot(kernel.across, kernel.across),
                           kernel.along / dot(kernel.along, kernel.along));
    vec4 centre = to_clip * vec4(kernel.position, 1.0);
    for (int axis = 0; axis < 2; ++axis) {
        vec2 farthest = vec2(0.0);
        for (int side = -1; side <= 1; side += 2) {
            vec4 end = to_clip * vec4(kernel.position + float(side) * axes[axis], 1.0);
            vec2 pixels =
            (end.xy / max(end.w, 0.05 * centre.w) - centre.xy / centre.w) * 0.5 * vec2(map_size);
            farthest = max(farthest, abs(pixels));
        }
        extent += farthest * farthest;
    }
    ivec2 pixels = ivec2(min(ceil(sqrt(extent)) + 1.0, vec2(MAX_REACH)));
    return ivec4(max(middle - pixels, ivec2(0)), min(middle + pixels, map_size - 1));
}

// From the square of the distance from the middle, in radii.
float profile(float squared)
{
    if (squared >= 1.0) {
        return 0.0;
    }
#if defined(KERNEL_BOX)
    return 1.0;
#elif defined(KERNEL_CONE)
    return 1.0 - sqrt(squared);
#elif defined(KERNEL_EPANECHNIKOV)
    return 1.0 - squared;
#elif defined(KERNEL_SILVERMAN)
    return (1.0 - squared) * (1.0 - squared);
#else
    // Gaussian, cut off at three standard deviations.
    return exp(-4.5 * squared);
#endif
}

// The kernel's weight at a pixel: nothing on other surfaces and around corners.
float weight_at(Kernel kernel, Surface surface)
{
    if (surface.number != kernel.number || dot(surface.normal, kernel.normal) <= LEAST_AGREEMENT) {
        return 0.0;
    }
    vec3 away = surface.position - kernel.position;
    vec3 part = vec3(dot(away, kernel.across), dot(away, kernel.along), dot(away, kernel.through));
    return profile(dot(part, part));
}
