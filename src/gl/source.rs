//! A program put together from files, defines and a version line.

use std::fmt::Write as _;

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
    defines: Vec<(&'static str, u32)>,
    /// The fragment stage.
    files: Vec<(&'static str, &'static str)>,
    /// The vertex stage; none stands for the one triangle.
    vertex_files: Vec<(&'static str, &'static str)>,
}

impl ShaderSource {
    /// An empty source; `label` names its pass in errors, debug groups and timings.
    #[must_use]
    pub(crate) fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), defines: Vec::new(), files: Vec::new(), vertex_files: Vec::new() }
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

    /// A file of the vertex stage, which takes the place of the one triangle; the defines hold for it as well.
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
