// Extents on curved surfaces end where these have turned away.

// How far neighbours go on sharing a face: left, right, down and up.
uniform usampler2D chains;

vec3 facing_at(ivec2 pixel)
{
    return texelFetch(normal, pixel, 0).xyz;
}

// In pixels: left, right, down and up.
layout(location = 0) out uvec4 extent;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 facing = facing_at(pixel);
    ivec2 ways[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
    extent = texelFetch(chains, pixel, 0);
    for (int way = 0; way < 4; ++way) {
        int length = int(extent[way]);
        vec3 end = facing_at(pixel + length * ways[way]);
        if (dot(facing, end) < ENDS_AGREE) {
            // The last place that agrees, by halving.
            int agrees = 0;
            for (int step = 64; step > 0; step >>= 1) {
                int next = agrees + step;
                if (next < length && dot(facing, facing_at(pixel + next * ways[way])) >= ENDS_AGREE) {
                    agrees = next;
                }
            }
            extent[way] = uint(agrees);
        }
    }
}
