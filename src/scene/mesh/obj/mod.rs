//! OBJ with its MTL files (<https://paulbourke.net/dataformats/obj/>): statement by statement to parts of
//! faces that have one material each.
//!
//! It is read here because the known crates refuse much of what exporters write, panic at some of it, and
//! report no line numbers.

mod faces;
mod lines;
mod materials;
mod mtl;
mod pictures;
mod polygon;

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use self::faces::Faces;
use self::lines::{Line, Name, lines};
use self::materials::{Found, Libraries, Use};
use super::{Mesh, Problem};
use crate::scene::source::{self, Files};

/// Things left out that are listed; the others are counted.
const MAX_TOLD: usize = 12;

/// Reads an OBJ file named `name`, whose MTL files count from its folder. If no materials are needed, as the
/// surface has one, all faces come without.
pub(super) fn read(
    content: &[u8],
    files: &Files,
    name: &str,
    needs_materials: bool,
) -> Result<Mesh, Problem> {
    if source::is_utf16(content) {
        return Err(("it is text in UTF-16".to_owned(), "save it as UTF-8"));
    }
    let mut statements = Statements::default();
    let mut libraries = Libraries::new(files, name);
    for line in lines(content) {
        if line.keyword() == b"mtllib" {
            libraries.add(&line)?;
        } else {
            statements.add(&line)?;
        }
    }

    let (faces, uses) = (&statements.faces, &statements.uses);
    let Found { materials, of_use, left_out } = if needs_materials {
        let (indices, without) = faces.uses();
        if let Some(line) = without {
            let problem = format!("line {line}: the face has no material (usemtl), nor has the surface");
            return Err((problem, "give the surface a material"));
        }
        let wanted: Vec<_> = indices.into_iter().map(|index| (index, &uses[index as usize])).collect();
        libraries.materials(&wanted)?
    } else {
        Found { left_out: libraries.missing(), ..Found::default() }
    };
    let parts = faces.parts(|index| of_use.get(&index).copied())?;

    let left_out = statements.left_out().chain(left_out).collect();
    let mut mesh = Mesh { parts, materials, left_out, ..Mesh::default() };
    pictures::without_coordinates(&mut mesh);
    let told = &mut mesh.left_out;
    let more = told.len().saturating_sub(MAX_TOLD);
    told.truncate(MAX_TOLD);
    if more > 0 {
        told.push(format!("{more} more"));
    }
    Ok(mesh)
}

/// The state after the statements so far.
#[derive(Default)]
struct Statements {
    faces: Faces,
    /// The materials that are named, each once.
    uses: Vec<Use>,
    places: HashMap<Name, u32>,
    /// Index of the use that holds for the faces that come.
    current: Option<u32>,
    /// What is left out, and where it is first met.
    notes: Vec<(&'static str, usize)>,
    /// The first unknown statement.
    unknown: Option<String>,
}

impl Statements {
    fn add(&mut self, line: &Line<'_>) -> Result<(), Problem> {
        match line.keyword() {
            b"v" => self.position(line)?,
            b"vt" => self.coordinate(line),
            b"vn" => {
                let normal = triple(line)?;
                self.faces.normals.push(normal);
            }
            b"f" | b"fo" => {
                if !self.faces.add(line, self.current)? {
                    self.note("faces of fewer than three corners", line);
                }
            }
            b"usemtl" => self.select(line),
            // Points, lines, groups, smoothing and how to display things: nothing that light meets.
            b"p" | b"l" | b"g" | b"o" | b"s" | b"mg" | b"bevel" | b"c_interp" | b"d_interp" | b"lod"
            | b"shadow_obj" | b"trace_obj" => {}
            b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" | b"parm"
            | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" | b"ctech" | b"stech" | b"bsp"
            | b"bzp" | b"cdc" | b"cdp" | b"res" => self.note("curves and free-form surfaces", line),
            b"maplib" | b"usemap" => self.note("texture maps by usemap", line),
            _ => {
                self.unknown.get_or_insert_with(|| format!("unknown statements, first {}", line.place()));
            }
        }
        Ok(())
    }

    /// A position, with or without a weight or a colour. The weight is for rational curves, not for faces;
    /// colours have no standard.
    fn position(&mut self, line: &Line<'_>) -> Result<(), Problem> {
        let position = triple(line)?;
        self.faces.positions.push(position);
        let mut more = line.words().skip(3);
        match (more.next(), more.next(), more.next()) {
            (Some(weight), None, _) if weight.parse() != Ok(1.0_f32) => {
                self.note("weights of vertices", line);
            }
            (_, Some(_), None) => self.note("numbers after positions", line),
            (_, _, Some(_)) => self.note("vertex colours", line),
            _ => {}
        }
        Ok(())
    }

    /// Texture coordinates: the second one goes up in OBJ, and down in a scene.
    fn coordinate(&mut self, line: &Line<'_>) {
        let place = match line.numbers() {
            Ok(([u, v], count)) if count > 0 => Vec2::new(u, 1.0 - v),
            _ => {
                self.note("texture coordinates that are not finite numbers", line);
                Vec2::ZERO
            }
        };
        self.faces.coordinates.push(place);
    }

    /// The material for the faces that come. Once there is one it can't be turned off, so that `usemtl`
    /// without a name changes nothing then.
    fn select(&mut self, line: &Line<'_>) {
        let name = line.name();
        if name.bare.is_empty() && self.current.is_some() {
            return;
        }
        let next = u32::try_from(self.uses.len()).expect("fewer than 2^32 materials fit into memory");
        let index = *self.places.entry(name.clone()).or_insert(next);
        if index == next {
            self.uses.push(Use { name, line: line.number });
        }
        self.current = Some(index);
    }

    fn note(&mut self, what: &'static str, line: &Line<'_>) {
        if !self.notes.iter().any(|(known, _)| *known == what) {
            self.notes.push((what, line.number));
        }
    }

    /// All that is left out.
    fn left_out(&self) -> impl Iterator<Item = String> {
        let notes = self.notes.iter().map(|(what, line)| format!("{what} (line {line})"));
        notes.chain(self.unknown.clone())
    }
}

/// Three numbers: a position or a normal.
fn triple(line: &Line<'_>) -> Result<Vec3, Problem> {
    match line.numbers() {
        Ok((numbers, 3)) => Ok(Vec3::from_array(numbers)),
        Ok((_, count)) => Err((format!("{}: it has {count} numbers of 3", line.place()), "give x, y and z")),
        Err(problem) => {
            Err((format!("{}: {problem}", line.place()), "give finite numbers, with a point before decimals"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const FILES: Files = Files::Shipped(&[
        (
            "a.mtl",
            "newmtl red\nKd 1 0 0\nnewmtl red\nnewmtl bark\nmap_Kd bark.png\nd 0.5\nnewmtl bad\nillum x\n",
        ),
        ("sub/a.mtl", "newmtl red\nKd 1 0 0\n"),
    ]);

    fn left_out(name: &str, text: &str, needs_materials: bool) -> Vec<String> {
        read(text.as_bytes(), &FILES, name, needs_materials).unwrap().left_out
    }

    #[test]
    fn what_is_left_out_is_said_with_its_line() {
        for (line, expected) in [
            ("v 0 0 0 1 0 0", "vertex colours (line 4)"),
            ("v 0 0 0 2", "weights of vertices (line 4)"),
            ("v 0 0 0 1 2", "numbers after positions (line 4)"),
            ("curv 0 1 1 2", "curves and free-form surfaces (line 4)"),
            ("usemap a", "texture maps by usemap (line 4)"),
            ("f 1 2", "faces of fewer than three corners (line 4)"),
            ("vt nan 0", "texture coordinates that are not finite numbers (line 4)"),
            ("foo 1\nbar 2", "unknown statements, first line 4, `foo 1`"),
            ("mtllib none.mtl", "materials of none.mtl (line 4): there is no such file in the program"),
        ] {
            assert_eq!(left_out("a.obj", &format!("{CORNERS}{line}\nf 1 2 3\n"), false), [expected]);
        }
        let usual = format!("{CORNERS}v 0 0 0 1\no a\ng b\ns 1\nl 1 2\np 1\nf 1 2 3\n");
        assert_eq!(left_out("a.obj", &usual, false), Vec::<String>::new());
    }

    #[test]
    fn what_is_left_out_of_materials_names_their_file() {
        let text = format!("mtllib a.mtl none.mtl\n{CORNERS}usemtl bark\nf 1 2 3\n");
        assert_eq!(
            left_out("a.obj", &text, true),
            [
                "a second material \"red\" of a.mtl (line 3)",
                "material \"bark\" of a.mtl: transparency (d), texture \"bark.png\" (map_Kd): there is no \
                 such file in the program, no Kd, 0.8 is taken",
                "material \"bad\" of a.mtl, which no face has, line 8, `illum x`: `x` is not a finite number",
                "materials of none.mtl (line 1): there is no such file in the program",
            ]
        );
        let text = format!("mtllib a.mtl\n{CORNERS}usemtl\nf 1 2 3\n");
        assert_eq!(
            left_out("sub/a.obj", &text, true),
            ["the material of a usemtl without a name (line 5), a grey is taken"]
        );
    }

    #[test]
    fn coordinates_go_down_and_stay_with_their_corners() {
        let text =
            format!("{CORNERS}vt 0.25 0.75\nvt 1 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1\nf 1/2 2/2 3/2\nf 1 2 3\n");
        let parts = read(text.as_bytes(), &FILES, "a.obj", false).unwrap().parts;
        let (first, second) = (Vec2::new(0.25, 0.25), Vec2::new(1.0, 1.0));
        let found: Vec<_> = parts.iter().map(|part| part.coordinates[0].as_slice()).collect();
        assert_eq!(found, [&[first, second, first][..], &[second; 3], &[]]);
        assert!(parts.iter().all(|part| part.coordinates[0] == part.coordinates[1]));
        assert_eq!(parts.iter().map(|part| part.normals.len()).collect::<Vec<_>>(), [3, 0, 0]);
    }
}
