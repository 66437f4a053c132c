// A point for each photon, as cheap as a point can be.

// Where the photon landed, in scene units.
layout(location = 0) in vec3 photon_position;

// From scene units to clip space, with row 0 of the picture at the bottom.
uniform mat4 to_clip;

void main()
{
    gl_Position = to_clip * vec4(photon_position, 1.0);
    gl_PointSize = 1.0;
}
