//! What a shader needs from a host: its samplers, uniforms, vertex attributes and targets, read from its
//! declarations.

use std::fmt;

use super::TextureFormat;

/// One of the two stages of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum ShaderStage {
    /// GL_VERTEX_SHADER.
    Vertex,
    /// GL_FRAGMENT_SHADER.
    Fragment,
}

impl ShaderStage {
    /// Both, in the order of the pipeline.
    pub const ALL: [Self; 2] = [Self::Vertex, Self::Fragment];

    /// Its name, "vertex" or "fragment".
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Fragment => "fragment",
        }
    }
}

/// A variable by which a shader and its host exchange data.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Variable {
    /// Its name in the text.
    pub name: String,
    /// Its type in GLSL, for example `usampler2D`.
    #[cfg_attr(feature = "serde", serde(rename = "type"))]
    pub glsl_type: String,
    /// Where it is declared: one stage, or both.
    pub stages: Vec<ShaderStage>,
    /// Of attributes and targets.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub location: Option<u32>,
    /// Of targets: the GL enum of the textures that the library draws to.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub format: Option<&'static str>,
    /// What it holds, and in which unit.
    pub meaning: String,
}

/// Everything that a program reads and writes, in the order of declaration.
///
/// A driver may leave out what a variant does not use: then glGetUniformLocation gives -1.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Interface {
    /// Textures that it reads, by texelFetch alone: filtering and wrapping do not matter.
    pub samplers: Vec<Variable>,
    /// All other uniforms.
    pub uniforms: Vec<Variable>,
    /// Vertex attributes; without any, the vertex stage goes by gl_VertexID.
    pub attributes: Vec<Variable>,
    /// Colours that it writes.
    pub targets: Vec<Variable>,
}

impl Interface {
    /// Adds the declarations of a stage's resolved text; `formats` are those of the targets.
    ///
    /// # Panics
    /// If a declaration can't be read, which is a bug of the library.
    pub(super) fn read(&mut self, text: &str, stage: ShaderStage, formats: &[TextureFormat]) {
        let mut comment = Vec::new();
        let mut is_comment_open = false;
        for line in text.lines() {
            if let Some(sentence) = line.strip_prefix("//") {
                if !is_comment_open {
                    comment.clear();
                }
                is_comment_open = true;
                comment.push(sentence.trim());
            } else if line.starts_with("uniform ") || line.starts_with("layout(") {
                is_comment_open = false;
                let (mut variable, place) = declaration(line, stage)
                    .unwrap_or_else(|| panic!("a declaration that is not understood: {line}"));
                // One comment may explain several declarations below it.
                variable.meaning = comment.join(" ");
                if place == Place::Target {
                    let location = variable.location.unwrap_or(0) as usize;
                    variable.format = formats.get(location).map(|format| format.name());
                }
                self.take(variable, place);
            } else {
                is_comment_open = false;
                comment.clear();
            }
        }
    }

    fn take(&mut self, variable: Variable, place: Place) {
        let list = match place {
            Place::Sampler => &mut self.samplers,
            Place::Uniform => &mut self.uniforms,
            Place::Attribute => &mut self.attributes,
            Place::Target => &mut self.targets,
        };
        // Both stages may declare the same uniform; the first one explains it.
        match list.iter_mut().find(|known| known.name == variable.name) {
            Some(known) => known.stages.extend(variable.stages),
            None => list.push(variable),
        }
    }

    /// What one stage declares.
    #[must_use]
    pub fn of_stage(&self, stage: ShaderStage) -> Self {
        let of = |list: &[Variable]| {
            list.iter().filter(|variable| variable.stages.contains(&stage)).cloned().collect()
        };
        Self {
            samplers: of(&self.samplers),
            uniforms: of(&self.uniforms),
            attributes: of(&self.attributes),
            targets: of(&self.targets),
        }
    }

    /// Each list with what it is called.
    #[must_use]
    pub fn lists(&self) -> [(&'static str, &[Variable]); 4] {
        [
            ("samplers", &self.samplers),
            ("uniforms", &self.uniforms),
            ("attributes", &self.attributes),
            ("targets", &self.targets),
        ]
    }
}

impl fmt::Display for Interface {
    /// A table with a line for each variable: location, type and name, format, meaning.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let declared = |variable: &Variable| {
            let location = variable.location.map(|location| format!("{location}: ")).unwrap_or_default();
            let format = variable.format.map(|format| format!(" in {format}")).unwrap_or_default();
            format!("{location}{} {}{format}", variable.glsl_type, variable.name)
        };
        let all = self.lists().into_iter().flat_map(|(_, list)| list);
        let width = all.map(|variable| declared(variable).len()).max().unwrap_or(0);
        for (title, list) in self.lists() {
            if !list.is_empty() {
                writeln!(f, "{title}")?;
            }
            for variable in list {
                writeln!(f, "  {:width$}  {}", declared(variable), variable.meaning)?;
            }
        }
        Ok(())
    }
}

/// Which list a declaration belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Sampler,
    Uniform,
    Attribute,
    Target,
}

/// `uniform TYPE NAME;` or `layout(location = N) in|out TYPE NAME;`
fn declaration(line: &str, stage: ShaderStage) -> Option<(Variable, Place)> {
    let (code, location) = match line.strip_prefix("layout(location = ") {
        Some(rest) => {
            let (location, code) = rest.split_once(") ")?;
            (code, Some(location.parse().ok()?))
        }
        None => (line, None),
    };
    let words: Vec<_> = code.strip_suffix(';')?.split(' ').collect();
    let [storage, glsl_type, name] = words[..] else { return None };
    let place = match (storage, stage, location) {
        ("uniform", _, None) if glsl_type.contains("sampler") => Place::Sampler,
        ("uniform", _, None) => Place::Uniform,
        ("in", ShaderStage::Vertex, Some(_)) => Place::Attribute,
        ("out", ShaderStage::Fragment, Some(_)) => Place::Target,
        _ => return None,
    };
    let variable = Variable {
        name: name.to_owned(),
        glsl_type: glsl_type.to_owned(),
        stages: vec![stage],
        location,
        format: None,
        meaning: String::new(),
    };
    Some((variable, place))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_read_with_the_comments_above_them() {
        let text = "\
// What the file does.

// Photons
// per pixel.
uniform usampler2D density;
uniform ivec2 map_size;

uniform mat4 to_clip;
in vec3 at;

// The radius.
layout(location = 1) out uint radius;
void main()
{
    uint uniform_radius = 1u;
}
";
        let mut interface = Interface::default();
        let formats = [TextureFormat::R8Uint, TextureFormat::R32Uint];
        interface.read(text, ShaderStage::Fragment, &formats);
        let facts = |list: &[Variable]| {
            let fact = |variable: &Variable| {
                format!("{} {}: {}", variable.glsl_type, variable.name, variable.meaning)
            };
            list.iter().map(fact).collect::<Vec<_>>()
        };
        assert_eq!(facts(&interface.samplers), ["usampler2D density: Photons per pixel."]);
        assert_eq!(facts(&interface.uniforms), ["ivec2 map_size: Photons per pixel.", "mat4 to_clip: "]);
        assert_eq!(facts(&interface.targets), ["uint radius: The radius."]);
        assert_eq!((interface.targets[0].location, interface.targets[0].format), (Some(1), Some("GL_R32UI")));
        assert!(interface.attributes.is_empty());

        // A second stage is added to the line, not a second line.
        interface.read("// Others.\nuniform mat4 to_clip;\n", ShaderStage::Vertex, &[]);
        assert_eq!(interface.uniforms[1].stages, [ShaderStage::Fragment, ShaderStage::Vertex]);
        assert_eq!(facts(&interface.of_stage(ShaderStage::Vertex).uniforms), ["mat4 to_clip: "]);
        assert_eq!(
            interface.of_stage(ShaderStage::Fragment).to_string().lines().last(),
            Some("  1: uint radius in GL_R32UI  The radius.")
        );
    }

    #[test]
    #[should_panic(expected = "a declaration that is not understood")]
    fn a_declaration_that_can_t_be_read_is_no_silence() {
        Interface::default().read("uniform float weights[4] = float[4](1);\n", ShaderStage::Fragment, &[]);
    }
}
