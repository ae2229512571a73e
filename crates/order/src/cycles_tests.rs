//! Rings stand together, whatever closes them, and nothing else is out of order for it.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use tetrascope_mesh::{CellId, VertexId};
use tetrascope_view::Viewpoint;

use crate::mpvo_tests::{entry, grid, place};
use crate::*;

/// Drawn members of a ring come one right after the other, by the distance of their centroids, and no face between cells that are not of
/// one ring is out of order.
pub(crate) fn assert_rings(cells: Cells<'_>, view: Viewpoint, order: &Order) {
    let mut ring_of = vec![None; cells.tetrahedra.len()];
    for (number, ring) in order.cycles.iter().enumerate() {
        assert!(ring.len() > 1 && ring.is_sorted());
        for cell in ring {
            assert_eq!(ring_of[cell.index()].replace(number), None, "rings share no cell");
        }
        let places: Vec<usize> =
            (0..order.front_to_back.len()).filter(|&i| ring.contains(&order.front_to_back[i])).collect();
        assert!(places.windows(2).all(|pair| pair[0] + 1 == pair[1]), "{places:?}");
        let depth = |place: &usize| match view {
            Viewpoint::Eye(eye) => cells.centroid(order.front_to_back[*place]).distance(eye),
            Viewpoint::Direction(direction) => cells.centroid(order.front_to_back[*place]).dot(direction),
        };
        // Keys are squares in 32 bits.
        assert!(places.windows(2).all(|pair| depth(&pair[0]) <= depth(&pair[1]) + 1e-5), "{places:?}");
    }
    let most = order.cycles.iter().map(Vec::len).max().unwrap_or(1);
    for turn in 0..most {
        let stands_in = |cell: &CellId| {
            ring_of[cell.index()].is_none_or(|ring| order.cycles[ring][turn % order.cycles[ring].len()] == *cell)
        };
        let thinned: Vec<CellId> = order.front_to_back.iter().copied().filter(stands_in).collect();
        assert_eq!(misordered_faces(cells, view, &thinned), 0);
    }
}

/// Long thin cells in a ring, each with its end over the start of the next one; a plate above them all and one below.
fn roof(count: u32) -> (Vec<DVec3>, Vec<[VertexId; 4]>) {
    let mut points = Vec::new();
    let plate = |z: f64| {
        [DVec3::new(-4.0, -3.0, z), DVec3::new(4.0, -3.0, z), DVec3::new(0.0, 5.0, z), DVec3::new(0.0, 0.0, z + 0.1)]
    };
    points.extend(plate(3.0));
    for i in 0..count {
        let on_circle = |turn: f64| DVec3::new(turn.cos(), turn.sin(), 0.0);
        let step = std::f64::consts::TAU / f64::from(count);
        let (start, end) = (on_circle((f64::from(i) - 0.2) * step), on_circle((f64::from(i) + 1.2) * step) + DVec3::Z);
        let width = 0.05 / f64::from(count);
        points.extend([start * (1.0 - width), start * (1.0 + width)]);
        points.extend([-width, width].map(|width| end + (end + DVec3::Z) * width));
    }
    points.extend(plate(-3.0));
    let cells = (0..count + 2).map(|cell| [0, 1, 2, 3].map(|i| VertexId(4 * cell + i))).collect();
    (points, cells)
}

#[test]
fn rings_across_gaps_are_found_and_stand_between_what_is_before_and_behind() {
    for count in [3, 4, 17] {
        let (points, tetrahedra) = roof(count);
        let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
        let visibility = MeshVisibility::new();
        let [bsp, mpvo] = [OrderMethod::BspXmpvo, OrderMethod::Mpvo].map(|method| visibility.prepare(cells, method));
        let ring: Vec<CellId> = (1..=count).map(CellId).collect();
        let all: Vec<CellId> = (0..count + 2).map(CellId).collect();
        for view in [Viewpoint::Direction(-DVec3::Z), Viewpoint::Eye(DVec3::new(0.1, 0.2, 30.0))] {
            let order = bsp.order(cells, view, &all);
            assert_eq!(order.cycles, std::slice::from_ref(&ring), "{count} {view:?}");
            assert_eq!(order.guarantee, Guarantee::Exact);
            assert_rings(cells, view, &order);
            assert_eq!((order.front_to_back[0], order.front_to_back[count as usize + 1]), (all[0], CellId(count + 1)));
            let mut sorted = order.front_to_back;
            sorted.sort_unstable();
            assert_eq!(sorted, all);

            assert!(mpvo.order(cells, view, &all).cycles.is_empty(), "no two of them share a face");
            // What is not drawn still closes the ring.
            let drawn: Vec<CellId> = all.iter().copied().filter(|cell| cell.0 % 2 == 0).collect();
            let some = bsp.order(cells, view, &drawn);
            assert_eq!(some.cycles, order.cycles);
            assert_rings(cells, view, &some);
            let mut sorted = some.front_to_back;
            sorted.sort_unstable();
            assert_eq!(sorted, drawn);
        }
        let opened = bsp.order(cells, Viewpoint::Direction(DVec3::X), &all);
        assert!(opened.cycles.is_empty(), "from the side there is none");
    }
}

/// Blades of a fan, see `a_ring_of_neighbors_is_reported_and_all_cells_are_placed`, as many as asked, and fans above one another.
fn fans(count: u32, levels: u32) -> (Vec<DVec3>, Vec<[VertexId; 4]>) {
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    for level in 0..=levels {
        for i in 0..count {
            let turn = (f64::from(i) - f64::from(level) / 3.0) / f64::from(count) * std::f64::consts::TAU;
            points.push(DVec3::new(turn.cos(), turn.sin(), f64::from(level)));
        }
        points.push(DVec3::new(0.0, 0.0, f64::from(level)));
    }
    let row = count + 1;
    for level in 0..levels {
        let (low, high) = (row * level + count, row * (level + 1) + count);
        for i in 0..count {
            let next = (i + 1) % count;
            let [a, b] = [i, next].map(|i| row * level + i);
            let [c, d] = [a + row, b + row];
            cells.extend([[low, a, b, high], [high, a, b, c], [high, b, c, d]].map(|cell| cell.map(VertexId)));
        }
    }
    (points, cells)
}

#[test]
fn rings_above_one_another_are_told_apart() {
    for (count, levels) in [(6, 1), (7, 3), (40, 5)] {
        let (points, tetrahedra) = fans(count, levels);
        let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
        let all: Vec<CellId> = (0..tetrahedra.len() as u32).map(CellId).collect();
        let visibility = MeshVisibility::new();
        for method in [OrderMethod::Mpvo, OrderMethod::BspXmpvo] {
            let order = visibility.prepare(cells, method).order(cells, Viewpoint::Direction(-DVec3::Z), &all);
            assert_eq!(order.front_to_back.len(), all.len());
            let sizes: Vec<usize> = order.cycles.iter().map(Vec::len).collect();
            assert_eq!(sizes, vec![2 * count as usize; levels as usize], "{method}");
            assert_rings(cells, Viewpoint::Direction(-DVec3::Z), &order);
        }
    }
}

proptest! {
    /// Holes everywhere: of two cells on one ray the nearer one comes first, whether or not they touch.
    #[test]
    fn rays_through_a_mesh_full_of_holes_meet_cells_in_order(
        eye in place(5.0), target in place(1.0), seed: u64, share in 0.1..0.9_f64, step in 1..3_usize,
    ) {
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.3, 1.0, 0.0), DVec3::new(0.1, 0.2, 1.0));
        let mesh = grid(4, |p| shear * (p * 0.5 - 1.0));
        let mut state = seed | 1;
        let mut is_kept = |_: &&[VertexId; 4]| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 31) < share
        };
        let tetrahedra: Vec<_> = mesh.tetrahedra().iter().filter(&mut is_kept).copied().collect();
        let cells = Cells { positions: mesh.positions(), tetrahedra: &tetrahedra };
        let drawn: Vec<CellId> = (0..tetrahedra.len() as u32).map(CellId).step_by(step).collect();
        let direction = target - eye;
        prop_assume!(direction.length() > 0.1);
        let order = MeshVisibility::new().prepare(cells, OrderMethod::BspXmpvo).order(cells, Viewpoint::Eye(eye), &drawn);
        prop_assert_eq!(order.guarantee, Guarantee::Exact);
        // Cells of a regular triangulation: no ring from anywhere.
        prop_assert!(order.cycles.is_empty());
        prop_assert_eq!(order.front_to_back.len(), drawn.len());
        prop_assert_eq!(misordered_faces(cells, Viewpoint::Eye(eye), &order.front_to_back), 0);
        let corners = |cell: CellId| tetrahedra[cell.index()].map(|v| mesh.positions()[v.index()]);
        let entered = |(rank, &cell): (usize, &CellId)| Some((entry(corners(cell), eye, direction)?, rank));
        let mut met: Vec<(f64, usize)> = order.front_to_back.iter().enumerate().filter_map(entered).collect();
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        prop_assert!(met.windows(2).all(|pair| pair[0].1 < pair[1].1), "{:?}", met);
    }
}
