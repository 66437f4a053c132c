//! GLB, buffers, and what else wraps a mesh.

use serde_json::json;

use super::{Made, corners, load, moved, refuses};

/// A chunk of a GLB, as long as it is.
fn chunk(kind: [u8; 4], content: &[u8]) -> Vec<u8> {
    [&u32::try_from(content.len()).unwrap().to_le_bytes()[..], &kind, content].concat()
}

fn glb(chunks: &[Vec<u8>]) -> Vec<u8> {
    let chunks = chunks.concat();
    let length = u32::try_from(12 + chunks.len()).unwrap();
    [b"glTF", &2_u32.to_le_bytes()[..], &length.to_le_bytes(), &chunks].concat()
}

/// The square, with its numbers in the BIN part.
fn square() -> (Vec<u8>, Vec<u8>) {
    let mut made = Made::square();
    let bytes = std::mem::take(&mut made.bytes);
    made.json["buffers"] = json!([{"byteLength": bytes.len()}]);
    (chunk(*b"JSON", made.text().as_bytes()), chunk(*b"BIN\0", &bytes))
}

#[test]
fn a_glb_brings_its_bytes() {
    let (json, bin) = square();
    let plain = glb(&[json.clone(), bin.clone()]);
    let with_others = glb(&[json.clone(), chunk(*b"XTRA", b"1234"), bin.clone(), chunk(*b"MORE", b"")]);
    let with_a_tail = [&plain[..], b"after the end"].concat();
    for content in [plain, with_others, with_a_tail] {
        assert_eq!(corners(&load(&content, "a.glb", &[]).unwrap()), moved(|at| at));
    }
}

#[test]
fn a_damaged_glb_is_refused_at_every_length() {
    let (json, bin) = square();
    let whole = glb(&[json.clone(), bin.clone()]);
    for length in 1..whole.len() {
        refuses(
            &whole[..length],
            "a.glb",
            if length < 4 { &["not a glTF file"] } else { &["GLB: ", "are left"] },
        );
    }
    refuses(&glb(std::slice::from_ref(&json)), "a.glb", &["buffers[0]", "a BIN part"]);
    refuses(&glb(&[bin.clone(), json.clone()]), "a.glb", &["its first chunk is not JSON"]);
    let mut older = whole.clone();
    older[4] = 1;
    refuses(&older, "a.glb", &["version 1", "glTF 2.0"]);
    for (at, told) in [(8, 3_u32), (8, u32::MAX), (12, u32::MAX), (12 + json.len(), u32::MAX)] {
        let mut wrong = whole.clone();
        wrong[at..at + 4].copy_from_slice(&told.to_le_bytes());
        refuses(&wrong, "a.glb", &["GLB: "]);
    }
}

#[test]
fn buffers_come_from_files_and_data_of_both_kinds() {
    let mut made = Made::square();
    let bytes = std::mem::take(&mut made.bytes);
    let percent = bytes.iter().fold(String::new(), |text, byte| format!("{text}%{byte:02x}"));
    for uri in [format!("data:,{percent}"), "the%20bytes.bin".to_owned()] {
        made.json["buffers"] = json!([{"uri": uri, "byteLength": bytes.len()}]);
        let scene = made.load_with(&[("the bytes.bin", &bytes)]).unwrap();
        assert_eq!(corners(&scene), moved(|at| at));
    }
    // A buffer that nothing drawn needs may be missing.
    made.json["buffers"].as_array_mut().unwrap().push(json!({"uri": "animations.bin", "byteLength": 7}));
    assert!(made.load_with(&[("the bytes.bin", &bytes)]).is_ok());
    made.json["buffers"][0]["uri"] = json!("data:text/plain;base64,?");
    made.refuses(&["buffers[0]: its buffer a data URI: the data URI is damaged"]);
    made.json["buffers"][0]["uri"] = json!("none.bin");
    made.refuses(&["buffers[0]: its buffer none.bin: there is no such file"]);
}

#[test]
fn a_byte_order_mark_is_passed_over() {
    let content = ["\u{feff}", &Made::square().text()].concat();
    assert_eq!(corners(&load(content.as_bytes(), "a.gltf", &[]).unwrap()), moved(|at| at));
}
