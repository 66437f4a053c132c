// One for each photon, and its power; blending adds them up.

flat in vec3 power;

// Photons of the pixel.
layout(location = 0) out float count;
// Their power, red, green and blue; a: their count.
layout(location = 1) out vec4 power_and_count;

void main()
{
    count = 1.0;
    power_and_count = vec4(power, 1.0);
}
