//! Every golden image and every reference picture by both paths of the GPU, against the CPU's picture of the same scene.

use std::path::Path;

use tetrascope::{Backend, Choice, Error, GpuError, GpuPath, LinearImage, SceneFile, Silent, render_scene};
use tetrascope_tests::compare::difference;
use tetrascope_tests::golden::{SCENES, folder};
use tetrascope_tests::{gpu, shared};

/// What a path is held to.
struct Way {
    path: GpuPath,
    target_bits: Option<u32>,
    within: f64,
}

const WAYS: [Way; 3] = [
    Way { path: GpuPath::Compute, target_bits: None, within: 2e-5 },
    Way { path: GpuPath::Triangles, target_bits: Some(32), within: 3e-4 },
    Way { path: GpuPath::Triangles, target_bits: Some(16), within: 1e-2 },
];

/// A scene in which pictures may differ by more in some pixels.
struct Allowance {
    name: &'static str,
    /// Share of the pixels.
    share: f64,
    why: &'static str,
}

const ALLOWANCES: &[Allowance] = &[Allowance {
    name: "cyclic",
    // One pixel.
    share: 2e-5,
    why: "needles twenty times as long as thick, whose planes are known to f32 relative to their length: as the hard case \"cycles\" has it",
}];

fn draw(scene: &SceneFile, base: &Path, backend: Backend, way: Option<&Way>) -> Result<LinearImage, Error> {
    let mut scene = scene.clone();
    scene.quality.backend = Choice::Named(backend);
    if let Some(way) = way {
        scene.quality.adapter = Some(gpu::adapter());
        scene.quality.gpu_path = Some(Choice::Named(way.path));
        scene.quality.target_bits = way.target_bits;
    }
    Ok(render_scene(&scene, base, &Silent)?.image)
}

/// Draws a scene in every way and says what is too far from the CPU's picture.
fn check(name: &str, base: &Path, path: &Path, failures: &mut Vec<String>) {
    let text = std::fs::read_to_string(path).unwrap();
    let scene = SceneFile::parse(&text, path).unwrap();
    let expected = draw(&scene, base, Backend::Cpu, None).unwrap();
    for way in &WAYS {
        let label = format!("{name}, {} {}", way.path, way.target_bits.map_or(String::new(), |bits| bits.to_string()));
        let drawn = match draw(&scene, base, Backend::Gpu, Some(way)) {
            Ok(drawn) => drawn,
            // What a path cannot do it says, and does not draw something else.
            Err(Error::Gpu(GpuError::TrianglesCannotSort)) if way.path == GpuPath::Triangles => {
                println!("{label}: pixels are to sort, which triangles cannot");
                continue;
            }
            Err(Error::Scene(problem)) if way.path == GpuPath::Compute => {
                println!("{label}: {problem}");
                continue;
            }
            Err(error) => {
                failures.push(format!("{label}: {error}"));
                continue;
            }
        };
        let found = difference(&drawn, &expected, way.within, &[]);
        let share = found.beyond as f64 / drawn.pixels().len() as f64;
        println!(
            "{label}: largest {:.2e} at {:?}, opacity {:.2e}, rms {:.2e}, {} pixels beyond {:.0e}",
            found.largest, found.at, found.opacity, found.rms, found.beyond, way.within
        );
        let allowed = ALLOWANCES.iter().find(|allowance| allowance.name == name);
        if share > allowed.map_or(0.0, |allowance| allowance.share) {
            failures.push(format!(
                "{label}: {:.2e} at {:?}, {} pixels beyond {:.0e} ({})",
                found.largest,
                found.at,
                found.beyond,
                way.within,
                allowed.map_or("none may be", |allowance| allowance.why)
            ));
        }
    }
}

#[test]
fn gpu_golden_images() {
    if gpu::gpu("gpu_golden_images").is_none() {
        return;
    }
    let mut failures = Vec::new();
    for scene in SCENES {
        let path = folder().join(format!("{}.toml", scene.name));
        check(scene.name, &folder(), &path, &mut failures);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn gpu_reference_pictures() {
    let Some(shared) = shared::folder("gpu_reference_pictures") else { return };
    if gpu::gpu("gpu_reference_pictures").is_none() {
        return;
    }
    let base = shared.join("reference");
    let mut failures = Vec::new();
    for name in ["cube5", "cyclic", "block", "fire", "bluntfin", "bluntfin-inside", "bluntfin-isosurfaces", "combustor"]
    {
        check(name, &base, &base.join(format!("{name}.toml")), &mut failures);
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
