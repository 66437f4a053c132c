//! A program put together from files, defines and a version line.

use std::fmt::Write as _;

use super::preprocessor::{self, Macros};
use super::{Interface, ShaderStage, TextureFormat};

/// A file below `glsl/` as a `(name, text)` pair for [`ShaderSource::file`](crate::gl::ShaderSource).
macro_rules! glsl {
    ($name:literal) => {
        ($name, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/", $name)))
    };
}
pub(crate) use glsl;

/// The vertex stage of a pass unless it has one of its own: one triangle over the whole target.
const FULL_SCREEN: (&str, &str) = glsl!("common/full_screen.vert");

/// The GLSL version of every shader.
pub(crate) const VERSION_LINE: &str = "#version 330 core\n";

/// A program: a label, defines, and the files that follow each other in its stages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderSource {
    label: String,
    /// What distinguishes it from others of its label.
    variant: Vec<String>,
    defines: Vec<(&'static str, u32)>,
    /// The fragment stage.
    files: Vec<(&'static str, &'static str)>,
    /// The vertex stage; none stands for the one triangle.
    vertex_files: Vec<(&'static str, &'static str)>,
    /// What it is drawn to; none where a pass writes no colour.
    target_formats: Vec<TextureFormat>,
}

impl ShaderSource {
    /// An empty source; `label` names its pass in errors, debug groups and timings.
    #[must_use]
    pub(crate) fn new(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            variant: Vec::new(),
            defines: Vec::new(),
            files: Vec::new(),
            vertex_files: Vec::new(),
            target_formats: Vec::new(),
        }
    }

    /// A word of its [name](Self::name), where several programs share a label.
    #[must_use]
    pub(crate) fn variant(mut self, word: impl Into<String>) -> Self {
        self.variant.push(word.into());
        self
    }

    /// The same if `condition` holds.
    #[must_use]
    pub(crate) fn variant_if(self, condition: bool, word: &str) -> Self {
        if condition { self.variant(word) } else { self }
    }

    /// The formats that it is drawn to, one for each draw buffer; every pass checks them.
    #[must_use]
    pub(crate) fn targets(mut self, formats: impl IntoIterator<Item = TextureFormat>) -> Self {
        self.target_formats.extend(formats);
        self
    }

    pub(super) fn target_formats(&self) -> &[TextureFormat] {
        &self.target_formats
    }

    /// `#define name value`.
    #[must_use]
    pub(crate) fn define(mut self, name: &'static str, value: impl Into<u32>) -> Self {
        self.defines.push((name, value.into()));
        self
    }

    /// `#define name 1` if `condition` holds.
    #[must_use]
    pub(crate) fn define_if(self, condition: bool, name: &'static str) -> Self {
        if condition { self.define(name, 1_u32) } else { self }
    }

    /// The text of the file `name` below `glsl/`; see [`glsl!`](crate::gl::glsl).
    #[must_use]
    pub(crate) fn file(mut self, (name, text): (&'static str, &'static str)) -> Self {
        self.files.push((name, text));
        self
    }

    /// A file of the vertex stage, which takes the place of the one triangle; the defines hold for it as
    /// well.
    #[must_use]
    pub(crate) fn vertex_file(mut self, file: (&'static str, &'static str)) -> Self {
        self.vertex_files.push(file);
        self
    }

    /// The pass's label.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    /// A name without spaces, one of its own among the shaders of one frame: `radius-search/inner`.
    #[must_use]
    pub fn name(&self) -> String {
        let label = self.label.replace(' ', "-");
        if self.variant.is_empty() { label } else { format!("{label}/{}", self.variant.join("-")) }
    }

    /// The defines that choose this variant, by name and value.
    #[must_use]
    pub fn defines(&self) -> &[(&'static str, u32)] {
        &self.defines
    }

    /// The names of a stage's files below `glsl/`, in the order in which they follow each other.
    #[must_use]
    pub fn files(&self, stage: ShaderStage) -> Vec<&'static str> {
        self.of_stage(stage).iter().map(|&(name, _)| name).collect()
    }

    /// What the pass does: the first sentence of its last fragment file.
    #[must_use]
    pub fn purpose(&self) -> String {
        let (_, text) = self.files[self.files.len() - 1];
        let lines: Vec<_> = text.lines().map_while(|line| line.strip_prefix("//")).map(str::trim).collect();
        let comment = lines.join(" ");
        let end = comment.find(". ").map_or(comment.len(), |dot| dot + 1);
        comment[..end].to_owned()
    }

    /// The text of a stage for a reader, or for an engine with code of its own: version line, what it reads
    /// and writes as a comment, and the files with all conditions decided and all defines put in.
    ///
    /// It declares what [`fragment`](Self::fragment) or [`vertex`](Self::vertex) declares, and computes the
    /// same.
    ///
    /// # Panics
    /// If a file holds what the small preprocessor does not support, which is a bug of the library.
    #[must_use]
    pub fn resolved(&self, stage: ShaderStage) -> String {
        let mut text = String::from(VERSION_LINE);
        let mut facts = vec![format!(
            "{}, {} stage of varikernel {}.",
            self.name(),
            stage.name(),
            env!("CARGO_PKG_VERSION")
        )];
        facts.push(self.purpose());
        if !self.defines.is_empty() {
            let defines: Vec<_> =
                self.defines.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            facts.push(format!("Put in: {}.", defines.join(", ")));
        }
        let table = self.interface().of_stage(stage).to_string();
        for line in facts.iter().map(String::as_str).chain(table.lines()) {
            writeln!(text, "// {line}").expect("writing to a string");
        }
        for (name, file) in self.resolved_files(stage) {
            write!(text, "\n// glsl/{name}\n//\n{file}").expect("writing to a string");
        }
        text
    }

    /// What the program reads and writes.
    ///
    /// # Panics
    /// As [`resolved`](Self::resolved), or if a declaration can't be read.
    #[must_use]
    pub fn interface(&self) -> Interface {
        let mut interface = Interface::default();
        for stage in ShaderStage::ALL {
            for (_, text) in self.resolved_files(stage) {
                interface.read(&text, stage, &self.target_formats);
            }
        }
        interface
    }

    fn resolved_files(&self, stage: ShaderStage) -> Vec<(&'static str, String)> {
        let mut macros: Macros =
            self.defines.iter().map(|(name, value)| ((*name).to_owned(), value.to_string())).collect();
        let resolve = |&(name, text): &(&'static str, &str)| {
            let resolved = preprocessor::resolve(text, &mut macros);
            (name, resolved.unwrap_or_else(|what| panic!("glsl/{name}, {what}")))
        };
        self.of_stage(stage).iter().map(resolve).collect()
    }

    fn of_stage(&self, stage: ShaderStage) -> &[(&'static str, &'static str)] {
        match stage {
            ShaderStage::Vertex => self.vertex_stage(),
            ShaderStage::Fragment => &self.files,
        }
    }

    /// The whole text of the fragment shader, ready for glShaderSource.
    ///
    /// `#line` restarts the count in each file, so a driver's `2:17` is line 17 of the second file.
    #[must_use]
    pub fn fragment(&self) -> String {
        self.stage(&self.files, 1)
    }

    /// The whole text of the vertex shader, ready for glShaderSource.
    #[must_use]
    pub fn vertex(&self) -> String {
        self.stage(self.vertex_stage(), 1 + self.files.len())
    }

    fn vertex_stage(&self) -> &[(&'static str, &'static str)] {
        if self.vertex_files.is_empty() { &[FULL_SCREEN] } else { &self.vertex_files }
    }

    fn stage(&self, files: &[(&str, &str)], first_number: usize) -> String {
        let mut text = String::from(VERSION_LINE);
        for (name, value) in &self.defines {
            writeln!(text, "#define {name} {value}").expect("writing to a string");
        }
        for (number, (name, file)) in (first_number..).zip(files) {
            write!(text, "// {name}\n#line 1 {number}\n{file}").expect("writing to a string");
        }
        text
    }

    /// Both stages for a reader, the fragment stage first: each line with the file's number and its own.
    #[must_use]
    pub fn listing(&self) -> String {
        let mut listing = String::new();
        for (name, value) in &self.defines {
            writeln!(listing, "      #define {name} {value}").expect("writing to a string");
        }
        for (number, (name, file)) in (1..).zip(self.files.iter().chain(self.vertex_stage())) {
            writeln!(listing, "  file {number}: glsl/{name}").expect("writing to a string");
            for (line, text) in (1..).zip(file.lines()) {
                writeln!(listing, "{number}:{line:<4} {text}").expect("writing to a string");
            }
        }
        listing
    }
}
