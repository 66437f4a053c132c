// Scan, step 5: the entries as one plain texture.

// The entries in tiles of 4 x 8: a layer for each row.
uniform usampler2DArray tiles;

// Photons up to and with this column and row.
layout(location = 0) out uint sum;

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    uvec4 row = texelFetch(tiles, ivec3(p.x >> 2, p.y >> 3, p.y & 7), 0);
    // Choosing by conditions: an index that varies costs more on llvmpipe.
    uvec2 two = (p.x & 2) == 0 ? row.xy : row.zw;
    sum = wrapped((p.x & 1) == 0 ? two.x : two.y);
}
