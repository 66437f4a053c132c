//! The modules of a package, and where the paths in their sources lead.

use std::collections::BTreeMap;

use crate::tokens::{Token, tokens};
use crate::{files_below, text_of};

/// A path from the root of a package, without `crate`; `["gl", "pass", "Pass"]`.
pub(crate) type Place = Vec<String>;

/// A file of a package.
pub(crate) struct Module {
    /// From the root of the repository.
    pub(crate) file: String,
    pub(crate) tokens: Vec<Token>,
    /// What the file names inside of its own package, as written, but from the root of the package.
    pub(crate) names: Vec<Place>,
    /// What `use` makes known in the module itself, by the name there.
    pub(crate) imports: BTreeMap<String, Place>,
}

/// All modules of a package, by their paths.
pub(crate) struct Package(pub(crate) BTreeMap<Place, Module>);

impl Package {
    /// The package whose sources are in a folder.
    pub(crate) fn of(folder: &str) -> Self {
        let files = files_below(folder, &["rs"]);
        Self::read(folder, files.iter().map(|file| (file.to_str().unwrap().to_owned(), text_of(file))))
    }

    /// A package that is not on the disk, to plant faults in: names below its folder of sources, and texts.
    pub(crate) fn planted(files: &[(&str, &str)]) -> Self {
        Self::read("src", files.iter().map(|(name, text)| (format!("src/{name}"), (*text).to_owned())))
    }

    fn read(folder: &str, files: impl Iterator<Item = (String, String)>) -> Self {
        let mut modules: BTreeMap<Place, Module> = files
            .map(|(file, text)| {
                let inside = file.strip_prefix(folder).unwrap().trim_start_matches('/');
                let mut path: Place = inside.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
                if path.last().is_some_and(|name| ["lib", "main", "mod"].contains(&name.as_str())) {
                    path.pop();
                }
                let tokens = tokens(&text);
                (path, Module { file, tokens, names: Vec::new(), imports: BTreeMap::new() })
            })
            .collect();
        let paths: Vec<Place> = modules.keys().cloned().collect();
        for (path, module) in &mut modules {
            for Mention { mut place, known_as } in Reader::of(path, &module.tokens).mentions {
                // A name without `crate`, `self` or `super` before it is a module's own, or another
                // package's.
                if place.is_from_here {
                    let child = [path.as_slice(), &place.segments[..1]].concat();
                    if !paths.contains(&child) {
                        continue;
                    }
                    place.segments = [path.as_slice(), &place.segments].concat();
                }
                if let Some(name) = known_as {
                    module.imports.insert(name, place.segments.clone());
                }
                module.names.push(place.segments);
            }
        }
        Self(modules)
    }

    /// How much of a path is the path of a module.
    pub(crate) fn module_of<'a>(&self, place: &'a [String]) -> &'a [String] {
        (0..=place.len())
            .rev()
            .map(|end| &place[..end])
            .find(|path| self.0.contains_key(*path))
            .unwrap_or(&[])
    }

    /// Where a path leads in the end: through what modules only hand on, to the file that defines it.
    pub(crate) fn defined_at(&self, place: &[String]) -> Place {
        let mut place = place.to_vec();
        // As deep as any chain of imports goes, and an end where two modules import from each other.
        for _ in 0..8 {
            let module = self.module_of(&place).to_vec();
            let [name, inside @ ..] = &place[module.len()..] else { break };
            match self.0.get(&module).and_then(|module| module.imports.get(name)) {
                Some(from) => place = [from.as_slice(), inside].concat(),
                None => break,
            }
        }
        place
    }
}

/// A path as a source file has it.
struct Mention {
    place: Written,
    /// The name by which `use` makes it known in the file's own module.
    known_as: Option<String>,
}

struct Written {
    segments: Place,
    /// Whether it begins with a name of the module, and not at the root of the package.
    is_from_here: bool,
}

/// Collects the paths of a file.
struct Reader<'a> {
    tokens: &'a [Token],
    /// The module, with the modules inside of the file that are open.
    module: Place,
    mentions: Vec<Mention>,
}

impl<'a> Reader<'a> {
    fn of(path: &[String], tokens: &'a [Token]) -> Self {
        let mut reader = Self { tokens, module: path.to_vec(), mentions: Vec::new() };
        // How deep in braces each module inside of the file began.
        let (mut depth, mut open) = (0, Vec::new());
        let mut at = 0;
        while let Some(token) = tokens.get(at) {
            match token {
                Token::Word(word) if word == "mod" => {
                    if let [Token::Word(name), Token::Mark('{'), ..] = &tokens[at + 1..] {
                        reader.module.push(name.clone());
                        open.push(depth);
                        depth += 1;
                        at += 2;
                    }
                }
                Token::Word(word) if word == "use" => {
                    at = reader.tree(at + 1, &[], Some(open.is_empty()));
                    continue;
                }
                Token::Word(word) if ["crate", "self", "super"].contains(&word.as_str()) => {
                    let is_path = tokens.get(at + 1) == Some(&Token::Path);
                    if is_path && at.checked_sub(1).is_none_or(|before| tokens[before] != Token::Path) {
                        at = reader.tree(at, &[], None);
                        continue;
                    }
                }
                Token::Mark('{') => depth += 1,
                Token::Mark('}') => {
                    depth -= 1;
                    if open.last() == Some(&depth) {
                        open.pop();
                        reader.module.pop();
                    }
                }
                _ => {}
            }
            at += 1;
        }
        reader
    }

    /// Reads a path, or a tree of them in braces, and says where it ends. `imported` is for trees of `use`:
    /// whether what they make known is known in the file's own module.
    fn tree(&mut self, mut at: usize, before: &[String], imported: Option<bool>) -> usize {
        let mut path = before.to_vec();
        loop {
            match self.tokens.get(at) {
                Some(Token::Mark('{')) => {
                    at += 1;
                    while self.tokens.get(at).is_some_and(|token| *token != Token::Mark('}')) {
                        at = self.tree(at, &path, imported);
                        if self.tokens.get(at) == Some(&Token::Mark(',')) {
                            at += 1;
                        }
                    }
                    return at + 1;
                }
                Some(Token::Mark('*')) => {
                    path.push("*".to_owned());
                    self.add(&path, None);
                    return at + 1;
                }
                Some(Token::Word(word)) => {
                    path.push(word.clone());
                    at += 1;
                    if self.tokens.get(at) == Some(&Token::Path) {
                        at += 1;
                        continue;
                    }
                    if path.last().is_some_and(|last| last == "self") && path.len() > 1 {
                        path.pop();
                    }
                    let mut name = path.last().cloned();
                    if let (Some(_), [Token::Word(keyword), Token::Word(other), ..]) =
                        (imported, &self.tokens[at..])
                        && keyword == "as"
                    {
                        name = Some(other.clone());
                        at += 2;
                    }
                    self.add(&path, name.filter(|_| imported == Some(true)));
                    return at;
                }
                // As the `<` of `crate::gl::read::<f32>`.
                _ => {
                    self.add(&path, None);
                    return at + 1;
                }
            }
        }
    }

    fn add(&mut self, path: &[String], known_as: Option<String>) {
        let Some(first) = path.first() else { return };
        let (mut segments, rest) = match first.as_str() {
            "crate" => (Vec::new(), &path[1..]),
            "self" | "super" => (self.module.clone(), path),
            _ => {
                let place = Written { segments: path.to_vec(), is_from_here: true };
                self.mentions.push(Mention { place, known_as });
                return;
            }
        };
        for segment in rest {
            match segment.as_str() {
                "self" => {}
                "super" => drop(segments.pop()),
                name => segments.push(name.to_owned()),
            }
        }
        self.mentions.push(Mention { place: Written { segments, is_from_here: false }, known_as });
    }
}

/// A path in words.
pub(crate) fn words(place: &[String]) -> String {
    place.join("::")
}

#[test]
fn paths_are_followed_to_where_they_lead() {
    let package = Package::planted(&[
        ("lib.rs", "pub use gl::{Gl, pass::Pass as Drawing};"),
        ("gl/mod.rs", "mod pass; mod program; pub use pass::Pass; use std::fmt; pub struct Gl;"),
        (
            "gl/pass.rs",
            "use super::{Gl, program::{self, Program}}; mod tests { use super::super::super::maps::*; }",
        ),
        ("gl/program.rs", "fn f() { crate::gl::Pass::new::<u8>(); self::g(super::super::Drawing); }"),
        ("maps.rs", "// use crate::gl::Gl;\nconst TEXT: &str = \"crate::gl::Gl\"; pub(crate) fn f() {}"),
    ]);
    let names = |path: &[&str]| {
        let path: Place = path.iter().map(|&name| name.to_owned()).collect();
        package.0[&path].names.iter().map(|place| words(place)).collect::<Vec<_>>()
    };
    let defined = |path: &[&str]| {
        let place: Place = path.iter().map(|&name| name.to_owned()).collect();
        words(&package.defined_at(&place))
    };
    assert_eq!(names(&["gl"]), ["gl::pass::Pass"]);
    assert_eq!(names(&["gl", "pass"]), ["gl::Gl", "gl::program", "gl::program::Program", "maps::*"]);
    assert_eq!(names(&["gl", "program"]), ["gl::Pass::new", "gl::program::g", "Drawing"]);
    assert_eq!(names(&["maps"]), [""; 0]);
    assert_eq!(defined(&["gl", "Pass", "new"]), "gl::pass::Pass::new");
    assert_eq!(defined(&["Drawing"]), "gl::pass::Pass");
    assert_eq!(defined(&["gl", "Gl"]), "gl::Gl");
}
