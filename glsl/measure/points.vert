// A point for each photon, as cheap as a point can be.
layout(location = 0) in vec3 photon_position;

uniform mat4 to_clip;

void main()
{
    gl_Position = to_clip * vec4(photon_position, 1.0);
    gl_PointSize = 1.0;
}
