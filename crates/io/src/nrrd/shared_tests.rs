//! NRRD files of the shared data set: positions and order of the samples. Counts and ranges are the crate's test of all shared files.

use glam::DVec3;
use tetrascope_mesh::ArrayValues;

use super::tests::sanity_check;
use crate::{Loaded, ReadOptions, read_mesh, shared::shared};

fn load(file: &str) -> Option<Loaded> {
    let path = shared(&format!("data/{file}"))?;
    Some(read_mesh(&path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn shared_files_end_at_their_last_points() {
    for (file, last) in [
        ("headsq/quarter.nhdr", [201.6, 201.6, 138.0]),
        ("headsq_quarter_gzip.nrrd", [201.6, 201.6, 138.0]),
        ("hydrogen_float_bigendian_raw.nrrd", [63.0; 3]),
        ("neghip.nhdr", [63.0; 3]),
    ] {
        let Some(loaded) = load(&format!("volume/{file}")) else { return };
        sanity_check(&loaded.dataset);
        assert!((*loaded.dataset.points.last().unwrap() - DVec3::from(last)).length() < 1e-9, "{file}");
    }
}

/// The slices of the head and the one file made of them; the raw volume and its header.
#[test]
fn shared_files_of_the_same_volume_are_equal() {
    let (Some(slices), Some(one)) = (load("volume/headsq/quarter.nhdr"), load("volume/headsq_quarter_gzip.nrrd"))
    else {
        return;
    };
    let numbers = |loaded: &Loaded| loaded.dataset.point_arrays[0].values.to_f64();
    // The sums of VTK's reader, the second of samples times their index modulo 1009.
    let sums = numbers(&one)
        .iter()
        .enumerate()
        .fold((0.0, 0.0), |sums, (index, sample)| (sums.0 + sample, sums.1 + sample * (index % 1009) as f64));
    assert_eq!(sums, (193_392_317.0, 97_394_109_883.0));
    assert!(numbers(&slices) == numbers(&one) && slices.dataset.points == one.dataset.points);
    let (Some(header), Some(raw)) = (load("volume/neghip.nhdr"), load("volume/neghip_64x64x64_uint8.raw")) else {
        return;
    };
    let ArrayValues::U8(samples) = &header.dataset.point_arrays[0].values else { panic!() };
    assert!(samples.iter().any(|&sample| sample != 0));
    assert!(numbers(&header) == numbers(&raw) && header.dataset.points == raw.dataset.points);
}

#[test]
fn hostile_files_are_refused() {
    for (file, words) in [
        ("huge_sizes.nrrd", "3000000000x3000000000x3000000000 samples"),
        ("short_data.nrrd", "4096 samples"),
        ("missing_data_file.nhdr", "`does_not_exist.raw` cannot be read"),
    ] {
        let Some(path) = shared(&format!("data/hostile/{file}")) else { return };
        let error = read_mesh(&path, &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains(file) && error.contains(words), "{error}");
    }
}
