// Gathering: each pixel adds up the power of the pixels around it within its own radius.

// Power of each pixel's photons, red, green and blue; a: their count.
uniform sampler2D power;
// From scene units to clip space, with row 0 of the picture at the bottom.
uniform mat4 to_clip;

// Irradiance: red, green and blue, in power per square of a scene unit; a: photons found.
layout(location = 0) out vec4 irradiance_and_found;

void main()
{
    ivec2 home = min(ivec2(gl_FragCoord.xy), map_size - 1);
    Surface surface = surface_at(home);
    irradiance_and_found = vec4(0.0);
    if (surface.number <= 0.0) {
        return;
    }
    Kernel kernel = kernel_on(surface.position, surface, radius_at(home));
    ivec4 pixels = reach(kernel, to_clip, home);
    vec3 gathered = vec3(0.0);
    float area = 0.0;
    float found = 0.0;
    for (int y = pixels.y; y <= pixels.w; ++y) {
        for (int x = pixels.x; x <= pixels.z; ++x) {
            Surface there = surface_at(ivec2(x, y));
            float weight = weight_at(kernel, there);
            if (weight > 0.0) {
                vec4 photons = texelFetch(power, ivec2(x, y), 0);
                gathered += weight * photons.rgb;
                area += weight * area_on(there, 1e-3);
                found += photons.a;
            }
        }
    }
    vec3 irradiance = gathered / area;
#ifdef COUNT_CORRECTION
    // The radius ends at a photon, so that the disc holds one more than its share (thesis 2.4: the n
    // nearest).
    irradiance *= found > 1.0 ? (found - 1.0) / found : 0.0;
#endif
    irradiance_and_found = vec4(irradiance, found);
}
