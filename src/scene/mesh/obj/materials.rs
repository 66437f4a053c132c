//! From the names that an OBJ file uses to materials: the MTL files that it names, and where each material is found.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::lines::{Line, Name, shown};
use super::mtl::{self, Entry};
use crate::scene::Material;
use crate::scene::mesh::Problem;
use crate::scene::source::{self, Files};

/// Names of MTL files that are tried; more are no mesh but an attack on the disk.
const MAX_LIBRARIES: usize = 1000;
/// Names of materials that an error lists.
const MAX_LISTED: usize = 8;

const REMEDY: &str = "put the MTL file beside the OBJ file, or give the surface a material";

/// The MTL files of a mesh.
pub(super) struct Libraries<'a> {
    files: &'a Files,
    /// The OBJ file, beside which they lie.
    obj: &'a str,
    /// Lines that were read.
    lines: HashSet<Name>,
    /// Paths that were tried, and what is wrong with those that could not be read.
    tried: HashMap<String, Option<String>>,
    /// Paths and contents, in the order in which they are searched.
    found: Vec<(String, Vec<u8>)>,
    /// Those that could not be read: which, in which line, and why.
    missing: Vec<String>,
}

/// A material that faces use.
#[derive(Clone)]
pub(super) struct Use {
    /// Empty where the file leaves the name out.
    pub(super) name: Name,
    /// The first line that names it.
    pub(super) line: usize,
}

/// Materials of a mesh, as far as its faces use them.
#[derive(Default)]
pub(super) struct Found {
    /// In the order of the MTL files.
    pub(super) materials: Vec<Material>,
    /// The material of each use, by its index.
    pub(super) of_use: HashMap<u32, u32>,
    /// What of the MTL files is left out.
    pub(super) left_out: Vec<String>,
}

impl<'a> Libraries<'a> {
    /// None, for an OBJ file at `obj`.
    pub(super) fn new(files: &'a Files, obj: &'a str) -> Self {
        Self {
            files,
            obj,
            lines: HashSet::new(),
            tried: HashMap::new(),
            found: Vec::new(),
            missing: Vec::new(),
        }
    }

    /// Reads what a line names: one file, whose name may have blanks, or else several.
    ///
    /// # Errors
    /// If far too many are named.
    pub(super) fn add(&mut self, line: &Line<'_>) -> Result<(), Problem> {
        let name = line.name();
        if self.tried.len() > MAX_LIBRARIES {
            let problem = format!("{}: more than {MAX_LIBRARIES} MTL files are named", line.place());
            return Err((problem, "put the materials into one MTL file"));
        }
        if name.bare.is_empty() || !self.lines.insert(name.clone()) || self.open(&name.whole).is_ok() {
            return Ok(());
        }
        let Err(problem) = self.open(&name.bare) else { return Ok(()) };
        let mut missing = Vec::new();
        for word in name.bare.split_ascii_whitespace().take(MAX_LIBRARIES) {
            if let Err(problem) = self.open(word) {
                missing.push((word.to_owned(), problem));
            }
        }
        if missing.len() == name.bare.split_ascii_whitespace().count() {
            missing = vec![(name.bare, problem)];
        }
        let told = missing
            .iter()
            .map(|(name, problem)| format!("{} (line {}): {problem}", shown(name), line.number));
        self.missing.extend(told);
        Ok(())
    }

    /// Reads a file, if that has not been done.
    fn open(&mut self, name: &str) -> Result<(), String> {
        let path = source::beside(self.obj, name)?;
        let problem = match self.tried.get(&path) {
            Some(problem) => problem.clone(),
            None => {
                let content = self.files.read(&path);
                let content = content.and_then(|content| match source::is_utf16(&content) {
                    true => Err("it is text in UTF-16; save it as UTF-8".to_owned()),
                    false => Ok(content),
                });
                let problem = content.map(|content| self.found.push((path.clone(), content))).err();
                self.tried.insert(path, problem.clone());
                problem
            }
        };
        problem.map_or(Ok(()), Err)
    }

    /// What can't be read, where no material is needed.
    pub(super) fn missing(self) -> Vec<String> {
        self.missing.into_iter().map(|missing| format!("materials of {missing}")).collect()
    }

    /// The materials of `uses`, each with its index. A `usemtl` without a name is grey.
    ///
    /// # Errors
    /// If one is in no file, or can't be used as it is.
    pub(super) fn materials(self, uses: &[(u32, &Use)]) -> Result<Found, Problem> {
        let read: Vec<Vec<Entry<'_>>> = self.found.iter().map(|(_, content)| mtl::entries(content)).collect();
        let mut places: [HashMap<&str, (usize, usize)>; 2] = Default::default();
        let mut left_out = Vec::new();
        for (file, entries) in read.iter().enumerate() {
            for (number, entry) in entries.iter().enumerate() {
                let first = *places[0].entry(&entry.name.whole).or_insert((file, number));
                places[1].entry(&entry.name.bare).or_insert((file, number));
                if first.0 == file && first.1 != number {
                    let name = shown(&entry.name.whole);
                    left_out.push(format!(
                        "a second material \"{name}\" of {} (line {})",
                        self.found[file].0, entry.line
                    ));
                }
            }
        }
        let find = |name: &Name| {
            let [whole, bare] = [&name.whole, &name.bare].map(String::as_str);
            let [by_whole, by_bare] = &places;
            by_whole
                .get(whole)
                .or_else(|| by_whole.get(bare))
                .or_else(|| by_bare.get(whole))
                .or_else(|| by_bare.get(bare))
        };

        let mut used: BTreeMap<(usize, usize), Vec<u32>> = BTreeMap::new();
        let mut nameless = None;
        for &(index, wanted) in uses {
            if wanted.name.bare.is_empty() {
                nameless = Some((index, wanted.line));
                continue;
            }
            let place = find(&wanted.name).ok_or_else(|| self.unknown(wanted, &read))?;
            used.entry(*place).or_default().push(index);
        }

        let mut found = Found { left_out, ..Found::default() };
        for (file, entries) in read.iter().enumerate() {
            for (number, entry) in entries.iter().enumerate() {
                let users = used.get(&(file, number));
                let name = &entry.name.whole;
                let of = format!("material \"{}\" of {}", shown(name), self.found[file].0);
                match (entry.material(name.clone()), users) {
                    (Ok((material, notes)), Some(users)) => {
                        found.take(material, users);
                        if !notes.is_empty() {
                            found.left_out.push(format!("{of}: {}", notes.join(", ")));
                        }
                    }
                    (Err((problem, remedy)), Some(_)) => return Err((format!("{of}, {problem}"), remedy)),
                    (Err((problem, _)), None) => {
                        found.left_out.push(format!("{of}, which no face has, {problem}"))
                    }
                    (Ok(_), None) => {}
                }
            }
        }
        if let Some((index, line)) = nameless {
            found
                .left_out
                .push(format!("the material of a usemtl without a name (line {line}), a grey is taken"));
            found.take(mtl::grey("grey".to_owned()), &[index]);
        }
        found.left_out.extend(self.missing());
        Ok(found)
    }

    /// A used material that is nowhere.
    fn unknown(&self, wanted: &Use, read: &[Vec<Entry<'_>>]) -> Problem {
        let mut problem = format!("line {}, `usemtl {}`: ", wanted.line, shown(&wanted.name.whole));
        problem += match (&self.found[..], &self.missing[..]) {
            ([], []) => "no MTL file is named (mtllib)",
            ([], _) => "its MTL file can't be read",
            _ => "no MTL file has this material",
        };
        for missing in self.missing.iter().take(MAX_LISTED) {
            problem += &format!("; {missing}");
        }
        let known: Vec<_> =
            read.iter().flatten().map(|entry| shown(&entry.name.whole)).take(MAX_LISTED).collect();
        if !known.is_empty() {
            problem += &format!("; there are: {}", known.join(", "));
        }
        (problem, REMEDY)
    }
}

impl Found {
    fn take(&mut self, material: Material, users: &[u32]) {
        let index = u32::try_from(self.materials.len()).expect("fewer than 2^32 materials fit into memory");
        self.materials.push(material);
        self.of_use.extend(users.iter().map(|&user| (user, index)));
    }
}
