//! From where orders are looked at.

use glam::DVec3;
use tetrascope::view::Viewpoint;
use tetrascope_tests::meshes::Random;
use tetrascope_tests::pictures::random_turn;

/// A hundred viewpoints: far and near, in the mesh, on its points, in the planes of its faces, and along directions.
///
/// - `corners`: of one cell of a random number
pub(super) fn hundred(
    random: &mut Random,
    center: DVec3,
    size: f64,
    mut corners: impl FnMut(&mut Random) -> [DVec3; 4],
) -> Vec<Viewpoint> {
    let mut views = Vec::with_capacity(100);
    for number in 0..100 {
        let turned = random_turn(random) * DVec3::Z;
        let [a, b, c, d] = corners(random);
        views.push(match number % 10 {
            0 | 1 => Viewpoint::Eye(center + turned * (size * random.between(1.5, 6.0))),
            2 => Viewpoint::Eye(center + turned * (size * random.between(0.5, 1.5))),
            // In a cell, in the plane of a face, on an edge, on a point.
            3 | 4 => {
                let shares = [0, 1, 2, 3].map(|_| random.between(0.1, 1.0));
                let sum: f64 = shares.iter().sum();
                let inside = [a, b, c, d].iter().zip(shares).map(|(&p, w)| p * (w / sum)).sum();
                Viewpoint::Eye(inside)
            }
            5 => Viewpoint::Eye(a + (b - a) * random.between(-2.0, 3.0) + (c - a) * random.between(-2.0, 3.0)),
            6 => Viewpoint::Eye(if random.unit() < 0.5 { a } else { a + (b - a) * 0.5 }),
            // Along a face, along an axis, along anything.
            7 => Viewpoint::Direction((b - a).normalize()),
            8 => Viewpoint::Direction(DVec3::AXES[(random.unit() * 3.0) as usize]),
            _ => Viewpoint::Direction(turned),
        });
    }
    views
}
