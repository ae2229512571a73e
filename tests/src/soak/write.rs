//! Writes a case as a scene that reproduces it, and reads it back.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use tetrascope::mesh::{ArrayValues, Cells};
use tetrascope::{Error, ReadOptions, SceneFile, Volume, write_bytes, write_vtu};

use super::{Case, Failure};
use crate::meshes::Tets;
use crate::ways::Way;

/// The files of a case.
#[derive(Clone, Debug)]
pub struct Written {
    /// The scene.
    pub scene: PathBuf,
    /// Its mesh.
    pub mesh: PathBuf,
    /// What is wrong with it, and how to see it.
    pub text: PathBuf,
}

/// Writes `soak-SEED.toml`, `.vtu` and `.txt` into a folder, over those that are there.
///
/// # Errors
/// [`Error::Io`] and [`Error::WriteScene`]; each file is written whole or not at all.
pub fn write_case(folder: &Path, case: &Case, failures: &[Failure]) -> Result<Written, Error> {
    tetrascope::make_folder(folder)?;
    let name = format!("soak-{}", case.seed);
    let path = |extension: &str| folder.join(&name).with_extension(extension);
    let written = Written { scene: path("toml"), mesh: path("vtu"), text: path("txt") };
    write_vtu(&written.mesh, &case.dataset())?;
    let mut scene = case.scene.clone();
    scene.mesh.path = format!("{name}.vtu").into();
    write_bytes(&written.scene, scene.to_toml()?.as_bytes())?;
    let mut text = format!("{}\n\n", case.describe());
    for failure in failures {
        let _ = writeln!(text, "{failure}");
    }
    let mut ways = vec![Way::Reference];
    for failure in failures.iter().filter(|failure| failure.way != Way::Reference) {
        if !ways.contains(&failure.way) {
            ways.push(failure.way);
        }
    }
    text.push_str("\nTo see it:\n\n");
    for way in &ways {
        let _ = writeln!(text, "tetrascope render {name}.toml {} -o {name}-{}.exr", options(*way), file_part(*way));
    }
    for way in ways.iter().skip(1) {
        let _ = writeln!(text, "tetrascope compare {name}-reference.exr {name}-{}.exr", file_part(*way));
    }
    write_bytes(&written.text, text.as_bytes())?;
    Ok(written)
}

/// The options of `tetrascope render` that ask for a way.
fn options(way: Way) -> &'static str {
    match way {
        Way::Cpu => "--backend cpu",
        Way::Reference => "--backend reference",
        Way::Compute => "--backend gpu --gpu-path compute",
        Way::Triangles => "--backend gpu --gpu-path triangles --target-bits 32",
    }
}

fn file_part(way: Way) -> &'static str {
    match way {
        Way::Cpu => "cpu",
        Way::Reference => "reference",
        Way::Compute => "compute",
        Way::Triangles => "triangles",
    }
}

/// Reads a written case; what it was made from is not known any more.
///
/// # Errors
/// [`Error`] if scene or mesh are not read, or the mesh has no array "field" of f64.
pub fn read_case(scene: &Path, seed: u64) -> Result<Case, Error> {
    let text = std::fs::read_to_string(scene)
        .map_err(|source| Error::Io(tetrascope::IoError::Read { path: scene.to_owned(), source }))?;
    let scene_file = SceneFile::parse(&text, scene)?;
    let mesh = scene.parent().unwrap_or(Path::new(".")).join(&scene_file.mesh.path);
    let dataset = Volume::load(&mesh, &ReadOptions::default())?.dataset;
    let Cells::Unstructured(cells) = &dataset.cells else {
        return Err(Error::NoSuchSample { name: mesh });
    };
    let scalars = dataset.point_arrays.iter().find(|array| array.name == "field").map(|array| &array.values);
    let Some(ArrayValues::F64(scalars)) = scalars else {
        return Err(Error::NoSuchSample { name: mesh });
    };
    let tets = Tets {
        cells: cells.connectivity.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect(),
        scalars: scalars.clone(),
        points: dataset.points,
    };
    Ok(Case {
        seed,
        mesh_kind: "read from a file",
        changes: Vec::new(),
        view_kind: "as written",
        transfer_kind: "as written",
        tets,
        scene: scene_file,
    })
}
