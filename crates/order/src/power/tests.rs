//! Faces in the right order, from anywhere, where the certificate says so; and a certificate that says no where it must.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use robust::orient3d;
use tetrascope_mesh::{CellId, FaceAdjacency, VertexId};
use tetrascope_view::Viewpoint;

use super::certify::coord;
use super::double::Double;
use super::*;

pub(super) struct Mesh {
    pub(super) positions: Vec<DVec3>,
    pub(super) tetrahedra: Vec<[VertexId; 4]>,
}

impl Mesh {
    pub(super) fn cells(&self) -> Cells<'_> {
        Cells { positions: &self.positions, tetrahedra: &self.tetrahedra }
    }

    pub(super) fn drawn(&self) -> Vec<CellId> {
        (0..self.tetrahedra.len() as u32).map(CellId).collect()
    }

    fn power(&self, visits_per_face: u32) -> Power {
        let adjacency = FaceAdjacency::new(&self.tetrahedra);
        Power::with_adjacency(self.cells(), &adjacency, Budget { visits_per_face })
    }

    pub(super) fn map(mut self, f: impl Fn(usize, DVec3) -> DVec3) -> Self {
        self.positions = self.positions.iter().enumerate().map(|(i, &p)| f(i, p)).collect();
        self
    }
}

/// A grid of n³ unit cubes, each cut by `cut`: corners as bits x, y, z; `cut` also gets the cube's parity.
fn grid(n: u32, cut: impl Fn(bool) -> Vec<[usize; 4]>) -> Mesh {
    let side = n + 1;
    let point = |x: u32, y: u32, z: u32| VertexId((z * side + y) * side + x);
    let mut mesh = Mesh { positions: Vec::new(), tetrahedra: Vec::new() };
    for (z, y, x) in (0..side.pow(3)).map(|i| (i / side / side, i / side % side, i % side)) {
        mesh.positions.push(DVec3::new(x.into(), y.into(), z.into()));
    }
    for (z, y, x) in (0..n.pow(3)).map(|i| (i / n / n, i / n % n, i % n)) {
        let corner = |c: usize| point(x + (c & 1) as u32, y + (c >> 1 & 1) as u32, z + (c >> 2) as u32);
        mesh.tetrahedra.extend(cut((x + y + z) % 2 == 1).iter().map(|t| t.map(corner)));
    }
    mesh
}

/// Five tetrahedra a cube, mirrored from cube to cube.
pub(super) fn checkerboard(n: u32) -> Mesh {
    grid(n, |is_odd| {
        let five = [[0, 3, 5, 6], [1, 0, 3, 5], [2, 0, 3, 6], [4, 0, 5, 6], [7, 3, 5, 6]];
        five.map(|t| t.map(|c| if is_odd { c ^ 1 } else { c })).to_vec()
    })
}

/// Six tetrahedra a cube around one diagonal.
fn around_diagonals(n: u32) -> Mesh {
    grid(n, |_| [(1, 3), (1, 5), (2, 3), (2, 6), (4, 5), (4, 6)].map(|(a, b)| [0, a, b, 7]).to_vec())
}

/// Pairs of cells that share a face and come in the wrong order. Along a direction the eye is put so far away that only faces
/// seen within 1e-9 of edge-on could be judged differently; these are left out.
pub(super) fn misordered(mesh: &Mesh, viewpoint: Viewpoint, order: &[CellId]) -> usize {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(i, cell)| place[cell.index()] = i);
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let mut count = 0;
    for (cell, points) in mesh.tetrahedra.iter().enumerate() {
        for corner in 0..4 {
            let Some(other) = adjacency.neighbor(CellId(cell as u32), corner) else { continue };
            let at = |k: usize| mesh.positions[points[(corner + k) % 4].index()];
            let side = |p: DVec3| orient3d(coord(at(1)), coord(at(2)), coord(at(3)), coord(p));
            let seen = match viewpoint {
                Viewpoint::Eye(eye) => side(eye),
                Viewpoint::Direction(direction) => {
                    let normal = (at(2) - at(1)).cross(at(3) - at(1));
                    let slope = normal.normalize().dot(direction);
                    if slope.abs() > 1e-9 { slope } else { 0.0 }
                }
            };
            if seen != 0.0 && ((seen > 0.0) == (side(at(0)) > 0.0)) != (place[cell] < place[other.index()]) {
                count += 1;
            }
        }
    }
    count
}

pub(super) fn unit() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0_f64).prop_map(DVec3::from)
}

/// Inside, outside, on grid points and planes (many equal keys), and along directions.
pub(super) fn viewpoint(n: u32) -> impl Strategy<Value = Viewpoint> {
    let n = f64::from(n);
    let lattice =
        (-2..9_i32, -2..9_i32, -2..9_i32).prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into()) * 0.5);
    let direction = (-2..3_i32, -2..3_i32, -2..3_i32).prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into()));
    prop_oneof![
        unit().prop_map(move |p| Viewpoint::Eye(p * n)),
        unit().prop_map(move |p| Viewpoint::Eye(p * 20.0 * n)),
        lattice.prop_map(Viewpoint::Eye),
        unit().prop_filter("a direction", |d| d.length() > 0.1).prop_map(|d| Viewpoint::Direction(d.normalize())),
        direction.prop_filter("a direction", |d| d.length() > 0.0).prop_map(|d| Viewpoint::Direction(d.normalize())),
    ]
}

fn check_exact(mesh: &Mesh, viewpoint: Viewpoint) -> Result<(), TestCaseError> {
    let power = mesh.power(Budget::QUICK.visits_per_face);
    prop_assert!(power.certificate().is_exact(), "{:?}", power.certificate());
    let order = power.order(mesh.cells(), viewpoint, &mesh.drawn()).front_to_back;
    prop_assert_eq!(misordered(mesh, viewpoint, &order), 0);
    let mut sorted = order;
    sorted.sort();
    prop_assert_eq!(sorted, mesh.drawn());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn checkerboards_are_exact_from_everywhere(viewpoint in viewpoint(4)) {
        check_exact(&checkerboard(4), viewpoint)?;
    }

    #[test]
    fn affine_images_are_exact(
        columns in [unit(), unit(), unit()], viewpoint in viewpoint(4), around: bool, stretch in 0.01..1.0_f64,
    ) {
        let matrix = DMat3::from_cols(columns[0], columns[1], columns[2] * stretch);
        prop_assume!(matrix.determinant().abs() > 0.05 * stretch);
        let mesh = if around { around_diagonals(4) } else { checkerboard(4) };
        check_exact(&mesh.map(|_, p| matrix * p), viewpoint)?;
    }

    #[test]
    fn jittered_grids_are_exact(offsets in prop::collection::vec(unit(), 125), viewpoint in viewpoint(4)) {
        check_exact(&checkerboard(4).map(|i, p| p + offsets[i] * 0.12), viewpoint)?;
    }

    /// Graded towards a wall and bent around an axis, as grids about bodies are.
    #[test]
    fn bent_graded_grids_are_exact(turn in 0.1..1.5_f64, grading in 1.0..3.0_f64, viewpoint in viewpoint(4)) {
        let mesh = checkerboard(6).map(|_, p| {
            let radius = 1.0 + (grading * p.x / 3.0).exp() * 0.1;
            let angle = turn * p.y / 3.0;
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.2 * p.z)
        });
        check_exact(&mesh, viewpoint)?;
    }

    #[test]
    fn a_part_of_the_cells_comes_in_the_same_order(viewpoint in viewpoint(4), step in 2_usize..5) {
        let mesh = checkerboard(3).map(|i, p| p + DVec3::new((i as f64).sin(), (2.0 * i as f64).sin(), 0.0) * 0.1);
        let power = mesh.power(300);
        let drawn: Vec<CellId> = mesh.drawn().into_iter().step_by(step).collect();
        let part = power.order(mesh.cells(), viewpoint, &drawn).front_to_back;
        let whole = power.order(mesh.cells(), viewpoint, &mesh.drawn()).front_to_back;
        let keys = |cells: &[CellId]| -> Vec<f64> { cells.iter().map(|&c| power.key(c, viewpoint).value).collect() };
        let kept: Vec<CellId> = whole.into_iter().filter(|cell| drawn.contains(cell)).collect();
        // Cells with keys equal to rounding may change places.
        for (a, b) in keys(&part).iter().zip(keys(&kept)) {
            prop_assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs() + b.abs()) * 100.0);
        }
    }

    #[test]
    fn doubles_keep_what_floats_lose(a in -1e9..1e9_f64, b in -1.0..1.0_f64, c in 0.5..2.0_f64) {
        let square = |x: Double| x * x;
        // (a + b)² - a² - 2ab - b² is 0; a float alone is off by some 100.
        let sum = Double::difference(a, -b);
        let twice = Double::from(2.0 * a) * Double::from(b);
        let rest = square(sum) - square(Double::from(a)) - twice - square(Double::from(b));
        prop_assert!(rest.high.abs() <= 1e18 * ROUNDING_OF_FOUR, "{}", rest.high);
        let back = sum.over(Double::from(c)) * Double::from(c) - sum;
        prop_assert!(back.high.abs() <= 1e9 * ROUNDING_OF_FOUR, "{}", back.high);
    }
}

/// Some ten roundings of 2⁻¹⁰⁴.
const ROUNDING_OF_FOUR: f64 = 1e-30;

/// Equal heights are convex nowhere; |p|² is only just not convex across a cube's inner faces.
#[test]
fn heights_that_order_nothing_are_refused() {
    let mesh = checkerboard(2);
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let flat = Power::with_heights(mesh.cells(), &adjacency, &[]);
    assert_eq!(flat.certificate().violated, flat.certificate().faces);
    assert!(!flat.certificate().is_exact());
    let squares = mesh.power(0);
    assert_eq!(squares.certificate().violated, 4 * 8);
}

/// |p|² and a little for the odd points: the closed form for boxes, by which the solver's answer is judged too.
#[test]
fn parity_orders_the_checkerboard() {
    let mesh = checkerboard(3);
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let parity = |p: &DVec3| p.length_squared() + 1e-9 * (p.element_sum() % 2.0);
    let heights: Vec<f64> = mesh.positions.iter().map(parity).collect();
    assert!(Power::with_heights(mesh.cells(), &adjacency, &heights).certificate().is_exact());
    // The other way round every inner face is concave.
    let wrong: Vec<f64> = mesh.positions.iter().map(|p| 2.0 * p.length_squared() - parity(p)).collect();
    assert_eq!(Power::with_heights(mesh.cells(), &adjacency, &wrong).certificate().violated, 4 * 27);
}

#[test]
fn the_start_says_what_found_the_heights() {
    let solve = |mesh: &Mesh, visits_per_face| {
        Heights::solve(mesh.cells(), &FaceAdjacency::new(&mesh.tetrahedra), Budget { visits_per_face })
    };
    let board = solve(&checkerboard(3), 300);
    assert_eq!((board.violated, board.source), (0, HeightSource::LocalRelaxation));
    assert!(board.worst > 0.0 && board.visits > 0 && board.violated_at_first > 0);
    let none = solve(&checkerboard(3), 0);
    assert_eq!((none.violated, none.source, none.visits), (none.violated_at_first, HeightSource::SquaredDistance, 0));
    // Sheared so far that a sweep or two from |p|² do not help.
    let sheared = around_diagonals(5).map(|_, p| DVec3::new(p.x + 9.0 * p.y, p.y, p.z - 7.0 * p.x));
    let sheared = solve(&sheared, 300);
    assert_eq!((sheared.violated, sheared.source), (0, HeightSource::QuadraticForm));
}

/// Two cells on one side of their common face, a cell of no volume, the same cell twice, no cell: counted, and an order comes.
#[test]
fn odd_cells_are_counted_and_ordered() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.4), DVec3::new(0.5, 0.5, 0.0)];
    let count = |tetrahedra: &[[u32; 4]]| {
        let mesh =
            Mesh { positions: positions.clone(), tetrahedra: tetrahedra.iter().map(|t| t.map(VertexId)).collect() };
        let power = Power::new(mesh.cells());
        for view in [Viewpoint::Eye(DVec3::splat(3.0)), Viewpoint::Direction(DVec3::Z)] {
            let mut order = power.order(mesh.cells(), view, &mesh.drawn()).front_to_back;
            order.sort();
            assert_eq!(order, mesh.drawn());
        }
        let PowerCertificate { folded, flat, .. } = power.certificate();
        assert_eq!(power.certificate().is_exact(), folded + flat == 0 && power.certificate().imprecise == 0);
        (folded, flat)
    };
    assert_eq!(count(&[[0, 1, 2, 3], [0, 1, 2, 4]]), (1, 0));
    assert_eq!(count(&[[0, 1, 2, 3], [0, 1, 2, 5]]), (0, 1));
    assert_eq!(count(&[[0, 1, 2, 3], [3, 2, 1, 0]]), (4, 0));
    assert_eq!(count(&[]), (0, 0));
    assert_eq!(count(&[[0, 0, 0, 0], [0, 0, 0, 0]]).0, 0);
}

#[test]
fn the_order_does_not_depend_on_threads() {
    let mesh = checkerboard(16).map(|i, p| p + DVec3::new((i as f64).sin(), (3.0 * i as f64).cos(), 0.0) * 0.1);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let order = mesh.power(100).order(mesh.cells(), Viewpoint::Eye(DVec3::splat(5.3)), &mesh.drawn());
            order.front_to_back
        })
    };
    assert!(run(1) == run(3));
}
