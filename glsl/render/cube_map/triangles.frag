// Which triangle is nearest to a place, from 1 (thesis 2.2, 2.6.1). Follows render/surfaces/plane.glsl.

flat in float number;

// The triangle's number, from 1.
layout(location = 0) out uint primitive;

void main()
{
    primitive = uint(number + 0.5);
    gl_FragDepth = depth_of(distance_to_plane(normalize(ray_of_pixel())));
}
