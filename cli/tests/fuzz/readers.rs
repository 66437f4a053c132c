//! The readers of files that others made, each as a function of a path; errors are as good as success, panics
//! are not.

use std::fs;
use std::path::Path;

use varikernel::image::{ReadOptions, read_colours, read_counts, read_mask};
use varikernel::scene::Scene;
use varikernel_lab::bench::{Report, compare};
use varikernel_lab::reproduce::RunFile;
use varikernel_lab::study::Study;

/// A reader, the name of the file that it is given, the other files beside it, and what its seeds end in.
pub(crate) struct Reader {
    pub(crate) name: &'static str,
    /// The file that is changed.
    pub(crate) file: &'static str,
    /// Names and contents of files that stay as they are.
    pub(crate) beside: &'static [(&'static str, &'static str)],
    /// Folders of seeds below the repository, and the extension that a seed has.
    pub(crate) seeds: &'static [(&'static str, &'static str)],
    pub(crate) read: fn(&Path),
}

const SCENE: &str = "
[camera]
position = [0, 0, 3]
direction = [0, 0, -1]
up = [0, 1, 0]
vertical_fov_degrees = 60
[lights.lamp]
point = [0, 0, 3]
intensity = [30, 30, 30]
[materials]
grey = { lambert = [0.5, 0.5, 0.5] }
[surfaces]
own = { mesh = { file = \"a.EXTENSION\" } }
given = { material = \"grey\", mesh = { file = \"a.EXTENSION\", smooth = true } }
";
const OBJ: &str =
    "mtllib a.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nusemtl red\nf 1/1 2/1 3/1 4/1\n";
const MTL: &str = "newmtl red\nKd 0.6 0.1 0.1\nillum 2\n";
const MAPS: &str = "assets/maps";
const SEEDS: &str = "cli/tests/fuzz/seeds";

/// Every reader.
pub(crate) const READERS: [Reader; 13] = [
    Reader { name: "exr", file: "a.exr", beside: &[], seeds: &[(SEEDS, "exr")], read: read_map },
    Reader { name: "npy", file: "a.npy", beside: &[], seeds: &[(SEEDS, "npy")], read: read_map },
    Reader {
        name: "png",
        file: "a.png",
        beside: &[],
        seeds: &[(SEEDS, "png"), (MAPS, "png")],
        read: read_map,
    },
    Reader {
        name: "obj",
        file: "a.obj",
        beside: &[("a.mtl", MTL)],
        seeds: &[(SEEDS, "obj"), ("tests/scene/exported", "obj")],
        read: |path| read_mesh(path, "obj"),
    },
    Reader {
        name: "mtl",
        file: "a.mtl",
        beside: &[("a.obj", OBJ)],
        seeds: &[(SEEDS, "mtl"), ("tests/scene/exported", "mtl")],
        read: |path| read_mesh(path, "obj"),
    },
    Reader {
        name: "gltf",
        file: "a.gltf",
        beside: &[],
        seeds: &[(SEEDS, "gltf")],
        read: |path| read_mesh(path, "gltf"),
    },
    Reader {
        name: "glb",
        file: "a.glb",
        beside: &[],
        seeds: &[(SEEDS, "glb")],
        read: |path| read_mesh(path, "glb"),
    },
    Reader {
        name: "scene",
        file: "a.toml",
        beside: &[("a.obj", OBJ), ("a.mtl", MTL), ("ring.obj", OBJ), ("water.obj", OBJ)],
        seeds: &[(SEEDS, "toml"), ("assets/scenes", "toml")],
        read: |path| drop(Scene::load(path)),
    },
    Reader {
        name: "window_settings",
        file: "a.json",
        beside: &[],
        seeds: &[("cli/tests/fuzz/seeds/window", "json")],
        read: read_window_settings,
    },
    Reader {
        name: "bench",
        file: "a.json",
        beside: &[],
        seeds: &[("cli/tests/fuzz/seeds/bench", "json")],
        read: |path| {
            if let Ok(report) = Report::load(path) {
                drop(compare(&report, &report));
                drop(report.save_csv(&path.with_extension("csv")));
            }
        },
    },
    Reader {
        name: "reproduction",
        file: "a.json",
        beside: &[],
        seeds: &[("cli/tests/fuzz/seeds/reproduction", "json")],
        read: |path| drop(RunFile::load(path)),
    },
    Reader {
        name: "study",
        file: "a.json",
        beside: &[],
        seeds: &[("cli/tests/fuzz/seeds/study", "json")],
        read: |path| {
            if let Ok(study) = Study::load(path) {
                drop(study.check_resumable(path, &study));
                drop(study.save(&path.with_extension("again")));
                drop(study.save_csv(&path.with_extension("csv")));
                drop(study.html("varikernel study"));
            }
        },
    },
    Reader {
        name: "texture",
        file: "t.png",
        beside: &[("a.obj", OBJ), ("a.mtl", "newmtl red\nmap_Kd t.png\nmap_Ke t.png\n")],
        seeds: &[(SEEDS, "png"), (SEEDS, "jpg")],
        read: |path| read_mesh(&path.with_file_name("a.obj"), "obj"),
    },
];

fn read_map(path: &Path) {
    drop(read_counts(path, &ReadOptions::default()));
    drop(read_counts(path, &ReadOptions { channel: Some("R"), ..ReadOptions::default() }));
    drop(read_mask(path));
    drop(read_colours(path));
}

fn read_mesh(path: &Path, extension: &str) {
    let scene = path.with_file_name("scene.toml");
    if fs::write(&scene, SCENE.replace("EXTENSION", extension)).is_ok() {
        drop(Scene::load(&scene));
    }
}

/// The program's own file: it ends with an error before there is a window, or because there is no display.
fn read_window_settings(path: &Path) {
    let mut command = assert_cmd::Command::cargo_bin("varikernel").expect("the program is built");
    let run = command
        .arg("view")
        .arg(path)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .expect("the program runs");
    let stderr = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.code() == Some(2) && !stderr.contains("panicked"), "{:?}: {stderr}", run.status);
}
