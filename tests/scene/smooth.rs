//! Normals of smooth meshes: faces that meet at a position share its normal, however the file is cut into
//! pieces.

use varikernel::glam::Vec3;

use crate::meshes::with_mesh;

const SMOOTH: &str = "material = \"white\"\nmesh = { file = \"a.obj\", smooth = true }";

/// Positions and normals of the mesh's vertices that triangles use.
fn normals(obj: &str) -> Vec<(Vec3, Vec3)> {
    let scene = with_mesh(SMOOTH, &[("a.obj", obj.as_bytes())]).unwrap();
    let geometry = scene.geometry();
    let mine = geometry.triangles.iter().filter(|one| geometry.surfaces[one.surface as usize] == "thing");
    let vertices = mine.flat_map(|one| one.vertices.map(|vertex| geometry.vertices[vertex as usize]));
    vertices.map(|vertex| (vertex.position, vertex.normal)).collect()
}

/// A roof of two slopes that meet at 90 degrees on the line y = 1: the mean of both there is +y.
#[track_caller]
fn ridge_is_up(obj: &str) {
    let ridge: Vec<_> = normals(obj).into_iter().filter(|(position, _)| position.y == 1.0).collect();
    assert_eq!(ridge.len(), 6, "{obj}");
    for (position, normal) in ridge {
        assert!(normal.abs_diff_eq(Vec3::Y, 1e-6), "{obj}: {normal} at {position}");
    }
}

#[test]
fn seams_groups_materials_and_doubled_vertices_do_not_part_faces() {
    let corners = "v -1 0 0\nv -1 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\n";
    ridge_is_up(&format!("{corners}f 1 2 4 3\nf 3 4 6 5\n"));
    ridge_is_up(&format!("{corners}vt 0 0\nvt 1 1\nf 1/1 2/1 4/1 3/1\nf 3/2 4/2 6/2 5/2\n"));
    ridge_is_up(&format!("{corners}o a\ng b\nusemtl c\nf 1 2 4 3\no d\ng e\nusemtl f\nf 3 4 6 5\n"));
    // The ridge again as vertices 7 and 8, where zero has the other sign.
    ridge_is_up(&format!("{corners}v -0.0 1 -0\nv -0.0 1 1\nf 1 2 4 3\nf 7 8 6 5\n"));
    // One slope brings normals of its own, the other has the mean.
    let given = format!("{corners}vn 0 1 0\nf 1//1 2//1 4//1 3//1\nf 3 4 6 5\n");
    ridge_is_up(&given);
    assert!(normals(&given)[0].1 == Vec3::Y);
    // A normal without length is none.
    ridge_is_up(&format!("{corners}vn 0 0 0\nf 1//1 2//1 4//1 3//1\nf 3//1 4//1 6//1 5//1\n"));
}

#[test]
fn a_sheet_with_two_sides_has_the_normals_of_its_faces() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let found = normals(&format!("{corners}f 1 2 3\nf 4 6 5\n"));
    assert!(found[..3].iter().all(|(_, normal)| *normal == Vec3::Z), "{found:?}");
    assert!(found[3..].iter().all(|(_, normal)| *normal == -Vec3::Z), "{found:?}");
}
