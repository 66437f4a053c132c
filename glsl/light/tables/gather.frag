// Light by the width that the tests of noise allow at each pixel.

// Towards the camera; w: the surface's number from 1, negative for mirrors and glass, 0 where nothing is
// seen.
uniform sampler2D normal;
// Sums of areas.
uniform usampler2DArray area_table;
// Shares of radii 2, 4, 8 and 16, and of 32 and 64, at every second pixel of every second row.
uniform sampler2D narrow_shares;
uniform sampler2D wide_shares;

// Light: red, green and blue, in units of power over those of area; a: radius in pixels.
layout(location = 0) out vec4 light_and_radius;
// The same light in whole steps; a: 1 where the pixel is lit, and 2^16 more where it is too bright for them.
layout(location = 1) out uvec4 steps;

// a: whether there is any area.
vec4 light_in(ivec4 box)
{
    uint area = sum_of(area_table, box).r;
    return area == 0u ? vec4(0.0) : vec4(vec3(sum_of(flux_table, box).rgb) / float(area), 1.0);
}

// The cell of the shares that hold for a pixel: its own, or where the cell's pixel is on another face, the
// next one.
ivec2 cell_of(ivec2 pixel, ivec4 extent)
{
    ivec2 is_other = ivec2(equal(extent.xz, ivec2(0))) * ivec2(greaterThan(extent.yw, ivec2(0)));
    return (pixel >> 1) + (pixel & 1) * is_other;
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
    ivec2 cell = cell_of(pixel, extent);
    vec4 narrow = texelFetch(narrow_shares, cell, 0);
    vec4 wide = texelFetch(wide_shares, cell, 0);
    // That of radius 1 is pooled over so narrow a box that each pixel has its own.
    ivec4 around = box_at(pixel, extent, POOL);
    uint sum = sum_of(fine_tests, around).r;
    float first = share_of(sum, around.zw - around.xy + 1, share_of_noise(), 1);
    float shares[7] = float[7](first, narrow.x, narrow.y, narrow.z, narrow.w, wide.x, wide.y);
    // The widest radius that all tests up to it allow, then mixed with the next ones as far as they go.
    int known = 0;
    int level = 0;
    while (level < 7 && min(first, shares[level]) == 1.0) {
        known = 1 << level;
        ++level;
    }
    vec4 light = light_in(box_at(pixel, extent, known));
    float radius = float(known);
    for (; level < 7 && min(first, shares[level]) > 0.0; ++level) {
        // Where there is nothing, what is wider is all there is.
        float part = light.a == 0.0 ? 1.0 : min(first, shares[level]);
        int wider = 1 << level;
        light = mix(light, light_in(box_at(pixel, extent, wider)), part);
        radius = mix(radius, float(wider), part);
    }
    for (int wider = max(2 * known, 1); light.a == 0.0 && wider <= WIDEST; wider *= 2) {
        light = light_in(box_at(pixel, extent, wider));
        radius = float(wider);
    }
    // Nothing is lit so far from photons, nor in tiles that are left out.
    if (light.rgb == vec3(0.0) && sum_of(flux_table, box_at(pixel, extent, WIDEST)).rgb == uvec3(0u)) {
        radius = 0.0;
    }
    light_and_radius = vec4(light.rgb, radius);
    vec3 exact = light.rgb * steps_of_light();
    bool fits = all(lessThan(exact, vec3(MOST_STEPS - 1)));
    vec3 by_chance = vec3(chance(pixel, 0u), chance(pixel, 1u), chance(pixel, 2u));
    steps = fits ? uvec4(exact + by_chance, 1u) : uvec4(uvec3(0u), 0x10001u);
}
