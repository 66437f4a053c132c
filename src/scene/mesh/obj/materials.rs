//! From the names that an OBJ file uses to materials: the MTL files that it names, and where each material is
//! found.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::lines::{Line, Name, shown};
use super::mtl::{self, Entry};
use super::pictures::Pictures;
use crate::scene::Material;
use crate::scene::mesh::Problem;
use crate::scene::source::{self, Files};

/// The most names of MTL files that are tried: a limit for hostile files.
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
        if let Some(problem) = self.tried.get(&path) {
            return problem.clone().map_or(Ok(()), Err);
        }
        let content = self.files.read(&path).and_then(|content| {
            let wide = source::is_utf16(&content);
            if wide { Err("it is text in UTF-16; save it as UTF-8".to_owned()) } else { Ok(content) }
        });
        let problem = content.map(|content| self.found.push((path.clone(), content))).err();
        self.tried.insert(path, problem.clone());
        problem.map_or(Ok(()), Err)
    }

    /// What can't be read, where no material is needed.
    pub(super) fn missing(self) -> Vec<String> {
        self.missing.into_iter().map(|missing| format!("materials of {missing}")).collect()
    }

    /// The materials that faces use, each with its index. A `usemtl` without a name is grey.
    ///
    /// # Errors
    /// If one is in no file, or can't be used as it is.
    pub(super) fn materials(self, wanted: &[(u32, &Use)]) -> Result<Found, Problem> {
        let files: Vec<_> = self.found.iter().map(|(path, content)| (path, mtl::entries(content))).collect();
        let mut found = Found::default();
        let known = Known::new(&files, &mut found.left_out);
        let mut users: BTreeMap<Place, Vec<u32>> = BTreeMap::new();
        let mut nameless = Vec::new();
        let mut pictures = Pictures::new(self.files);
        for &(index, one) in wanted {
            if one.name.bare.is_empty() {
                nameless.push(index);
                let line = one.line;
                let note = format!("the material of a usemtl without a name (line {line}), a grey is taken");
                found.left_out.push(note);
            } else {
                let place = known.find(&one.name).ok_or_else(|| self.unknown(one, &files))?;
                users.entry(place).or_default().push(index);
            }
        }
        for (file, (path, entries)) in files.iter().enumerate() {
            for (number, entry) in entries.iter().enumerate() {
                let name = &entry.name.whole;
                let of = format!("material \"{}\" of {path}", shown(name));
                match (entry.material(name.clone()), users.get(&(file, number))) {
                    (Ok((mut material, mut notes)), Some(users)) => {
                        pictures.hang(path, entry, &mut material, &mut notes);
                        found.take(material, users);
                        if !notes.is_empty() {
                            found.left_out.push(format!("{of}: {}", notes.join(", ")));
                        }
                    }
                    (Err((problem, remedy)), Some(_)) => return Err((format!("{of}, {problem}"), remedy)),
                    (Err((problem, _)), None) => {
                        found.left_out.push(format!("{of}, which no face has, {problem}"));
                    }
                    (Ok(_), None) => {}
                }
            }
        }
        if !nameless.is_empty() {
            found.take(mtl::grey("grey".to_owned()), &nameless);
        }
        found.left_out.extend(self.missing());
        Ok(found)
    }

    /// A used material that is nowhere.
    fn unknown(&self, wanted: &Use, files: &[(&String, Vec<Entry<'_>>)]) -> Problem {
        let problem = match (&self.found[..], &self.missing[..]) {
            ([], []) => "no MTL file is named (mtllib)",
            ([], _) => "its MTL file can't be read",
            _ => "no MTL file has this material",
        };
        let place = format!("line {}, `usemtl {}`: ", wanted.line, shown(&wanted.name.whole));
        let mut told = vec![place + problem];
        told.extend(self.missing.iter().take(MAX_LISTED).cloned());
        let entries = files.iter().flat_map(|(_, entries)| entries);
        let known: Vec<_> = entries.map(|entry| shown(&entry.name.whole)).take(MAX_LISTED).collect();
        if !known.is_empty() {
            told.push(format!("there are: {}", known.join(", ")));
        }
        (told.join("; "), REMEDY)
    }
}

/// A file's index and that of a material in it.
type Place = (usize, usize);

/// Where each name is found first, by the whole name and by what stands before a `#`.
struct Known<'a> {
    by_whole: HashMap<&'a str, Place>,
    by_bare: HashMap<&'a str, Place>,
}

impl<'a> Known<'a> {
    /// Says which materials come a second time in one file.
    fn new(files: &'a [(&String, Vec<Entry<'_>>)], left_out: &mut Vec<String>) -> Self {
        let mut known = Self { by_whole: HashMap::new(), by_bare: HashMap::new() };
        for (file, (path, entries)) in files.iter().enumerate() {
            for (number, entry) in entries.iter().enumerate() {
                let (here, name) = ((file, number), &entry.name);
                let first = *known.by_whole.entry(&name.whole).or_insert(here);
                known.by_bare.entry(&name.bare).or_insert(here);
                if first.0 == file && first != here {
                    let (name, line) = (shown(&name.whole), entry.line);
                    left_out.push(format!("a second material \"{name}\" of {path} (line {line})"));
                }
            }
        }
        known
    }

    fn find(&self, name: &Name) -> Option<Place> {
        let [whole, bare] = [name.whole.as_str(), name.bare.as_str()];
        let in_whole = self.by_whole.get(whole).or_else(|| self.by_whole.get(bare));
        in_whole.or_else(|| self.by_bare.get(whole)).or_else(|| self.by_bare.get(bare)).copied()
    }
}

impl Found {
    fn take(&mut self, material: Material, users: &[u32]) {
        let index = u32::try_from(self.materials.len()).expect("fewer than 2^32 materials fit into memory");
        self.materials.push(material);
        self.of_use.extend(users.iter().map(|&user| (user, index)));
    }
}
