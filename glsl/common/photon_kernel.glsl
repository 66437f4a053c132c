// The weight of a photon's kernel; its own pixel gets a little in any case, so that no photon is lost.
const float LEAST_AT_HOME = 1e-3;

float weight_of_photon(Kernel kernel, ivec2 home, ivec2 pixel, Surface surface)
{
    float weight = weight_at(kernel, surface);
    return pixel == home ? max(weight, LEAST_AT_HOME) : weight;
}
