// Scan, step 3: the sum of all groups before each. Few are left, so that adding them one by one is the least work.
// Follows a file that defines the direction.
uniform usampler2D group_sums;

layout(location = 0) out uvec4 sum;

void main()
{
    ivec2 group = ivec2(gl_FragCoord.xy);
    sum = uvec4(0);
    for (ivec2 before = place(0, place(group.x, group.y).y); before != group; before += place(1, 0)) {
        sum += texelFetch(group_sums, before, 0);
    }
}
