//! glTF files made by hand, and what becomes of them.

mod accessors;
mod cases;
mod container;
mod errors;
mod lights;
mod materials;
mod nodes;
mod skins;
mod textures;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use varikernel::Result;
use varikernel::glam::Vec3;
use varikernel::scene::{Material, Scene, Triangle, Vertex};

use crate::{BARE, load_with};

const U8: u32 = 5121;
const U16: u32 = 5123;
const F32: u32 = 5126;

/// A glTF file in the making: its JSON without buffers, and the bytes of buffer 0.
struct Made {
    json: Value,
    bytes: Vec<u8>,
}

impl Made {
    /// A scene of one node with one mesh, whose primitives are to be given.
    fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": []}],
            "bufferViews": [],
            "accessors": [],
        });
        Self { json, bytes: Vec::new() }
    }

    /// A square from (-1, -1, 0) to (1, 1, 0) that looks along z: positions in accessor 0, indices in
    /// accessor 1.
    fn square() -> Self {
        let mut made = Self::new();
        let corners = [-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0];
        let positions = made.floats("VEC3", &corners);
        let indices = made.shorts(&[0, 1, 2, 0, 2, 3]);
        made.json["meshes"][0]["primitives"] =
            json!([{"attributes": {"POSITION": positions}, "indices": indices}]);
        made
    }

    /// The first primitive.
    fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// Adds a material, which the first primitive then has.
    fn material(&mut self, material: &Value) {
        self.json["materials"] = json!([material]);
        self.primitive()["material"] = json!(0);
    }

    /// Adds bytes, and a view of them.
    fn view(&mut self, bytes: &[u8]) -> usize {
        // Numbers stand at multiples of their size.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend(bytes);
        push(&mut self.json["bufferViews"], view)
    }

    /// Adds an accessor of `count` items.
    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessor = json!({"bufferView": view, "componentType": component, "count": count, "type": kind});
        push(&mut self.json["accessors"], accessor)
    }

    /// Adds an accessor of single-precision numbers.
    fn floats(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.accessor(kind, F32, numbers.len() / width(kind), &bytes)
    }

    /// Adds an accessor of indices.
    fn shorts(&mut self, numbers: &[u16]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.accessor("SCALAR", U16, numbers.len(), &bytes)
    }

    /// The file, with its buffer in it.
    fn text(&self) -> String {
        let mut json = self.json.clone();
        if !self.bytes.is_empty() {
            let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&self.bytes));
            json["buffers"] = json!([{"uri": uri, "byteLength": self.bytes.len()}]);
        }
        json.to_string()
    }

    fn load(&self) -> Result<Scene> {
        self.load_with(&[])
    }

    /// In a scene with other files beside the mesh.
    fn load_with(&self, others: &[(&str, &[u8])]) -> Result<Scene> {
        load(self.text().as_bytes(), "a.gltf", others)
    }

    #[track_caller]
    fn refuses(&self, words: &[&str]) {
        refuses(self.text().as_bytes(), "a.gltf", words);
    }
}

/// A scene whose surface `thing` is a mesh.
fn load(content: &[u8], name: &str, others: &[(&str, &[u8])]) -> Result<Scene> {
    let text = format!("{BARE}\n[surfaces.thing]\nmesh = {{ file = \"{name}\" }}\n");
    let files: Vec<_> = others.iter().copied().chain([(name, content)]).collect();
    load_with(&text, &files)
}

#[track_caller]
fn refuses(content: &[u8], name: &str, words: &[&str]) {
    let message = load(content, name, &[]).unwrap_err().to_string();
    for word in words.iter().chain(&["line ", name, "\nhelp: "]) {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

fn push(list: &mut Value, item: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(item);
    list.len() - 1
}

/// Numbers of an item.
fn width(kind: &str) -> usize {
    match kind {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => panic!("{kind}"),
    }
}

/// The triangles of `thing`.
fn things(scene: &Scene) -> Vec<Triangle> {
    let geometry = scene.geometry();
    let is_thing = |triangle: &&Triangle| geometry.surfaces[triangle.surface as usize] == "thing";
    geometry.triangles.iter().filter(is_thing).copied().collect()
}

/// The corners of the triangles of `thing`.
fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    things(scene).iter().map(|triangle| scene.geometry().corners(triangle)).collect()
}

/// The vertices of the triangles of `thing`, one after another.
fn vertices(scene: &Scene) -> Vec<Vertex> {
    let all = &scene.geometry().vertices;
    things(scene).iter().flat_map(|triangle| triangle.vertices).map(|index| all[index as usize]).collect()
}

/// The material of the first triangle of `thing`.
fn material(scene: &Scene) -> &Material {
    &scene.materials()[things(scene)[0].material as usize]
}

/// The square's triangles, each point moved.
fn moved(by: impl Fn(Vec3) -> Vec3) -> Vec<[Vec3; 3]> {
    let [a, b, c, d] =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| by(Vec3::new(x, y, 0.0)));
    vec![[a, b, c], [a, c, d]]
}
