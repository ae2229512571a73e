//! Which time steps an animation shows: those of one file, or one of each of several.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use tetrascope::{MeshSection, SceneFile};

use super::{Asked, Kept};
use crate::Failure;
use crate::scene_of::scene_of_inputs;
use crate::scene_paths::is_scene;

/// One time step that is shown, or a file of which they are not known yet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Shown {
    /// The mesh file, as the scene has it.
    pub(super) path: PathBuf,
    /// PLOT3D: the solution.
    pub(super) solution: Option<PathBuf>,
    /// Which of the file's time steps; the one that the scene says if it is not there.
    pub(super) step: Option<usize>,
    /// Its time, where the file knows it.
    pub(super) time: Option<f64>,
}

impl Shown {
    /// The scene's section with this file and step in it.
    pub(super) fn section(&self, scene: &MeshSection) -> MeshSection {
        let mut section = scene.clone();
        (section.path, section.solution) = (self.path.clone(), self.solution.clone());
        if self.step.is_some() {
            (section.step, section.time) = (self.step, None);
        }
        section
    }
}

/// The scene without options, what its paths are relative to, and its mesh files.
pub(super) fn inputs_of(inputs: &[PathBuf]) -> Result<(SceneFile, PathBuf, Vec<Shown>), Failure> {
    let shown = |path: &Path, solution: Option<&Path>| Shown {
        path: path.to_owned(),
        solution: solution.map(Path::to_owned),
        step: None,
        time: None,
    };
    let is_solution = |path: &PathBuf| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("q"));
    match inputs {
        [] | [_] => {
            let (scene, base_dir) = scene_of_inputs(inputs)?;
            let one = shown(&scene.mesh.path, scene.mesh.solution.as_deref());
            Ok((scene, base_dir, vec![one]))
        }
        several if several.iter().any(|path| is_scene(path)) => {
            Err(Failure::Usage("a scene file names its mesh itself: give one scene, or meshes alone".to_owned()))
        }
        [grid, solutions @ ..] if !is_solution(grid) && solutions.iter().all(is_solution) => {
            let steps = solutions.iter().map(|solution| shown(grid, Some(solution))).collect();
            Ok((SceneFile::of_mesh(grid), PathBuf::new(), steps))
        }
        [first, ..] => {
            let steps = inputs.iter().map(|path| shown(path, None)).collect();
            Ok((SceneFile::of_mesh(first), PathBuf::new(), steps))
        }
    }
}

/// The time steps that are shown, in their order.
pub(super) fn steps_of(asked: &Asked<'_>, inputs: Vec<Shown>, kept: &mut Kept) -> Result<Vec<Shown>, Failure> {
    let mesh = &asked.scene.mesh;
    let all = match inputs.as_slice() {
        [file] if mesh.step.is_none() && mesh.time.is_none() => {
            let volume = kept.volume(asked, &inputs, 0)?;
            let (times, last) = (volume.times.clone(), volume.step);
            let step = |(step, time): (usize, f64)| Shown { step: Some(step), time: Some(time), ..file.clone() };
            if times.len() > 1 {
                // What was read without a number is the last one.
                if let Some((at, _)) = &mut kept.volume {
                    *at = last;
                }
                times.into_iter().enumerate().map(step).collect()
            } else {
                inputs
            }
        }
        _ => inputs,
    };
    let args = asked.args;
    let (first, every) = (args.first.unwrap_or(0), args.every.unwrap_or(1) as usize);
    let last = args.last.unwrap_or(usize::MAX);
    if let Some(wrong) = args.first.into_iter().chain(args.last).find(|step| *step >= all.len()) {
        let count = all.len();
        return Err(Failure::Input(format!(
            "there is no time step {wrong}: there are {count}, counted from 0; see `tetrascope info`"
        )));
    }
    let is_shown = |step: usize| (first..=last).contains(&step) && (step - first).is_multiple_of(every);
    if let Some((at, _)) = &mut kept.volume {
        // By its place among those that are shown, if it is one of them.
        *at = if is_shown(*at) { (*at - first) / every } else { usize::MAX };
    }
    let shown: Vec<Shown> =
        all.into_iter().enumerate().filter(|(step, _)| is_shown(*step)).map(|(_, shown)| shown).collect();
    if shown.is_empty() {
        return Err(Failure::Usage(format!("no time step is left from {first} to {last}")));
    }
    Ok(shown)
}
