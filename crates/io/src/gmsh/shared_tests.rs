//! The shared files, as their description states them.

use std::collections::BTreeMap;

use tetrascope_mesh::{CellKind, decompose};

use super::element_tests::six_volume;
use super::tests::cells;
use crate::shared::shared;
use crate::{ReadOptions, read_mesh};

/// Name, what its format must say, points, kinds, volume and how far it may be off, a field of its points and that field's range.
type File =
    (&'static str, &'static str, usize, &'static [(CellKind, usize)], (f64, f64), Option<(&'static str, f64, f64)>);

const BLOCK: &[(CellKind, usize)] = &[(CellKind::Tetrahedron, 2737), (CellKind::Flat, 1190)];
const MIXED: &[(CellKind, usize)] =
    &[(CellKind::Tetrahedron, 224), (CellKind::Hexahedron, 64), (CellKind::Wedge, 84), (CellKind::Pyramid, 16)];
const BALL: &[(CellKind, usize)] = &[(CellKind::QuadraticTetrahedron, 256)];
const F: Option<(&str, f64, f64)> = Some(("f", -0.996164, 1.47385));
const LINEAR: Option<(&str, f64, f64)> = Some(("linear", 0.0, 8.1));
const RADIUS: Option<(&str, f64, f64)> = Some(("one_minus_r2", -2.22045e-16, 1.0));

// The block is coarse where it is round: its volume is that of these tetrahedra, by Gmsh itself. The ball's is nearly that of the sphere.
const FILES: &[File] = &[
    ("ball_tet10_v22_ascii.msh", "MSH 2, text", 516, BALL, (4.18879, 0.15), RADIUS),
    ("ball_tet10_v41_ascii.msh", "MSH 4.1, text", 516, BALL, (4.18879, 0.15), RADIUS),
    ("block_v22_ascii.msh", "MSH 2, text", 772, BLOCK, (2.479659606907949, 1e-12), F),
    ("block_v22_binary.msh", "MSH 2, binary, little-endian", 772, BLOCK, (2.479659606907949, 1e-12), F),
    ("block_v41_ascii.msh", "MSH 4.1, text", 772, BLOCK, (2.479659606907949, 1e-12), F),
    ("block_v41_binary.msh", "MSH 4.1, binary, little-endian", 772, BLOCK, (2.479659606907949, 1e-12), F),
    ("mixed_v22_ascii.msh", "MSH 2, text", 261, MIXED, (1.9675, 1e-9), LINEAR),
    ("mixed_v41_ascii.msh", "MSH 4.1, text", 261, MIXED, (1.9675, 1e-9), LINEAR),
    ("sfepy_msh_tetra.msh", "MSH 2, text", 66, &[(CellKind::Tetrahedron, 127)], (0.0, f64::INFINITY), None),
];

#[test]
fn shared_files_are_as_described() {
    let Some(folder) = shared("data/gmsh") else { return };
    for &(name, format, points, kinds, (volume, off), field) in FILES {
        let loaded = read_mesh(&folder.join(name), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        assert!(loaded.format.contains(format), "{name}: {}", loaded.format);
        assert_eq!(loaded.warnings, Vec::<String>::new(), "{name}");
        assert_eq!(loaded.dataset.points.len(), points, "{name}");
        let mut counts = BTreeMap::new();
        for &kind in &cells(&loaded).kinds {
            *counts.entry(kind).or_insert(0) += 1;
        }
        assert_eq!(counts, kinds.iter().copied().collect(), "{name}");
        let cut = decompose(&loaded.dataset).unwrap();
        assert_eq!((cut.counts.inverted, cut.counts.malformed, cut.counts.no_volume), (0, 0, 0), "{name}");
        let six: f64 = (0..cut.mesh.tetrahedra().len()).map(|t| six_volume(&cut.mesh, t)).sum();
        assert!((six / 6.0 - volume).abs() <= off, "{name}: {} is not {volume}", six / 6.0);
        let Some((array, low, high)) = field else {
            assert!(loaded.dataset.point_arrays.is_empty(), "{name}");
            continue;
        };
        let [found] = loaded.dataset.point_arrays.as_slice() else { panic!("{name}") };
        assert_eq!((found.name.as_str(), found.values.type_name()), (array, "Float64"), "{name}");
        let values = found.component(0);
        let range = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
        let close = |a: f64, b: f64| (a - b).abs() <= 5.01e-6 * b.abs();
        assert!(close(range.0, low) && close(range.1, high), "{name}: {range:?}");
        for (point, value) in loaded.dataset.points.iter().zip(values) {
            let [x, y, z] = point.to_array();
            let bump = ((x - 1.4).powi(2) + (y - 0.7).powi(2) + (z - 0.5).powi(2)) / 0.05;
            let expected = match array {
                "linear" => x + 2.0 * y + 3.0 * z,
                "f" => (3.0 * x).sin() * (2.0 * y).cos() + 0.5 * z + (-bump).exp(),
                _ => 1.0 - point.length_squared(),
            };
            assert!((value - expected).abs() < 1e-12, "{name}: {value} at {point}, not {expected}");
        }
    }
}

#[test]
fn shared_table_names_every_file() {
    let Some(folder) = shared("data/gmsh") else { return };
    for entry in std::fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name().to_string_lossy().into_owned();
        assert!(FILES.iter().any(|file| file.0 == name), "{name} is in no test");
    }
}

#[test]
fn shared_block_is_the_same_in_all_its_files() {
    let Some(folder) = shared("data/gmsh") else { return };
    let load = |name: &str| read_mesh(&folder.join(name), &ReadOptions::default()).unwrap();
    for version in ["v22", "v41"] {
        let text = load(&format!("block_{version}_ascii.msh"));
        let binary = load(&format!("block_{version}_binary.msh"));
        // Text has 16 digits.
        let off =
            text.dataset.points.iter().zip(&binary.dataset.points).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(off < 1e-15, "{version}: {off}");
        assert_eq!(text.dataset.points.len(), binary.dataset.points.len());
        assert_eq!(cells(&text).kinds, cells(&binary).kinds);
        assert_eq!(cells(&text).connectivity, cells(&binary).connectivity);
        for (a, b) in text.dataset.cell_arrays.iter().zip(&binary.dataset.cell_arrays) {
            assert_eq!((&a.name, a.component(0)), (&b.name, b.component(0)));
        }
        let physical = text.dataset.cell_arrays.iter().find(|array| array.name == "gmsh:physical").unwrap();
        let groups = |group: f64| physical.component(0).iter().filter(|&&x| x == group).count();
        assert_eq!((groups(1.0), groups(2.0)), (2737, 1190), "{version}");
        assert!(text.format.contains("1 `solid` (volumes), 2 `wall` (surfaces)"), "{}", text.format);
    }
}

#[test]
fn shared_hostile_files() {
    let Some(folder) = shared("data/hostile") else { return };
    let error = read_mesh(&folder.join("huge_count.msh"), &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("huge_count.msh") && error.contains("$Nodes, line") && error.contains("Gmsh"), "{error}");
    let loaded = read_mesh(&folder.join("legacy_vtk_named.msh"), &ReadOptions::default()).unwrap();
    assert!(loaded.warnings.iter().any(|warning| warning.contains(".msh")), "{:?}", loaded.warnings);
}
