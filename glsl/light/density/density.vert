// Each photon as a point at its pixel, if it contributes (thesis 2.1).
#ifdef FLUX
// One over the unit of power, and over the root of that of squares.
uniform float units_of_power;
uniform float units_of_root;

// Red, green, blue and square in units: the lowest 8 bits, and the rest.
flat out vec4 low;
flat out vec4 high;

// A chance from 0 to 1 by the photon's own bits, another for each number.
float chance(uint number)
{
    uvec3 place = floatBitsToUint(photon_position);
    uvec3 power = floatBitsToUint(photon_power);
    uint bits = number * 0x9E3779B9u;
    uint words[6] = uint[6](place.x, place.y, place.z, power.x, power.y, power.z);
    for (int i = 0; i < 6; ++i) {
        // One round of PCG (Jarzynski and Olano 2020) for each word.
        bits = (bits ^ words[i]) * 747796405u + 2891336453u;
        bits = ((bits >> ((bits >> 28) + 4u)) ^ bits) * 277803737u;
        bits ^= bits >> 22;
    }
    return float(bits >> 8) / 16777216.0;
}
#else
flat out vec3 power;
#endif

void main()
{
    ivec2 pixel = ivec2(floor(pixel_of(photon_position)));
    bool counts = contributes(pixel, surface_or_none(pixel));
#ifdef FLUX
    // To 12 bits, so that its square is exact, fused with what is added or not.
    float sum = photon_power.r + photon_power.g + photon_power.b;
    float root = uintBitsToFloat(floatBitsToUint(sum * units_of_root) & 0xFFFFF000u);
    vec4 exact = vec4(photon_power * units_of_power, root * root);
    // A negative power counts as none, and the units have room for the others.
    exact = min(max(exact, 0.0), 4294000000.0);
    vec4 whole = floor(exact + vec4(chance(0u), chance(1u), chance(2u), chance(3u)));
    high = floor(whole / 256.0);
    low = whole - 256.0 * high;
#else
    power = photon_power;
#endif
    // What does not contribute is put outside of the picture.
    vec2 place = (vec2(pixel) + 0.5) / vec2(map_size) * 2.0 - 1.0;
    gl_Position = counts ? vec4(place, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = 1.0;
}
