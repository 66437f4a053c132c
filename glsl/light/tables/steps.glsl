// Light in whole steps, so that tables can sum it.

// Light of fewer steps in the mean is too coarse.
const float FEWEST_STEPS = 32.0;

// Steps of one unit of power over one of area: of what the picture's photons give its pixels in the mean,
// BRIGHTEST times as much are MOST_STEPS.
float steps_of_light()
{
    uvec3 all = entry(flux_table, map_size.x - 1, map_size.y - 1).rgb;
    float mean = float(max(max(all.r, all.g), all.b)) / (float(MEAN_AREA) * float(map_size.x) * float(map_size.y));
    return float(MOST_STEPS) / (float(BRIGHTEST) * max(mean, 1e-20));
}
