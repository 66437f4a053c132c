// How far the plane of a triangle is. Follows render/surfaces/ray.glsl.

in vec3 at;
flat in vec3 facing;
// From the camera, along the normal, in scene units.
flat in float plane_distance;

// A plane seen at a smaller cosine is seen edge-on: where the pixel's ray meets it depends on how its edges
// were rounded.
const float EDGE_ON = 1e-3;

// Distance along a unit vector through the pixel.
float distance_to_plane(vec3 sight)
{
    float cosine = dot(facing, sight);
    return abs(cosine) > EDGE_ON ? abs(plane_distance / cosine) : length(at - camera);
}
