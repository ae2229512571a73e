//! Neighbors come in the right order from everywhere; rings are found; what is flat or folded does no harm.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use tetrascope_mesh::{CellId, Dataset, TetMesh, VertexId, decompose, rings_sample};
use tetrascope_view::Viewpoint;

use crate::cycles::{Arrows, groups};
use crate::cycles_tests::assert_rings;
use crate::gaps::Gaps;
use crate::*;

pub(crate) fn mesh_of(dataset: &Dataset) -> TetMesh {
    decompose(dataset).unwrap().mesh
}

fn all(mesh: &TetMesh) -> Vec<CellId> {
    (0..mesh.tetrahedra().len() as u32).map(CellId).collect()
}

/// Five tetrahedra a cube on a grid of points that `moved` shifts.
pub(crate) fn grid(cells: usize, mut moved: impl FnMut(DVec3) -> DVec3) -> TetMesh {
    let mut dataset = rings_sample(cells);
    let side = cells + 1;
    for (index, point) in dataset.points.iter_mut().enumerate() {
        let [i, j, k] = [index % side, index / side % side, index / side / side].map(|n| n as f64);
        *point = moved(DVec3::new(i, j, k));
    }
    mesh_of(&dataset)
}

/// A cube from -1 to 1 whose inner points are moved: no two faces turn at once.
pub(crate) fn jittered(cells: usize, seed: u64) -> TetMesh {
    let (mut state, side) = (seed, cells as f64);
    grid(cells, |p| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let [x, y, z] = [40, 20, 0].map(|shift| (state >> shift & 0xff_ffff) as f64 / f64::from(1 << 24) - 0.5);
        let is_inner = p.min_element() > 0.0 && p.max_element() < side;
        (p + if is_inner { DVec3::new(x, y, z) * 0.3 } else { DVec3::ZERO }) / side * 2.0 - 1.0
    })
}

pub(crate) fn place(reach: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-reach..reach).prop_map(DVec3::from)
}

pub(crate) fn viewpoint() -> impl Strategy<Value = Viewpoint> {
    prop_oneof![
        // Inside about as often as outside.
        place(0.9).prop_map(Viewpoint::Eye),
        place(8.0).prop_map(Viewpoint::Eye),
        place(1.0).prop_filter("a direction", |d| d.length() > 0.1).prop_map(|d| Viewpoint::Direction(d.normalize())),
        // Straight along the axes, where faces are edge-on.
        (0..3_usize, prop::bool::ANY)
            .prop_map(|(axis, turned)| { Viewpoint::Direction(DVec3::AXES[axis] * if turned { -1.0 } else { 1.0 }) }),
    ]
}

proptest! {
    #[test]
    fn neighbors_come_in_order(cells in 1..7_usize, view in viewpoint(), shear in place(0.6)) {
        let affine = DMat3::from_cols(DVec3::X, DVec3::new(shear.x, 1.0, 0.0), DVec3::new(shear.y, shear.z, 1.0));
        for mesh in [mesh_of(&rings_sample(cells)), grid(cells, |p| affine * (p / cells as f64 * 2.0 - 1.0))] {
            let cells: Cells<'_> = (&mesh).into();
            let order = Mpvo::new(cells).order(cells, view, &all(&mesh));
            prop_assert_eq!(order.front_to_back.len(), mesh.tetrahedra().len());
            prop_assert!(order.cycles.is_empty());
            prop_assert_eq!(misordered_faces(cells, view, &order.front_to_back), 0);
        }
    }

    /// The mesh is convex: along a ray every cell comes before all that the ray meets later, also those that it does not touch.
    #[test]
    fn rays_through_a_convex_mesh_meet_cells_in_order(eye in place(6.0), target in place(0.8)) {
        let mesh = grid(4, |p| p * 0.5 - 1.0);
        let cells: Cells<'_> = (&mesh).into();
        let order = Mpvo::new(cells).order(cells, Viewpoint::Eye(eye), &all(&mesh));
        let direction = target - eye;
        prop_assume!(direction.length() > 0.1);
        let mut met: Vec<(f64, usize)> = order
            .front_to_back
            .iter()
            .enumerate()
            .filter_map(|(rank, &cell)| Some((entry(mesh.corners(cell), eye, direction)?, rank)))
            .collect();
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        prop_assert!(met.windows(2).all(|pair| pair[0].1 < pair[1].1), "{:?}", met);
    }

    #[test]
    fn what_is_not_drawn_still_orders(view in viewpoint(), step in 2..5_usize) {
        let mesh = mesh_of(&rings_sample(4));
        let cells: Cells<'_> = (&mesh).into();
        let mpvo = Mpvo::new(cells);
        let drawn: Vec<CellId> = all(&mesh).into_iter().step_by(step).collect();
        let order = mpvo.order(cells, view, &drawn).front_to_back;
        let mut sorted = order.clone();
        sorted.sort();
        prop_assert_eq!(sorted, drawn.clone());
        prop_assert_eq!(misordered_faces(cells, view, &order), 0);
    }
}

proptest! {
    /// One order after the other from a moving eye, each repaired or made anew: all right.
    #[test]
    fn orders_along_a_path_are_right(
        cells in 2..9_usize, start in place(3.0), steps in prop::collection::vec((place(1.0), -12..1_i32), 1..12), seed: u64,
    ) {
        let mesh = jittered(cells, seed);
        let cells: Cells<'_> = (&mesh).into();
        let mpvo = Mpvo::new(cells);
        let all = all(&mesh);
        let mut eye = start;
        for (step, size) in steps {
            eye += step * 2.0_f64.powi(size);
            let order = mpvo.order(cells, Viewpoint::Eye(eye), &all);
            let mut sorted = order.front_to_back.clone();
            sorted.sort_unstable();
            prop_assert_eq!(&sorted, &all);
            let anew = Mpvo::new(cells).order(cells, Viewpoint::Eye(eye), &all);
            prop_assert_eq!(&order.cycles, &anew.cycles);
            prop_assert!(!order.cycles.is_empty() || misordered_faces(cells, Viewpoint::Eye(eye), &order.front_to_back) == 0);
        }
    }
}

/// Where a ray enters a tetrahedron, in units of the direction; `None` if it misses it or passes within rounding of its rim.
pub(crate) fn entry([a, b, c, d]: [DVec3; 4], origin: DVec3, direction: DVec3) -> Option<f64> {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for ([p, q, r], apex) in [([b, c, d], a), ([a, c, d], b), ([a, b, d], c), ([a, b, c], d)] {
        let normal = (q - p).cross(r - p);
        let inward = normal * normal.dot(apex - p).signum();
        let (height, speed) = (inward.dot(origin - p), inward.dot(direction));
        if speed > 0.0 {
            enter = enter.max(-height / speed);
        } else {
            leave = leave.min(-height / speed);
        }
    }
    (leave - enter > 1e-9).then_some(enter)
}

#[test]
fn centroids_alone_misorder_what_planes_do_not() {
    let mesh = mesh_of(&rings_sample(8));
    let cells: Cells<'_> = (&mesh).into();
    let view = Viewpoint::Direction(DVec3::new(0.3, 0.5, -0.8).normalize());
    let by_centroid = Centroid.order(cells, view, &all(&mesh)).front_to_back;
    assert!(misordered_faces(cells, view, &by_centroid) > 20, "the judge finds what is wrong");
}

#[test]
fn rings_are_found_each_once() {
    // 0 -> 1 -> 2 -> 0 and 3 -> 4 -> 3, joined by an arrow that makes no ring; 5 is alone.
    const NONE: u32 = u32::MAX;
    let table = [
        [1, NONE, NONE, NONE],
        [2, NONE, NONE, NONE],
        [0, 3, NONE, NONE],
        [4, NONE, NONE, NONE],
        [3, NONE, NONE, NONE],
        [0, NONE, NONE, NONE],
    ];
    let arrows = Arrows { nearer: &[1, 1, 3, 1, 1, 1], table: &table, gaps: &Gaps::default() };
    let groups_of = |arrows: Arrows<'_>, placed: &[CellId], roots: &[u32]| {
        let mut found = Vec::new();
        groups(arrows, placed, roots.iter().copied().map(CellId), |group| {
            let mut group = group.to_vec();
            group.sort_unstable();
            found.push(group);
        });
        found
    };
    assert_eq!(groups_of(arrows, &[], &[5, 0, 1, 2, 3, 4]), [vec![3, 4], vec![0, 1, 2], vec![5]]);
    assert_eq!(groups_of(arrows, &[3, 4].map(CellId), &[1]), [[0, 1, 2]], "what was placed is not given again");
    // Across a gap 5 lies in front of 3: all but 5 behind it, and with 3 in front of 5 too one ring of five or six.
    let gaps = Gaps::new(6, &[(CellId(3), CellId(5))]);
    assert_eq!(groups_of(Arrows { gaps: &gaps, ..arrows }, &[], &[0]), [[0, 1, 2, 3, 4, 5]]);
    let none = Arrows { nearer: &[0; 6], ..arrows };
    assert_eq!(groups_of(none, &[], &[2, 0, 1, 5]), [[2], [0], [1], [5]]);
}

/// A column of twisted sectors, each leaning over the next one like the blades of a fan: seen along its axis, two of the three cells of
/// every sector form one ring; from the side there is none.
#[test]
fn a_ring_of_neighbors_is_reported_and_all_cells_are_placed() {
    let count = 6_u32;
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    for level in 0..2 {
        for i in 0..count {
            let angle = (f64::from(i) - f64::from(level) / 3.0) / f64::from(count) * std::f64::consts::TAU;
            points.push(DVec3::new(angle.cos(), angle.sin(), f64::from(level)));
        }
    }
    points.push(DVec3::new(0.0, 0.0, 0.0));
    points.push(DVec3::Z);
    let (low, high) = (2 * count, 2 * count + 1);
    for i in 0..count {
        let next = (i + 1) % count;
        let [a, b, c, d] = [i, next, count + i, count + next];
        cells.push([low, a, b, high].map(VertexId));
        cells.push([high, a, b, c].map(VertexId));
        cells.push([high, b, c, d].map(VertexId));
    }
    let cells = Cells { positions: &points, tetrahedra: &cells };
    let drawn: Vec<CellId> = (0..3 * count).map(CellId).collect();
    let mpvo = Mpvo::new(cells);
    for (view, in_ring) in [
        (Viewpoint::Direction(-DVec3::Z), 12),
        (Viewpoint::Eye(DVec3::new(0.1, 0.2, 9.0)), 12),
        (Viewpoint::Direction(DVec3::X), 0),
        (Viewpoint::Direction(DVec3::Y), 0),
    ] {
        let order = mpvo.order(cells, view, &drawn);
        let mut sorted = order.front_to_back.clone();
        sorted.sort();
        assert_eq!(sorted, drawn);
        assert_eq!(
            order.cycles.iter().map(Vec::len).collect::<Vec<_>>(),
            if in_ring > 0 { vec![in_ring] } else { vec![] }
        );
        assert_rings(cells, view, &order);
    }
}

#[test]
fn flat_and_folded_cells_order_what_they_can() {
    // A flat cell between two others, and one folded back over its neighbor.
    let points = [
        DVec3::ZERO,
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::new(0.3, 0.3, 0.0),
        DVec3::new(0.2, 0.2, -1.0),
        DVec3::new(0.3, 0.2, 0.5),
    ];
    let tetrahedra = [[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 4, 5], [0, 1, 2, 6]].map(|cell: [u32; 4]| cell.map(VertexId));
    let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
    let drawn: Vec<CellId> = (0..4).map(CellId).collect();
    for eye in [DVec3::new(0.2, 0.3, 5.0), DVec3::new(0.1, 0.1, -5.0), DVec3::new(9.0, 0.0, 0.0), points[4]] {
        let order = Mpvo::new(cells).order(cells, Viewpoint::Eye(eye), &drawn);
        assert_eq!(order.front_to_back.len(), 4);
    }
}
