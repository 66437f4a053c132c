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
// The unit of power.
uniform float flux_unit;

// Irradiance: red, green and blue, in power per square of a scene unit; a: radius in pixels.
layout(location = 0) out vec4 irradiance_and_radius;

// Between pure widths light is mixed: ratios this far from 1 decide all.
const float SOFT = 0.4;
// Tests are pooled over boxes that are so many times as wide.
const int POOL = 2;

vec3 light_in(ivec4 box)
{
    uint area = sum_of(area_table, box).r;
    return area == 0u ? vec3(0.0) : vec3(sum_of(flux_table, box).rgb) / float(area);
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
    irradiance_and_radius = vec4(0.0);
    if (texelFetch(normal, pixel, 0).w <= 0.0) {
        return;
    }
    ivec4 extent = ivec4(texelFetch(extents, pixel, 0));
    // The widest radius that all tests up to it allow, then mixed with the next ones as far as they go.
    float share = 1.0;
    float radius = 0.0;
    int known = 0;
    vec3 light = vec3(0.0);
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
            light = mix(light, light_in(box_at(pixel, extent, wider)), share);
            radius = mix(radius, float(wider), share);
        }
    }
    if (!is_found) {
        light = light_in(box_at(pixel, extent, known));
    }
    irradiance_and_radius = vec4(light * (flux_unit / area_unit()), radius);
}
