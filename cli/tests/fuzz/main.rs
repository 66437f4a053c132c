//! Malformed files: no reader panics, hangs or takes gigabytes of memory for them.
//!
//! Each reader gets some changed seeds whose choice is always the same. `.ci/fuzz` runs each for a minute,
//! and each time with others: VARIKERNEL_FUZZ_SECONDS says for how long. A file at which a reader fails stays
//! in the folder that the failure names.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![expect(clippy::print_stdout, reason = "`.ci/fuzz` tells how far it came")]

mod mutation;
mod readers;

use std::env;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use mutation::Mutator;
use readers::{READERS, Reader};

/// Files for each reader without VARIKERNEL_FUZZ_SECONDS; fewer for the one that starts a process each time.
const FILES: u32 = 1000;
const FILES_OF_PROGRAM: u32 = 8;
/// A file of a few kilobytes that takes longer than this has found a loop.
const LONGEST: Duration = Duration::from_secs(20);
/// All readers together, in KiB of resident memory.
const MOST_MEMORY: u64 = 3 << 20;

/// Files below a folder of the repository.
fn seeds(reader: &Reader) -> Vec<Vec<u8>> {
    fn collect(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(&path, extension, found);
            } else if path.extension().is_some_and(|found| found == extension) {
                found.push(path);
            }
        }
    }
    let mut files = Vec::new();
    for (folder, extension) in reader.seeds {
        collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder), extension, &mut files);
    }
    files.sort();
    assert!(!files.is_empty(), "{}: no seed", reader.name);
    files.iter().map(|file| fs::read(file).unwrap()).collect()
}

fn round(name: &str) {
    let reader = READERS.iter().find(|reader| reader.name == name).unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz").join(name);
    fs::create_dir_all(&folder).unwrap();
    for (file, content) in reader.beside {
        fs::write(folder.join(file), content).unwrap();
    }
    let path = folder.join(reader.file);
    let seeds = seeds(reader);
    let limit =
        env::var("VARIKERNEL_FUZZ_SECONDS").ok().map(|seconds| Duration::from_secs(seconds.parse().unwrap()));
    let seed = match limit {
        Some(_) => u64::try_from(SystemTime::UNIX_EPOCH.elapsed().unwrap().as_millis()).unwrap(),
        None => 1,
    };
    let mut mutator = Mutator::new(seed);
    let files = if name == "window_settings" { FILES_OF_PROGRAM } else { FILES };
    let begun = Instant::now();
    let mut done = 0;
    // The seeds themselves come first.
    let mut unchanged = seeds.iter();
    while limit.map_or(done < files, |limit| begun.elapsed() < limit) {
        let bytes = unchanged.next().cloned().unwrap_or_else(|| mutator.file(&seeds));
        fs::write(&path, &bytes).unwrap();
        let started = Instant::now();
        let ended = catch_unwind(AssertUnwindSafe(|| (reader.read)(&path)));
        let took = started.elapsed();
        if ended.is_err() || took > LONGEST {
            let kept = folder.join(format!("failed-{seed}-{done}-{}", reader.file));
            fs::write(&kept, &bytes).unwrap();
            panic!(
                "{name}: {} after {took:?}: {}",
                if ended.is_err() { "a panic" } else { "slow" },
                kept.display()
            );
        }
        done += 1;
    }
    println!("{name}: {done} files, {} seeds, {:.1} s", seeds.len(), begun.elapsed().as_secs_f64());
    check_memory(name);
}

/// The most memory that this process has held.
fn check_memory(name: &str) {
    // Linux only; elsewhere there is no such file.
    let Ok(status) = fs::read_to_string("/proc/self/status") else { return };
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    let kibibytes: u64 = peak.split_whitespace().next().unwrap().parse().unwrap();
    assert!(kibibytes < MOST_MEMORY, "{name}: {kibibytes} KiB");
}

macro_rules! rounds {
    ($($test:ident: $name:literal),* $(,)?) => {
        $(#[test]
        fn $test() {
            round($name);
        })*

        #[test]
        fn every_reader_has_a_round() {
            assert_eq!([$($name),*], READERS.map(|reader| reader.name));
        }
    };
}

rounds! {
    exr: "exr",
    npy: "npy",
    png: "png",
    obj: "obj",
    mtl: "mtl",
    gltf: "gltf",
    glb: "glb",
    scene: "scene",
    window_settings: "window_settings",
    bench: "bench",
    reproduction: "reproduction",
    study: "study",
    texture: "texture",
}

#[test]
fn changed_files_differ_and_repeat() {
    let seeds = vec![b"v 1 2 3\nf 1 2 3\n".to_vec()];
    let files = |seed| {
        let mut mutator = Mutator::new(seed);
        (0..50).map(|_| mutator.file(&seeds)).collect::<Vec<_>>()
    };
    assert_eq!(files(7), files(7));
    assert!(files(7) != files(8));
    let changed = files(7).iter().filter(|file| **file != seeds[0]).count();
    assert!(changed > 45, "{changed} of 50");
}

#[test]
fn a_reader_that_panics_is_seen() {
    let reader = |path: &Path| {
        let bytes = fs::read(path).unwrap();
        assert!(!bytes.contains(&b'9'), "a nine");
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    let seeds = vec![b"1 22 333 4444".to_vec()];
    let mut mutator = Mutator::new(3);
    let found = (0..2000).any(|_| {
        fs::write(&path, mutator.file(&seeds)).unwrap();
        catch_unwind(AssertUnwindSafe(|| reader(&path))).is_err()
    });
    assert!(found, "no nine in 2000 files");
}
