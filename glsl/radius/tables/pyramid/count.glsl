// A box cut into texels of a mipmap, one sample at a time, the rest on a stack (thesis 3.3.2, 4.3).

// The mipmap of sums, or of averages.
uniform SUM_SAMPLER pyramid;
// The mipmap's last level.
uniform int top_level;

SUM block_sum(ivec2 block, int level)
{
    SUM texel = texelFetch(pyramid, block, level).r;
#ifdef AVERAGED
    // 3.3: the average of 2^l by 2^l pixels times their number.
    texel *= float(1 << (2 * level));
#endif
    return texel;
}

// The highest level that has a block starting at `at` and fitting into `extent`.
int matching_level(ivec2 at, ivec2 extent)
{
#ifdef MATCHING_BITS
    // The exponent of a float is the place of its highest bit: exact below 2^24.
    int corner = at.x | at.y;
    int fits = min(extent.x, extent.y);
    int level = min((floatBitsToInt(float(fits)) >> 23) - 127, top_level);
    return corner == 0 ? level : min(level, (floatBitsToInt(float(corner & -corner)) >> 23) - 127);
#else
    int level = top_level;
    int side = 1 << top_level;
    while (any(notEqual(at % side, ivec2(0))) || any(greaterThan(ivec2(side), extent))) {
        --level;
        side >>= 1;
    }
    return level;
#endif
}

#ifdef WHOLE_STRIPS
// 6.3.5: the strips of width or height 1 that odd coordinates leave are at the box's sides. Takes them off,
// each in one loop, so that blocks of 2 x 2 and larger fill what is left, from `lo` to before `end`.
SUM strips_sum(inout ivec2 lo, inout ivec2 end)
{
    SUM sum = SUM(0);
    if ((lo.x & 1) == 1) {
        for (int y = lo.y; y < end.y; ++y) sum += block_sum(ivec2(lo.x, y), 0);
        ++lo.x;
    }
    if ((end.x & 1) == 1) {
        --end.x;
        for (int y = lo.y; y < end.y; ++y) sum += block_sum(ivec2(end.x, y), 0);
    }
    if ((lo.y & 1) == 1) {
        for (int x = lo.x; x < end.x; ++x) sum += block_sum(ivec2(x, lo.y), 0);
        ++lo.y;
    }
    if ((end.y & 1) == 1) {
        --end.y;
        for (int x = lo.x; x < end.x; ++x) sum += block_sum(ivec2(x, end.y), 0);
    }
    return sum;
}
#endif

uint count_in_box(ivec2 lo, ivec2 hi)
{
    // Areas as (x, y, x_end, y_end), ends not included. STACK_SIZE is proved enough in
    // src/radius/tables/pyramid.rs.
    ivec4 stack[STACK_SIZE];
    ivec2 end = hi + 1;
    SUM sum = SUM(0);
#ifdef WHOLE_STRIPS
    sum += strips_sum(lo, end);
#endif
    stack[0] = ivec4(lo, end);
    int top = all(lessThan(lo, end)) ? 1 : 0;

    while (top > 0) {
        ivec4 area = stack[--top];
        ivec2 at = area.xy;
        int level = matching_level(at, area.zw - at);
        int side = 1 << level;
        sum += block_sum(at / side, level);

        // Split the rest, the larger piece to the bottom of the stack.
        ivec2 next = at + side;
        ivec2 rest = area.zw - next;
        bvec2 left = greaterThan(rest, ivec2(0));
#ifdef SPLIT_LARGER
        if (rest.x > rest.y) {
            if (left.x) stack[top++] = ivec4(next.x, at.y, area.zw);
            if (left.y) stack[top++] = ivec4(at.x, next.y, next.x, area.w);
        } else {
            if (left.y) stack[top++] = ivec4(at.x, next.y, area.zw);
            if (left.x) stack[top++] = ivec4(next.x, at.y, area.z, next.y);
        }
#else
        bvec2 odd = equal(at & 1, ivec2(1));
#ifdef FAULT_FORGOTTEN_STRIP
        // As printed, an odd corner goes on in a direction only if there is a rest in the other one too.
        bool whole = all(left);
        bvec2 even = not(odd);
        left = bvec2(left.x && (whole || even.x), left.y && (whole || even.y));
#endif
        if (all(odd)) {
            if (all(left)) stack[top++] = ivec4(next, area.zw);
            if (left.y) stack[top++] = ivec4(at.x, next.y, next.x, area.w);
            if (left.x) stack[top++] = ivec4(next.x, at.y, area.z, next.y);
        } else if (odd.y) {
            if (left.y) stack[top++] = ivec4(at.x, next.y, area.zw);
            if (left.x) stack[top++] = ivec4(next.x, at.y, area.z, next.y);
        } else {
            if (left.x) stack[top++] = ivec4(next.x, at.y, area.zw);
            if (left.y) stack[top++] = ivec4(at.x, next.y, next.x, area.w);
        }
#endif
    }
#ifdef AVERAGED
    return to_count(sum + 0.5);
#else
    return to_count(sum);
#endif
}
