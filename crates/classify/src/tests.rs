//! What the tests share: random cells, and rays clipped by a cell as an independent reference.

mod cut_tests;
mod hard_tests;
mod projection_tests;
mod sign_tests;
mod table_tests;

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use tetrascope_view::Viewpoint;

use crate::FACES;

/// All orders of four corners; the first twelve are even.
fn permutations() -> Vec<[usize; 4]> {
    let mut all = Vec::new();
    for code in 0..256_usize {
        let order = [code / 64, code / 16 % 4, code / 4 % 4, code % 4];
        if (0..4).all(|corner| order.contains(&corner)) {
            all.push(order);
        }
    }
    all.sort_by_key(|order| is_odd(*order));
    assert_eq!(all.len(), 24);
    assert!(!is_odd(all[11]) && is_odd(all[12]));
    all
}

fn is_odd(order: [usize; 4]) -> bool {
    let inversions = (0..4).flat_map(|i| (0..i).map(move |j| (i, j))).filter(|&(i, j)| order[j] > order[i]).count();
    inversions % 2 == 1
}

fn oriented(mut positions: [DVec3; 4]) -> [DVec3; 4] {
    let [p, q, r, s] = positions;
    if (q - p).cross(r - p).dot(s - p) < 0.0 {
        positions.swap(2, 3);
    }
    positions
}

fn point() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from_array)
}

fn direction() -> impl Strategy<Value = DVec3> {
    point().prop_filter("a direction needs a length", |p| p.length() > 0.1).prop_map(DVec3::normalize)
}

/// A positively oriented cell within the unit cube around 0, not flat.
fn cell() -> impl Strategy<Value = [DVec3; 4]> {
    prop::array::uniform4(point())
        .prop_map(oriented)
        .prop_filter("flat", |&[p, q, r, s]| (q - p).cross(r - p).dot(s - p) > 0.01)
}

fn scalars() -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(-10.0..10.0_f64)
}

/// An eye outside the unit cube, near or not so near, or a direction.
fn viewpoint() -> impl Strategy<Value = Viewpoint> {
    prop_oneof![
        (direction(), 2.0..20.0_f64).prop_map(|(direction, distance)| Viewpoint::Eye(direction * distance)),
        direction().prop_map(Viewpoint::Direction),
    ]
}

/// Where the view looks: at 0.
fn line_of_sight(viewpoint: Viewpoint) -> DVec3 {
    match viewpoint {
        Viewpoint::Eye(eye) => -eye.normalize(),
        Viewpoint::Direction(direction) => direction,
    }
}

/// Orthonormal: to the right, down, and along the line of sight, right-handed as pixels and depth are.
fn screen_basis(viewpoint: Viewpoint) -> [DVec3; 3] {
    let forward = line_of_sight(viewpoint);
    let right = forward.any_orthonormal_vector();
    [right, forward.cross(right), forward]
}

/// Screen position, y down; perspective: as slopes.
fn on_screen(p: DVec3, viewpoint: Viewpoint) -> DVec2 {
    let [right, down, forward] = screen_basis(viewpoint);
    match viewpoint {
        Viewpoint::Eye(eye) => {
            let ray = p - eye;
            DVec2::new(ray.dot(right), ray.dot(down)) / ray.dot(forward)
        }
        Viewpoint::Direction(_) => DVec2::new(p.dot(right), p.dot(down)),
    }
}

/// Origin and direction of the ray of a screen position; the direction has unit depth.
fn ray_of(screen: DVec2, viewpoint: Viewpoint) -> (DVec3, DVec3) {
    let [right, down, forward] = screen_basis(viewpoint);
    let across = right * screen.x + down * screen.y;
    match viewpoint {
        Viewpoint::Eye(eye) => (eye, forward + across),
        Viewpoint::Direction(direction) => (across - 100.0 * direction, direction),
    }
}

/// The interval of t in which `origin + t direction` is in the cell.
fn clip(positions: &[DVec3; 4], origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for [p, q, r] in FACES.map(|face| face.map(|corner| positions[corner])) {
        let outward = (q - p).cross(r - p);
        let (speed, ahead) = (outward.dot(direction), outward.dot(p - origin));
        if speed > 0.0 {
            leave = leave.min(ahead / speed);
        } else if speed < 0.0 {
            enter = enter.max(ahead / speed);
        } else if ahead < 0.0 {
            return None;
        }
    }
    (enter <= leave).then_some((enter, leave))
}

/// The linear field of a cell at a point.
fn field_at(positions: &[DVec3; 4], scalars: &[f64; 4], at: DVec3) -> f64 {
    let [p, q, r, s] = *positions;
    let inverse = glam::DMat3::from_cols(q - p, r - p, s - p).inverse();
    let weights = inverse * (at - p);
    scalars[0] + weights.dot(DVec3::new(scalars[1] - scalars[0], scalars[2] - scalars[0], scalars[3] - scalars[0]))
}

/// Twice the area of a triangle; positive where it runs clockwise on a screen with y down, as drawn.
fn turn(p: DVec2, q: DVec2, r: DVec2) -> f64 {
    (q - p).perp_dot(r - p)
}

/// Twice the area of the convex hull.
fn hull_area(points: &[DVec2; 4]) -> f64 {
    let mut sorted = points.to_vec();
    sorted.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while chain.len() >= 2 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain
    };
    let mut hull = chain(&mut sorted.iter().copied());
    hull.pop();
    hull.extend(chain(&mut sorted.iter().rev().copied()));
    (1..hull.len() - 1).map(|i| turn(hull[0], hull[i], hull[i + 1])).sum()
}
