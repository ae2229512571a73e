//! Gradients as normals, and the light on them.

use glam::DVec3;
use tetrascope_integrate::SurfaceShading;
use tetrascope_integrate::surface::Crossing;
use tetrascope_mesh::{CellId, TetMesh, vertex_gradients};
use tetrascope_scene::{Gradients, Lighting};

/// The light in a mesh with a field.
///
/// Directions are the world's. Gradients are taken in the mesh's frame, which is the world moved and uniformly scaled, and of
/// them only the direction counts.
pub(super) struct Light<'a> {
    lighting: Lighting,
    mesh: &'a TetMesh,
    scalars: &'a [f64],
    /// One a point; empty if none are interpolated.
    gradients: Vec<DVec3>,
}

impl<'a> Light<'a> {
    /// Computes the gradients that are needed, and no others.
    pub(super) fn new(lighting: Lighting, needed: Gradients, mesh: &'a TetMesh, scalars: &'a [f64]) -> Self {
        let gradients = if needed == Gradients::Points { vertex_gradients(mesh, scalars) } else { Vec::new() };
        Self { lighting, mesh, scalars, gradients }
    }

    /// Points whose gradients are interpolated.
    pub(super) fn point_gradients(&self) -> u64 {
        self.gradients.len() as u64
    }

    pub(super) fn lights_volume(&self) -> bool {
        self.lighting.volume
    }

    /// What a surface shows where a ray crosses it.
    ///
    /// - `corners`, `point`: of the cell, and where the ray meets the surface in it; in pixel space
    pub(super) fn shade(
        &self,
        crossing: &Crossing<'_>,
        cell: u32,
        corners: &[DVec3; 4],
        point: DVec3,
        to_eye: DVec3,
    ) -> [f64; 3] {
        let gradient = match crossing.surface.shading {
            SurfaceShading::None => return crossing.color,
            SurfaceShading::Flat => self.gradient_of(cell),
            SurfaceShading::Smooth => self.gradient_at(cell, corners, point),
        };
        self.lighting.phong.shade(crossing.color, gradient.into(), to_eye.into(), self.to_light(to_eye))
    }

    /// How much of its light the volume shows at a point, the highlight included.
    pub(super) fn intensity(&self, cell: u32, corners: &[DVec3; 4], point: DVec3, to_eye: DVec3) -> f64 {
        let gradient = self.gradient_at(cell, corners, point);
        let [body, highlight] = self.lighting.phong.intensities(gradient.into(), to_eye.into(), self.to_light(to_eye));
        body + highlight
    }

    fn to_light(&self, to_eye: DVec3) -> [f64; 3] {
        self.lighting.direction.unwrap_or(to_eye).into()
    }

    /// The direction of a cell's constant gradient, of no particular length; zero where the scalar is constant.
    fn gradient_of(&self, cell: u32) -> DVec3 {
        let corners = self.mesh.corners(CellId(cell));
        let scalars = self.mesh.tetrahedra()[cell as usize].map(|v| self.scalars[v.index()]);
        // By the largest, so that differences of huge scalars stay finite.
        let largest = scalars.iter().fold(0.0_f64, |largest, scalar| largest.max(scalar.abs()));
        if largest == 0.0 {
            return DVec3::ZERO;
        }
        let [a, b, c] = [1, 2, 3].map(|n| corners[n] - corners[0]);
        let [da, db, dc] = [1, 2, 3].map(|n| scalars[n] / largest - scalars[0] / largest);
        // Times six volumes, which are positive: no division by a small one.
        b.cross(c) * da + c.cross(a) * db + a.cross(b) * dc
    }

    /// The points' gradients, interpolated.
    fn gradient_at(&self, cell: u32, corners: &[DVec3; 4], point: DVec3) -> DVec3 {
        let gradients = self.mesh.tetrahedra()[cell as usize].map(|v| self.gradients[v.index()]);
        let shares = shares(corners, point);
        gradients.iter().zip(shares).map(|(&gradient, share)| gradient * share).sum()
    }
}

/// How much each corner of a tetrahedron counts at a point in it; not negative, adding up to 1.
///
/// The same in any coordinates that are an affine map of the world's, pixel space among them.
fn shares(corners: &[DVec3; 4], point: DVec3) -> [f64; 4] {
    let [a, b, c, d] = corners.map(|corner| corner - point);
    // Volumes that the point makes with the four faces.
    let volumes = [b.dot(c.cross(d)), -a.dot(c.cross(d)), a.dot(b.cross(d)), -a.dot(b.cross(c))];
    let whole: f64 = volumes.iter().sum();
    // Rounding may put the point outside by a little.
    let inside = volumes.map(|volume| (volume / whole).max(0.0));
    let sum: f64 = inside.iter().sum();
    if sum > 0.0 && sum.is_finite() { inside.map(|share| share / sum) } else { [0.25; 4] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from)
    }

    proptest! {
        /// Corners weighted by their shares give the point, in cells either way round.
        #[test]
        fn shares_give_the_point_back(corners in [point(), point(), point(), point()], weights in [0.0..1.0, 0.0..1.0, 0.0..1.0, 0.01..1.0]) {
            let [a, b, c, d] = corners;
            let volume6 = (b - a).dot((c - a).cross(d - a)).abs();
            prop_assume!(volume6 > 1e-3);
            let sum: f64 = weights.iter().sum();
            let inside: DVec3 = corners.iter().zip(weights).map(|(&corner, weight): (_, f64)| corner * (weight / sum)).sum();
            let found = shares(&corners, inside);
            prop_assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            for (share, weight) in found.iter().zip(weights) {
                // A dozen products of lengths up to 4, cubed, relative to the volume.
                prop_assert!((share - weight / sum).abs() < 64.0 * 16.0 * f64::EPSILON / volume6, "{found:?}");
            }
        }
    }
}
