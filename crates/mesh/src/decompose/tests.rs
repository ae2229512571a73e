//! Known volumes, conforming neighbors, and what is left out.

use super::*;
use crate::{CellId, CellKind, StructuredBlock, UnstructuredCells};
use glam::DVec3;

fn dataset(points: Vec<DVec3>, cells: &[(CellKind, Vec<u32>)]) -> Dataset {
    let mut layout = UnstructuredCells::default();
    for (kind, list) in cells {
        layout.kinds.push(*kind);
        layout.connectivity.extend(list);
        layout.offsets.push(layout.connectivity.len());
    }
    Dataset { points, cells: Cells::Unstructured(layout), ..Dataset::default() }
}

fn volume_local(mesh: &TetMesh) -> f64 {
    (0..mesh.tetrahedra().len() as u32).map(|cell| mesh.volume6_local(CellId(cell))).sum::<f64>() / 6.0
}

fn volume(mesh: &TetMesh) -> f64 {
    volume_local(mesh) * mesh.frame().scale.powi(3)
}

/// Reference points of each kind, in VTK's order, with the cell's volume and the number of tetrahedra.
fn specimens() -> Vec<(CellKind, Vec<[f64; 3]>, f64, usize)> {
    let hexahedron = vec![
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [0., 0., 1.],
        [1., 0., 1.],
        [1., 1., 1.],
        [0., 1., 1.],
    ];
    let tetrahedron = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    let wedge = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [0., 1., 1.]];
    let pyramid = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.25, 0.5, 1.]];
    let prism = |sides: usize| -> Vec<[f64; 3]> {
        let corner = |n: usize, z: f64| {
            let (sin, cos) = (n as f64 / sides as f64 * std::f64::consts::TAU).sin_cos();
            [cos, sin, z]
        };
        (0..sides).map(|n| corner(n, 0.0)).chain((0..sides).map(|n| corner(n, 1.0))).collect()
    };
    let prism_volume = |sides: f64| sides / 2.0 * (std::f64::consts::TAU / sides).sin();
    let with_means = |base: &[[f64; 3]], groups: &[&[usize]]| {
        let mean = |group: &&[usize]| {
            [0, 1, 2].map(|axis| group.iter().map(|&n| base[n][axis]).sum::<f64>() / group.len() as f64)
        };
        base.iter().copied().chain(groups.iter().map(mean)).collect::<Vec<_>>()
    };
    let hexahedron_edges: Vec<&[usize]> = vec![
        &[0, 1],
        &[1, 2],
        &[2, 3],
        &[3, 0],
        &[4, 5],
        &[5, 6],
        &[6, 7],
        &[7, 4],
        &[0, 4],
        &[1, 5],
        &[2, 6],
        &[3, 7],
    ];
    let side_centers: [&[usize]; 4] = [&[0, 3, 7, 4], &[1, 2, 6, 5], &[0, 1, 5, 4], &[3, 2, 6, 7]];
    let other_centers: [&[usize]; 3] = [&[0, 1, 2, 3], &[4, 5, 6, 7], &[0, 1, 2, 3, 4, 5, 6, 7]];
    let hexahedron_24 = [hexahedron_edges.as_slice(), &side_centers].concat();
    let hexahedron_27 = [hexahedron_24.as_slice(), &other_centers].concat();
    let triangle_edges: [&[usize]; 6] = [&[0, 1], &[1, 2], &[2, 0], &[3, 4], &[4, 5], &[5, 3]];
    let wedge_15 = [&triangle_edges[..], &[&[0, 3], &[1, 4], &[2, 5]]].concat();
    let wedge_18 = [wedge_15.as_slice(), &[&[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]]].concat();
    let voxel = [0, 1, 3, 2, 4, 5, 7, 6].map(|n: usize| hexahedron[n]).to_vec();
    vec![
        (CellKind::Tetrahedron, tetrahedron.clone(), 1.0 / 6.0, 1),
        (CellKind::Voxel, voxel, 1.0, 6),
        (CellKind::Hexahedron, hexahedron.clone(), 1.0, 6),
        (CellKind::Wedge, wedge.clone(), 0.5, 3),
        (CellKind::Pyramid, pyramid.clone(), 1.0 / 3.0, 2),
        (CellKind::PentagonalPrism, prism(5), prism_volume(5.0), 9),
        (CellKind::HexagonalPrism, prism(6), prism_volume(6.0), 12),
        (
            CellKind::QuadraticTetrahedron,
            with_means(&tetrahedron, &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]]),
            1.0 / 6.0,
            8,
        ),
        (CellKind::QuadraticHexahedron, with_means(&hexahedron, &hexahedron_edges), 1.0, 48),
        (CellKind::BiquadraticQuadraticHexahedron, with_means(&hexahedron, &hexahedron_24), 1.0, 48),
        (CellKind::TriquadraticHexahedron, with_means(&hexahedron, &hexahedron_27), 1.0, 48),
        (CellKind::QuadraticWedge, with_means(&wedge, &wedge_15), 0.5, 24),
        (CellKind::BiquadraticQuadraticWedge, with_means(&wedge, &wedge_18), 0.5, 24),
        (CellKind::QuadraticLinearWedge, with_means(&wedge, &triangle_edges), 0.5, 12),
        (
            CellKind::QuadraticPyramid,
            with_means(&pyramid, &[&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 4], &[1, 4], &[2, 4], &[3, 4]]),
            1.0 / 3.0,
            16,
        ),
    ]
}

/// A permutation of 0..n that depends on the seed alone.
fn shuffled(n: usize, mut seed: u64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..n as u32).collect();
    for place in (1..n).rev() {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        order.swap(place, ((seed >> 33) as usize) % (place + 1));
    }
    order
}

#[test]
fn every_kind_fills_its_volume_upright_in_any_numbering() {
    for (kind, reference, exact, tetrahedra) in specimens() {
        for seed in 0..40 {
            let order = shuffled(reference.len(), seed);
            let mut points = vec![DVec3::ZERO; reference.len()];
            for (place, &index) in order.iter().enumerate() {
                points[index as usize] = DVec3::from_array(reference[place]);
            }
            let cut = decompose(&dataset(points, &[(kind, order)])).expect("a good cell");
            assert_eq!(cut.counts.tetrahedra, tetrahedra, "{kind:?}");
            assert_eq!((cut.counts.no_volume, cut.counts.inverted), (0, 0), "{kind:?} seed {seed}");
            let found = volume(&cut.mesh);
            assert!((found - exact).abs() < 1e-14, "{kind:?} seed {seed}: {found} for {exact}");
            assert_eq!(cut.counts.cells, [(kind, 1)].into_iter().collect());
        }
    }
}

#[test]
fn structured_block_is_five_tetrahedra_a_cell() {
    let points = (0..3 * 4 * 5).map(|n| DVec3::new((n % 3) as f64, (n / 3 % 4) as f64, (n / 12) as f64)).collect();
    let block = StructuredBlock { dims: [3, 4, 5], first_point: 0, hidden_points: Vec::new() };
    let cut =
        decompose(&Dataset { points, cells: Cells::Structured(vec![block]), ..Dataset::default() }).expect("good");
    assert_eq!((cut.counts.tetrahedra, cut.counts.inverted, cut.counts.no_volume), (5 * 24, 0, 0));
    assert!((volume(&cut.mesh) - 24.0).abs() < 1e-12);
}
