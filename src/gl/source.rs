//! Shaders put together from files, defines and a version line.

use std::fmt::Write as _;

/// The vertex stage of every pass but those that draw geometry: one triangle over the whole target.
pub(crate) const FULL_SCREEN: &str = include_str!("../../glsl/common/full_screen.vert");

/// The GLSL version of every shader.
pub(crate) const VERSION_LINE: &str = "#version 330 core\n";

/// The shaders of a program: a label, defines, the files of the fragment shader that follow each other, and those of the
/// vertex shader where it is not the full-screen one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderSource {
    label: String,
    defines: Vec<(&'static str, u32)>,
    files: Vec<(&'static str, &'static str)>,
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

    /// The same for the vertex shader, which takes the place of the full-screen one.
    #[cfg(feature = "render")]
    #[must_use]
    pub(crate) fn vertex_file(mut self, (name, text): (&'static str, &'static str)) -> Self {
        self.vertex_files.push((name, text));
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
        self.text(&self.files)
    }

    /// The whole text of the vertex shader, ready for glShaderSource.
    #[must_use]
    pub fn vertex(&self) -> String {
        if self.vertex_files.is_empty() {
            return format!("{VERSION_LINE}{FULL_SCREEN}");
        }
        self.text(&self.vertex_files)
    }

    fn text(&self, files: &[(&str, &str)]) -> String {
        let mut text = String::from(VERSION_LINE);
        for (name, value) in &self.defines {
            writeln!(text, "#define {name} {value}").expect("writing to a string");
        }
        for (number, (name, file)) in (1..).zip(files) {
            write!(text, "// {name}\n#line 1 {number}\n{file}").expect("writing to a string");
        }
        text
    }

    /// The shaders for a reader: each line with the file's number and its own.
    #[must_use]
    pub fn listing(&self) -> String {
        let mut listing = String::new();
        for (name, value) in &self.defines {
            writeln!(listing, "      #define {name} {value}").expect("writing to a string");
        }
        for (stage, files) in [("fragment", &self.files), ("vertex", &self.vertex_files)] {
            for (number, (name, file)) in (1..).zip(files) {
                writeln!(listing, "  {stage} file {number}: glsl/{name}").expect("writing to a string");
                for (line, text) in (1..).zip(file.lines()) {
                    writeln!(listing, "{number}:{line:<4} {text}").expect("writing to a string");
                }
            }
        }
        listing
    }
}

/// A file below `glsl/` as a `(name, text)` pair for [`ShaderSource::file`](crate::gl::ShaderSource).
macro_rules! glsl {
    ($name:literal) => {
        ($name, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/", $name)))
    };
}
pub(crate) use glsl;
