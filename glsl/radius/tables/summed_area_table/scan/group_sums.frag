// Scan, step 2: the sum of each group of elements. Follows a file that defines the elements.

// Elements of a line.
uniform int elements;
// Elements of a group.
uniform int group_size;

// Photons of the group, for 4 rows or columns at once.
layout(location = 0) out uvec4 sum;

void main()
{
    ivec2 group = place(int(gl_FragCoord.x), int(gl_FragCoord.y));
    int first = group.x * group_size;
    int end = min(first + group_size, elements);
    sum = uvec4(0);
    for (int i = first; i < end; ++i) {
        sum += element(i, group.y);
    }
}
