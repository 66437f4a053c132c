// Sums of photons in coarser units, rounded to the nearest.

// Photons of each pixel.
uniform sampler2D counts;
// Power in units, red, green, blue and squares: the lowest 8 bits, and the rest.
uniform sampler2D low;
uniform sampler2D high;
// The old units over the new ones, of power and of squares: powers of two, 1 or less.
uniform float power_factor;
uniform float square_factor;

// Photons of the pixel.
layout(location = 0) out float count;
// Their power in the new units: the lowest 8 bits.
layout(location = 1) out vec4 low_bits;
// The rest, in 256 units.
layout(location = 2) out vec4 high_bits;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    count = texelFetch(counts, pixel, 0).r;
    vec4 sum = texelFetch(high, pixel, 0) * 256.0 + texelFetch(low, pixel, 0);
    vec4 whole = floor(sum * vec4(vec3(power_factor), square_factor) + 0.5);
    high_bits = floor(whole / 256.0);
    low_bits = whole - 256.0 * high_bits;
}
