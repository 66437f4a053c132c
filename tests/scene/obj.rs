//! OBJ as many programs write it: what must come out is worked out by hand.

use varikernel::glam::Vec3;
use varikernel::scene::{Scattering, Scene, area};

use crate::meshes::{OBJ, refuses, with_mesh};

/// A square of side 2 at z = 0 that faces +z.
const CORNERS: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
const RED: &[u8] = b"newmtl red\nKd 0.6 0.1 0.1\n";
const OWN: &str = "mesh = { file = \"a.obj\" }";

/// The corners of the triangles of the surface `thing`, each with its material's name.
fn triangles(scene: &Scene) -> Vec<([Vec3; 3], &str)> {
    let geometry = scene.geometry();
    let mine = geometry.triangles.iter().filter(|one| geometry.surfaces[one.surface as usize] == "thing");
    mine.map(|one| (geometry.corners(one), scene.materials()[one.material as usize].name.as_str())).collect()
}

fn whole_area(scene: &Scene) -> f64 {
    triangles(scene).iter().map(|(corners, _)| area(corners)).sum()
}

/// The OBJ is the square, in two triangles that face +z, in red.
#[track_caller]
fn is_the_red_square(obj: &[u8], files: &[(&str, &[u8])]) {
    let told = String::from_utf8_lossy(obj);
    let scene = with_mesh(OWN, &[&[("a.obj", obj)], files].concat())
        .unwrap_or_else(|error| panic!("{told}\n{error}"));
    let found = triangles(&scene);
    assert_eq!(found.len(), 2, "{told}");
    assert_eq!(whole_area(&scene), 4.0, "{told}");
    for ([a, b, c], material) in found {
        assert_eq!((b - a).cross(c - a).normalize(), Vec3::Z, "{told}");
        let material = scene.materials().iter().find(|known| known.name == material).unwrap();
        assert_eq!(material.scattering, Scattering::Lambert(Vec3::new(0.6, 0.1, 0.1)), "{told}");
    }
}

#[test]
fn what_stands_around_the_numbers_does_not_matter() {
    let plain = format!("mtllib a.mtl\n{CORNERS}usemtl red\nf 1 2 3 4\n");
    let changed = |from: &str, to: &str| {
        assert!(plain.contains(from));
        plain.replace(from, to).into_bytes()
    };
    for obj in [
        plain.clone().into_bytes(),
        changed("\n", "\r\n"),
        changed("\n", "\r"),
        changed(" ", "\t"),
        changed("\n", " \t\n  "),
        changed("\n", "  # told # twice\n"),
        changed("f 1 2 3 4", "f 1 2 3 4#front"),
        changed("mtllib", "\u{feff}mtllib"),
        changed("v -1 -1 0\n", "\n\n# C:\\temp\\\nv -1 -1 0\n"),
        changed("f 1 2 3 4", "f 1 2 \\\n 3 4"),
        changed("f 1 2 3 4", "f \\\r\n1 \\\r\n2 3\\\r\n 4"),
        changed("v -1 1 0", "v -1e0 +1.0 -0.0"),
        changed("f 1", "g a b\no c\ns 1\ns off\nl 1 2\np 3\nf 1"),
        // Weights and colours; on some vertices only.
        changed("v 1 1 0\n", "v 1 1 0 2\n"),
        changed(" 0\n", " 0 1 0 0\n"),
        changed(" 0\n", " 0 1 0 0 1\n"),
        changed("1 1 0\n", "1 1 0 1 0 0\n"),
        // Corners from behind, with coordinates, normals, and without.
        changed("f 1 2 3 4", "f -4 -3 -2 -1"),
        changed("f 1 2 3 4", "vt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1 4//"),
        changed("f 1 2 3 4", "vt 0\nf  1/1   2/1/  3/1 4/1 "),
        changed("f 1 2 3 4", "vn 0 0 1\nf 1//-1 2//-1 3//-1 4//-1"),
        changed("f 1 2 3 4", "f 1/9/9 2/9/9 3/9/9 4/9/9"),
        changed("f 1 2 3 4", "f 1 2\nf 1\nf\nf 1 2 3 4\nfoo 1 2"),
        changed("f 1 2 3 4", "vp 0 1\ncstype bezier\ndeg 3\ncurv 0 1 1 2 3\nend\nf 1 2 3 4"),
        changed("f 1 2 3 4", "f 1 2 3\nf 1 3 4"),
        changed("f 1 2 3 4", "f 1 1 2 3 3 4"),
    ] {
        is_the_red_square(&obj, &[("a.mtl", RED)]);
    }
    let mut latin = b"# Mod\xe8le\n".to_vec();
    latin.extend(plain.bytes());
    is_the_red_square(&latin, &[("a.mtl", RED)]);
    // Faces may come before their vertices.
    is_the_red_square(
        format!("mtllib a.mtl\nusemtl red\nf 1 2 3 4\n{CORNERS}").as_bytes(),
        &[("a.mtl", RED)],
    );
}

#[test]
fn mtl_files_are_found_as_they_are_written() {
    let obj = |lines: &str| format!("{}\n{CORNERS}f 1 2 3 4\n", lines.replace('|', "\n")).into_bytes();
    for (lines, mtl) in [
        ("mtllib ./a.mtl|usemtl red", "a.mtl"),
        ("mtllib .\\a.mtl|usemtl red", "a.mtl"),
        ("mtllib sub/../a.mtl|usemtl red", "a.mtl"),
        ("mtllib sub\\a.mtl|usemtl red", "sub/a.mtl"),
        ("mtllib my own.mtl|usemtl red", "my own.mtl"),
        ("mtllib my #1.mtl|usemtl red", "my #1.mtl"),
        ("mtllib a.mtl # mine|usemtl red # the red one", "a.mtl"),
        ("mtllib none.mtl a.mtl|usemtl red", "a.mtl"),
        ("mtllib a.mtl none.mtl a.mtl|usemtl red", "a.mtl"),
        ("mtllib none.mtl|mtllib a.mtl|usemtl red", "a.mtl"),
        ("mtllib|mtllib\ta.mtl|usemtl\tred", "a.mtl"),
        ("usemtl red|mtllib a.mtl", "a.mtl"),
        ("mtllib a.mtl|usemtl|usemtl red", "a.mtl"),
        ("mtllib a.mtl|usemtl red|usemtl", "a.mtl"),
        ("mtllib a.mtl|usemtl blue|usemtl red", "a.mtl"),
    ] {
        is_the_red_square(&obj(lines), &[(mtl, RED)]);
    }
    is_the_red_square(
        &obj("mtllib a.mtl|usemtl red"),
        &[("a.mtl", b"\xef\xbb\xbf  newmtl\tred # mine\r\n\tKd\t0.6 0.1 0.1\r\n")],
    );
    // The first file that has a material counts.
    let other = b"newmtl red\nKd 0 0 0\n";
    is_the_red_square(&obj("mtllib a.mtl b.mtl|usemtl red"), &[("a.mtl", RED), ("b.mtl", other)]);
    // A `#` belongs to a name where the MTL file has it so, and else begins a comment.
    let numbered = b"newmtl Material #1\nKd 0 0 0\nnewmtl Material #2\nKd 0.6 0.1 0.1\n";
    is_the_red_square(&obj("mtllib a.mtl|usemtl Material #2"), &[("a.mtl", numbered)]);
    is_the_red_square(
        &obj("mtllib a.mtl|usemtl Modell \u{e8}"),
        &[("a.mtl", b"newmtl Modell \xe8\nKd 0.6 0.1 0.1")],
    );
}

#[test]
fn an_mtl_file_beside_an_obj_in_a_folder_counts_from_there() {
    let obj = format!("mtllib ../mtl/a.mtl\n{CORNERS}usemtl red\nf 1 2 3 4\n");
    let files: [(&str, &[u8]); 2] = [("objs/a.obj", obj.as_bytes()), ("mtl/a.mtl", RED)];
    for path in ["objs/a.obj", "./objs//a.obj", "objs\\\\a.obj", "mtl/../objs/./a.obj"] {
        let scene = with_mesh(&format!("mesh = {{ file = \"{path}\" }}"), &files).unwrap();
        assert_eq!(triangles(&scene).len(), 2, "{path}");
    }
}

#[test]
fn materials_change_within_a_file() {
    let obj =
        format!("mtllib a.mtl\n{CORNERS}usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\nusemtl red\nf 3 2 1\n");
    let mtl = b"newmtl blue\nKd 0 0 1\nnewmtl unused\nKd 0,5 1 1\nnewmtl red\nKd 1 0 0\n";
    let scene = with_mesh(OWN, &[("a.obj", obj.as_bytes()), ("a.mtl", mtl)]).unwrap();
    let materials: Vec<_> = triangles(&scene).iter().map(|(_, material)| *material).collect();
    assert_eq!(materials, ["red", "blue", "red"]);
    assert!(scene.materials().iter().all(|material| material.name != "unused"));
}

#[test]
fn a_usemtl_without_a_name_is_grey() {
    let obj = format!("{CORNERS}usemtl\nf 1 2 3 4\n");
    let scene = with_mesh(OWN, &[("a.obj", obj.as_bytes())]).unwrap();
    let grey = scene.materials().iter().find(|material| material.name == "grey").unwrap();
    assert_eq!(grey.scattering, Scattering::Lambert(Vec3::splat(0.8)));
    let obj = format!("{CORNERS}usemtl\nf 1 2 3\nusemtl # none\nf 1 3 4\n");
    let scene = with_mesh(OWN, &[("a.obj", obj.as_bytes())]).unwrap();
    assert!(triangles(&scene).iter().all(|(_, material)| *material == "grey"));
}

#[test]
fn the_surfaces_material_needs_no_mtl_file() {
    for line in ["mtllib none.mtl", "mtllib ../a.mtl", "mtllib a.mtl", "usemtl", ""] {
        let obj = format!("{line}\n{CORNERS}usemtl red\nf 1 2 3 4\n");
        let scene = with_mesh(OBJ, &[("a.obj", obj.as_bytes()), ("a.mtl", b"newmtl red\nKd x\n")]).unwrap();
        assert!(triangles(&scene).iter().all(|(_, material)| *material == "white"), "{line}");
    }
}

#[test]
fn dents_are_left_open_from_whichever_corner() {
    // An arrow head of area 1.5, its dent at (0, -0.5).
    let corners = "v -1 -1 0\nv 0 -0.5 0\nv 1 -1 0\nv 0 1 0\n";
    for face in ["1 2 3 4", "2 3 4 1", "3 4 1 2", "4 1 2 3"] {
        let obj = format!("{corners}f {face}\n");
        let scene = with_mesh(OBJ, &[("a.obj", obj.as_bytes())]).unwrap();
        assert_eq!(whole_area(&scene), 1.5, "{face}");
        for ([a, b, c], _) in triangles(&scene) {
            assert_eq!((b - a).cross(c - a).normalize(), Vec3::Z, "{face}");
        }
    }
}

#[test]
fn what_is_wrong_is_told_by_line() {
    let with = |line: &str| format!("{CORNERS}{line}\nf 1 2 3 4\n");
    for (line, words) in [
        ("v 1,5 2 3", "a.obj: line 5, `v 1,5 2 3`: `1,5` is not a finite number"),
        ("\nv 1 2", "line 6, `v 1 2`: it has 2 numbers of 3"),
        ("v nan 0 0", "line 5, `v nan 0 0`: `nan` is not a finite number"),
        ("v 0 inf 0", "`inf` is not a finite number"),
        ("v 0 0 1e39", "`1e39` is not a finite number"),
        ("v 1.#QNAN 0 0", "it has 1 numbers of 3"),
        ("vn 0 x 0", "line 5, `vn 0 x 0`: `x` is not a finite number"),
        ("f 1 2 9", "line 5: a face names vertex 9, and there are 4"),
        ("f 1 2 -5", "line 5, `f 1 2 -5`: `-5` names something before the first"),
        ("f 1 2 0", "`0` names something before the first"),
        ("f 1 2 3.5", "`3.5` is no corner of a face"),
        ("f 1 2 /3", "`/3` is no corner of a face"),
        ("f 1 2 3/1/1/1", "`3/1/1/1` is no corner of a face"),
        ("f 1 2 99999999999", "`99999999999` names something"),
        ("f 1 2 -9223372036854775808", "names something before the first"),
    ] {
        refuses(OBJ, &[("a.obj", with(line).as_bytes())], &[words]);
    }
    refuses(OBJ, &[("a.obj", b"v\0 \x001\0")], &["a.obj: it is text in UTF-16", "save it as UTF-8"]);
}

#[test]
fn materials_that_are_nowhere_are_told_by_both_files_and_the_line() {
    let obj = |lines: &str| format!("{lines}\n{CORNERS}usemtl red\nf 1 2 3 4\n");
    let files = |obj: &str, words: &[&str]| {
        refuses(OWN, &[("a.obj", obj.as_bytes()), ("b.mtl", b"newmtl blue\n")], words);
    };
    files(
        &obj("mtllib none.mtl"),
        &[
            "a.obj: line 6, `usemtl red`",
            "none.mtl (line 1): there is no such file",
            "give the surface a material",
        ],
    );
    files(&obj("mtllib my own.mtl"), &["my own.mtl (line 1): there is no such file"]);
    files(&obj("mtllib ../b.mtl"), &["../b.mtl (line 1): the path leaves the scene's folder"]);
    files(&obj(""), &["line 6, `usemtl red`: no MTL file is named"]);
    files(&obj("mtllib b.mtl"), &["no MTL file has this material", "there are: blue"]);
    let wide: &[u8] = b"\xff\xfen\0e\0w\0";
    let scene = with_mesh(OWN, &[("a.obj", obj("mtllib a.mtl").as_bytes()), ("a.mtl", wide)]);
    let message = scene.unwrap_err().to_string();
    assert!(message.contains("a.mtl (line 1): it is text in UTF-16; save it as UTF-8"), "{message}");
    files(&format!("mtllib b.mtl\n{CORNERS}f 1 2 3 4\n"), &["line 6: the face has no material"]);
    let many = (0..1100).map(|number| format!("mtllib {number}.mtl")).collect::<Vec<_>>().join("\n");
    files(&obj(&many), &["more than 1000 MTL files are named"]);
}
