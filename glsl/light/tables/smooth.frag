// Light averaged over half of each pixel's width, so that no box is seen: as if it were gathered by a kernel
// that falls off to its edge.

// Light: red, green and blue, in units of power over those of area; a: radius in pixels.
uniform sampler2D gathered;
// Sums of the same in whole steps, and of lit pixels, with 2^16 more for one that is too bright for steps.
uniform usampler2DArray light_table;
// The unit of power.
uniform float flux_unit;

// Irradiance: red, green and blue, in power per square of a scene unit; a: radius in pixels.
layout(location = 0) out vec4 irradiance_and_radius;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 light = texelFetch(gathered, pixel, 0);
    int radius = min(int(0.5 * light.a), MOST_SMOOTH);
    if (radius > 0) {
        uvec4 sum = sum_of(light_table, box_at(pixel, ivec4(texelFetch(extents, pixel, 0)), radius));
        uint most = max(max(sum.r, sum.g), sum.b);
        if (sum.a < 0x10000u && float(most) >= FEWEST_STEPS * float(sum.a)) {
            light.rgb = vec3(sum.rgb) / (steps_of_light() * float(sum.a));
        }
    }
    irradiance_and_radius = vec4(light.rgb * (flux_unit / area_unit()), light.a);
}
