// The unit of every timing: one texel read, the same texel written.

// Photons per pixel.
uniform usampler2D density;

// The same.
layout(location = 0) out uint photons;

void main()
{
    photons = texelFetch(density, ivec2(gl_FragCoord.xy), 0).r;
}
