//! What the integration `vertex` makes of a pixel, in f64: color and opacity at the vertices of a cell's fan, interpolated on the screen.

use glam::{DVec2, DVec3};
use tetrascope_classify::{FanVertex, Viewpoint, project};
use tetrascope_integrate::{OpticalModel, RgbaAssoc, Segment, TransferFunction, opacity_2d, thick_vertex};
use tetrascope_mesh::TetMesh;
use tetrascope_scene::Plan;

use super::ray::{Fragment, Ray};
use crate::geometry::PixelSpace;

/// Paints the fans of cells, one pixel at a time.
pub(crate) struct FanPainter<'a> {
    mesh: &'a TetMesh,
    scalars: &'a [f64],
    transfer: TransferFunction,
    model: OpticalModel,
    space: PixelSpace,
}

impl<'a> FanPainter<'a> {
    pub(crate) fn new(plan: &Plan, space: PixelSpace, mesh: &'a TetMesh, scalars: &'a [f64]) -> Self {
        Self { mesh, scalars, transfer: plan.transfer.clone(), model: plan.model, space }
    }

    /// The light of a fragment.
    ///
    /// - `corners`: of its cell, in pixel space
    /// - `segment`: of the fragment; what is shown of cells that reach the eye's plane, which have no fan
    pub(crate) fn light(&self, ray: &Ray, fragment: &Fragment, corners: &[DVec3; 4], segment: &Segment) -> RgbaAssoc {
        let is_perspective = self.space.is_perspective;
        if is_perspective && corners.iter().any(|p| p.z <= 0.0) {
            return opacity_2d(&self.transfer, self.model, segment);
        }
        let scalars = self.mesh.tetrahedra()[fragment.cell as usize].map(|v| self.scalars[v.index()]);
        let viewpoint = if is_perspective { Viewpoint::Eye(DVec3::ZERO) } else { Viewpoint::Direction(DVec3::Z) };
        let projected = project(corners, &scalars, [0, 1, 2, 3], viewpoint);
        let Some(thick) = projected.thick else { return RgbaAssoc::TRANSPARENT };
        let on_screen = |p: DVec3| if is_perspective { p.truncate() / p.z } else { p.truncate() };
        let center = on_screen(if is_perspective { thick.ray } else { thick.near });
        let chord =
            if is_perspective { thick.chord_length * thick.ray.z / thick.ray.length() } else { thick.chord_length };
        let peak = thick_vertex(
            &self.transfer,
            self.model,
            &Segment {
                scalar_front: thick.scalar_front,
                scalar_back: thick.scalar_back,
                chord_length: chord * self.space.ray_stretch(center.x, center.y),
            },
        );
        // What is linear on the screen, and 0 on the outline.
        let nearness = |front: f64, back: f64| if is_perspective { 1.0 / front - 1.0 / back } else { back - front };
        let whole = if is_perspective { nearness(thick.near.z, thick.far.z) } else { chord };
        let [front, back] = fragment.depth;
        let share = if whole > 0.0 { (nearness(front, back) / whole).min(1.0) } else { 0.0 };
        if self.model != OpticalModel::DensityEmitter {
            return RgbaAssoc { rgb: peak.rgb.map(|channel| channel * share), opacity: peak.opacity * share };
        }
        let at_center = [thick.scalar_front, thick.scalar_back].map(|s| self.transfer.color(s));
        let at_center: [f64; 3] = std::array::from_fn(|c| 0.5 * (at_center[0][c] + at_center[1][c]));
        let from_center = DVec2::from(ray.center) - center;
        let mut color = at_center;
        for [_, i, j] in projected.fan.triangles() {
            let (FanVertex::Corner(i), FanVertex::Corner(j)) = (i, j) else { continue };
            let (to_p, to_q) = (on_screen(corners[i]) - center, on_screen(corners[j]) - center);
            let area = to_p.perp_dot(to_q);
            let [p, q] = [from_center.perp_dot(to_q) / area, to_p.perp_dot(from_center) / area];
            if p >= 0.0 && q >= 0.0 {
                let [of_p, of_q] = [i, j].map(|corner| self.transfer.color(scalars[corner]));
                color = std::array::from_fn(|c| {
                    (at_center[c] + p * (of_p[c] - at_center[c]) + q * (of_q[c] - at_center[c])).max(0.0)
                });
                break;
            }
        }
        let opacity = peak.opacity * share;
        RgbaAssoc { rgb: color.map(|channel| channel * opacity), opacity }
    }
}
