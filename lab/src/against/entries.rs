//! The file that names the pictures: of which scene, by what, and how long they took.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use varikernel::error::{Error, Result};

/// The ways that are none: what pictures are compared with, and the layers that tell regions apart.
const REFERENCE: &str = "reference";
const LAYERS: &str = "layers";

/// A row of the file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Record {
    scene: String,
    way: String,
    #[serde(default)]
    options: String,
    #[serde(default)]
    seed: String,
    seconds: Option<f64>,
    file: PathBuf,
}

/// A picture to judge.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Run {
    /// The renderer and its version.
    pub(super) way: String,
    /// What it was asked for.
    pub(super) options: String,
    pub(super) seed: String,
    pub(super) seconds: f64,
    pub(super) file: PathBuf,
}

/// The files of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SceneFiles {
    pub(super) scene: String,
    /// Pictures whose mean is the reference.
    pub(super) references: Vec<PathBuf>,
    pub(super) layers: Option<PathBuf>,
    pub(super) runs: Vec<Run>,
}

/// Reads the rows scene by scene, in the order of their first rows; files are found from the folder of `path`.
pub(super) fn read(path: &Path) -> Result<Vec<SceneFiles>> {
    let remedy =
        "give columns scene, way, options, seed, seconds and file, as `varikernel study --help` says";
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(path)
        .map_err(|error| Error::file(path, error.to_string(), "give the CSV file with the pictures"))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut scenes: Vec<SceneFiles> = Vec::new();
    let headers = reader.headers().map_err(|error| Error::file(path, error.to_string(), remedy))?.clone();
    for record in reader.records() {
        let record = record.map_err(|error| Error::file(path, error.to_string(), remedy))?;
        let line = record.position().map_or(0, csv::Position::line);
        let refuse = |what: &str, remedy: &str| Error::file(path, format!("line {line}: {what}"), remedy);
        let record: Record = record.deserialize(Some(&headers)).map_err(|error| match error.kind() {
            csv::ErrorKind::Deserialize { err, .. } => refuse(&err.to_string(), remedy),
            _ => refuse(&error.to_string(), remedy),
        })?;
        if record.scene.is_empty() || record.way.is_empty() {
            return Err(refuse("the scene or the way has no name", remedy));
        }
        let index = scenes.iter().position(|one| one.scene == record.scene).unwrap_or_else(|| {
            let scene = record.scene.clone();
            scenes.push(SceneFiles { scene, references: Vec::new(), layers: None, runs: Vec::new() });
            scenes.len() - 1
        });
        let of_scene = &mut scenes[index];
        let file = folder.join(&record.file);
        match record.way.as_str() {
            REFERENCE => of_scene.references.push(file),
            LAYERS if of_scene.layers.is_some() => {
                return Err(refuse("the scene has layers already", "give one picture with layers a scene"));
            }
            LAYERS => of_scene.layers = Some(file),
            _ => {
                let seconds = record.seconds.filter(|seconds| *seconds > 0.0 && seconds.is_finite());
                let seconds = seconds.ok_or_else(|| {
                    refuse("no seconds", "say in the column `seconds` how long the picture took, above 0")
                })?;
                let Record { way, options, seed, .. } = record;
                of_scene.runs.push(Run { way, options, seed, seconds, file });
            }
        }
    }
    for SceneFiles { scene, references, runs, .. } in &scenes {
        if references.is_empty() {
            let remedy = "add a row with the way `reference` and a picture that is right";
            return Err(Error::file(path, format!("the scene {scene} has no reference"), remedy));
        }
        if runs.is_empty() {
            return Err(Error::file(path, format!("the scene {scene} has no picture to judge"), "add a row"));
        }
    }
    if scenes.is_empty() {
        return Err(Error::file(path, "it names no picture", remedy));
    }
    Ok(scenes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Vec<SceneFiles>> {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("runs.csv");
        std::fs::write(&path, text).unwrap();
        let strip = |file: &PathBuf| file.strip_prefix(folder.path()).unwrap().to_owned();
        read(&path).map(|mut scenes| {
            for scene in &mut scenes {
                scene.references = scene.references.iter().map(strip).collect();
                scene.layers = scene.layers.as_ref().map(strip);
                scene.runs.iter_mut().for_each(|run| run.file = strip(&run.file));
            }
            scenes
        })
    }

    #[test]
    fn rows_are_read_scene_by_scene() {
        let found = of("# made by hand\nscene,way,options,seed,seconds,file\n\
                        box, reference, , , , a.exr\nglass,reference,,,,b.exr\n\
                        box,layers,,,,c.exr\nbox,\"other 1.0, fast\",spp 4,7,0.5,d.exr\nglass,ours,,,2,e.exr\n")
        .unwrap();
        let run = |way: &str, options: &str, seed: &str, seconds, file: &str| Run {
            way: way.to_owned(),
            options: options.to_owned(),
            seed: seed.to_owned(),
            seconds,
            file: file.into(),
        };
        let expected = [
            SceneFiles {
                scene: "box".to_owned(),
                references: vec!["a.exr".into()],
                layers: Some("c.exr".into()),
                runs: vec![run("other 1.0, fast", "spp 4", "7", 0.5, "d.exr")],
            },
            SceneFiles {
                scene: "glass".to_owned(),
                references: vec!["b.exr".into()],
                layers: None,
                runs: vec![run("ours", "", "", 2.0, "e.exr")],
            },
        ];
        assert_eq!(found, expected);
        // Columns that may be left out.
        assert!(of("scene,way,seconds,file\na,reference,,r.exr\na,w,1,p.exr\n").is_ok());
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, words) in [
            ("", "it names no picture"),
            ("scene,way,seconds,file\n", "it names no picture"),
            ("scene,way,seconds,file\na,reference,,r.exr\n", "a has no picture"),
            ("scene,way,seconds,file\na,w,1,r.exr\n", "a has no reference"),
            ("scene,way,seconds,file\na,reference,,r.exr\na,w,,p.exr\n", "line 3: no seconds"),
            ("scene,way,seconds,file\na,reference,,r.exr\na,w,-1,p.exr\n", "line 3: no seconds"),
            ("scene,way,seconds,file\na,reference,,r.exr\na,w,fast,p.exr\n", "line 3"),
            ("scene,way,seconds,file\na,reference,,r.exr\na,w,1\n", "line: 3"),
            ("scene,way,file\na,reference,r.exr\n,w,p.exr\n", "line 3: the scene or"),
            ("scene,way,time,file\na,reference,,r.exr\n", "time"),
            ("scene,way,seconds,file\na,layers,,r.exr\na,layers,,p.exr\n", "line 3: the scene has layers"),
        ] {
            let error = of(text).expect_err(text).to_string();
            assert!(error.contains(words) && error.contains("help: "), "{text}: {error}");
        }
        let absent = read(Path::new("/nowhere/runs.csv")).unwrap_err().to_string();
        assert!(absent.contains("/nowhere/runs.csv"), "{absent}");
    }
}
