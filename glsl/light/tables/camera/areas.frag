// The area that each pixel sees, in whole units.
//
// Areas beyond the largest weight count as that: their pixels' light is averaged evenly. Those below two
// thirds of a unit are left out.
const float MOST_UNITS = 262144.0;

// Units of area; 0 where nothing is lit.
layout(location = 0) out uint area;
// What the pixel's flux is multiplied with, so that its light stays that over its true area.
layout(location = 1) out float weight;

void main()
{
    Surface surface = surface_at(ivec2(gl_FragCoord.xy));
    area = 0u;
    weight = 0.0;
    if (surface.number > 0.0) {
        float exact = area_on(surface, 1e-3) / area_unit();
        float whole = min(floor(exact + 0.5), MOST_UNITS);
        if (3.0 * exact >= 2.0) {
            area = uint(whole);
            weight = whole / exact;
        }
    }
}
