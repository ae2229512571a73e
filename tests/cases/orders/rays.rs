//! A judge that knows nothing of orders: rays through random cells, cut against every cell.

use glam::DVec3;
use tetrascope::order::{Cells, Order};
use tetrascope::view::Viewpoint;
use tetrascope_tests::meshes::Random;
use tetrascope_tests::shapes::along_ray;

/// Pairs along rays, and how many of them come in the wrong order.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    pub(super) pairs: usize,
    pub(super) wrong: usize,
    /// Pairs whose two cells are in one ring: no order has them all right.
    pub(super) in_rings: usize,
}

/// Judges neighbors along rays. What a ray meets later than the next comes later too if all neighbors are right.
///
/// Segments shorter than 1e-7 of `size` judge nobody, nor do two that overlap by more than that: which comes first is rounding there,
/// or nothing.
pub(super) fn judge_by_rays(
    cells: Cells<'_>,
    size: f64,
    viewpoint: Viewpoint,
    order: &Order,
    rays: usize,
    random: &mut Random,
) -> Found {
    let shortest = 1e-7 * size;
    let count = cells.tetrahedra.len();
    let mut rank = vec![0; count];
    for (place, cell) in order.front_to_back.iter().enumerate() {
        rank[cell.index()] = place;
    }
    let mut ring_of = vec![usize::MAX; count];
    for (ring, members) in order.cycles.iter().enumerate() {
        members.iter().for_each(|cell| ring_of[cell.index()] = ring);
    }
    let mut found = Found::default();
    for _ in 0..rays {
        let corners = cells.tetrahedra[(random.unit() * count as f64) as usize].map(|v| cells.positions[v.index()]);
        let shares = corners.map(|_| random.between(0.05, 1.0));
        let total: f64 = shares.iter().sum();
        let aim: DVec3 = corners.iter().zip(shares).map(|(&p, w)| p * (w / total)).sum();
        let (origin, direction, from) = match viewpoint {
            Viewpoint::Eye(eye) => (eye, (aim - eye).normalize(), 0.0),
            Viewpoint::Direction(direction) => (aim, direction, f64::NEG_INFINITY),
        };
        if !direction.is_finite() {
            continue;
        }
        for pair in along_ray(cells, origin, direction, from, shortest).windows(2) {
            let [front, back] = [pair[0], pair[1]];
            if front.depth[1] > back.depth[0] + shortest {
                continue;
            }
            found.pairs += 1;
            if ring_of[front.cell] != usize::MAX && ring_of[front.cell] == ring_of[back.cell] {
                found.in_rings += 1;
            } else {
                found.wrong += usize::from(rank[front.cell] > rank[back.cell]);
            }
        }
    }
    found
}
