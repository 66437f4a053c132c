//! The faces of an OBJ file: what their corners name, and the parts that they make.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::lines::{Line, shown};
use super::polygon::Cutter;
use crate::scene::mesh::{Part, Problem};

/// What a corner names: positions, texture coordinates and normals count from 1, and 0 is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct Corner {
    position: u32,
    coordinate: u32,
    normal: u32,
}

struct Face {
    line: usize,
    /// The material's use, as the caller counts them.
    material: Option<u32>,
    /// Where its corners end, which begin where those of the face before end.
    end: usize,
}

/// All numbers and faces of a file.
#[derive(Default)]
pub(super) struct Faces {
    pub(super) positions: Vec<Vec3>,
    pub(super) coordinates: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    corners: Vec<Corner>,
    list: Vec<Face>,
}

impl Corner {
    /// Reads `4`, `4/7`, `4//5` or `4/7/5`; numbers below zero count back from the last of `counts` so far.
    fn read(word: &str, counts: [usize; 3]) -> Result<Self, String> {
        let mut parts = word.split('/');
        let mut index = |count: usize| {
            let text = parts.next().unwrap_or_default();
            if text.is_empty() {
                return Ok(0);
            }
            let number: i64 = text.parse().map_err(|_| "is no corner of a face".to_owned())?;
            let count = i64::try_from(count).map_err(|error| error.to_string())?;
            let number = if number < 0 { count + 1 + number } else { number };
            let index = u32::try_from(number).ok().filter(|&index| index > 0);
            index.ok_or_else(|| "names something before the first".to_owned())
        };
        let told = |problem: String| format!("`{}` {problem}", shown(word));
        let [positions, coordinates, normals] = counts;
        let corner = Self {
            position: index(positions).map_err(told)?,
            coordinate: index(coordinates).map_err(told)?,
            normal: index(normals).map_err(told)?,
        };
        if corner.position == 0 || parts.next().is_some() {
            return Err(told("is no corner of a face".to_owned()));
        }
        Ok(corner)
    }
}

impl Faces {
    /// Adds a face. Says whether it has corners enough for an area.
    ///
    /// # Errors
    /// If a corner can't be read.
    pub(super) fn add(&mut self, line: &Line<'_>, material: Option<u32>) -> Result<bool, Problem> {
        let counts = [self.positions.len(), self.coordinates.len(), self.normals.len()];
        let first = self.corners.len();
        for word in line.words() {
            let corner = Corner::read(word, counts).map_err(|problem| {
                let remedy = "give corners as VERTEX, VERTEX/TEXTURE, VERTEX//NORMAL or \
                              VERTEX/TEXTURE/NORMAL, counted from 1";
                (format!("{}: {problem}", line.place()), remedy)
            })?;
            self.corners.push(corner);
        }
        if self.corners.len() < first + 3 {
            self.corners.truncate(first);
            return Ok(false);
        }
        self.list.push(Face { line: line.number, material, end: self.corners.len() });
        Ok(true)
    }

    /// The uses of materials that faces have, and the first line of a face without one.
    pub(super) fn uses(&self) -> (Vec<u32>, Option<usize>) {
        let mut uses: Vec<_> = self.list.iter().filter_map(|face| face.material).collect();
        uses.sort_unstable();
        uses.dedup();
        (uses, self.list.iter().find(|face| face.material.is_none()).map(|face| face.line))
    }

    /// The faces as parts, in the order of the file: one for all faces in a row that are alike. `material`
    /// gives the index of a use's material.
    ///
    /// # Errors
    /// If a face names a vertex that is not in the file, or can't be cut.
    pub(super) fn parts(&self, material: impl Fn(u32) -> Option<u32>) -> Result<Vec<Part>, Problem> {
        let mut parts: Vec<Part> = Vec::new();
        let mut last = None;
        let mut vertices: HashMap<Corner, u32> = HashMap::new();
        let mut cutter = Cutter::default();
        let (mut places, mut indices) = (Vec::new(), Vec::new());
        let mut begin = 0;
        for face in &self.list {
            let corners = &self.corners[begin..face.end];
            begin = face.end;
            let known = |index: u32, count: usize| (1..=count).contains(&(index as usize));
            if let Some(corner) = corners.iter().find(|corner| !known(corner.position, self.positions.len()))
            {
                let (vertex, count) = (corner.position, self.positions.len());
                let problem =
                    format!("line {}: a face names vertex {vertex}, and there are {count}", face.line);
                return Err((problem, "export the mesh again as OBJ"));
            }
            let has_coordinates =
                corners.iter().all(|corner| known(corner.coordinate, self.coordinates.len()));
            let has_normals = corners.iter().all(|corner| known(corner.normal, self.normals.len()));

            let kind = (face.material, has_coordinates, has_normals);
            if last != Some(kind) {
                last = Some(kind);
                vertices = HashMap::new();
                parts.push(Part { material: face.material.and_then(&material), ..Part::default() });
            }
            let Some(part) = parts.last_mut() else { continue };
            places.clear();
            indices.clear();
            for corner in corners {
                let corner = Corner {
                    position: corner.position,
                    coordinate: if has_coordinates { corner.coordinate } else { 0 },
                    normal: if has_normals { corner.normal } else { 0 },
                };
                let place = self.positions[corner.position as usize - 1];
                places.push(place);
                indices.push(*vertices.entry(corner).or_insert_with(|| self.push(corner, part)));
            }
            let cut =
                cutter.cut(&places, |triangle| part.triangles.push(triangle.map(|corner| indices[corner])));
            cut.map_err(|problem| {
                (format!("line {}: {problem}", face.line), "cut the face into triangles first")
            })?;
        }
        Ok(parts)
    }

    /// Adds a corner to a part's vertices.
    fn push(&self, corner: Corner, part: &mut Part) -> u32 {
        let index = u32::try_from(part.positions.len()).expect("fewer than 2^32 vertices fit into memory");
        part.positions.push(self.positions[corner.position as usize - 1]);
        if corner.coordinate > 0 {
            let at = self.coordinates[corner.coordinate as usize - 1];
            part.coordinates.iter_mut().for_each(|coordinates| coordinates.push(at));
        }
        if corner.normal > 0 {
            part.normals.push(self.normals[corner.normal as usize - 1]);
        }
        index
    }
}
