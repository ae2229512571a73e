//! Rays meet cells and pieces front to back, the pieces of a cell make up the cell, and what cannot be cut stays as it was.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use tetrascope_mesh::{CellId, VertexId};
use tetrascope_view::Viewpoint;

use super::relation::{Relation, relation};
use crate::*;

/// Tetrahedra that share no points.
#[derive(Clone, Debug, Default)]
struct Soup {
    points: Vec<DVec3>,
    tetrahedra: Vec<[VertexId; 4]>,
}

impl Soup {
    fn add(&mut self, corners: [DVec3; 4]) {
        let first = self.points.len() as u32;
        self.points.extend(corners);
        self.tetrahedra.push([0, 1, 2, 3].map(|i| VertexId(first + i)));
    }

    /// Bars around the z axis, each with its high end over the low end of the one before, seen from +z.
    fn add_ring(&mut self, count: usize, radius: f64, height: f64) {
        let thickness = 0.12 * radius * (TAU / count as f64).min(1.0);
        for i in 0..count {
            let at = |turns: f64, z: f64| {
                let (y, x) = (TAU * turns / count as f64).sin_cos();
                DVec3::new(radius * x, radius * y, height + 2.0 * thickness * z)
            };
            // Each reaches a little beyond the ends of its neighbors.
            let (start, end) = (at(i as f64, 1.0), at(i as f64 + 1.0, -1.0));
            let along = (end - start) * 0.3;
            let (start, end) = (start - along, end + along);
            let side = along.cross(DVec3::Z).normalize() * thickness;
            self.add([
                start + side,
                start - side,
                end + DVec3::Z * (thickness * 0.5),
                end - DVec3::Z * (thickness * 0.5),
            ]);
        }
    }

    fn cells(&self) -> Cells<'_> {
        Cells { positions: &self.points, tetrahedra: &self.tetrahedra }
    }

    /// All cells by the distance of their centroids, said to be one ring.
    fn one_ring(&self, viewpoint: Viewpoint) -> Order {
        let all: Vec<CellId> = (0..self.tetrahedra.len() as u32).map(CellId).collect();
        Order { cycles: vec![all.clone()], ..Centroid.order(self.cells(), viewpoint, &all) }
    }

    /// Cells that do not penetrate each other, of those offered.
    fn disjoint(offered: &[[DVec3; 4]]) -> Self {
        let mut soup = Self::default();
        for &corners in offered {
            let [a, b, c, d] = corners;
            let is_apart = |t: &[VertexId; 4]| {
                // An eye in the cell sees it everywhere: only a plane between the two can part them.
                let inside = Viewpoint::Eye((a + b + c + d) * 0.25);
                relation(inside, &corners, &t.map(|v| soup.points[v.index()]), 0.0) != Relation::Entangled
            };
            if (b - a).dot((c - a).cross(d - a)).abs() > 1e-4 && soup.tetrahedra.iter().all(is_apart) {
                soup.add(corners);
            }
        }
        soup
    }
}

/// Where a line is inside a cell and behind planes; `None` if nowhere.
fn interval(corners: [DVec3; 4], planes: &[CutPlane], origin: DVec3, direction: DVec3) -> Option<[f64; 2]> {
    let [a, b, c, d] = corners;
    let faces = [([b, c, d], a), ([a, c, d], b), ([a, b, d], c), ([a, b, c], d)].map(|([p, q, r], apex)| {
        let normal = (q - p).cross(r - p).normalize();
        CutPlane { point: p, normal: normal * -normal.dot(apex - p).signum() }
    });
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for plane in faces.iter().chain(planes) {
        let (room, speed) = (plane.normal.dot(plane.point - origin), plane.normal.dot(direction));
        if speed > 0.0 {
            leave = leave.min(room / speed);
        } else if speed < 0.0 {
            enter = enter.max(room / speed);
        } else if room < 0.0 {
            return None;
        }
    }
    (leave > enter).then_some([enter, leave])
}

/// How the pieces of an order lie along one ray: none before what it hides, and none lost.
fn check_ray(soup: &Soup, order: &Order, viewpoint: Viewpoint, through: DVec3) -> Result<(), TestCaseError> {
    let (origin, direction) = match viewpoint {
        Viewpoint::Eye(eye) => (eye, (through - eye).normalize()),
        Viewpoint::Direction(direction) => (through - direction * 100.0, direction),
    };
    let mut pieces = order.pieces.iter().peekable();
    let mut reached = f64::NEG_INFINITY;
    let mut chords = vec![0.0; soup.tetrahedra.len()];
    // Corners of size 1 and unit normals of faces whose heights are 1e-2 or more.
    let within = 1e-9;
    for (place, &cell) in order.front_to_back.iter().enumerate() {
        let corners = soup.tetrahedra[cell.index()].map(|v| soup.points[v.index()]);
        let planes = pieces.next_if(|piece| piece.place as usize == place).map_or(&[][..], |piece| &piece.planes);
        let Some([enter, leave]) = interval(corners, planes, origin, direction) else { continue };
        if leave <= 0.0 {
            continue;
        }
        let enter = enter.max(0.0);
        if leave - enter > within {
            prop_assert!(enter >= reached - within, "{cell:?} at {enter} after {reached}");
            reached = reached.max(leave);
        }
        chords[cell.index()] += leave - enter;
    }
    prop_assert!(pieces.next().is_none(), "pieces by ascending place");
    for (chord, &vertices) in chords.iter().zip(&soup.tetrahedra) {
        let corners = vertices.map(|v| soup.points[v.index()]);
        let whole =
            interval(corners, &[], origin, direction).map_or(0.0, |[enter, leave]| leave.max(0.0) - enter.max(0.0));
        prop_assert!((chord - whole).abs() <= within, "chord {chord} of {whole}");
    }
    Ok(())
}

/// Rays through random points of the unit cube, and through the middle of every cell.
fn check(soup: &Soup, order: &Order, viewpoint: Viewpoint, through: &[DVec3]) -> Result<(), TestCaseError> {
    let middles = (0..soup.tetrahedra.len()).map(|cell| soup.cells().centroid(CellId(cell as u32)));
    through.iter().copied().chain(middles).try_for_each(|through| check_ray(soup, order, viewpoint, through))
}

fn place(reach: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-reach..reach).prop_map(DVec3::from)
}

fn viewpoint() -> impl Strategy<Value = Viewpoint> {
    prop_oneof![
        place(0.7).prop_map(Viewpoint::Eye),
        place(5.0).prop_map(Viewpoint::Eye),
        place(1.0).prop_filter("a direction", |d| d.length() > 0.1).prop_map(|d| Viewpoint::Direction(d.normalize())),
    ]
}

/// Long thin cells, which make rings, and others.
fn tetrahedron() -> impl Strategy<Value = [DVec3; 4]> {
    (place(0.8), place(0.8), place(0.3), place(0.3))
        .prop_map(|(start, end, across, up)| [start + across, start - across, end + up, end - up])
}

const FROM_ABOVE: [Viewpoint; 2] = [Viewpoint::Direction(DVec3::NEG_Z), Viewpoint::Eye(DVec3::new(0.03, 0.02, 7.0))];

fn grid_of_rays() -> Vec<DVec3> {
    (0..60 * 60)
        .map(|i| DVec3::new((f64::from(i % 60) + 0.37) / 30.0 - 1.0, (f64::from(i / 60) + 0.21) / 30.0 - 1.0, 0.1))
        .collect()
}

#[test]
fn a_ring_of_bars_takes_few_cuts() {
    for count in [3, 4, 5, 12, 60] {
        let mut soup = Soup::default();
        soup.add_ring(count, 0.7, 0.0);
        for view in FROM_ABOVE {
            let before = soup.one_ring(view);
            assert!(check(&soup, &before, view, &grid_of_rays()).is_err(), "{count} bars are no ring from {view:?}");
            let order = before.cut_cycles(soup.cells(), view);
            check(&soup, &order, view, &grid_of_rays()).unwrap();
            assert_eq!(order.cycles, Vec::<Vec<CellId>>::new());
            // One plane opens the ring, through two bars at the best; some more where it puts a few bars aside first.
            let cuts = order.front_to_back.len() - count;
            assert!((1..=if count < 12 { 2 } else { 6 }).contains(&cuts), "{cuts} cuts of {count} bars");
        }
    }
}

/// Rings inside one another, behind one another, and two that have bars across both.
#[test]
fn rings_among_rings_are_all_cut() {
    let mut soup = Soup::default();
    soup.add_ring(3, 0.25, 0.0);
    soup.add_ring(7, 0.8, 0.0);
    soup.add_ring(4, 0.5, -1.0);
    soup.add_ring(6, 0.45, 1.0);
    for view in FROM_ABOVE {
        let order = soup.one_ring(view).cut_cycles(soup.cells(), view);
        check(&soup, &order, view, &grid_of_rays()).unwrap();
        assert!(order.cycles.is_empty());
        let pieces = order.front_to_back.len() - 20;
        assert!((4..=8).contains(&pieces), "{pieces} cuts of four rings");
    }
}

/// From aside the bars are no ring: nothing is cut, whatever the cycles say.
#[test]
fn what_is_no_ring_is_not_cut() {
    let mut soup = Soup::default();
    soup.add_ring(4, 0.7, 0.0);
    for view in [Viewpoint::Direction(DVec3::X), Viewpoint::Eye(DVec3::new(0.1, -5.0, 0.2))] {
        let order = soup.one_ring(view).cut_cycles(soup.cells(), view);
        assert_eq!((order.front_to_back.len(), order.pieces.len(), order.cycles.len()), (4, 0, 0));
        check(&soup, &order, view, &grid_of_rays()).unwrap();
    }
}

/// Cells outside of rings keep their places, two rings are cut by themselves, and undrawn cells play no part.
#[test]
fn rings_are_cut_where_they_stand() {
    let mut soup = Soup::default();
    soup.add_ring(3, 0.6, 2.0);
    soup.add_ring(4, 0.6, -2.0);
    // Between the rings, behind both, and in front.
    for z in [0.0, -4.0, 4.0] {
        soup.add([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * 0.5 + DVec3::Z * z));
    }
    let view = FROM_ABOVE[0];
    let ids = |numbers: &[u32]| -> Vec<CellId> { numbers.iter().map(|&n| CellId(n)).collect() };
    let order = Order {
        cycles: vec![ids(&[0, 1, 2]), ids(&[3, 4, 5, 6])],
        ..Order::whole(ids(&[9, 1, 0, 2, 7, 6, 3, 5, 4, 8]), Guarantee::Exact)
    };
    let cut = order.clone().cut_cycles(soup.cells(), view);
    check(&soup, &cut, view, &grid_of_rays()).unwrap();
    assert!(cut.cycles.is_empty() && cut.guarantee == Guarantee::Exact);
    let place = |cell: u32| cut.front_to_back.iter().position(|&c| c == CellId(cell)).unwrap();
    assert_eq!((place(9), place(8)), (0, cut.front_to_back.len() - 1));
    assert!(cut.front_to_back[1..place(7)].iter().all(|c| c.0 < 3));
    assert!(cut.front_to_back[place(7) + 1..place(8)].iter().all(|c| (3..7).contains(&c.0)));
    assert_eq!(cut.clone().cut_cycles(soup.cells(), view), cut, "there is nothing left to cut");

    // One bar of each ring is not drawn: the others are sorted, and none is cut.
    let drawn = Order { front_to_back: ids(&[9, 1, 0, 7, 6, 3, 5, 8]), ..order };
    let cut = drawn.cut_cycles(soup.cells(), view);
    assert_eq!((cut.front_to_back.len(), cut.pieces.len(), cut.cycles.len()), (8, 0, 0));
}

/// Two cells through one another have no order: they stay as they were, and are still reported; another ring is cut.
#[test]
fn entangled_cells_stay() {
    let mut soup = Soup::default();
    soup.add_ring(3, 0.6, 2.0);
    let cell = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    soup.add(cell);
    soup.add(cell.map(|p| p * 0.8 + 0.05));
    let view = FROM_ABOVE[1];
    let ids = |numbers: &[u32]| -> Vec<CellId> { numbers.iter().map(|&n| CellId(n)).collect() };
    let order =
        Order { cycles: vec![ids(&[0, 1, 2]), ids(&[3, 4])], ..Order::whole(ids(&[0, 1, 2, 4, 3]), Guarantee::Exact) };
    let cut = order.cut_cycles(soup.cells(), view);
    assert_eq!(cut.cycles, [ids(&[3, 4])]);
    assert!(cut.front_to_back.ends_with(&ids(&[4, 3])) && !cut.pieces.is_empty());
}

/// Faces that touch to within rounding are no entanglement.
#[test]
fn rounding_is_no_entanglement() {
    let face = [DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.1, 0.3, 0.7), DVec3::new(0.4, 1.3, 0.2)];
    let [above, below] = [face[0] + DVec3::Z, face[1] - DVec3::Z];
    let normal = (face[1] - face[0]).cross(face[2] - face[0]).normalize();
    let shifted = face.map(|p| face[0] + (p - face[0]) * 0.3 + (face[1] - face[0]) * 0.2 + normal * 3e-16);
    let (a, b) = ([face[0], face[1], face[2], above], [shifted[0], shifted[1], shifted[2], below]);
    for view in FROM_ABOVE {
        assert_eq!(relation(view, &a, &b, 1.0), Relation::Front);
        assert_eq!(relation(view, &b, &a, 1.0), Relation::Behind);
    }
    let deep = shifted.map(|p| p + normal * 1e-9);
    assert_eq!(relation(FROM_ABOVE[0], &a, &[deep[0], deep[1], deep[2], below], 1.0), Relation::Entangled);
}

/// Cells without volume are in nobody's way, and too many cells are left alone.
#[test]
fn flat_cells_and_large_rings_do_no_harm() {
    let mut soup = Soup::default();
    soup.add_ring(3, 0.7, 0.0);
    soup.add([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y]);
    soup.add([DVec3::ONE; 4]);
    for view in FROM_ABOVE {
        let order = soup.one_ring(view).cut_cycles(soup.cells(), view);
        assert!(order.cycles.is_empty() && order.front_to_back.len() >= 6);
    }
    let mut many = Soup::default();
    many.add_ring(super::MEMBERS + 1, 0.7, 0.0);
    let order = many.one_ring(FROM_ABOVE[0]);
    assert_eq!(order.clone().cut_cycles(many.cells(), FROM_ABOVE[0]), order);
}

/// The largest ring that is cut at all.
#[test]
fn a_long_ring_is_cut() {
    let mut soup = Soup::default();
    soup.add_ring(super::MEMBERS, 0.7, 0.0);
    let order = soup.one_ring(FROM_ABOVE[0]).cut_cycles(soup.cells(), FROM_ABOVE[0]);
    assert!(order.cycles.is_empty());
    for through in (0..super::MEMBERS as u32).step_by(50).map(|cell| soup.cells().centroid(CellId(cell))) {
        check_ray(&soup, &order, FROM_ABOVE[0], through).unwrap();
    }
}

proptest! {
    #[test]
    fn soups_come_in_order(
        offered in prop::collection::vec(tetrahedron(), 2..40),
        view in viewpoint(),
        through in prop::collection::vec(place(0.9), 40),
    ) {
        let soup = Soup::disjoint(&offered);
        let order = soup.one_ring(view).cut_cycles(soup.cells(), view);
        prop_assert!(order.cycles.is_empty());
        check(&soup, &order, view, &through)?;
    }

    /// Bars in all directions through a small space: many rings that share bars.
    #[test]
    fn bars_come_in_order(
        bars in prop::collection::vec((place(1.0), place(1.0), place(0.04), place(0.04)), 8..60),
        view in viewpoint(),
        through in prop::collection::vec(place(0.9), 40),
    ) {
        let bars: Vec<[DVec3; 4]> = bars
            .into_iter()
            .map(|(start, end, across, up)| [start + across, start - across, end + up, end - up])
            .collect();
        let soup = Soup::disjoint(&bars);
        let order = soup.one_ring(view).cut_cycles(soup.cells(), view);
        prop_assert!(order.cycles.is_empty());
        check(&soup, &order, view, &through)?;
    }

    /// The two pieces on both sides of a plane have the same point and opposite normals; a turned scene has as many pieces.
    #[test]
    fn pieces_fit_together(count in 3..9_usize, turn in place(3.0), shift in place(2.0)) {
        let mut soup = Soup::default();
        soup.add_ring(count, 0.7, 0.0);
        let turn = DMat3::from_rotation_z(turn.x) * DMat3::from_rotation_x(turn.y);
        for p in &mut soup.points {
            *p = turn * *p + shift;
        }
        let view = Viewpoint::Eye(turn * DVec3::new(0.0, 0.1, 6.0) + shift);
        let order = soup.one_ring(view).cut_cycles(soup.cells(), view);
        prop_assert!(order.cycles.is_empty() && !order.pieces.is_empty());
        let planes: Vec<&CutPlane> = order.pieces.iter().flat_map(|piece| &piece.planes).collect();
        for plane in &planes {
            prop_assert!((plane.normal.length() - 1.0).abs() < 1e-15);
            prop_assert!(planes.iter().any(|other| other.point == plane.point && other.normal == -plane.normal));
        }
    }
}
