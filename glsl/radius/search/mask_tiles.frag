// Whether any of 8 x 8 texels is not 0.

// The mask, or one reduced already.
uniform usampler2D mask;
// Columns and rows of the mask.
uniform ivec2 mask_size;

// 1 or 0.
layout(location = 0) out uint any_set;

void main()
{
    ivec2 first = 8 * ivec2(gl_FragCoord.xy);
    any_set = 0u;
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            any_set |= texelFetch(mask, min(first + ivec2(x, y), mask_size - 1), 0).r;
        }
    }
    any_set = any_set == 0u ? 0u : 1u;
}
