// One for each photon, wherever it is seen; blending adds them up.

// Photons of the pixel.
layout(location = 0) out float count;

void main()
{
    count = 1.0;
}
