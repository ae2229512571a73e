//! The shared files: versions, volumes and fields. Their counts and ranges are the crate's test of all shared files.

use tetrascope_mesh::decompose;

use super::element_tests::six_volume;
use super::tests::cells;
use crate::shared::shared;
use crate::{ReadOptions, read_mesh};

/// Name, what its format must say, volume and how far it may be off, a field of its points.
type File = (&'static str, &'static str, (f64, f64), Option<&'static str>);

// The block is coarse where it is round: its volume is that of these tetrahedra, by Gmsh itself. The ball's is nearly that of the sphere.
const FILES: &[File] = &[
    ("ball_tet10_v22_ascii.msh", "MSH 2, text", (4.18879, 0.15), Some("one_minus_r2")),
    ("ball_tet10_v41_ascii.msh", "MSH 4.1, text", (4.18879, 0.15), Some("one_minus_r2")),
    ("block_v22_ascii.msh", "MSH 2, text", (2.479659606907949, 1e-12), Some("f")),
    ("block_v22_binary.msh", "MSH 2, binary, little-endian", (2.479659606907949, 1e-12), Some("f")),
    ("block_v41_ascii.msh", "MSH 4.1, text", (2.479659606907949, 1e-12), Some("f")),
    ("block_v41_binary.msh", "MSH 4.1, binary, little-endian", (2.479659606907949, 1e-12), Some("f")),
    ("mixed_v22_ascii.msh", "MSH 2, text", (1.9675, 1e-9), Some("linear")),
    ("mixed_v41_ascii.msh", "MSH 4.1, text", (1.9675, 1e-9), Some("linear")),
    ("sfepy_msh_tetra.msh", "MSH 2, text", (0.0, f64::INFINITY), None),
];

#[test]
fn shared_files_have_their_volumes_and_fields() {
    let Some(folder) = shared("data/gmsh") else { return };
    for &(name, format, (volume, off), field) in FILES {
        let loaded = read_mesh(&folder.join(name), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        assert!(loaded.format.contains(format), "{name}: {}", loaded.format);
        let cut = decompose(&loaded.dataset).unwrap();
        assert_eq!((cut.counts.inverted, cut.counts.malformed, cut.counts.no_volume), (0, 0, 0), "{name}");
        let six: f64 = (0..cut.mesh.tetrahedra().len()).map(|t| six_volume(&cut.mesh, t)).sum();
        assert!((six / 6.0 - volume).abs() <= off, "{name}: {} is not {volume}", six / 6.0);
        let Some(array) = field else { continue };
        let [found] = loaded.dataset.point_arrays.as_slice() else { panic!("{name}") };
        let values = found.component(0);
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
