// Which triangle is nearest to a place, from 1 (thesis 2.2, 2.6.1).
uniform vec3 camera;
// A distance beyond everything.
uniform float far;

in vec3 at;
flat in float number;

layout(location = 0) out uint primitive;

void main()
{
    primitive = uint(number + 0.5);
    gl_FragDepth = min(length(at - camera) / far, 1.0);
}
