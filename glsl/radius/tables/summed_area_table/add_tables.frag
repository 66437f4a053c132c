// The table of all photons: that of those before, and that of those added.

// The table of the photons before.
uniform SUM_SAMPLER before;
// The table of the photons that are added.
uniform SUM_SAMPLER added;

// Photons up to and with this column and row.
layout(location = 0) out SUM sum;

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    sum = wrapped(texelFetch(before, p, 0).r + texelFetch(added, p, 0).r);
}
