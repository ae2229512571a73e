//! What an animation's folder says of itself, so that an interrupted one goes on with the same numbers.

use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};
use tetrascope::{SceneFile, is_builtin, resolve_path, short, write_bytes};

use super::{AnimateArgs, Shown};
use crate::Failure;

/// The record's file.
pub(super) const NAME: &str = "animation.json";

/// What was asked for and what was chosen.
#[derive(Clone, Debug)]
pub(super) struct Record {
    /// [`asked_text`].
    pub(super) asked: String,
    /// With numbers that are the same for all frames.
    pub(super) scene: SceneFile,
    /// The field's full name.
    pub(super) field: String,
    /// Its lowest and highest value over all time steps; nothing where they were not looked at, as the scene leaves nothing open.
    pub(super) range: Option<[f64; 2]>,
    /// Time steps that are shown.
    pub(super) steps: Vec<Shown>,
    /// Frames by their files' names.
    pub(super) frames: Vec<FrameFile>,
}

/// One frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct FrameFile {
    /// Its name in the folder.
    pub(super) file: String,
    /// Which of the record's time steps it shows.
    pub(super) step: usize,
    /// How far the camera has turned, degrees.
    pub(super) turned: f64,
}

/// A record as it is written. Numbers of the scene are in TOML, whose reader gives the same floats back to the last bit.
#[derive(Serialize, Deserialize)]
struct Written {
    tetrascope: String,
    asked: String,
    field: String,
    range: Option<[f64; 2]>,
    steps: Vec<Shown>,
    frames: Vec<FrameFile>,
    scene: String,
}

impl Record {
    /// Writes it into the folder.
    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let path = folder.join(NAME);
        let scene = self.scene.to_toml().map_err(tetrascope::Error::WriteScene)?;
        let written = Written {
            tetrascope: env!("CARGO_PKG_VERSION").to_owned(),
            asked: self.asked.clone(),
            field: self.field.clone(),
            range: self.range,
            steps: self.steps.clone(),
            frames: self.frames.clone(),
            scene,
        };
        let text = serde_json::to_string_pretty(&written)
            .map_err(|error| Failure::Input(format!("{}: cannot be written: {error}", path.display())))?;
        Ok(write_bytes(&path, text.as_bytes()).map_err(tetrascope::Error::Io)?)
    }

    /// Removes files that have the names of its frames and are none of them, where that was asked for: what is there counts as drawn.
    pub(super) fn make_way(&self, args: &AnimateArgs) -> Result<(), Failure> {
        for path in self.frames.iter().map(|frame| args.output.join(&frame.file)) {
            if args.restart {
                remove(&path)?;
            } else if path.exists() {
                return Err(in_the_way(&path));
            }
        }
        Ok(())
    }

    /// The times of the steps, where files know them.
    pub(super) fn times(&self) -> Vec<f64> {
        self.steps.iter().filter_map(|step| step.time).collect()
    }

    /// ", times 0 to 2", or nothing.
    pub(super) fn times_text(&self) -> String {
        match self.times().as_slice() {
            [] => String::new(),
            [one] => format!(", time {}", short(*one)),
            [first, .., last] => format!(", times {} to {}", short(*first), short(*last)),
        }
    }
}

/// What to do about a folder that holds something else.
const REMEDY: &str = "choose another folder with -o, or draw all frames anew with --restart";

fn in_the_way(path: &Path) -> Failure {
    Failure::Input(format!("{}: it is there, with no {NAME} beside it; {REMEDY}", path.display()))
}

/// Everything that frames depend on, with the lengths and times of the files, as one text.
pub(super) fn asked_text(
    scene: &SceneFile,
    base_dir: &Path,
    shown: &[Shown],
    args: &AnimateArgs,
) -> Result<String, Failure> {
    let text = scene.to_toml().map_err(tetrascope::Error::WriteScene)?;
    let meshes = shown.iter().flat_map(|shown| [Some(&shown.path), shown.solution.as_ref()]).flatten();
    let files: Vec<String> = meshes.chain(&scene.transfer.preset).map(|path| stamp(base_dir, path)).collect();
    let AnimateArgs { frames, turn, axis, first, last, every, format, .. } = args;
    let frames = format!("{frames:?} {turn:?} {axis:?} {first:?} {last:?} {every:?} {}", format.extension());
    Ok(format!("{text}\n{}\n{frames}", files.join("\n")))
}

/// A file's path, length and time of change: another file at the same place is another animation.
fn stamp(base_dir: &Path, path: &Path) -> String {
    if is_builtin(path) {
        return path.display().to_string();
    }
    let path = resolve_path(base_dir, path);
    let there = std::path::absolute(&path).unwrap_or(path);
    // What cannot be looked at the reader will say.
    let Ok(metadata) = std::fs::metadata(&there) else { return there.display().to_string() };
    let changed = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    format!("{} {} {}", there.display(), metadata.len(), changed.map_or(0, |time| time.as_nanos()))
}

/// The record of the same animation, if the folder has one.
///
/// A folder with frames of another one is an error, unless these are to be removed.
pub(super) fn find(args: &AnimateArgs, asked: &str) -> Result<Option<Record>, Failure> {
    let folder = &args.output;
    let path = folder.join(NAME);
    let written = match std::fs::read(&path) {
        Ok(bytes) => Some(serde_json::from_slice::<Written>(&bytes)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
        Err(error) => return Err(Failure::Input(format!("{}: cannot be read: {error}", path.display()))),
    };
    match written {
        None => {
            let first = folder.join(format!("frame_0000.{}", args.format.extension()));
            if first.exists() && !args.restart {
                return Err(in_the_way(&first));
            }
            Ok(None)
        }
        Some(Ok(written)) if written.asked == asked && !args.restart => {
            // The scene in it is TOML, which the parser tells by the name.
            let scene = SceneFile::parse(&written.scene, &folder.join("animation.json: scene.toml"))
                .map_err(|error| Failure::Input(error.to_string()))?;
            let Written { asked, field, range, steps, frames, .. } = written;
            if let Some(odd) = frames.iter().find(|frame| frame.step >= steps.len() || !is_name(&frame.file)) {
                return Err(Failure::Input(format!("{}: the frame {} is none; {REMEDY}", path.display(), odd.file)));
            }
            Ok(Some(Record { asked, scene, field, range, steps, frames }))
        }
        Some(Ok(written)) if args.restart => {
            let names = written.frames.iter().map(|frame| &frame.file).filter(|name| is_name(name));
            for name in names.map(String::as_str).chain([NAME]) {
                remove(&folder.join(name))?;
            }
            Ok(None)
        }
        Some(Ok(_)) => Err(Failure::Input(format!(
            "{}: the folder holds frames of another animation: the scene, its options or its files were others; {REMEDY}",
            path.display()
        ))),
        Some(Err(_)) if args.restart => Ok(None),
        Some(Err(error)) => {
            Err(Failure::Input(format!("{}: no record of an animation: {error}; {REMEDY}", path.display())))
        }
    }
}

/// Whether a name is one that frames have: a record that somebody else wrote removes nothing else.
fn is_name(name: &str) -> bool {
    let digits = name.strip_prefix("frame_").and_then(|rest| rest.strip_suffix(".png").or(rest.strip_suffix(".exr")));
    digits.is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()))
}

fn remove(path: &PathBuf) -> Result<(), Failure> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(Failure::Input(format!("{}: cannot be removed: {error}", path.display())))
        }
        _ => Ok(()),
    }
}
