// How much a photon's kernel covers: the sum of its weights times the pixels' areas. Dividing by it keeps the
// energy, at the picture's edges and at the surface's as well. One point of the table for each photon.

// Columns and rows of the table of photons.
uniform ivec2 table_size;

flat out float covered;

void main()
{
    ivec2 home = ivec2(floor(pixel_of(photon_position)));
    Surface surface = surface_or_none(home);
    covered = 0.0;
    if (contributes(home, surface)) {
        Kernel kernel = kernel_on(photon_position, surface, radius_at(home));
        ivec4 pixels = reach(kernel, to_clip, home);
        for (int y = pixels.y; y <= pixels.w; ++y) {
            for (int x = pixels.x; x <= pixels.z; ++x) {
                Surface there = surface_at(ivec2(x, y));
                covered += weight_of_photon(kernel, home, ivec2(x, y), there) * area_on(there, 1e-3);
            }
        }
    }
    ivec2 entry = ivec2(gl_VertexID % table_size.x, gl_VertexID / table_size.x);
    gl_Position = vec4((vec2(entry) + 0.5) / vec2(table_size) * 2.0 - 1.0, 0.0, 1.0);
    gl_PointSize = 1.0;
}
