//! Known volumes, conforming neighbors, and what is left out.

use super::*;
use crate::{CellId, CellKind, FaceAdjacency, StructuredBlock, UnstructuredCells, VertexId, rings_sample};
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

/// What two tests share: a 3 by 3 by 3 lattice of unit cells, inner points moved a little.
struct Lattice {
    points: Vec<DVec3>,
}

impl Lattice {
    /// `refined` is the number of lattice steps a cell: 1, or 2 where there are mid-edge points.
    fn new(refined: usize) -> Self {
        let side = 3 * refined + 1;
        let point = |n: usize| {
            let [i, j, k] = [n % side, n / side % side, n / side / side];
            let is_inner = [i, j, k].iter().all(|&c| c != 0 && c != side - 1);
            let shift = if is_inner {
                DVec3::new((n as f64).sin(), (2.0 * n as f64).cos(), (3.0 * n as f64).sin())
            } else {
                DVec3::ZERO
            };
            (DVec3::new(i as f64, j as f64, k as f64) + shift * 0.06) / refined as f64
        };
        Self { points: (0..side * side * side).map(point).collect() }
    }

    /// Lattice indices of a cell's points, given as steps from its lowest corner.
    fn cell(&self, refined: usize, [i, j, k]: [usize; 3], steps: &[[usize; 3]]) -> Vec<u32> {
        let side = 3 * refined + 1;
        let at = |[a, b, c]: [usize; 3]| i * refined + a + side * (j * refined + b + side * (k * refined + c));
        steps.iter().map(|&step| at(step) as u32).collect()
    }
}

fn each_cell() -> impl Iterator<Item = [usize; 3]> {
    (0..27).map(|n| [n % 3, n / 3 % 3, n / 9])
}

const HEXAHEDRON_STEPS: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

/// Steps of the 27 points of a triquadratic hexahedron, doubled.
fn triquadratic_steps() -> Vec<[usize; 3]> {
    let (kind, points, ..) = specimens().remove(10);
    assert_eq!(kind, CellKind::TriquadraticHexahedron);
    points.iter().map(|p| p.map(|c| (2.0 * c) as usize)).collect()
}

/// Renumbers points and reorders cells, then checks that only the hull is boundary and the cube is filled once.
fn check_conforming(points: &[DVec3], cells: &[(CellKind, Vec<u32>)], hull_faces: usize) {
    for seed in 0..12 {
        let (numbers, order) = (shuffled(points.len(), seed), shuffled(cells.len(), seed + 99));
        let mut moved = vec![DVec3::ZERO; points.len()];
        for (point, &number) in points.iter().zip(&numbers) {
            moved[number as usize] = *point;
        }
        let renumber = |list: &Vec<u32>| list.iter().map(|&n| numbers[n as usize]).collect::<Vec<_>>();
        let cells: Vec<_> =
            order.iter().map(|&c| &cells[c as usize]).map(|(kind, list)| (*kind, renumber(list))).collect();
        check_filled_cube(&dataset(moved, &cells), hull_faces);
    }
}

fn check_filled_cube(dataset: &Dataset, hull_faces: usize) {
    let cut = decompose(dataset).expect("good cells");
    assert_eq!((cut.counts.no_volume, cut.counts.inverted), (0, 0));
    let adjacency = FaceAdjacency::new(cut.mesh.tetrahedra());
    assert_eq!(adjacency.boundary_faces().len(), hull_faces);
    assert!(adjacency.non_manifold_faces().is_empty() && adjacency.folded_faces().is_empty());
    for face in adjacency.boundary_faces() {
        let tetrahedron = cut.mesh.tetrahedra()[face.cell.index()];
        let world = |v: VertexId| cut.mesh.frame().to_world(cut.mesh.positions()[v.index()]).to_array();
        let corners: Vec<_> =
            (0..4).filter(|&n| n != usize::from(face.corner)).map(|n| world(tetrahedron[n])).collect();
        let lies_in = |axis: usize, at: f64| corners.iter().all(|c| (c[axis] - at).abs() < 1e-12);
        assert!((0..3).any(|axis| lies_in(axis, 0.0) || lies_in(axis, 3.0)), "a hole inside at {corners:?}");
    }
    assert!((volume(&cut.mesh) - 27.0).abs() < 1e-12, "{}", volume(&cut.mesh));
}

#[test]
fn hexahedra_conform() {
    let lattice = Lattice::new(1);
    let cells: Vec<_> = each_cell().map(|at| (CellKind::Hexahedron, lattice.cell(1, at, &HEXAHEDRON_STEPS))).collect();
    check_conforming(&lattice.points, &cells, 6 * 9 * 2);
}

#[test]
fn wedges_conform_in_both_orders() {
    let lattice = Lattice::new(1);
    let mut cells = Vec::new();
    for at in each_cell() {
        let corners = lattice.cell(1, at, &HEXAHEDRON_STEPS);
        let pick = |places: [usize; 6]| (CellKind::Wedge, places.map(|n| corners[n]).to_vec());
        // One with its first triangle below, one with it above.
        cells.extend([pick([0, 1, 2, 4, 5, 6]), pick([4, 6, 7, 0, 2, 3])]);
        let turned = pick([4, 6, 7, 0, 2, 3]);
        let mirrored = (CellKind::Wedge, [0, 2, 1, 3, 5, 4].map(|n| turned.1[n]).to_vec());
        if at[0] == 1 {
            *cells.last_mut().expect("just added") = mirrored;
        }
    }
    check_conforming(&lattice.points, &cells, 6 * 9 * 2);
}

#[test]
fn pyramids_tetrahedra_and_hexahedra_conform() {
    let mut lattice = Lattice::new(1);
    let mut cells = Vec::new();
    for (n, at) in each_cell().enumerate() {
        let corners = lattice.cell(1, at, &HEXAHEDRON_STEPS);
        if n % 2 == 0 {
            cells.push((CellKind::Hexahedron, corners));
            continue;
        }
        let center = lattice.points.len() as u32;
        lattice.points.push(DVec3::new(at[0] as f64, at[1] as f64, at[2] as f64) + 0.5);
        for face in linear::HEXAHEDRON {
            // From outside the faces turn counterclockwise; a pyramid's base is given as its apex sees it.
            let base = face.iter().rev().map(|&place| corners[usize::from(place)]);
            cells.push((CellKind::Pyramid, base.chain([center]).collect()));
        }
    }
    check_conforming(&lattice.points, &cells, 6 * 9 * 2);
}

#[test]
fn quadratic_hexahedra_conform_with_and_without_centers() {
    let lattice = Lattice::new(2);
    let steps = triquadratic_steps();
    for (kind, own) in [(CellKind::TriquadraticHexahedron, 27), (CellKind::QuadraticHexahedron, 20)] {
        let cells: Vec<_> = each_cell().map(|at| (kind, lattice.cell(2, at, &steps[..own]))).collect();
        check_conforming(&lattice.points, &cells, 6 * 9 * 8);
    }
}

#[test]
fn quadratic_wedges_and_pyramids_conform_with_hexahedra() {
    let mut lattice = Lattice::new(2);
    // Straight, so that the points added for wedges and pyramids lie between their neighbors.
    for point in &mut lattice.points {
        *point = (*point * 2.0).round() / 2.0;
    }
    let steps = triquadratic_steps();
    let mut cells = Vec::new();
    for (n, at) in each_cell().enumerate() {
        let p = lattice.cell(2, at, &steps);
        let pick = |places: &[usize]| places.iter().map(|&n| p[n]).collect::<Vec<_>>();
        match n % 3 {
            0 => cells.push((CellKind::QuadraticHexahedron, p[..20].to_vec())),
            1 => {
                // Cut along the diagonal 0-2: its mid-points are the centers of the lowest and highest face.
                cells.push((CellKind::QuadraticWedge, pick(&[0, 1, 2, 4, 5, 6, 8, 9, 24, 12, 13, 25, 16, 17, 18])));
                cells.push((CellKind::QuadraticWedge, pick(&[0, 2, 3, 4, 6, 7, 24, 10, 11, 25, 14, 15, 16, 18, 19])));
            }
            _ => {
                let center = p[26];
                for face in linear::HEXAHEDRON {
                    let base: Vec<usize> = face.iter().rev().map(|&place| usize::from(place)).collect();
                    let middle = |a: DVec3, b: DVec3| (a + b) / 2.0;
                    let mut list = pick(&base);
                    list.push(center);
                    for side in 0..4 {
                        let (a, b) = (list[side], list[(side + 1) % 4]);
                        let at = middle(lattice.points[a as usize], lattice.points[b as usize]);
                        let place = lattice.points.iter().position(|q| *q == at).expect("a lattice point");
                        list.push(place as u32);
                    }
                    for corner in 0..4 {
                        let at = middle(lattice.points[list[corner] as usize], lattice.points[center as usize]);
                        let known = lattice.points.iter().position(|q| *q == at);
                        list.push(known.unwrap_or(lattice.points.len()) as u32);
                        if known.is_none() {
                            lattice.points.push(at);
                        }
                    }
                    cells.push((CellKind::QuadraticPyramid, list));
                }
            }
        }
    }
    check_conforming(&lattice.points, &cells, 6 * 9 * 8);
}

#[test]
fn polyhedra_conform_with_hexahedra_and_prisms_with_their_faces_turned_anyhow() {
    let lattice = Lattice::new(1);
    let mut layout = UnstructuredCells::default();
    for (n, at) in each_cell().enumerate() {
        let corners = lattice.cell(1, at, &HEXAHEDRON_STEPS);
        layout.kinds.push(if n % 2 == 0 { CellKind::Polyhedron } else { CellKind::Hexahedron });
        layout.connectivity.extend(&corners);
        layout.offsets.push(layout.connectivity.len());
        if n % 2 == 0 {
            let face = |(f, face): (usize, &&[u8])| {
                let mut list: Vec<u32> = face.iter().map(|&place| corners[usize::from(place)]).collect();
                if (f + n) % 3 == 0 {
                    list.reverse();
                }
                list.rotate_left(f % 4);
                list
            };
            layout.polyhedra.push(linear::HEXAHEDRON.iter().enumerate().map(face).collect());
        }
    }
    let set = Dataset { points: lattice.points, cells: Cells::Unstructured(layout), ..Dataset::default() };
    check_filled_cube(&set, 6 * 9 * 2);
    let cut = decompose(&set).expect("good cells");
    assert_eq!(cut.added_points.len(), 14);
    assert_eq!(cut.counts.tetrahedra, 14 * 12 + 13 * 6);
}

fn block(dims: [usize; 3], place: impl Fn(DVec3) -> DVec3) -> Dataset {
    let [ni, nj, nk] = dims;
    let point = |n: usize| place(DVec3::new((n % ni) as f64, (n / ni % nj) as f64, (n / ni / nj) as f64));
    let block = StructuredBlock { dims, first_point: 0, hidden_points: Vec::new() };
    Dataset {
        points: (0..ni * nj * nk).map(point).collect(),
        cells: Cells::Structured(vec![block]),
        ..Dataset::default()
    }
}

#[test]
fn checkerboard_conforms_and_joins_even_points() {
    let set = block([4, 4, 4], |p| p);
    check_filled_cube(&set, 6 * 9 * 2);
    for tetrahedron in decompose(&set).expect("good").mesh.tetrahedra() {
        for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let index = |v: VertexId| [v.index() % 4, v.index() / 4 % 4, v.index() / 16];
            let (a, b) = (index(tetrahedron[a]), index(tetrahedron[b]));
            let steps = (0..3).filter(|&axis| a[axis] != b[axis]).count();
            let is_even = |p: [usize; 3]| p.iter().sum::<usize>() % 2 == 0;
            assert!(steps == 1 || (steps == 2 && is_even(a) && is_even(b)), "{a:?} {b:?}");
        }
    }
}

#[test]
fn left_handed_blocks_are_turned_round_and_counted() {
    let cut = decompose(&block([3, 3, 3], |p| DVec3::new(-p.x, p.y, p.z))).expect("good");
    assert_eq!((cut.counts.inverted, cut.counts.tetrahedra), (40, 40));
    assert!((volume(&cut.mesh) - 8.0).abs() < 1e-13);
}

#[test]
fn collapsed_line_leaves_out_exactly_the_flat_ones() {
    // As in the blunt fin: at k = 0 the lines j = 0 and j = 1 coincide from i = 1 on. 39 cells along i have the line
    // as two of their edges; each has two flat tetrahedra but the first, which is collapsed at one end only.
    let collapse = |p: DVec3| {
        let y = if p.z == 0.0 && p.x >= 1.0 && p.y == 1.0 { 0.0 } else { p.y };
        DVec3::new(p.x + 0.1 * p.y * p.z, y * (1.0 + 0.01 * p.x), p.z + 0.02 * p.x)
    };
    for origin in [DVec3::ZERO, DVec3::new(1048576.0, -2097152.0, 4194304.0)] {
        let stored = |p: DVec3| (collapse(p).as_vec3() + origin.as_vec3()).as_dvec3();
        let set = block([40, 5, 4], stored);
        let flat_exactly = decompose(&set).expect("good").counts;
        assert_eq!(flat_exactly.tetrahedra, 5 * 39 * 4 * 3);
        if origin == DVec3::ZERO {
            assert_eq!(flat_exactly.no_volume, 77, "{flat_exactly:?}");
        } else {
            assert!(flat_exactly.no_volume >= 77);
        }
    }
}

#[test]
fn bad_cells_are_left_out_one_by_one() {
    let mut points: Vec<DVec3> = specimens()[2].1.iter().map(|p| DVec3::from_array(*p)).collect();
    points.push(DVec3::new(0.0, f64::NAN, 0.0));
    points.push(DVec3::new(0.0, f64::INFINITY, 0.0));
    let good = (CellKind::Hexahedron, (0..8).collect::<Vec<u32>>());
    let cells = [
        (CellKind::Flat, vec![0, 1, 2]),
        (CellKind::Other(250), vec![0, 1]),
        (CellKind::Other(250), vec![]),
        (CellKind::Tetrahedron, vec![0, 1, 2]),
        (CellKind::Wedge, vec![0, 1, 2, 4, 5]),
        (CellKind::Tetrahedron, vec![0, 1, 2, 8]),
        (CellKind::Tetrahedron, vec![0, 1, 9, 2]),
        good.clone(),
        (CellKind::Hexahedron, (0..8).chain([0; 12]).collect()),
        (CellKind::Tetrahedron, vec![0, 0, 0, 0]),
        (CellKind::Tetrahedron, vec![0, 1, 2, 3]),
        (CellKind::Tetrahedron, vec![0, 3, 1, 4]),
    ];
    let cut = decompose(&dataset(points.clone(), &cells)).expect("the hexahedron is good");
    let counts = &cut.counts;
    assert_eq!((counts.flat, counts.unknown[&250], counts.malformed, counts.first_malformed), (1, 2, 2, Some(3)));
    assert_eq!((counts.non_finite, counts.shortened, counts.no_volume, counts.inverted), (2, 1, 2, 1));
    assert_eq!((counts.tetrahedra, cut.mesh.tetrahedra().len(), counts.cell_count()), (15, 13, 12));
    assert_eq!(counts.findings().len(), 7);
    assert_eq!(cut.mesh.source_cells()[..6], [7; 6]);
    assert!(cut.mesh.positions()[..8].iter().all(|p| p.length() < 2.0), "the frame ignores points without a place");

    let error =
        |cells: &[(CellKind, Vec<u32>)]| decompose(&dataset(points.clone(), cells)).expect_err("nothing to draw");
    assert_eq!(error(&[]), MeshError::NoCells { points: 10 });
    assert!(matches!(error(&cells[..7]), MeshError::NoSolidCell { cells: 7, .. }));
    assert!(error(&cells[..7]).to_string().contains("2 have too few points"), "{}", error(&cells[..7]));
    assert_eq!(error(&cells[9..11]), MeshError::NoVolume { tetrahedra: 2 });
    assert!(matches!(error(&[(CellKind::Tetrahedron, vec![0, 1, 2, 10])]), MeshError::Inconsistent { value: 10, .. }));
    assert_eq!(decompose(&Dataset::default()).expect_err("empty"), MeshError::NoPoints);
}

#[test]
fn inconsistent_layouts_are_refused() {
    let sound = dataset(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], &[(CellKind::Tetrahedron, vec![0, 1, 2, 3])]);
    let refuse = |spoil: &dyn Fn(&mut UnstructuredCells)| {
        let mut set = sound.clone();
        if let Cells::Unstructured(cells) = &mut set.cells {
            spoil(cells);
        }
        assert!(matches!(decompose(&set), Err(MeshError::Inconsistent { .. })));
        assert!(cell_data_to_points(&set, &[1.0]).iter().all(|x| x.is_nan()));
    };
    refuse(&|cells| cells.offsets.clear());
    refuse(&|cells| cells.offsets[1] = 9);
    refuse(&|cells| cells.offsets = vec![1, 4]);
    refuse(&|cells| cells.kinds.push(CellKind::Flat));
    refuse(&|cells| cells.connectivity.push(0));
    refuse(&|cells| cells.kinds[0] = CellKind::Polyhedron);
    let mut set = block([2, 2, 2], |p| p);
    set.points.pop();
    assert!(matches!(decompose(&set), Err(MeshError::Inconsistent { .. })));
}

#[test]
fn hidden_corners_hide_their_cells() {
    let mut set = block([4, 4, 4], |p| p);
    if let Cells::Structured(blocks) = &mut set.cells {
        blocks[0].hidden_points = (0..64).map(|n| n == 0 || n == 21).collect();
    }
    let cut = decompose(&set).expect("others are seen");
    // Point 21 is (1, 1, 1): the corner of eight cells, of which (0, 0, 0) is hidden by point 0 as well.
    assert_eq!((cut.counts.hidden, cut.counts.tetrahedra), (8, 5 * 19));
}

#[test]
fn scale_and_distance_lose_nothing() {
    let lattice = Lattice::new(1);
    let cells: Vec<_> = each_cell().map(|at| (CellKind::Hexahedron, lattice.cell(1, at, &HEXAHEDRON_STEPS))).collect();
    let local = |points: Vec<DVec3>| decompose(&dataset(points, &cells)).expect("good");
    for scale in [1e-300, 1e-200, 1e-9, 1e9, 1e20, 1e200, 1e307] {
        let cut = local(lattice.points.iter().map(|p| *p * scale).collect());
        assert_eq!((cut.counts.no_volume, cut.counts.inverted), (0, 0), "{scale}");
        let unit = cut.mesh.frame().scale / scale;
        let ratio = volume_local(&cut.mesh) * unit * unit * unit / 27.0;
        assert!((ratio - 1.0).abs() < 1e-12, "{ratio} at {scale}");
    }
    // The hull's corners are stored exactly at this distance, and what is inside moves no volume to the outside.
    let far = DVec3::new(5e5, 5e6, -5e6);
    let cut = local(lattice.points.iter().map(|p| *p + far).collect());
    assert_eq!((cut.counts.no_volume, cut.counts.inverted), (0, 0));
    assert!((volume(&cut.mesh) / 27.0 - 1.0).abs() < 1e-12, "{}", volume(&cut.mesh));
}

#[test]
fn slivers_are_kept_and_flat_sets_are_not() {
    let thin = |height: f64| {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.25, 0.25, height)];
        TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]])
    };
    for height in [1e-7, 1e-12, 1e-30, 1e-100] {
        let cut = thin(height).expect("thin but not flat");
        assert_eq!((cut.counts.no_volume, cut.counts.inverted), (0, 0), "{height}");
        assert!((volume(&cut.mesh) / (height / 6.0) - 1.0).abs() < 1e-12);
    }
    assert_eq!(thin(0.0).expect_err("flat"), MeshError::NoVolume { tetrahedra: 1 });
    // A plane through points that no float grid lines up with: flat in the file, so it is never kept.
    let plane = |x: f64, y: f64| DVec3::new(x, y, x + y);
    let points = [plane(0.125, 0.375), plane(1.625, 0.5), plane(0.25, 2.875), plane(0.75, 0.625)].map(|p| p * 3.0);
    assert!(TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]]).is_err());
}

#[test]
fn added_points_take_the_fields_value() {
    let (kind, points, ..) = specimens().remove(8);
    assert_eq!(kind, CellKind::QuadraticHexahedron);
    let points: Vec<DVec3> = points.iter().map(|p| DVec3::from_array(*p)).collect();
    let cut = decompose(&dataset(points.clone(), &[(kind, (0..20).collect())])).expect("good");
    assert_eq!(cut.added_points.len(), 7);
    let field = |p: DVec3| 1.0 + 2.0 * p.x - p.y + 3.0 * p.z + p.x * p.y - 4.0 * p.y * p.z + 2.0 * p.x * p.x;
    let scalars = cut.point_scalars(&points.iter().map(|p| field(*p)).collect::<Vec<_>>());
    for (position, scalar) in cut.mesh.positions().iter().zip(&scalars) {
        assert!((field(cut.mesh.frame().to_world(*position)) - scalar).abs() < 1e-13);
    }
    assert!(cut.point_scalars(&[]).iter().all(|s| s.is_nan()));
}

#[test]
fn cell_values_are_averaged_over_cells_that_are_drawn() {
    let set = block([3, 2, 2], |p| p);
    let means = cell_data_to_points(&set, &[1.0, 4.0]);
    assert_eq!(means, [1.0, 2.5, 4.0, 1.0, 2.5, 4.0, 1.0, 2.5, 4.0, 1.0, 2.5, 4.0]);
    let means = cell_data_to_points(&set, &[f64::INFINITY, 4.0]);
    assert!(means[0].is_nan() && means[1] == 4.0 && means[2] == 4.0);
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let cells = [(CellKind::Tetrahedron, vec![0, 1, 2, 3]), (CellKind::Flat, vec![0, 1, 4])];
    let means = cell_data_to_points(&dataset(points, &cells), &[2.0, 7.0]);
    assert!(means[..4].iter().all(|x| *x == 2.0) && means[4].is_nan());
}

#[test]
fn retain_keeps_points_and_sources() {
    let cut = decompose(&block([3, 3, 3], |p| p)).expect("good");
    let half = cut.mesh.retain(|cell| cut.mesh.source_cells()[cell.index()] < 4);
    assert_eq!(half.tetrahedra().len(), 20);
    assert_eq!(half.source_cells(), &cut.mesh.source_cells()[..20]);
    assert_eq!(half.positions(), cut.mesh.positions());
    assert_eq!(half.bounds_world(), Some((DVec3::ZERO, DVec3::new(2.0, 2.0, 1.0))));
    assert_eq!(cut.mesh.retain(|_| false).bounds_world(), None);
}

#[test]
fn threads_do_not_matter() {
    let set = rings_sample(12);
    let cut_by = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| decompose(&set).expect("good"))
    };
    let (one, four) = (cut_by(1), cut_by(4));
    assert_eq!(one.mesh.tetrahedra(), four.mesh.tetrahedra());
    assert_eq!(one.mesh.positions(), four.mesh.positions());
    assert_eq!(one.counts, four.counts);
}

#[test]
fn blocks_follow_each_other() {
    let (mut first, second) = (block([3, 2, 2], |p| p), block([2, 2, 3], |p| p + DVec3::new(9.0, 0.0, 0.0)));
    let flat = StructuredBlock { dims: [5, 1, 2], first_point: 0, hidden_points: Vec::new() };
    if let Cells::Structured(blocks) = &mut first.cells {
        let mut hidden_points = vec![false; 12];
        hidden_points[11] = true;
        blocks.extend([flat, StructuredBlock { dims: [2, 2, 3], first_point: 12, hidden_points }]);
    }
    first.points.extend(second.points);
    let cut = decompose(&first).expect("good");
    // Cells 0 and 1, none of the flat block, and of the last two the one away from its hidden end.
    let cells = |cell: u32| cut.mesh.source_cells().iter().filter(|&&c| c == cell).count();
    assert_eq!([0, 1, 2, 3].map(cells), [5, 5, 5, 0]);
    // Parity is counted within the block: its first cell has its central tetrahedron at its first point.
    assert_eq!(cut.mesh.tetrahedra()[10].map(|v| v.0), [12, 15, 18, 17]);
    let means = cell_data_to_points(&first, &[1.0, 2.0, 3.0, 4.0]);
    assert_eq!((means[1], means[12], means[16]), (1.5, 3.0, 3.0));
    assert!(means[23].is_nan());
}
