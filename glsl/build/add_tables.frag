// The table of all photons: that of those before, and that of those added.
uniform SUM_SAMPLER before;
uniform SUM_SAMPLER added;

layout(location = 0) out SUM sum;

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    sum = wrapped(texelFetch(before, p, 0).r + texelFetch(added, p, 0).r);
}
