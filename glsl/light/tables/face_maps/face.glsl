// What "the same face" means.

// The least cosine between the normals of neighbours on a face, and between those of a box's middle and ends:
// 11 and 26 degrees.
const float NEIGHBOURS_AGREE = 0.98;
const float ENDS_AGREE = 0.9;

// Whether two neighbours are on one face: on the same surface, about as it faces, and neither off the other's
// plane by more than a fifth of what lies between them.
bool share_a_face(Surface a, Surface b)
{
    if (a.number <= 0.0 || a.number != b.number || dot(a.normal, b.normal) < NEIGHBOURS_AGREE) {
        return false;
    }
    vec3 away = b.position - a.position;
    float aside = max(abs(dot(a.normal, away)), abs(dot(b.normal, away)));
    return aside * aside <= 0.04 * dot(away, away);
}
