//! NRRD files of the shared data set, as its description has them.

use glam::DVec3;
use tetrascope_mesh::{ArrayValues, Cells};

use super::tests::sanity_check;
use crate::{Loaded, ReadOptions, read_mesh, shared::shared};

fn load(file: &str) -> Option<Loaded> {
    let path = shared(&format!("data/{file}"))?;
    Some(read_mesh(&path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}")))
}

/// File, type, range, last point, and what its warnings say.
type Row = (&'static str, &'static str, [f64; 2], [f64; 3], &'static [&'static str]);

const FILES: &[Row] = &[
    ("headsq/quarter.nhdr", "Int16", [0.0, 3926.0], [201.6, 201.6, 138.0], &["left-handed"]),
    ("headsq_quarter_gzip.nrrd", "UInt16", [0.0, 3926.0], [201.6, 201.6, 138.0], &[]),
    ("hydrogen_float_bigendian_raw.nrrd", "Float32", [0.0, 1.0], [63.0, 63.0, 63.0], &[]),
    ("neghip.nhdr", "UInt8", [0.0, 255.0], [63.0, 63.0, 63.0], &[]),
];

#[test]
fn shared_files_are_as_described() {
    for &(file, kind, range, last, warnings) in FILES {
        let Some(loaded) = load(&format!("volume/{file}")) else { return };
        sanity_check(&loaded.dataset);
        let (points, cells) = if file.contains("quarter") { (380_928, 365_148) } else { (262_144, 250_047) };
        assert_eq!(loaded.dataset.points.len(), points, "{file}");
        let Cells::Structured(blocks) = &loaded.dataset.cells else { panic!() };
        assert_eq!(blocks[0].cell_count(), cells, "{file}");
        assert!((loaded.dataset.points[points - 1] - DVec3::from(last)).length() < 1e-9, "{file}");
        let array = &loaded.dataset.point_arrays[0];
        assert_eq!((array.values.type_name(), array.components), (kind, 1), "{file}");
        let all = array.values.to_f64();
        let found =
            [all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(f64::NEG_INFINITY, f64::max)];
        assert_eq!(found, range, "{file}");
        assert_eq!(loaded.warnings.len(), warnings.len(), "{file}: {:?}", loaded.warnings);
        for (warning, words) in loaded.warnings.iter().zip(warnings) {
            assert!(warning.contains(words), "{file}: {warning}");
        }
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
