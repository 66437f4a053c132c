// The flux of each pixel, weighed so that it stays that over the pixel's true area.

// Power in units, red, green, blue and squares: the lowest 8 bits, and the rest.
uniform sampler2D low;
uniform sampler2D high;
// What flux is multiplied with; 0 where nothing is lit.
uniform sampler2D weights;

// Red, green, blue and squares, in units.
layout(location = 0) out uvec4 flux;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 whole = uvec4(texelFetch(high, pixel, 0)) * 256u + uvec4(texelFetch(low, pixel, 0));
    float weight = texelFetch(weights, pixel, 0).r;
    flux = uvec4(vec4(whole) * vec4(vec3(weight), weight * weight) + 0.5);
}
