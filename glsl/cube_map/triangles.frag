// Which triangle is nearest to a place, from 1 (thesis 2.2, 2.6.1).

// The place, in scene units.
uniform vec3 camera;
// A distance beyond everything, in scene units.
uniform float far;

in vec3 at;
flat in float number;

// The triangle's number, from 1.
layout(location = 0) out uint primitive;

void main()
{
    primitive = uint(number + 0.5);
    gl_FragDepth = min(length(at - camera) / far, 1.0);
}
