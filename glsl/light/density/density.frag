// One for each photon, and its power; blending adds them up.

#ifdef FLUX
flat in vec4 low;
flat in vec4 high;
#else
flat in vec3 power;
#endif

// Photons of the pixel.
layout(location = 0) out float count;
#ifdef FLUX
// Their power in units, red, green and blue, and squares of its sum: the lowest 8 bits of each photon.
layout(location = 1) out vec4 low_bits;
// The rest, in 256 units.
layout(location = 2) out vec4 high_bits;
#else
// Their power, red, green and blue; a: their count.
layout(location = 1) out vec4 power_and_count;
#endif

void main()
{
    count = 1.0;
#ifdef FLUX
    low_bits = low;
    high_bits = high;
#else
    power_and_count = vec4(power, 1.0);
#endif
}
