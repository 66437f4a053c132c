//! `varikernel bench`: how fast each method is on this machine.

mod cells;
mod picture;
mod rivals;
mod table;
pub(crate) mod targets;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};
use clap::ValueEnum as _;
use glam::UVec2;
use indicatif::{ProgressBar, ProgressStyle};
use varikernel::context::DeviceChoice;
use varikernel::image::{ReadOptions, check_writable, read_counts};
use varikernel::settings::{Edges, MAX_RADIUS_LIMIT, Method, Order, SatBuild, SatSamples, Storage};
use varikernel_lab::bench::{self, BenchSettings, FastSuite, MapSource, Progress, Protocol, Report};
use varikernel_lab::rivals::Rival;
use varikernel_lab::synth::Kind;

use super::numbers::{duration, whole};
use super::saving::{Autosave, Resume, how_to_go_on};
use super::{Outcome, device};

/// Time the methods, check their answers, and rank them.
///
/// Every case is one full-screen job: "build" fills the intermediate structure, "search" finds the radii in
/// it, "frame" is both. Times are medians of GPU time queries, and "copies" are the same in passes that read
/// and write each texel once. A method whose answer is wrong gets no rank.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Time a fixed set of cases, and judge its targets. Of the choices below, `fast` takes --sizes,
    /// --build-sizes, --rivals and --protocol, `picture` --sizes and --photons; light from tables is judged
    /// at 1920x1080 with 1e6 photons, and 1e7.
    #[arg(long, value_enum, conflicts_with_all = FIXED_BY_SUITE)]
    #[arg(help_heading = "Suite and maps")]
    suite: Option<SuiteName>,

    /// Sizes of synthetic maps: sides, or WIDTHxHEIGHT; files have their own [default for suites: 1024 and
    /// 512].
    #[arg(long, value_delimiter = ',', default_value = "64,128,256,512", value_parser = parse_size,
          default_value_ifs([("suite", "fast", "1024"), ("suite", "picture", "512")]))]
    #[arg(help_heading = "Suite and maps")]
    sizes: Vec<UVec2>,

    /// Sizes of maps of --suite fast on which builds alone are timed [default: 64,128,256,512,1024,2048].
    #[arg(long, value_delimiter = ',', value_parser = parse_size, requires = "suite")]
    #[arg(help_heading = "Suite and maps")]
    build_sizes: Option<Vec<UVec2>>,

    /// Photons of --suite picture that are traced and drawn, each number at each size [default: 1e6].
    #[arg(long, value_delimiter = ',', value_parser = super::photons::parse_count, requires = "suite",
          value_name = "NUMBERS", allow_negative_numbers = true)]
    #[arg(help_heading = "Suite and maps")]
    photons: Option<Vec<u32>>,

    /// Map to time with, again for more: a kind of `varikernel synth`, or an EXR, PNG or NPY file of counts.
    #[arg(long = "map", value_name = "FILE|KIND", default_value = "caustic")]
    #[arg(help_heading = "Suite and maps")]
    maps: Vec<PathBuf>,

    /// Channel to read of EXR files that have several.
    #[arg(long)]
    #[arg(help_heading = "Suite and maps")]
    channel: Option<String>,

    /// Methods to time.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "brute-force,pyramid,sat")]
    #[arg(help_heading = "Method")]
    methods: Vec<Method>,

    /// Orders of the search.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "forward,binary,bracketed")]
    #[arg(help_heading = "Method")]
    searches: Vec<Order>,

    /// MR: the radius at which a search ends, in pixels.
    #[arg(short = 'r', long, value_delimiter = ',', default_value = "32",
          value_parser = whole(1..=MAX_RADIUS_LIMIT), allow_negative_numbers = true)]
    #[arg(help_heading = "Question")]
    max_radius: Vec<u32>,

    /// n: photons that a box has to hold.
    #[arg(short = 'n', long, value_delimiter = ',', default_value = "25",
          value_parser = whole(1..=u32::MAX), allow_negative_numbers = true)]
    #[arg(help_heading = "Question")]
    min_photons: Vec<u32>,

    /// What counts outside the map.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "scale")]
    #[arg(help_heading = "Question")]
    edges: Vec<Edges>,

    /// Builds of the summed-area table.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "doubling,scan")]
    #[arg(help_heading = "Method")]
    sat_build: Vec<SatBuild>,

    /// Samples a pass when the summed-area table is built by doubling.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "2,4")]
    #[arg(help_heading = "Method")]
    sat_samples: Vec<SatSamples>,

    /// Numbers in which summed-area tables are kept; each is left out where it is not proved exact (u16 where
    /// a box could hold 2^16 photons, f16 past 2^11 in all, f32-minus-mean and f32-minus-whole-mean always).
    #[arg(long, value_enum, value_delimiter = ',', default_value = "u32")]
    #[arg(help_heading = "Method")]
    storage: Vec<Storage>,

    /// Time rivals on the processor as well: an exact scanline search on one core and on all, and a k-d tree
    /// of the photons (edges zero only).
    #[arg(long)]
    #[arg(help_heading = "Method")]
    rivals: bool,

    /// How often: 5 sets of up to 100 samples, or the thesis's 5 sets of up to 1000; slow cases take fewer
    /// [default: short].
    #[arg(long, value_enum)]
    #[arg(help_heading = "Time")]
    protocol: Option<ProtocolName>,

    /// Time to share out among all cases, such as 90s or 5m [default: 60s, 3m for --suite fast, 60s for each
    /// size and number of photons of --suite picture, or 10m for the thesis's protocol].
    #[arg(long, value_parser = duration, allow_negative_numbers = true)]
    #[arg(help_heading = "Time")]
    budget: Option<Duration>,

    /// Write every sample to this file, anew after each case, or after each round of --suite picture.
    #[arg(long, value_name = "FILE")]
    #[arg(help_heading = "Input and output")]
    json: Option<PathBuf>,

    /// Write a row for each case to this file.
    #[arg(long, value_name = "FILE")]
    #[arg(help_heading = "Input and output")]
    csv: Option<PathBuf>,

    /// Go on with a file that --json wrote, and keep writing to it; the other options have to be the same
    /// again, except the budget, which is a new one.
    #[arg(long, value_name = "FILE", conflicts_with = "json")]
    #[arg(help_heading = "Input and output")]
    resume: Option<PathBuf>,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    device: DeviceChoice,

    /// Time nothing, but compare two files that --json wrote: medians differ if all sets of one lie beyond
    /// all of the other, and by 3 % or more.
    #[arg(long, num_args = 2, value_names = ["OLD.json", "NEW.json"], exclusive = true)]
    #[arg(help_heading = "Input and output")]
    compare: Option<Vec<PathBuf>>,
}

/// Options that a suite fixes.
const FIXED_BY_SUITE: [&str; 10] = [
    "maps",
    "channel",
    "methods",
    "searches",
    "max_radius",
    "min_photons",
    "edges",
    "sat_build",
    "sat_samples",
    "storage",
];

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum SuiteName {
    /// What the fast path costs, on five kinds of maps, against copies and the thesis's best.
    Fast,
    /// What the stages of a picture cost in the glass Cornell box, against its photons drawn as points.
    Picture,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum ProtocolName {
    /// 5 sets of up to 100 samples.
    Short,
    /// 5 sets of up to 1000 samples (5.1).
    Thesis,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    if let Some([old, new]) = args.compare.as_deref() {
        table::print_comparison(&Report::load(old)?, &Report::load(new)?)?;
        return Ok(Outcome::Done);
    }
    if let Some(SuiteName::Picture) = args.suite {
        return picture::run(args);
    }
    if args.photons.is_some() {
        bail!(
            "--photons is not possible with --suite fast\nhelp: it takes --sizes, --build-sizes, \
             --rivals and --protocol"
        );
    }
    // What can be refused without timing is refused first.
    let json = args.json.as_ref().or(args.resume.as_ref());
    for path in [json, args.csv.as_ref()].into_iter().flatten() {
        check_writable(path)?;
    }
    let earlier = args.resume.as_deref().map(Report::load).transpose()?;
    let settings = settings(args);
    let gl = device::open(&args.device)?;
    let maps = match &settings.suite {
        Some(suite) => suite.maps(),
        None => maps(args, gl.info().max_texture_size)?,
    };
    if let (Some(earlier), Some(path)) = (&earlier, &args.resume) {
        earlier.check_resumable(path, &bench::empty_report(&gl, &settings, &maps))?;
    }

    let bar = progress_bar();
    let mut saver =
        Saver { json, csv: args.csv.as_ref(), took: Duration::ZERO, is_saved: args.resume.is_some() };
    let mut autosave = Autosave::new(Duration::ZERO);
    let report = bench::run(&gl, &settings, &maps, earlier, &mut |report, progress| {
        show(&bar, progress);
        autosave.save_if_due(|| saver.save(report));
        autosave.wait(20 * saver.took);
        Ok(())
    })?;
    bar.finish_and_clear();
    let last_save = saver.save(&report);
    table::print_report(&report, json.map(PathBuf::as_path))?;
    targets::print(&report.targets, targets::MEDIANS)?;
    let resume = if saver.is_saved { RESUME } else { Resume::Anew };
    last_save.map_err(|error| how_to_go_on(error, &resume))?;
    if !report.runs.iter().any(|run| run.case.method.is_some()) {
        bail!("no method was timed; the reasons are above");
    }
    Ok(Outcome::Done)
}

fn settings(args: &Args) -> BenchSettings {
    let minute = Duration::from_mins(1);
    let short = if args.suite.is_some() { 3 * minute } else { minute };
    let protocol = match args.protocol.unwrap_or(ProtocolName::Short) {
        ProtocolName::Short => Protocol::within(args.budget.unwrap_or(short)),
        ProtocolName::Thesis => Protocol::thesis(args.budget.unwrap_or(10 * minute)),
    };
    let rivals = if args.rivals { Rival::ALL.to_vec() } else { Vec::new() };
    if let Some(SuiteName::Fast) = args.suite {
        let of = |sizes: &Vec<UVec2>| sizes.iter().map(UVec2::to_array).collect();
        let build_sizes = args.build_sizes.as_ref().map_or_else(|| FastSuite::default().build_sizes, of);
        let suite = FastSuite { sizes: of(&args.sizes), build_sizes };
        return BenchSettings { rivals, ..BenchSettings::fast(suite, protocol) };
    }
    BenchSettings {
        methods: args.methods.clone(),
        sat_builds: args.sat_build.clone(),
        sat_samples: args.sat_samples.clone(),
        storages: args.storage.clone(),
        searches: args.searches.clone(),
        min_photons: args.min_photons.clone(),
        max_radius: args.max_radius.clone(),
        edges: args.edges.clone(),
        rivals,
        ..BenchSettings::new(protocol)
    }
}

/// Kinds in each size, files in their own; small ones first, so that a short budget leaves out the large
/// ones.
fn maps(args: &Args, max_side: u32) -> Result<Vec<MapSource>> {
    let mut maps = Vec::new();
    for map in &args.maps {
        let kind = map.to_str().and_then(|name| Kind::from_str(name, false).ok());
        if let Some(kind) = kind {
            maps.extend(args.sizes.iter().map(|&size| MapSource::synthetic(kind, size, 1)));
        } else {
            maps.push(MapSource::given(map.display().to_string(), read_map(args, map, max_side)?));
        }
    }
    maps.sort_by_key(|map| map.size().x * map.size().y);
    Ok(maps)
}

fn read_map(args: &Args, map: &Path, max_side: u32) -> Result<varikernel::Image<u32>> {
    let options = ReadOptions { channel: args.channel.as_deref(), max_side, ..ReadOptions::default() };
    read_counts(map, &options).with_context(|| {
        let kinds = Kind::value_variants().iter().filter_map(clap::ValueEnum::to_possible_value);
        let kinds: Vec<_> = kinds.map(|kind| kind.get_name().to_owned()).collect();
        format!("--map {}: neither a readable file nor one of {}", map.display(), kinds.join(", "))
    })
}

fn parse_size(text: &str) -> Result<UVec2> {
    if text.contains('x') {
        super::synth::parse_size(text)
    } else {
        let side: u32 = text.parse().context("write a side as 512, or both as 640x480")?;
        super::synth::parse_size(&format!("{side}x{side}"))
    }
}

/// Hidden where stderr is no terminal.
fn progress_bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} sets, {prefix}\n{msg}");
    let bar = ProgressBar::new(0);
    bar.with_style(style.unwrap_or_else(|error| unreachable!("a fixed template: {error}")))
}

fn show(bar: &ProgressBar, progress: &Progress) {
    bar.set_length(progress.sets as u64);
    bar.set_position(progress.sets_done as u64);
    // Sets differ too much in length to estimate the end from their number; the budget is a sure bound.
    bar.set_prefix(format!("at most {} s left", progress.budget_left.as_secs() + 1));
    bar.set_message(progress.case.clone());
}

/// How to go on with what --json wrote.
const RESUME: Resume = Resume::Instead { of: "--json", option: "--resume" };

/// Writes the files after each case, unless writing would take more than a twentieth of the time.
struct Saver<'a> {
    json: Option<&'a PathBuf>,
    csv: Option<&'a PathBuf>,
    took: Duration,
    /// Whether there is something to go on with.
    is_saved: bool,
}

impl Saver<'_> {
    fn save(&mut self, report: &Report) -> varikernel::Result<()> {
        let start = Instant::now();
        if let Some(path) = self.json {
            report.save(path)?;
            self.is_saved = true;
        }
        self.csv.map_or(Ok(()), |path| report.save_csv(path))?;
        self.took = start.elapsed();
        Ok(())
    }
}
