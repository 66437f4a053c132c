// Fractions rounded up or down by chance, so that sums of whole numbers are right in the mean.

// From 0 to 1, another number for each pixel and channel.
float chance(ivec2 pixel, uint channel)
{
    uint bits = uint(pixel.x) * 73856093u ^ uint(pixel.y) * 19349663u ^ channel * 83492791u;
    bits = (bits ^ (bits >> 15)) * 747796405u + 2891336453u;
    bits = (bits ^ (bits >> 13)) * 277803737u;
    return float((bits ^ (bits >> 16)) >> 8) / 16777216.0;
}
