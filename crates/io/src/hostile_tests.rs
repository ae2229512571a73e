//! Broken files of the shared data set, and random bytes, through every reader.

use std::{fs, panic::catch_unwind, path::PathBuf};

use proptest::prelude::*;

use crate::{ReadOptions, Source, read_mesh, readers, shared::shared};

/// Files of `data/hostile` whose description says that they are valid, less those whose remark is on another subject.
fn valid_files() -> Option<Vec<String>> {
    let readme = fs::read_to_string(shared("data/README.md")?).unwrap();
    let name_and_text = |line: &str| {
        let mut cells = line.strip_prefix("| `hostile/")?.splitn(3, '|');
        let name = cells.next()?.trim().trim_end_matches('`').to_owned();
        cells.next().is_some_and(|text| text.trim().starts_with("valid")).then_some(name)
    };
    Some(readme.lines().filter_map(name_and_text).collect())
}

#[test]
fn every_hostile_file_ends_in_a_dataset_or_an_error() {
    let (Some(folder), Some(valid)) = (shared("data/hostile"), valid_files()) else { return };
    assert!(valid.len() >= 20, "the description has changed: {valid:?}");
    let mut wrong = Vec::new();
    let mut paths: Vec<PathBuf> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(paths.len() > 60);
    for path in paths {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let Ok(result) = catch_unwind(|| read_mesh(&path, &ReadOptions::default())) else {
            wrong.push(format!("{name}: panics"));
            continue;
        };
        match result {
            Ok(loaded) => eprintln!("{name}: {} {:?}", loaded.format, loaded.warnings),
            Err(error) => {
                eprintln!("{error}");
                if !error.to_string().contains(&name) {
                    wrong.push(format!("{name}: is not named by \"{error}\""));
                }
                let extension = &name[name.rfind('.').unwrap() + 1..];
                let readable = readers().iter().any(|reader| reader.extensions().contains(&extension));
                if valid.contains(&name) && readable {
                    wrong.push(format!("valid, but: {error}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Small real files, one of each layout family, to be damaged.
fn samples() -> Vec<Vec<u8>> {
    let files = [
        "data/plot3d/annulus_fortran_le_iblank.xyz",
        "data/hostile/q_dims_differ.xyz",
        "data/hostile/crlf.vtk",
        "data/hostile/legacy_vtk_named.msh",
        "data/hostile/no_arrays.vtu",
        "data/hostile/nan_inf_scalars_binary.vtu",
        "data/hostile/corrupt_zlib.vtu",
        "data/gmsh/sfepy_msh_tetra.msh",
        "data/hostile/huge_count.msh",
    ];
    let mut samples: Vec<_> = files.iter().filter_map(|f| shared(f)).map(|path| fs::read(path).unwrap()).collect();
    samples.push(b"2 2 2\n4*0.0 4*1.0\n2*0 2*1 2*0 2*1\n8*1.5D0\n".to_vec());
    samples.push(b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n0 0 0\n".to_vec());
    samples
}

/// Runs every reader; whether it recognizes the bytes or not.
fn read_by_all(bytes: Vec<u8>) {
    let source = Source { path: PathBuf::from("damaged"), bytes, ..Default::default() };
    for reader in readers() {
        let _ = reader.recognizes(&source.bytes);
        if let Err(error) = reader.read(&source) {
            assert!(error.to_string().contains("damaged"), "{}: {error}", reader.name());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        read_by_all(bytes);
    }

    /// Small integers in either order make headers that nearly fit.
    #[test]
    fn random_headers_never_panic(
        integers in prop::collection::vec(prop_oneof![-2_i32..12, Just(i32::MAX), Just(i32::MIN), any::<i32>()], 1..80),
        big in any::<bool>(),
    ) {
        let bytes = |i: &i32| if big { i.to_be_bytes() } else { i.to_le_bytes() };
        read_by_all(integers.iter().flat_map(bytes).collect());
    }

    #[test]
    fn damaged_files_never_panic(
        which in any::<prop::sample::Index>(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        in_header in any::<bool>(),
        kept in prop_oneof![Just(1.0), 0.0..1.0_f64],
    ) {
        let samples = samples();
        let mut bytes = which.get(&samples).clone();
        let reach = if in_header { bytes.len().min(400) } else { bytes.len() };
        for (at, byte) in flips {
            bytes[at.index(reach)] = byte;
        }
        bytes.truncate((bytes.len() as f64 * kept) as usize);
        read_by_all(bytes);
    }
}
