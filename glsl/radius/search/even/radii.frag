// The widest radius of 0, 1, 2, 4, ... over which the density around a pixel is even but for noise.

// Columns and rows of the map, in pixels.
uniform ivec2 map_size;
// Sums of departures of radii 1 and 4.
uniform usampler2D of_1_and_4;
#ifdef SEVERAL_LEVELS
// Sums of departures of radii 2 and 8.
uniform usampler2D of_2_and_8;
#endif
#ifdef WIDE_LEVELS
// Sums of departures of radii from 16 on, all places of a radius beside those of the one before.
uniform usampler2D of_wide;
#endif

// The radius in pixels; 0 where the mask is 0 as well.
layout(location = 0) out uint radius;
#ifdef LIMITED_MASK
// 1 where MR ended a density that is even still, else 0.
layout(location = 1) out uint limited;
#endif

// What a table sums from `lo` to `hi`, both included; what lies before the first column or row is nothing.
uint sum_in(usampler2D table, ivec2 lo, ivec2 hi)
{
    uint sum = texelFetch(table, hi, 0).r;
    if (lo.x > 0) {
        sum -= texelFetch(table, ivec2(lo.x - 1, hi.y), 0).r;
    }
    if (lo.y > 0) {
        sum -= texelFetch(table, ivec2(hi.x, lo.y - 1), 0).r;
    }
    if (lo.x > 0 && lo.y > 0) {
        sum += texelFetch(table, lo - 1, 0).r;
    }
    return sum;
}

// Whether the mean departure over the box of twice the radius is small enough; `first` is the column where
// the places of a radius from 16 on begin.
bool is_even(ivec2 center, int level, int first)
{
    int reach = 2 << level;
    ivec2 lo = max(center - reach, ivec2(0));
    ivec2 hi = min(center + reach, map_size - 1);
    uint steps = 0u;
#ifdef WIDE_LEVELS
    if (level >= NARROW_LEVELS) {
        int shift = level - 2;
        lo = (lo + (1 << shift) - 1) >> shift;
        hi = hi >> shift;
        steps = sum_in(of_wide, lo + ivec2(first, 0), hi + ivec2(first, 0));
    }
#endif
    if (level < NARROW_LEVELS) {
#ifdef SEVERAL_LEVELS
        uint both = (level & 1) == 1 ? sum_in(of_2_and_8, lo, hi) : sum_in(of_1_and_4, lo, hi);
#else
        uint both = sum_in(of_1_and_4, lo, hi);
#endif
        steps = level < 2 ? both >> LOWER_BITS : both & ((1u << LOWER_BITS) - 1u);
    }
    ivec2 places = hi - lo + 1;
    uvec2 limit = threshold(1 << level);
    return steps * limit.y <= (limit.x << EVEN_STEPS_LOG2) * uint(places.x * places.y);
}

void main()
{
    ivec2 center = min(ivec2(gl_FragCoord.xy), map_size - 1);
    radius = 0u;
    bool goes_on = !needs_none(center);
    bool was_even = true;
    int first = 0;
    // One radius that fails alone may be chance; two in a row end the search.
    for (int level = 0; level < LEVELS && goes_on; ++level) {
        bool is_candidate = is_even(center, level, first);
        if (is_candidate) {
            radius = 1u << level;
        }
        goes_on = is_candidate || was_even;
        was_even = is_candidate;
        if (level >= NARROW_LEVELS) {
            first += (map_size.x + (1 << (level - 2)) - 1) >> (level - 2);
        }
    }
#ifdef LIMITED_MASK
    limited = radius == 1u << (LEVELS - 1) ? 1u : 0u;
#endif
}
