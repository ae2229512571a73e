//! The shared Exodus files: forms, steps and the shape of their cells. Counts and ranges are the crate's test of all shared files.

use tetrascope_mesh::{DataArray, decompose};

use crate::shared::shared;
use crate::{ReadOptions, StepChoice, read_mesh};

/// Name, form, times.
const FILES: &[(&str, &str, usize)] = &[
    ("biplane_rms_pressure_bs.exo", "NetCDF-4", 1),
    ("box-noglom.ex2", "CDF-2", 1),
    ("disk_out_ref.ex2", "CDF-1", 1),
    ("edgeFaceElem.exii", "CDF-2", 2),
    ("mesh_fs8.exo", "CDF-2", 0),
    ("mug.e", "CDF-2", 21),
];

fn range(array: &DataArray) -> (f64, f64) {
    let values = array.values.to_f64();
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

#[test]
fn shared_files_have_their_steps_and_upright_cells() {
    let Some(folder) = shared("data/exodus") else { return };
    for &(name, form, times) in FILES {
        let loaded = read_mesh(&folder.join(name), &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        assert!(loaded.format.contains(form), "{name}: {}", loaded.format);
        assert_eq!((loaded.times.len(), loaded.step), (times, times.saturating_sub(1)), "{name}");
        // Quadratic cells in a wrong order of nodes would be crumpled.
        let cut = decompose(&loaded.dataset).unwrap();
        assert_eq!((cut.counts.inverted, cut.counts.no_volume, cut.counts.malformed), (0, 0, 0), "{name}");
    }
}

#[test]
fn shared_steps_differ() {
    let Some(folder) = shared("data/exodus") else { return };
    let at = |step| {
        let options = ReadOptions { step, ..ReadOptions::default() };
        read_mesh(&folder.join("mug.e"), &options)
    };
    let first = at(StepChoice::Number(0)).unwrap();
    assert_eq!(first.step, 0);
    assert!(first.dataset.point_arrays.iter().all(|array| range(array) == (0.0, 0.0)));
    let last = at(StepChoice::Time(first.times[20])).unwrap();
    assert_eq!(last.step, 20);
    let (low, high) = range(&last.dataset.point_arrays[0]);
    assert!(low == 0.0 && (high - 1.0).abs() < 1e-12, "{low} .. {high}");
    assert!(at(StepChoice::Number(21)).unwrap_err().to_string().contains("the file has 21"));
}
