//! `glsl`: shaders as text, without any OpenGL.

use std::process::Command as Tool;

use crate::Workplace;

/// What a run that finds neither EGL nor OSMesa prints.
#[track_caller]
fn answer_without_opengl(place: &Workplace, arguments: &str) -> String {
    let run = place
        .command(arguments)
        .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null")
        .env("LD_LIBRARY_PATH", place.folder.path())
        .assert()
        .success();
    String::from_utf8(run.get_output().stdout.clone()).unwrap()
}

/// With libraries in the way that are none.
fn place_without_opengl() -> Workplace {
    let place = Workplace::new();
    for name in ["libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", "libEGL.so", "libEGL.so.1"] {
        place.put(name, b"no library");
    }
    place
}

/// The names in a list, in order.
fn names(list: &str) -> Vec<&str> {
    list.lines().filter(|line| !line.starts_with(' ')).map(|line| line.split(' ').next().unwrap()).collect()
}

#[test]
fn the_list_is_in_the_order_of_a_frame() {
    let place = place_without_opengl();
    let list = answer_without_opengl(&place, "glsl --list");
    let names = names(&list);
    let order = [
        "surfaces-of-triangles",
        "density",
        "sat-tile-sums",
        "sat-unpack",
        "radius-tiles",
        "radius-search/inner",
        "certify-radii",
        "census",
        "splat-spread",
        "light-from-tables",
        "shade",
    ];
    let places: Vec<_> = order.map(|name| names.iter().position(|found| *found == name).unwrap()).to_vec();
    assert!(places.is_sorted(), "{names:?}");
    let line = list.lines().find(|line| line.trim_start().starts_with("radius-search/inner")).unwrap();
    assert!(line.contains("  The smallest radius whose box"), "{list}");
    assert!(
        list.contains("bracket in GL_R32UI, tile_class in GL_R8UI, from common/full_screen.vert"),
        "{list}"
    );
}

#[test]
fn options_choose_the_variant() {
    let place = place_without_opengl();
    let has = |options: &str, name: &str| {
        names(&answer_without_opengl(&place, &format!("glsl --list {options}"))).contains(&name)
    };
    assert!(has("--sat-build doubling", "sat-doubling") && !has("", "sat-doubling"));
    assert!(has("--search forward", "radius-search/continued") && !has("", "radius-search/continued"));
    assert!(has("--method pyramid", "mipmap-sum") && !has("--method pyramid", "sat-unpack"));
    assert!(has("--mask", "radius-mask") && !has("", "radius-mask"));

    let text = |arguments: &str| answer_without_opengl(&place, &format!("glsl {arguments} --stage fragment"));
    assert!(text("radius-search/edge --edges scale").contains("at_least(count"));
    assert!(!text("radius-search/inner").contains("at_least(count"));
    assert!(text("sat-unpack --storage u16").contains("layout(location = 0) out uint sum;"));
    assert!(text("sat-unpack --storage u16").contains("GL_R16UI"));
    assert!(text("sat-doubling --storage f32").contains("layout(location = 0) out float sum;"));
    assert!(text("sat-tiles --density r32f").contains("\nuniform sampler2D density;"));
    assert!(text("sat-tiles").contains("\nuniform usampler2D density;"));
    assert!(text("radius-search/edge --limited-mask").contains("1: uint limited in GL_R8UI"));
    assert!(text("gather --kernel cone").contains("return 1.0 - sqrt(squared);"));
    assert!(!text("gather").contains("return 1.0 - sqrt(squared);"));
    assert!(text("gather --radius fixed:3").contains("uniform uint fixed_radius;"));
}

#[test]
fn a_shader_is_printed_with_its_table() {
    let place = place_without_opengl();
    let text = answer_without_opengl(&place, "glsl density");
    let stages: Vec<_> = text.split("#version 330 core\n").collect();
    let [nothing, vertex, fragment] = stages[..] else { panic!("{text}") };
    assert_eq!(nothing, "");
    assert!(vertex.starts_with("// density, vertex stage of varikernel "), "{vertex}");
    assert!(vertex.contains("//   2: vec3 photon_power     Red, green and blue, in"), "{vertex}");
    assert!(
        vertex.contains("// samplers\n//   sampler2D position       Place in scene units; w: "),
        "{vertex}"
    );
    assert!(fragment.contains("//   0: float count in GL_R32F "), "{fragment}");
    assert!(!vertex.contains("\n#") && !fragment.contains("\n#"), "{text}");
    assert!(answer_without_opengl(&place, "glsl density --stage fragment").ends_with(fragment));
    assert!(answer_without_opengl(&place, "glsl density --stage vertex").starts_with("#version 330 core\n"));
}

#[test]
fn a_shader_is_one_json_object() {
    let place = place_without_opengl();
    let json = |arguments: &str| -> serde_json::Value {
        serde_json::from_str(&answer_without_opengl(&place, arguments)).unwrap()
    };
    let shader = json("glsl sat-unpack --json");
    assert_eq!(shader["name"], "sat-unpack");
    assert_eq!(shader["samplers"][0]["name"], "tiles");
    assert_eq!(shader["samplers"][0]["type"], "usampler2DArray");
    assert_eq!(shader["samplers"][0]["stages"], serde_json::json!(["fragment"]));
    assert_eq!(shader["targets"][0]["format"], "GL_R32UI");
    assert_eq!(shader["targets"][0]["location"], 0);
    for stage in ["vertex", "fragment"] {
        assert!(shader[stage].as_str().unwrap().starts_with("#version 330 core\n"), "{stage}");
    }
    let list = json("glsl --list --json");
    let listed: Vec<_> =
        list["shaders"].as_array().unwrap().iter().map(|shader| shader["name"].as_str().unwrap()).collect();
    assert_eq!(listed, names(&answer_without_opengl(&place, "glsl --list")));
}

#[test]
fn files_are_written_one_or_all_of_a_variant() {
    let place = place_without_opengl();
    let printed = answer_without_opengl(&place, "glsl radius-search/inner --stage fragment");
    answer_without_opengl(&place, "glsl radius-search/inner --stage fragment -o inner.frag");
    assert_eq!(String::from_utf8(place.bytes("inner.frag")).unwrap(), printed);

    let written = answer_without_opengl(&place, "glsl radius-search/inner -o two");
    assert_eq!(written, "two/radius-search-inner.vert\ntwo/radius-search-inner.frag\n");
    assert_eq!(place.bytes("two/radius-search-inner.frag"), place.bytes("inner.frag"));

    let shaders = names(&answer_without_opengl(&place, "glsl --list")).len();
    let written = answer_without_opengl(&place, "glsl -o all");
    assert_eq!(written.lines().count(), 2 * shaders + 1);
    assert_eq!(place.bytes("all/radius-search-inner.frag"), place.bytes("inner.frag"));
    let tables: serde_json::Value = serde_json::from_slice(&place.bytes("all/shaders.json")).unwrap();
    assert_eq!(tables["shaders"].as_array().unwrap().len(), shaders);

    let sources: Vec<_> = written.lines().filter(|name| !name.contains("shaders.json")).collect();
    let checked =
        Tool::new("glslangValidator").args(&sources).current_dir(place.folder.path()).output().unwrap();
    assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stdout));
}

#[test]
fn a_name_that_is_not_there_brings_those_like_it() {
    let place = Workplace::new();
    place.refuses(
        "glsl radius-serch/inner",
        &["radius-serch/inner: there is no", "radius-search/inner", "help: "],
    );
    place.refuses("glsl radius-search", &["radius-search/dense", "radius-search/edge", "help: "]);
    place.refuses(
        "glsl mipmap-sum",
        &["mipmap-sum: there is no", "add --method naive-mipmap or --method pyramid"],
    );
    place.refuses("glsl xyzzy", &["xyzzy: there is no such shader\n", "varikernel glsl --list"]);
    place.refuses("glsl xyzzy -o folder", &["xyzzy: there is no such shader\n"]);
    place.refuses("glsl density -r 0", &["--max-radius 0 is not possible"]);
    place.run("glsl").code(2);
    place.run("glsl density --list").code(2);
}
