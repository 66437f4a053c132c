// Each photon as a point at its pixel, if it contributes (thesis 2.1).
flat out vec3 power;

void main()
{
    ivec2 pixel = ivec2(floor(pixel_of(photon_position)));
    bool counts = contributes(pixel, surface_or_none(pixel));
    power = photon_power;
    // What does not contribute is put outside of the picture.
    vec2 place = (vec2(pixel) + 0.5) / vec2(map_size) * 2.0 - 1.0;
    gl_Position = counts ? vec4(place, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = 1.0;
}
