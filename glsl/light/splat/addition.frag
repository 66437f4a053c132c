// What the kernels of a chunk add up to at a pixel; blending adds it to all.

// Irradiance by the chunk's photons; a: its fragments.
uniform sampler2D of_chunk;

// Irradiance: red, green and blue, in power per square of a scene unit; a: fragments.
layout(location = 0) out vec4 irradiance_and_fragments;

void main()
{
    irradiance_and_fragments = texelFetch(of_chunk, ivec2(gl_FragCoord.xy), 0);
}
