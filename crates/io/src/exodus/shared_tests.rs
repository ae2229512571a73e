//! The shared Exodus files: what their description says of them.

use std::collections::BTreeMap;

use tetrascope_mesh::{CellKind, Cells, DataArray, decompose};

use crate::shared::shared;
use crate::{ReadOptions, StepChoice, read_mesh};

/// Name, form, points, cells by kind, tetrahedra that are cut, times, arrays.
type Row = (&'static str, &'static str, usize, &'static [(CellKind, usize)], usize, usize, &'static [Array]);
/// Owner, name, components, range at the last step to six digits.
type Array = (&'static str, &'static str, usize, f64, f64);

/// A hexahedron is cut into six here; VTK's filter of the description gives as many.
const FILES: &[Row] = &[
    (
        "biplane_rms_pressure_bs.exo",
        "NetCDF-4",
        774,
        &[
            (CellKind::Tetrahedron, 3),
            (CellKind::Hexahedron, 8),
            (CellKind::QuadraticTetrahedron, 6),
            (CellKind::QuadraticHexahedron, 28),
            (CellKind::Flat, 652),
            (CellKind::FlatOf(22), 30),
            (CellKind::FlatOf(23), 14),
        ],
        3 + 6 * 8 + 8 * 6 + 48 * 28,
        1,
        &[("cell", "ObjectId", 1, 1.0, 201.0)],
    ),
    (
        "box-noglom.ex2",
        "CDF-2",
        27,
        &[(CellKind::Tetrahedron, 40)],
        40,
        1,
        &[
            ("point", "First Point Array", 1, 0.0, 1e-15),
            ("point", "Second Point Array", 1, 0.0, 0.0),
            ("point", "Third Point Array", 1, 0.0, 0.0),
            ("cell", "First Cell Array", 1, 0.0, 0.0807692),
            ("cell", "Second Cell Array", 1, 0.0, 0.0346154),
            ("cell", "Third Cell Array", 1, 0.0, 0.0346154),
            ("cell", "Fourth Cell Array", 1, 0.0, 0.0),
            ("cell", "Fifth Cell Array", 1, 0.0, 0.0),
            ("cell", "Sixth Cell Array", 1, 0.0, 0.0),
        ],
    ),
    (
        "disk_out_ref.ex2",
        "CDF-1",
        8499,
        &[(CellKind::Hexahedron, 7472)],
        44_832,
        1,
        &[
            ("point", "Temp", 1, 293.15, 913.15),
            ("point", "V", 3, -21.126, 19.9491),
            ("point", "Pres", 1, 0.00678552, 0.0288185),
            ("point", "AsH3", 1, 0.0804768, 0.184839),
            ("point", "GaMe3", 1, 0.000222844, 0.00721393),
            ("point", "CH4", 1, 0.0, 0.00117024),
            ("point", "H2", 1, 0.807613, 0.917688),
        ],
    ),
    (
        "edgeFaceElem.exii",
        "CDF-2",
        12,
        &[(CellKind::Tetrahedron, 1), (CellKind::Hexahedron, 2)],
        13,
        2,
        &[
            ("point", "RHO", 1, 0.0, 0.9),
            ("point", "Luigi PISTILLI", 1, 1.0, 12.0),
            ("cell", "EPSTRN", 1, -8.0, 0.0),
            ("cell", "Benito STEFANELLI", 1, 1.0, 3.0),
            ("cell", "ObjectId", 1, 200.0, 201.0),
        ],
    ),
    ("mesh_fs8.exo", "CDF-2", 1000, &[(CellKind::Wedge, 1344)], 4032, 0, &[("cell", "ObjectId", 1, 1.0, 3.0)]),
    (
        "mug.e",
        "CDF-2",
        3774,
        &[(CellKind::Hexahedron, 2476)],
        14_856,
        21,
        &[
            ("point", "convected", 1, 0.0, 1.0),
            ("point", "diffused", 1, 0.0, 2.0),
            ("cell", "aux_elem", 1, 0.00901816, 9.99171),
            ("cell", "ObjectId", 1, 1.0, 76.0),
        ],
    ),
];

fn range(array: &DataArray) -> (f64, f64) {
    let values = array.values.to_f64();
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

#[test]
fn shared_files_are_as_described() {
    let Some(folder) = shared("data/exodus") else { return };
    for &(name, form, points, kinds, tetrahedra, times, arrays) in FILES {
        let loaded = read_mesh(&folder.join(name), &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        let dataset = &loaded.dataset;
        eprintln!("{name}: {} {:?}", loaded.format, loaded.warnings);
        assert!(loaded.format.contains(form), "{name}: {}", loaded.format);
        assert_eq!(dataset.points.len(), points, "{name}");
        let Cells::Unstructured(cells) = &dataset.cells else { panic!("{name}") };
        let mut counts = BTreeMap::new();
        cells.kinds.iter().for_each(|&kind| *counts.entry(kind).or_insert(0) += 1);
        assert_eq!(counts, kinds.iter().copied().collect(), "{name}");
        assert_eq!((loaded.times.len(), loaded.step), (times, times.saturating_sub(1)), "{name}");
        let cut = decompose(dataset).unwrap();
        assert_eq!(cut.counts.tetrahedra, tetrahedra, "{name}");
        // Quadratic cells in a wrong order of nodes would be crumpled.
        assert_eq!((cut.counts.inverted, cut.counts.no_volume, cut.counts.malformed), (0, 0, 0), "{name}");
        let found: Vec<&DataArray> = dataset.point_arrays.iter().chain(&dataset.cell_arrays).collect();
        for array in &found {
            eprintln!("  {} x{} {:?}", array.name, array.components, range(array));
        }
        assert_eq!(found.len(), arrays.len(), "{name}");
        for &(owner, array, components, low, high) in arrays {
            let all = if owner == "point" { &dataset.point_arrays } else { &dataset.cell_arrays };
            let one = all.iter().find(|one| one.name == array).unwrap_or_else(|| panic!("{name}: {array}"));
            assert_eq!(one.components, components, "{name}: {array}");
            let found = range(one);
            let close = |a: f64, b: f64| (a - b).abs() <= 5.01e-6 * b.abs();
            assert!(close(found.0, low) && close(found.1, high), "{name}: {array}: {found:?}, not {low} .. {high}");
        }
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
