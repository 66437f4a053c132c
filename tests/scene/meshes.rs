//! Meshes by reference: OBJ and glTF, and what is wrong with some.

use std::fs;

use tempfile::TempDir;
use varikernel::Result;
use varikernel::glam::Vec3;
use varikernel::scene::{Scattering, Scene};

use crate::{BARE, load_with};

/// A scene whose surface `thing` is a mesh with these fields.
pub(crate) fn with_mesh(fields: &str, others: &[(&str, &[u8])]) -> Result<Scene> {
    load_with(&format!("{BARE}\n[surfaces.thing]\n{fields}\n"), others)
}

#[track_caller]
pub(crate) fn refuses(fields: &str, others: &[(&str, &[u8])], words: &[&str]) {
    let message = with_mesh(fields, others).unwrap_err().to_string();
    for word in words.iter().chain(&["line ", "\nhelp: "]) {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

const SQUARE: &[u8] = b"v 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nf 4 3 2 1\n";
pub(crate) const OBJ: &str = "material = \"white\"\nmesh = { file = \"a.obj\" }";

#[test]
fn an_obj_is_scaled_moved_and_faces_as_it_says() {
    let fields = "material = \"white\"\nmesh = { file = \"a.obj\", scale = 3, translate = [1, 2, 3] }";
    let scene = with_mesh(fields, &[("a.obj", SQUARE)]).unwrap();
    let geometry = scene.geometry();
    let thing = geometry.surfaces.iter().position(|name| name == "thing").unwrap();
    let mine: Vec<_> = geometry.triangles.iter().filter(|one| one.surface as usize == thing).collect();
    assert_eq!(mine.len(), 2);
    for triangle in mine {
        for vertex in triangle.vertices.map(|index| geometry.vertices[index as usize]) {
            assert_eq!(vertex.normal, Vec3::Y);
            assert!(vertex.position.x == 1.0 || vertex.position.x == 7.0, "{vertex:?}");
            assert!(vertex.position.y == 2.0);
        }
    }
}

#[test]
fn an_mtl_says_what_is_glass_mirror_and_light() {
    let obj = b"mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nusemtl m\nf 1 2 3\nusemtl g\nf 1 3 4\n\
                usemtl d\nf 1 2 4\n";
    let mtl =
        b"newmtl m\nKs 0.9 0.8 0.7\nillum 3\nnewmtl g\nNi 1.4\nillum 6\nnewmtl d\nKd 0.1 0.2 0.3\nKe 5 6 7\n";
    let scene = with_mesh("mesh = { file = \"a.obj\" }", &[("a.obj", obj), ("a.mtl", mtl)]).unwrap();
    let of = |name: &str| scene.materials().iter().find(|material| material.name == name).unwrap();
    assert_eq!(of("m").scattering, Scattering::Mirror(Vec3::new(0.9, 0.8, 0.7)));
    assert_eq!(of("g").scattering, Scattering::Dielectric { index: 1.4 });
    assert_eq!(of("d").scattering, Scattering::Lambert(Vec3::new(0.1, 0.2, 0.3)));
    assert_eq!(scene.lights().iter().map(|light| light.name.as_str()).collect::<Vec<_>>(), ["thing", "lamp"]);
    refuses("mesh = { file = \"a.obj\" }", &[("a.obj", SQUARE)], &["no material"]);
}

/// A triangle of f32 positions (0, 0, 0), (1, 0, 0), (0, 1, 0) as a glTF with its buffer in `uri`.
fn gltf(uri: &str, more: &str) -> String {
    format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],
        \"nodes\":[{{\"mesh\":0,\"translation\":[5,0,0]{more}}}],
        \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}},\"material\":0}}]}}],
        \"materials\":[{{\"name\":\"lens\",\"extensions\":{{
        \"KHR_materials_transmission\":{{\"transmissionFactor\":1}},
        \"KHR_materials_ior\":{{\"ior\":1.7}}}}}}],
        \"extensionsUsed\":[\"KHR_materials_transmission\",\"KHR_materials_ior\"],
        \"buffers\":[{{\"uri\":\"{uri}\",\"byteLength\":36}}],
        \"bufferViews\":[{{\"buffer\":0,\"byteLength\":36}}],
        \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",
        \"min\":[0,0,0],\"max\":[1,1,0]}}]}}"
    )
}

fn corners() -> Vec<u8> {
    [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].into_iter().flat_map(f32::to_le_bytes).collect()
}

const GLTF: &str = "mesh = { file = \"a.gltf\" }";

#[test]
fn a_gltf_brings_its_transforms_and_glass() {
    let mirrored = ",\"scale\":[1,1,-1]";
    for (more, normal) in [("", Vec3::Z), (mirrored, -Vec3::Z)] {
        let text = gltf("the%20corners.bin", more);
        let files: [(&str, &[u8]); 2] = [("a.gltf", text.as_bytes()), ("the corners.bin", &corners())];
        let scene = with_mesh(GLTF, &files).unwrap();
        let geometry = scene.geometry();
        let triangle =
            geometry.triangles.iter().find(|one| geometry.surfaces[one.surface as usize] == "thing").unwrap();
        let expected = [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 1.0, 0.0]].map(Vec3::from);
        let mut found = geometry.corners(triangle);
        if more == mirrored {
            found.swap(1, 2);
        }
        assert_eq!(found, expected);
        // The copy is mirrored along its own normal, so that its front looks the other way.
        assert_eq!(geometry.vertices[triangle.vertices[0] as usize].normal, normal);
        let material = &scene.materials()[triangle.material as usize];
        assert_eq!(
            (material.name.as_str(), material.scattering),
            ("lens", Scattering::ThinDielectric { index: 1.7, transmittance: Vec3::ONE })
        );
    }
}

#[test]
fn damaged_meshes_are_refused() {
    refuses(OBJ, &[], &["line 15, surfaces.thing.mesh.file", "a.obj: there is no such file"]);
    refuses(OBJ, &[("a.obj", b"v 0 nan 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")], &["line 1, `v 0 nan 0`", "`nan`"]);
    refuses(OBJ, &[("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 0 1e30\nf 1 2 3\n")], &["past 1e9"]);
    refuses(OBJ, &[("a.obj", b"v 0 0 0\nf 1 2 3\n")], &["a.obj"]);
    refuses(
        OBJ,
        &[("a.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")],
        &["no triangle of the mesh has an area"],
    );
    refuses(OBJ, &[("a.obj", b"")], &["no triangle"]);
    refuses(OBJ, &[("a.obj", b"v a b c\n")], &["line 1, `v a b c`"]);
    refuses("material = \"white\"\nmesh = { file = \"a.stl\" }", &[], &[".obj, .gltf or .glb"]);

    let text = gltf("corners.bin", "");
    refuses(GLTF, &[("a.gltf", text.as_bytes())], &["its buffer corners.bin: there is no such file"]);
    refuses(
        GLTF,
        &[("a.gltf", text.as_bytes()), ("corners.bin", &corners()[..20])],
        &["bufferViews[0]", "past the end"],
    );
    refuses(GLTF, &[("a.gltf", b"{}")], &["not a glTF file"]);
    let sparse = text.replace("\"count\":3", "\"count\":99999999999");
    refuses(GLTF, &[("a.gltf", sparse.as_bytes()), ("corners.bin", &corners())], &["too large"]);
    let of_doubles = text.replace("\"componentType\":5126", "\"componentType\":5130");
    refuses(GLTF, &[("a.gltf", of_doubles.as_bytes()), ("corners.bin", &corners())], &["is not known"]);
    let ring = text.replace("\"mesh\":0,\"translation\"", "\"children\":[0],\"mesh\":0,\"translation\"");
    refuses(
        GLTF,
        &[("a.gltf", ring.as_bytes()), ("corners.bin", &corners())],
        &["nodes[0]: the node is below itself"],
    );
}

#[test]
fn a_file_cut_anywhere_never_panics() {
    let obj = [b"mtllib a.mtl\n", SQUARE].concat();
    let gltf = gltf("corners.bin", "");
    for (fields, name, content) in [(OBJ, "a.obj", obj.as_slice()), (GLTF, "a.gltf", gltf.as_bytes())] {
        let mut refused = 0;
        for length in 0..content.len() {
            let files: [(&str, &[u8]); 2] = [(name, &content[..length]), ("corners.bin", &corners())];
            refused += u32::from(with_mesh(fields, &files).is_err());
        }
        assert!(refused > 40, "{name}: only {refused} cuts were noticed");
    }
}

#[test]
fn a_degenerate_triangle_among_others_is_left_out() {
    let obj = [SQUARE, b"f 1 2 2\n".as_slice()].concat();
    let scene = with_mesh(OBJ, &[("a.obj", &obj)]).unwrap();
    assert_eq!(scene.geometry().triangles.len(), 2 + 2);
}

#[test]
fn no_path_leads_out_of_the_scenes_folder() {
    for path in ["../a.obj", "/etc/a.obj", "x/../../a.obj", "./../a.obj", "..\\\\a.obj", "\\\\a.obj"] {
        refuses(
            &format!("material = \"white\"\nmesh = {{ file = \"{path}\" }}"),
            &[("a.obj", SQUARE)],
            &["the path leaves the scene's folder"],
        );
    }
    for uri in ["../corners.bin", "/etc/passwd", "%2e%2e/corners.bin", "file:///etc/passwd"] {
        let text = gltf(uri, "");
        refuses(GLTF, &[("a.gltf", text.as_bytes())], &["its buffer"]);
    }
}

#[test]
fn paths_inside_the_folder_may_be_written_in_many_ways() {
    let files: [(&str, &[u8]); 2] = [("a.obj", SQUARE), ("x/a.obj", SQUARE)];
    for path in [
        "./a.obj",
        "x/../a.obj",
        "x/a.obj",
        "x//a.obj",
        "x/./a.obj",
        "x\\\\a.obj",
        ".\\\\a.obj",
        "y/../a.obj",
    ] {
        with_mesh(&format!("material = \"white\"\nmesh = {{ file = \"{path}\" }}"), &files).unwrap();
    }
    for path in ["", ".", "x/.."] {
        let fields = format!("material = \"white\"\nmesh = {{ file = \"{path}\" }}");
        refuses(&fields, &files, &["the path names no file"]);
    }
    for uri in ["./corners.bin", "x/../corners.bin"] {
        let text = gltf(uri, "");
        with_mesh(GLTF, &[("a.gltf", text.as_bytes()), ("corners.bin", &corners())]).unwrap();
    }
}

#[cfg(unix)]
#[test]
fn no_link_leads_out_of_the_scenes_folder() {
    let (inside, outside) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    fs::write(outside.path().join("a.obj"), SQUARE).unwrap();
    std::os::unix::fs::symlink(outside.path().join("a.obj"), inside.path().join("a.obj")).unwrap();
    let path = inside.path().join("scene.toml");
    fs::write(&path, format!("{BARE}\n[surfaces.thing]\n{OBJ}\n")).unwrap();
    assert!(Scene::load(&path).unwrap_err().to_string().contains("leaves the scene's folder by a link"));
}
