//! `varikernel glsl`: our shaders as text, for engines with code of their own.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use clap::ValueEnum;
use serde::Serialize;
use varikernel::gl::{Interface, ShaderSource, ShaderStage, TextureFormat};
use varikernel::image::write_atomically;
use varikernel::settings::{Kernel, KernelRadius, Method, Planning, Rule, Settings};
use varikernel::{MaskMaker, PositionMaker, light, radius, render};

use super::method_options::MethodOptions;
use super::render::parse_radius;
use super::words::in_words_of_options;
use super::{Outcome, output};

/// Print shaders as one variant compiles them, with a table of what they read and write.
///
/// For engines with code of their own. Conditions are decided and defines put in; the options choose the
/// variant, as they do for `radius` and `render`. No OpenGL is needed.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub(crate) struct Args {
    /// A shader of the list, for example radius-search/inner.
    #[arg(required_unless_present_any = ["list", "output"])]
    name: Option<String>,

    /// List the shaders of the variant, in the order of a frame.
    #[arg(long, conflicts_with_all = ["name", "output", "stage"])]
    #[arg(help_heading = "Input and output")]
    list: bool,

    /// What to print or write of a shader.
    #[arg(long, value_enum, default_value_t = Stages::Both)]
    #[arg(help_heading = "Input and output")]
    stage: Stages,

    /// Write instead of printing: with NAME and one --stage a file, with NAME and both stages a folder for
    /// two; without NAME a folder for all shaders of the variant, and for shaders.json, their tables. A
    /// folder is made if it is missing.
    #[arg(short, long, value_name = "FILE|FOLDER")]
    #[arg(help_heading = "Input and output")]
    output: Option<PathBuf>,

    #[command(flatten)]
    method: MethodOptions,

    /// The host's density map: r32ui, also for GL_R16UI and GL_R8UI, or r32f.
    #[arg(long, value_enum, default_value_t = Density::R32ui)]
    #[arg(help_heading = "Host's textures")]
    density: Density,

    /// With a second target that is 1 where MR ended the search with too few photons, else 0.
    #[arg(long)]
    #[arg(help_heading = "Host's textures")]
    limited_mask: bool,

    /// With a mask of the pixels that need a radius.
    #[arg(long)]
    #[arg(help_heading = "Host's textures")]
    mask: bool,

    /// Falloff of a kernel from its middle to its edge.
    #[arg(long, value_enum, default_value_t = Kernel::Silverman)]
    #[arg(help_heading = "Kernels")]
    kernel: Kernel,

    /// Width of the kernels: `variable`, or `fixed:PIXELS` for the same everywhere.
    #[arg(long, default_value = "variable", value_parser = parse_radius, value_name = "RADIUS")]
    #[arg(help_heading = "Kernels")]
    radius: KernelRadius,

    /// Print one JSON object instead of text.
    #[arg(long)]
    #[arg(help_heading = "Input and output")]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Stages {
    Vertex,
    Fragment,
    Both,
}

impl Stages {
    fn all(self) -> &'static [ShaderStage] {
        match self {
            Self::Vertex => &ShaderStage::ALL[..1],
            Self::Fragment => &ShaderStage::ALL[1..],
            Self::Both => &ShaderStage::ALL,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Density {
    /// Counts in whole numbers.
    R32ui,
    /// Counts as additive blending writes them.
    R32f,
}

/// A shader in JSON.
#[derive(Serialize)]
struct Shader {
    name: String,
    purpose: String,
    files: Vec<&'static str>,
    #[serde(flatten)]
    interface: Interface,
    #[serde(skip_serializing_if = "Option::is_none")]
    vertex: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    fragment: Option<String>,
}

#[derive(Serialize)]
struct List {
    version: &'static str,
    shaders: Vec<Shader>,
}

#[derive(Serialize)]
struct Written {
    written: Vec<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    args.method.check_rule()?;
    let settings = Settings { limited_mask: args.limited_mask, masked: args.mask, ..args.method.settings() };
    settings.validate().map_err(in_words_of_options)?;
    let sources = sources(args, &settings);
    let stages = args.stage.all();
    match (&args.name, &args.output) {
        (None, None) => list(args, &sources)?,
        (None, Some(folder)) => written(args, write_all(args, &sources, folder)?)?,
        (Some(name), None) => {
            let source = named(&sources, name)?;
            if args.json {
                output::print_json(&shader(source, stages))?;
            } else {
                let texts: Vec<_> = stages.iter().map(|&stage| source.resolved(stage)).collect();
                output::print(texts.join("\n").trim_end())?;
            }
        }
        (Some(name), Some(path)) => {
            let source = named(&sources, name)?;
            let files = if let [stage] = stages {
                write(path, &source.resolved(*stage))?;
                vec![path.clone()]
            } else {
                make_folder(path)?;
                write_stages(source, stages, path)?
            };
            written(args, files)?;
        }
    }
    Ok(Outcome::Done)
}

/// The shaders of a variant in the order of a frame.
fn sources(args: &Args, settings: &Settings) -> Vec<ShaderSource> {
    let density = match args.density {
        Density::R32ui => TextureFormat::R32Uint,
        Density::R32f => TextureFormat::R32Float,
    };
    let mut sources = render::surface_sources();
    sources.extend([PositionMaker::shader_source(), light::density_source(), MaskMaker::shader_source()]);
    // With the census of pipelines that plan each frame.
    let settings = Settings { planning: Planning::EachFrame, ..*settings };
    sources.extend(radius::shader_sources(density, &settings));
    sources.extend(light::spread_sources(args.kernel, args.radius));
    sources.extend(light::tables_sources());
    sources.extend(render::shading_sources());
    sources
}

fn named<'a>(sources: &'a [ShaderSource], name: &str) -> Result<&'a ShaderSource> {
    sources.iter().find(|source| source.name() == name).ok_or_else(|| {
        let near = near_matches(sources, name);
        let near =
            if near.is_empty() { String::new() } else { format!("; the variant has {}", near.join(", ")) };
        let even = Settings { rule: Rule::Even, ..Settings::default() };
        let elsewhere = methods_with(name);
        let help = if !elsewhere.is_empty() {
            format!("add --method {}", elsewhere.join(" or --method "))
        } else if has(&even, name) {
            "add --rule even".to_owned()
        } else {
            "list all with `varikernel glsl --list`".to_owned()
        };
        anyhow!("{name}: there is no such shader{near}\nhelp: {help}")
    })
}

/// Names that contain `name` or are spelled much like it, the nearest first.
fn near_matches(sources: &[ShaderSource], word: &str) -> Vec<String> {
    let likeness = |name: &str| {
        if name.contains(word) { 1.0 } else { strsim::normalized_damerau_levenshtein(name, word) }
    };
    let mut names: Vec<_> =
        sources.iter().map(ShaderSource::name).map(|name| (likeness(&name), name)).collect();
    names.retain(|(likeness, _)| *likeness >= 0.6);
    names.sort_by(|(one, _), (other, _)| other.total_cmp(one));
    names.into_iter().map(|(_, name)| name).take(6).collect()
}

/// Methods whose usual settings have a shader of that name.
fn methods_with(name: &str) -> Vec<&'static str> {
    let has_it = |method: &Method| has(&Settings::of(*method), name);
    Method::ALL.into_iter().filter(has_it).map(Method::name).collect()
}

/// Whether a variant has a shader of that name.
fn has(settings: &Settings, name: &str) -> bool {
    let sources = radius::shader_sources(TextureFormat::R32Uint, settings);
    sources.iter().any(|source| source.name() == name)
}

/// Two lines for each shader: what it does; what it draws to, and its files.
fn list(args: &Args, sources: &[ShaderSource]) -> Result<()> {
    if args.json {
        let shaders = sources.iter().map(|source| shader(source, &[])).collect();
        return output::print_json(&List { version: env!("CARGO_PKG_VERSION"), shaders });
    }
    let width = sources.iter().map(|source| source.name().len()).max().unwrap_or(0);
    let lines = sources.iter().flat_map(|source| {
        let details = format!("{}from {}", targets(&source.interface()), files(source).join(", "));
        [format!("{:width$}  {}", source.name(), source.purpose()), format!("{:width$}  {details}", "")]
    });
    output::print(&lines.collect::<Vec<_>>().join("\n"))
}

/// `radius in GL_R32UI and limited in GL_R8UI `, `8 targets in GL_RGBA32UI `, or nothing.
fn targets(interface: &Interface) -> String {
    let format = |index: usize| interface.targets[index].format.unwrap_or("any format");
    match &interface.targets[..] {
        [] => String::new(),
        all if all.len() > 3 => format!("{} targets in {}, ", all.len(), format(0)),
        all => {
            let each =
                all.iter().enumerate().map(|(index, target)| format!("{} in {}", target.name, format(index)));
            format!("{}, ", each.collect::<Vec<_>>().join(", "))
        }
    }
}

/// The files of both stages, the vertex stage's first, each once.
fn files(source: &ShaderSource) -> Vec<&'static str> {
    let mut files = Vec::new();
    for file in ShaderStage::ALL.into_iter().flat_map(|stage| source.files(stage)) {
        if !files.contains(&file) {
            files.push(file);
        }
    }
    files
}

fn shader(source: &ShaderSource, stages: &[ShaderStage]) -> Shader {
    let text = |stage| stages.contains(&stage).then(|| source.resolved(stage));
    Shader {
        name: source.name(),
        purpose: source.purpose(),
        files: files(source),
        interface: source.interface(),
        vertex: text(ShaderStage::Vertex),
        fragment: text(ShaderStage::Fragment),
    }
}

/// Every shader of the variant, and their tables.
fn write_all(args: &Args, sources: &[ShaderSource], folder: &Path) -> Result<Vec<PathBuf>> {
    make_folder(folder)?;
    let mut files = Vec::new();
    for source in sources {
        files.extend(write_stages(source, args.stage.all(), folder)?);
    }
    let shaders = sources.iter().map(|source| shader(source, &[])).collect();
    let tables = serde_json::to_string_pretty(&List { version: env!("CARGO_PKG_VERSION"), shaders })?;
    let path = folder.join("shaders.json");
    write(&path, &(tables + "\n"))?;
    files.push(path);
    Ok(files)
}

/// `radius-search/inner` as `radius-search-inner.frag` and `.vert`.
fn write_stages(source: &ShaderSource, stages: &[ShaderStage], folder: &Path) -> Result<Vec<PathBuf>> {
    let write_stage = |&stage: &ShaderStage| {
        let ending = match stage {
            ShaderStage::Vertex => "vert",
            ShaderStage::Fragment => "frag",
        };
        let path = folder.join(format!("{}.{ending}", source.name().replace('/', "-")));
        write(&path, &source.resolved(stage))?;
        Ok(path)
    };
    stages.iter().map(write_stage).collect()
}

fn make_folder(folder: &Path) -> Result<()> {
    output::make_folder(folder)
}

fn write(path: &Path, text: &str) -> Result<()> {
    Ok(write_atomically(path, |file| file.write_all(text.as_bytes()))?)
}

fn written(args: &Args, files: Vec<PathBuf>) -> Result<()> {
    if args.json {
        return output::print_json(&Written { written: files });
    }
    let names: Vec<_> = files.iter().map(|file| file.display().to_string()).collect();
    output::print(&names.join("\n"))
}
