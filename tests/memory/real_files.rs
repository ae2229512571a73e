//! The files beside the repository.

use tetrascope::{ReadOptions, SceneFile, Volume, read_mesh};
use tetrascope_tests::shared;

use crate::{alone, counted};

/// No hostile file is large, and no larger one stands behind it.
const MOST: usize = 256 << 20;

#[test]
fn hostile_files_stay_below_256_mib() {
    let _alone = alone();
    let Some(folder) = shared::folder("hostile files in memory") else { return };
    let mut worst = (0, String::new());
    for entry in std::fs::read_dir(folder.join("data/hostile")).unwrap() {
        let path = entry.unwrap().path();
        let solution = path.with_extension("q");
        let is_grid = path.extension().is_some_and(|e| e == "xyz") && solution.is_file();
        let (bytes, result) =
            counted(|| read_mesh(&path, &ReadOptions::with_solution(is_grid.then_some(solution.as_path()))));
        println!("{}: {bytes} bytes, read: {}", path.display(), result.is_ok());
        assert!(bytes < MOST, "{}: {bytes}", path.display());
        if bytes > worst.0 {
            worst = (bytes, path.display().to_string());
        }
        // The same for all that is done before anything is drawn.
        if let Ok(loaded) = result
            && let Ok(volume) = Volume::from_dataset(loaded.dataset, "hostile")
        {
            let (bytes, _) =
                counted(|| volume.field(None).map(|field| SceneFile::of_mesh("hostile").complete(&field.facts)));
            assert!(bytes < MOST, "{}: {bytes}", path.display());
        }
    }
    println!("the most: {} bytes by {}", worst.0, worst.1);
}

/// Real files, compressed ones among them, are far from every limit: none of them is refused for it.
#[test]
fn real_files_are_within_the_limits() {
    let _alone = alone();
    let Some(folder) = shared::folder("real files in memory") else { return };
    for name in ["vtu", "vtu/encodings", "vtk", "exodus", "gmsh", "volume"] {
        for entry in std::fs::read_dir(folder.join("data").join(name)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                continue;
            }
            let length = std::fs::metadata(&path).unwrap().len();
            let (bytes, result) = counted(|| read_mesh(&path, &ReadOptions::default()));
            if let Err(error) = &result {
                assert!(!error.to_string().contains("limit"), "{error}");
            }
            println!(
                "{}: {length} bytes, {bytes} allocated ({:.1} times)",
                path.display(),
                bytes as f64 / length as f64
            );
        }
    }
}
