// What each pixel of the picture shows: the g-buffer (thesis 2.3.2). Row 0 is the top of the picture.

// Place in scene units; w: depth along the view, 0 where nothing is seen.
uniform sampler2D position;
// Towards the camera; w: the surface's number from 1, negative for mirrors and glass, 0 where nothing is
// seen.
uniform sampler2D normal;
// Columns and rows of the picture, in pixels.
uniform ivec2 map_size;
// The pinhole, in scene units.
uniform vec3 camera;
// Side of a pixel at depth 1.
uniform float pixel_side;

// The least cosine between the normals of places that share their light.
const float LEAST_AGREEMENT = 0.5;

struct Surface {
    vec3 position;
    float depth;
    vec3 normal;
    float number;
};

Surface surface_at(ivec2 pixel)
{
    vec4 place = texelFetch(position, pixel, 0);
    vec4 facing = texelFetch(normal, pixel, 0);
    return Surface(place.xyz, place.w, facing.xyz, facing.w);
}

// Area that a pixel covers on its surface, whose cosine to the line of sight counts as at least
// `least_cosine`.
float area_on(Surface surface, float least_cosine)
{
    vec3 sight = surface.position - camera;
    float slant = max(abs(dot(surface.normal, sight)), least_cosine * length(sight));
    return pixel_side * pixel_side * surface.depth * surface.depth * surface.depth / slant;
}
