//! Golden images: small scenes with the pictures that they gave when somebody last looked.
//!
//! In `tests/golden` every scene `NAME.toml` has its picture `NAME.exr`, in linear floats with an opacity, and some of its
//! pixels as text in `NAME.txt`. Only the f64 reference writes them ([`regenerate`]). [`check`] draws every scene with
//! the reference and with the fast renderer and compares all four channels; what fails leaves pictures to look at.
//! [`review`] shows what would change.

mod evidence;
mod probes;
mod scenes;

use std::fs;
use std::path::{Path, PathBuf};

use tetrascope::{Backend, Choice, LinearImage, SceneFile, Silent, read_exr, render_scene, write_exr};

use crate::compare::{Difference, difference};
pub use evidence::{Review, review};
pub use probes::{Probe, parse_probes, print_probes, probe};
pub use scenes::{Fast, Golden, SCENES};

/// Largest difference of the reference from its own picture. The functions of the system's math library are what differs
/// from machine to machine; their last digits are far below this.
pub const REFERENCE_WITHIN: f64 = 1e-7;

/// Most bytes of a picture: they stay in the history for ever.
pub const BYTE_BUDGET: u64 = 40 * 1024;

/// Fewest and most pixels a side.
pub const SIDES: std::ops::RangeInclusive<u32> = 64..=128;

/// The folder of scenes and pictures.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden")
}

/// Where pictures of failures and reviews go: `golden` in the build's target folder.
pub fn evidence_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
    // A relative one counts from the root of the workspace, not from this crate.
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(target).join("golden")
}

/// Draws a scene of the folder.
///
/// # Errors
/// In words, if the scene is not read or not drawn.
pub fn draw(folder: &Path, name: &str, backend: Backend) -> Result<LinearImage, String> {
    let path = folder.join(format!("{name}.toml"));
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut scene = SceneFile::parse(&text, &path).map_err(|e| e.to_string())?;
    scene.quality.backend = Choice::Named(backend);
    Ok(render_scene(&scene, folder, &Silent).map_err(|e| format!("{name}: {e}"))?.image)
}

/// The picture that a scene should give.
///
/// # Errors
/// In words, if it is missing or damaged.
pub fn stored(folder: &Path, name: &str) -> Result<LinearImage, String> {
    let path = folder.join(format!("{name}.exr"));
    if !path.is_file() {
        return Err(format!("{name}.exr is missing; look at the picture and run `cargo xtask golden regenerate`"));
    }
    read_exr(&path).map_err(|e| e.to_string())
}

/// What one scene gave.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The scene.
    pub name: &'static str,
    /// The f64 reference against the stored picture; `None` if there was nothing to compare.
    pub reference: Option<Difference>,
    /// The fast renderer against the stored picture.
    pub fast: Option<Difference>,
    /// What is wrong, with a remedy; empty if the scene is as it should be.
    pub failures: Vec<String>,
}

/// Draws every scene with both renderers and compares.
///
/// Scenes that fail leave `NAME-*.png`, `.exr` and `NAME.txt` in `evidence`; what stood there of earlier runs is removed.
pub fn check(folder: &Path, scenes: &[Golden], evidence: &Path) -> Vec<Outcome> {
    scenes.iter().map(|scene| check_scene(folder, scene, evidence)).collect()
}

fn check_scene(folder: &Path, scene: &Golden, evidence: &Path) -> Outcome {
    let name = scene.name;
    let mut outcome = Outcome { name, reference: None, fast: None, failures: Vec::new() };
    evidence::forget(evidence, name);
    let expected = match stored(folder, name) {
        Ok(expected) => expected,
        Err(problem) => {
            outcome.failures.push(problem);
            return outcome;
        }
    };
    check_file(folder, name, &expected, &mut outcome.failures);
    for backend in [Backend::Reference, Backend::Cpu] {
        let drawn = match draw(folder, name, backend) {
            Ok(drawn) => drawn,
            Err(problem) => {
                outcome.failures.push(problem);
                continue;
            }
        };
        let failure = if (drawn.width(), drawn.height()) != (expected.width(), expected.height()) {
            Some(format!(
                "is {} x {} pixels, stored are {} x {}",
                drawn.width(),
                drawn.height(),
                expected.width(),
                expected.height()
            ))
        } else if let Some(at) = drawn.pixels().iter().position(|p| p.iter().any(|c| !c.is_finite())) {
            Some(format!("pixel {} of row {} is not finite", at as u32 % drawn.width(), at as u32 / drawn.width()))
        } else {
            let limit = if backend == Backend::Reference { REFERENCE_WITHIN } else { scene.fast.limit() };
            let found = difference(&drawn, &expected, limit, &[]);
            if backend == Backend::Reference {
                outcome.reference = Some(found);
                (found.largest > limit).then(|| describe(&found, limit))
            } else {
                outcome.fast = Some(found);
                judge_fast(scene, &found)
            }
        };
        if let Some(failure) = failure {
            let failure = format!("{name} by the back end {backend}: {failure}");
            if let Err(problem) = evidence::leave(evidence, name, backend, &expected, &drawn, &failure) {
                outcome.failures.push(problem);
            }
            outcome.failures.push(failure);
        }
    }
    outcome
}

fn judge_fast(scene: &Golden, found: &Difference) -> Option<String> {
    match scene.fast {
        Fast::Within(limit) => (found.largest > limit).then(|| describe(found, limit)),
        Fast::Wrong { beyond, why } if found.largest <= beyond => Some(format!(
            "differs by {:.2e} only, where more than {beyond:.0e} was expected since {why}; if it is right now, say `Fast::Within` in the list of scenes",
            found.largest
        )),
        Fast::Wrong { .. } => None,
    }
}

fn describe(found: &Difference, limit: f64) -> String {
    format!(
        "differs by up to {:.2e} (limit {limit:.0e}) at column {}, row {}; {} pixels beyond the limit",
        found.largest, found.at.0, found.at.1, found.beyond
    )
}

/// Size, byte budget and probed pixels of a stored picture.
fn check_file(folder: &Path, name: &str, image: &LinearImage, failures: &mut Vec<String>) {
    if !SIDES.contains(&image.width()) || !SIDES.contains(&image.height()) {
        failures.push(format!("{name}: {} x {} pixels; make both sides 64 to 128", image.width(), image.height()));
    }
    match fs::metadata(folder.join(format!("{name}.exr"))) {
        Ok(file) if file.len() > BYTE_BUDGET => failures.push(format!(
            "{name}.exr has {} bytes of {BYTE_BUDGET} allowed; draw fewer pixels, or more empty ones",
            file.len()
        )),
        Ok(_) => {}
        Err(problem) => failures.push(format!("{name}.exr: {problem}")),
    }
    let path = folder.join(format!("{name}.txt"));
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(problem) => {
            failures.push(format!("{name}.txt: {problem}; run `cargo xtask golden regenerate`"));
            return;
        }
    };
    match parse_probes(&text) {
        Ok(probes) if probes.is_empty() => failures.push(format!("{name}.txt names no pixel")),
        Ok(probes) => {
            for expected in probes {
                let at = (expected.x, expected.y);
                if at.0 >= image.width() || at.1 >= image.height() {
                    failures.push(format!("{name}.txt: the pixel {at:?} is not in the picture"));
                } else if image.pixel(at.0, at.1) != expected.rgba {
                    failures.push(format!(
                        "{name}.txt says {:?} at {at:?}, {name}.exr has {:?}; run `cargo xtask golden regenerate`",
                        expected.rgba,
                        image.pixel(at.0, at.1)
                    ));
                }
            }
        }
        Err(problem) => failures.push(format!("{name}.txt: {problem}")),
    }
}

/// Draws every scene with the f64 reference and writes what differs from what is stored; gives the names of those.
///
/// # Errors
/// In words, if a scene is not drawn or a file not written; scenes before it are written then.
pub fn regenerate(folder: &Path, scenes: &[Golden]) -> Result<Vec<&'static str>, String> {
    let mut written = Vec::new();
    for scene in scenes {
        let drawn = draw(folder, scene.name, Backend::Reference)?;
        let mut changed = false;
        // A picture that differs in last digits only keeps its bytes.
        let kept = match stored(folder, scene.name) {
            Ok(old) if is_same(&old, &drawn) => old,
            _ => {
                write_exr(&folder.join(format!("{}.exr", scene.name)), &drawn).map_err(|e| e.to_string())?;
                changed = true;
                drawn
            }
        };
        let path = folder.join(format!("{}.txt", scene.name));
        let text = print_probes(&kept);
        if fs::read_to_string(&path).ok().as_deref() != Some(text.as_str()) {
            fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
            changed = true;
        }
        if changed {
            written.push(scene.name);
        }
    }
    Ok(written)
}

/// Whether two pictures are one within what machines may differ by.
fn is_same(a: &LinearImage, b: &LinearImage) -> bool {
    (a.width(), a.height()) == (b.width(), b.height())
        && a.pixels().iter().flatten().chain(b.pixels().iter().flatten()).all(|c| c.is_finite())
        && difference(a, b, REFERENCE_WITHIN, &[]).largest <= REFERENCE_WITHIN
}

#[cfg(test)]
mod tests;
