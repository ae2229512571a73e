//! `tetrascope` with no arguments: draws the built-in sample and says what to do next.

use std::path::{Path, PathBuf};

use tetrascope::SceneFile;

use crate::Failure;
use crate::render::{DEFAULT_OUTPUT, Job};
use crate::report::line;

/// The scene, as a user would write it.
const SCENE: &str = include_str!("sample.toml");

pub(crate) fn run() -> Result<(), Failure> {
    line("Drawing the built-in sample: the distance from a sphere on a coarse mesh. Its opacity is 0 except in three");
    line("thin intervals, each a fraction of what one cell spans: sampling at the cells' corners would miss them.\n");
    let scene = SceneFile::parse(SCENE, Path::new("sample.toml")).map_err(|e| Failure::Input(e.to_string()))?;
    let outputs = [PathBuf::from(DEFAULT_OUTPUT)];
    let base_dir = PathBuf::new();
    Job {
        scene,
        scene_path: None,
        base_dir,
        outputs: &outputs,
        write_scene: None,
        threads: None,
        quiet: false,
        json: false,
        explain: false,
        verify: false,
        error_map: None,
    }
    .run()?;
    line("\nTry next:");
    line("  tetrascope info FILE                                    what is in a mesh file");
    line("  tetrascope render FILE                                  draw it with defaults that fit");
    line("  tetrascope render builtin:rings --write-scene my.toml   a scene file to edit");
    line("  tetrascope render --help                                everything else");
    Ok(())
}
