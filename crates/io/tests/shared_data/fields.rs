//! Fields of which the description has the formula.

use std::collections::BTreeMap;

use glam::DVec3;
use tetrascope_mesh::{CellKind, Cells, Dataset, decompose};

use crate::{cell_array, load, point_array};

fn f(p: DVec3) -> f64 {
    (3.0 * p.x).sin() * (2.0 * p.y).cos() + 0.5 * p.z + bump(p)
}

fn bump(p: DVec3) -> f64 {
    (-(p - DVec3::new(1.4, 0.7, 0.5)).length_squared() / 0.05).exp()
}

fn grad_f(p: DVec3) -> DVec3 {
    let waves =
        DVec3::new(3.0 * (3.0 * p.x).cos() * (2.0 * p.y).cos(), -2.0 * (3.0 * p.x).sin() * (2.0 * p.y).sin(), 0.5);
    waves - 40.0 * bump(p) * (p - DVec3::new(1.4, 0.7, 0.5))
}

#[test]
fn block_has_the_field_its_gradient_and_its_cell_values() {
    let Some(loaded) = load("vtu/gmsh_block_98k.vtu") else { return };
    let dataset = &loaded.dataset;
    let values = point_array(dataset, "f").component(0);
    let gradients = point_array(dataset, "grad_f").values.to_f64();
    for ((point, value), gradient) in dataset.points.iter().zip(values).zip(gradients.chunks_exact(3)) {
        assert!((value - f(*point)).abs() < 1e-12, "{value} at {point}");
        // Kept in 32 bits; components are below 6.
        let off = (DVec3::from_slice(gradient) - grad_f(*point)).abs().max_element();
        assert!(off < 6e-7, "{gradient:?} at {point}");
    }
    let Cells::Unstructured(cells) = &dataset.cells else { panic!("not unstructured") };
    for (corners, value) in cells.connectivity.chunks_exact(4).zip(cell_array(dataset, "f_cell").component(0)) {
        let middle = corners.iter().map(|&point| dataset.points[point as usize]).sum::<DVec3>() / 4.0;
        assert!((value - f(middle)).abs() < 2e-7, "{value} at {middle}");
    }
}

/// The mixed mesh of every format: volumes of its parts and of the tetrahedra that they are cut into, and its fields.
#[test]
fn mixed_mesh_has_the_volumes_and_fields() {
    for name in [
        "vtu/encodings/mixed_appended_raw_none_u64.vtu",
        "vtk/mixed_binary_v4.2.vtk",
        "gmsh/mixed_v22_ascii.msh",
        "gmsh/mixed_v41_ascii.msh",
    ] {
        let Some(loaded) = load(name) else { return };
        check_volumes(name, &loaded.dataset);
        let linear = point_array(&loaded.dataset, "linear");
        // In VTK's files in 32 bits, of values up to 8.1.
        let off = if linear.values.type_name() == "Float32" { 5e-7 } else { 1e-12 };
        for (p, value) in loaded.dataset.points.iter().zip(linear.component(0)) {
            assert!((value - (p.x + 2.0 * p.y + 3.0 * p.z)).abs() < off, "{name}: {value} at {p}");
        }
        if !name.starts_with("gmsh") {
            check_other_fields(name, &loaded.dataset);
        }
    }
}

fn check_volumes(name: &str, dataset: &Dataset) {
    let Cells::Unstructured(cells) = &dataset.cells else { panic!("{name}: not unstructured") };
    let cut = decompose(dataset).unwrap();
    let mut volumes = BTreeMap::new();
    for (corners, &source) in cut.mesh.tetrahedra().iter().zip(cut.mesh.source_cells()) {
        let [a, b, c, d] = corners.map(|corner| cut.mesh.frame().to_world(cut.mesh.positions()[corner.index()]));
        *volumes.entry(cells.kinds[source as usize]).or_insert(0.0) += (b - a).cross(c - a).dot(d - a).abs() / 6.0;
    }
    let expected = [
        (CellKind::Tetrahedron, 0.361974),
        (CellKind::Hexahedron, 1.0),
        (CellKind::Wedge, 0.5675),
        (CellKind::Pyramid, 0.0380255),
    ];
    assert_eq!(volumes.len(), expected.len(), "{name}");
    for (kind, volume) in expected {
        // Six digits are given.
        assert!((volumes[&kind] - volume).abs() < 5.01e-7, "{name}: {kind:?}: {}", volumes[&kind]);
    }
    let total: f64 = volumes.values().sum();
    assert!((total - 1.9675).abs() < 1e-9, "{name}: {total}");
}

fn check_other_fields(name: &str, dataset: &Dataset) {
    let waves = point_array(dataset, "wave").component(0);
    let vectors = point_array(dataset, "vec").values.to_f64();
    for ((p, wave), vector) in dataset.points.iter().zip(waves).zip(vectors.chunks_exact(3)) {
        let expected = (4.0 * p.x).sin() * (3.0 * p.y).cos() * (2.0 * p.z).sin();
        assert!((wave - expected).abs() < 1e-14, "{name}: {wave} at {p}");
        assert_eq!(vector, [p.y, -p.x, 0.0], "{name}: at {p}");
    }
    let Cells::Unstructured(cells) = &dataset.cells else { panic!("{name}: not unstructured") };
    let numbers = |array: &str| cell_array(dataset, array).component(0);
    for ((kind, block), material) in cells.kinds.iter().zip(numbers("block")).zip(numbers("mat")) {
        let expected = match kind {
            CellKind::Tetrahedron => (1.0, 10.0),
            CellKind::Hexahedron => (2.0, 12.0),
            CellKind::Wedge => (3.0, 13.0),
            _ => (4.0, 14.0),
        };
        assert_eq!((block, material), expected, "{name}: {kind:?}");
    }
}

/// A linear field is the same in every tetrahedron that is cut: points that cells of second order and polyhedra gain have its value.
#[test]
fn linear_fields_survive_the_cut() {
    for name in [
        "vtu/QuadraticPyramid.vtu",
        "vtu/QuadraticTetra.vtu",
        "vtu/QuadraticWedge.vtu",
        "vtu/TriQuadraticHexahedron.vtu",
        "vtu/polyhedra_new_layout_v2.3.vtu",
        "vtu/notch_disp.vtu",
        "exodus/biplane_rms_pressure_bs.exo",
        "gmsh/ball_tet10_v41_ascii.msh",
        "vtk/PentaHexa.vtk",
    ] {
        let Some(loaded) = load(name) else { return };
        let linear = |p: DVec3| p.x + 2.0 * p.y + 3.0 * p.z;
        let values: Vec<f64> = loaded.dataset.points.iter().map(|&p| linear(p)).collect();
        let cut = decompose(&loaded.dataset).unwrap();
        let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        for (local, scalar) in cut.mesh.positions().iter().zip(cut.point_scalars(&values)) {
            let expected = linear(cut.mesh.frame().to_world(*local));
            assert!((scalar - expected).abs() < 1e-12 * largest, "{name}: {scalar}, not {expected}");
        }
    }
}
