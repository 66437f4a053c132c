// Scan, step 3: the sum of all elements before each, for a run of 8 at once: whole groups first, then the
// elements of the run's own group. Follows a file that defines the elements.

// The sum of each group of elements.
uniform usampler2D group_sums;
// Elements of a line.
uniform int elements;
// Elements of a group.
uniform int group_size;

// Photons of all elements before element i of the run.
layout(location = 0) out uvec4 before_0;
layout(location = 1) out uvec4 before_1;
layout(location = 2) out uvec4 before_2;
layout(location = 3) out uvec4 before_3;
layout(location = 4) out uvec4 before_4;
layout(location = 5) out uvec4 before_5;
layout(location = 6) out uvec4 before_6;
layout(location = 7) out uvec4 before_7;

void main()
{
    ivec2 run = place(int(gl_FragCoord.x), int(gl_FragCoord.y));
    int first = run.x * 8;
    int group = first / group_size;
    uvec4 sum = uvec4(0);
    for (int i = 0; i < group; ++i) {
        sum += texelFetch(group_sums, place(i, run.y), 0);
    }
    for (int i = group * group_size; i < first; ++i) {
        sum += element(i, run.y);
    }
    uvec4 before[8];
    for (int i = 0; i < 8; ++i) {
        before[i] = sum;
        sum += element(min(first + i, elements - 1), run.y);
    }
    before_0 = before[0];
    before_1 = before[1];
    before_2 = before[2];
    before_3 = before[3];
    before_4 = before[4];
    before_5 = before[5];
    before_6 = before[6];
    before_7 = before[7];
}
