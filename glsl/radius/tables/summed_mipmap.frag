// One level of a summed mipmap: each texel is the sum of the four below it (thesis 3.3).

// The level below, as level 0 of what is read.
uniform SUM_SAMPLER finer;
// Columns and rows of the level below.
uniform ivec2 finer_size;

// Photons of the block.
layout(location = 0) out SUM sum;

SUM texel(ivec2 p)
{
    // A side of one texel has no second one; texelFetch outside is undefined.
    return all(lessThan(p, finer_size)) ? texelFetch(finer, p, 0).r : SUM(0);
}

void main()
{
    ivec2 p = 2 * ivec2(gl_FragCoord.xy);
    sum = texel(p) + texel(p + ivec2(1, 0)) + texel(p + ivec2(0, 1)) + texel(p + ivec2(1, 1));
}
