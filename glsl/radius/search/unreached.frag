// Pixels whose box of radius MR holds too few.

// MR, in pixels.
uniform int max_radius;

// MR; 0 where the mask is 0.
layout(location = 0) out uint radius;
#ifdef LIMITED_MASK
// 1; 0 where the mask is 0.
layout(location = 1) out uint limited;
#endif

void main()
{
    bool masked = needs_none(ivec2(gl_FragCoord.xy));
    radius = masked ? 0u : uint(max_radius);
#ifdef LIMITED_MASK
    limited = masked ? 0u : 1u;
#endif
}
