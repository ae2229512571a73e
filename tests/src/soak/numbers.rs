//! Fields of chance.

use super::mesh::pick;
use crate::meshes::{Random, Tets};

/// Gives every point a scalar, and says of what kind.
pub(super) fn field(random: &mut Random, tets: &mut Tets) -> &'static str {
    let local = super::case::Bounds::of(tets);
    let frequency = random.between(0.5, 4.0);
    let direction = random.point();
    let kind = ["a smooth field", "a linear field", "a random field", "a field of integers", "a constant field"]
        [[0, 0, 0, 1, 1, 2, 2, 2, 3, 4][pick(random, 10)]];
    tets.scalars = tets
        .points
        .iter()
        .map(|&point| {
            let p = (point - local.center) / local.radius;
            match kind {
                "a smooth field" => {
                    (frequency * p.x + 0.3).sin() * (frequency * p.y).cos() + 0.5 * (frequency * p.z).sin()
                }
                "a linear field" => direction.dot(p),
                "a random field" => random.between(-1.0, 1.0),
                "a field of integers" => (3.0 * random.between(-1.0, 1.0)).round(),
                _ => 0.7,
            }
        })
        .collect();
    let [factor, offset] = match pick(random, 10) {
        0 => [1e-30, 0.0],
        1 => [1e30, 0.0],
        2 => [1e-3, 1e9],
        3 => [10.0_f64.powf(random.between(-6.0, 6.0)), random.between(-1e3, 1e3)],
        _ => [1.0, 0.0],
    };
    tets.scalars.iter_mut().for_each(|scalar| *scalar = *scalar * factor + offset);
    if random.unit() < 0.05 {
        let count = 1 + tets.scalars.len() / 10;
        for _ in 0..count {
            let place = pick(random, tets.scalars.len());
            tets.scalars[place] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][pick(random, 3)];
        }
    }
    kind
}
