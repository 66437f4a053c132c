// Light by the width that the tests of noise allow at each pixel.

// Towards the camera; w: the surface's number from 1, negative for mirrors and glass, 0 where nothing is
// seen.
uniform sampler2D normal;
// Sums of flux, and of areas.
uniform usampler2DArray flux_table;
uniform usampler2DArray area_table;
// Sums of the tests' ratios: of radii 1, 2 and 4 at each pixel, and of 8 to 64 at every second one.
uniform usampler2DArray fine_tests;
uniform usampler2DArray coarse_tests;
// Steps of one unit of power over one of area.
uniform float steps_of_light;

// Light: red, green and blue, in units of power over those of area; a: radius in pixels.
layout(location = 0) out vec4 light_and_radius;
// The same light in whole steps; a: 1 where the pixel is lit.
layout(location = 1) out uvec4 steps;

// Between pure widths light is mixed: ratios this far from 1 decide all.
const float SOFT = 0.4;
// Tests are pooled over boxes that are so many times as wide.
const int POOL = 2;

// a: whether there is any area.
vec4 light_in(ivec4 box)
{
    uint area = sum_of(area_table, box).r;
    return area == 0u ? vec4(0.0) : vec4(vec3(sum_of(flux_table, box).rgb) / float(area), 1.0);
}

// The mean ratio of the tests around a pixel.
float pooled(ivec2 pixel, ivec4 extent, int level)
{
    ivec4 box = box_at(pixel, extent, POOL << level);
    int channel = level;
    uvec4 sum;
    if (level < 3) {
        sum = sum_of(fine_tests, box);
    } else {
        channel = level - 3;
        // The cells whose pixel is in the box; without any, its own.
        ivec4 cells = ivec4((box.xy + 1) >> 1, box.zw >> 1);
        if (any(lessThan(cells.zw, cells.xy))) {
            cells = (pixel >> 1).xyxy;
        }
        box = cells;
        sum = sum_of(coarse_tests, cells);
    }
    ivec2 sides = box.zw - box.xy + 1;
    return float(sum[channel]) / (8192.0 * float(sides.x * sides.y));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    light_and_radius = vec4(0.0);
    steps = uvec4(0u);
    if (texelFetch(normal, pixel, 0).w <= 0.0) {
        return;
    }
    ivec4 extent = ivec4(texelFetch(extents, pixel, 0));
    // The widest radius that all tests up to it allow, then mixed with the next ones as far as they go.
    float share = 1.0;
    float radius = 0.0;
    int known = 0;
    vec4 light = vec4(0.0);
    bool is_found = false;
    for (int level = 0; level < 7 && share > 0.0; ++level) {
        int wider = 1 << level;
        float ratio = pooled(pixel, extent, level);
        share = min(share, clamp((1.0 + SOFT - ratio) / (2.0 * SOFT), 0.0, 1.0));
        if (share == 1.0) {
            known = wider;
            radius = float(wider);
        } else if (share > 0.0) {
            if (!is_found) {
                light = light_in(box_at(pixel, extent, known));
                is_found = true;
            }
            // Where there is nothing, what is wider is all there is.
            float part = light.a == 0.0 ? 1.0 : share;
            light = mix(light, light_in(box_at(pixel, extent, wider)), part);
            radius = mix(radius, float(wider), part);
        }
    }
    if (!is_found) {
        light = light_in(box_at(pixel, extent, known));
    }
    for (int wider = max(2 * known, 1); light.a == 0.0 && wider <= 64; wider *= 2) {
        light = light_in(box_at(pixel, extent, wider));
        radius = float(wider);
    }
    light_and_radius = vec4(light.rgb, radius);
    steps = uvec4(min(light.rgb * steps_of_light, float(MOST_STEPS)) + 0.5, 1u);
}
