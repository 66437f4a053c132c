// What the kernels of a chunk add up to at a pixel; blending adds it to all.
uniform sampler2D of_chunk;

layout(location = 0) out vec4 irradiance_and_fragments;

void main()
{
    irradiance_and_fragments = texelFetch(of_chunk, ivec2(gl_FragCoord.xy), 0);
}
