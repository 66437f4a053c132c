// The ray of a pixel. Places are found along it and not interpolated between corners, which may be so far
// away that f32 between them is coarser than what a pixel shows.

// The pinhole or the light's place, in scene units.
uniform vec3 camera;
// From there to the picture's corner at depth 1 along the view: where column 0 and row 0 begin.
uniform vec3 to_corner;
// One column further, at depth 1.
uniform vec3 to_right;
// One row further, at depth 1.
uniform vec3 to_next_row;
// A distance beyond everything, in scene units.
uniform float far;

// To the middle of the pixel, at depth 1 along the view.
vec3 ray_of_pixel()
{
    return to_corner + gl_FragCoord.x * to_right + gl_FragCoord.y * to_next_row;
}

// For a depth buffer of f32, whose steps are as fine near as far where distances are kept as they are, over
// the largest.
float depth_of(float distance)
{
    return clamp(distance / far, 0.0, 1.0);
}
