// What the window shows: one view of the maps, or two beside a line; row 0 is the top. Views: 0 radiance,
// tone-mapped; 1 density and 2 radius in colours; 3 limited pixels marked; 4 error in colours.
uniform ivec2 map_size;
uniform vec2 origin;      // of the picture on the canvas, in canvas pixels
uniform float scale;      // canvas pixels a pixel of the maps
uniform float split;      // column from which side B is shown, in canvas pixels
uniform int view_a;
uniform int view_b;
uniform sampler2D colour_a;
uniform sampler2D colour_b;
uniform usampler2D whole_a;
uniform usampler2D whole_b;
uniform sampler2D reference;
uniform int reference_is_encoded;
uniform sampler2D colours; // of places from 0 to 1
uniform vec2 range_a;      // values at the ends of the colours
uniform vec2 range_b;
uniform float exposure;    // in stops
uniform float white;

out vec4 colour;

const vec3 BACKGROUND = vec3(0.055, 0.06, 0.07);

// ToneMap::apply: E. Reinhard and others 2002, equation 4, then sRGB.
vec3 encoded(vec3 radiance)
{
    radiance = max(radiance, 0.0) * exp2(exposure);
    float luminance = dot(radiance, vec3(0.2126, 0.7152, 0.0722));
    vec3 linear = clamp(radiance * (1.0 + luminance / (white * white)) / (1.0 + luminance), 0.0, 1.0);
    vec3 curved = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(12.92 * linear, curved, greaterThan(linear, vec3(0.0031308)));
}

// By logarithm of value + 1, as the legend and `varikernel radius -o map.png` do.
vec3 coloured(float value, vec2 range)
{
    float clamped = clamp(value, range.x, range.y);
    float place = log((clamped + 1.0) / (range.x + 1.0)) / log((range.y + 1.0) / (range.x + 1.0));
    return texelFetch(colours, ivec2(clamp(place, 0.0, 1.0) * 255.0 + 0.5, 0), 0).rgb;
}

vec3 shown(int view, vec4 value, uint whole, vec2 at, vec2 range)
{
    if (view == 0) {
        return encoded(value.rgb);
    }
    if (view == 1) {
        return coloured(value.r, range);
    }
    if (view == 2) {
        return coloured(float(whole), range);
    }
    if (view == 3) {
        vec3 grey = vec3(dot(encoded(value.rgb), vec3(0.2126, 0.7152, 0.0722)));
        return whole != 0u ? vec3(0.95, 0.15, 0.2) : 0.12 + 0.5 * grey;
    }
    vec3 wanted = texture(reference, at).rgb;
    wanted = reference_is_encoded != 0 ? wanted : encoded(wanted);
    vec3 error = abs(encoded(value.rgb) - wanted);
    return coloured(255.0 * max(error.r, max(error.g, error.b)), range);
}

void main()
{
    vec2 place = (gl_FragCoord.xy - origin) / scale;
    ivec2 pixel = ivec2(floor(place));
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, map_size))) {
        colour = vec4(BACKGROUND, 1.0);
        return;
    }
    vec2 at = place / vec2(map_size);
    // Both are read, so that no texture's derivatives depend on the side.
    vec4 value_a = texture(colour_a, at);
    vec4 value_b = texture(colour_b, at);
    bool is_a = gl_FragCoord.x < split;
    colour = vec4(is_a ? shown(view_a, value_a, texelFetch(whole_a, pixel, 0).r, at, range_a)
                       : shown(view_b, value_b, texelFetch(whole_b, pixel, 0).r, at, range_b), 1.0);
}
