//! Cells that hide one another in rings, cut: as the reference draws them, which sorts ray by ray.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec3;
use tetrascope_integrate::{Integration, Isosurface, Isosurfaces, OpticalModel, SurfaceShading, TransferFunction};
use tetrascope_mesh::{CellId, TetMesh};
use tetrascope_order::{Cells, Centroid, CycleRemedy, Order, VisibilityOrder};
use tetrascope_scene::{IsosurfaceMethod, IsosurfacePlan, Plan, PlanError, Rendered, Silent};
use tetrascope_view::{Camera, LinearImage, Projection, View, Viewpoint};

use super::{CpuRenderer, Prepared, remember};
use crate::{RenderError, reference};

/// Cells by their centroids, said to be one ring.
#[derive(Debug)]
struct OneRing;

impl VisibilityOrder for OneRing {
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order {
        let all = (0..cells.tetrahedra.len() as u32).map(CellId).collect();
        Order { cycles: vec![all], ..Centroid.order(cells, viewpoint, drawn) }
    }
}

/// Points, cells and scalars.
#[derive(Default)]
struct Soup {
    points: Vec<DVec3>,
    cells: Vec<[u32; 4]>,
    scalars: Vec<f64>,
}

impl Soup {
    fn add(&mut self, corners: [DVec3; 4]) {
        let first = self.points.len() as u32;
        self.points.extend(corners);
        self.cells.push([0, 1, 2, 3].map(|i| first + i));
        self.scalars.extend([0.0, 0.3, 0.7, 1.0]);
    }

    /// Bars around the z axis, each with its high end over the low end of the one before, seen from +z.
    fn add_ring(&mut self, count: usize, radius: f64, height: f64) {
        let thickness = 0.12 * radius * (TAU / count as f64).min(1.0);
        for i in 0..count {
            let at = |turns: f64, z: f64| {
                let (y, x) = (TAU * turns / count as f64 + 0.1).sin_cos();
                DVec3::new(radius * x, radius * y, height + 2.0 * thickness * z)
            };
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

    /// Draws with all cells in one ring, by this remedy.
    fn fast(&self, plan: &Plan, cycles: CycleRemedy) -> Rendered {
        let mesh = self.mesh();
        let renderer = CpuRenderer::new(&mesh, &self.scalars).unwrap();
        remember(&renderer.orders, Prepared { method: plan.order, order: Arc::new(OneRing) });
        renderer.render(&Plan { cycles, ..plan.clone() }, &Silent).unwrap()
    }

    fn reference(&self, plan: &Plan) -> LinearImage {
        reference::render(&self.mesh(), &self.scalars, plan, &Silent).unwrap().image
    }

    fn mesh(&self) -> TetMesh {
        TetMesh::from_tetrahedra(&self.points, &self.cells).unwrap().mesh
    }
}

/// Rings before and behind each other, one within another, and behind the eye of some views.
fn rings() -> Soup {
    let mut soup = Soup::default();
    soup.add_ring(3, 0.6, 0.0);
    soup.add_ring(4, 0.5, -0.8);
    soup.add_ring(11, 1.0, 0.1);
    soup.add_ring(5, 0.7, 3.0);
    // The eye of a view is in here. No surface is: seen along, one would show how far surfaces are moved in f32.
    soup.add([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * 0.8 + DVec3::new(-0.2, -0.2, 1.2)));
    soup.scalars.truncate(soup.points.len() - 4);
    soup.scalars.extend([0.3, 0.35, 0.4, 0.45]);
    soup
}

fn views() -> Vec<View> {
    let perspective = Projection::Perspective { fov_y: 0.7 };
    let flat = Projection::Orthographic { height: 2.6 };
    let towards = |eye: DVec3, projection| {
        View::new(&Camera { eye, target: DVec3::new(0.02, 0.01, 0.0), up: DVec3::Y, projection }, 96, 80).unwrap()
    };
    vec![
        towards(DVec3::new(0.1, -0.2, 6.0), perspective),
        towards(DVec3::new(0.1, -0.2, 6.0), flat),
        // Straight along the axis: the bars' ends are seen edge-on.
        towards(DVec3::new(0.02, 0.01, 5.0), flat),
        // Inside a cell, with a ring behind.
        towards(DVec3::new(0.0, 0.0, 1.4), Projection::Perspective { fov_y: 1.6 }),
        // Among the bars.
        towards(DVec3::new(0.03, 0.02, 0.2), Projection::Perspective { fov_y: 2.2 }),
        // From behind.
        towards(DVec3::new(0.3, 0.2, -5.0), perspective),
    ]
}

/// - `strength`: of the extinction; at 1 a bar takes away about half of the light
fn plan(view: View, strength: f64) -> Plan {
    let color = [[0.0, 0.05, 0.2, 0.9], [0.4, 0.2, 0.9, 0.3], [1.0, 1.0, 0.55, 0.05]];
    let extinction = [[0.0, 3.0], [0.6, 9.0], [1.0, 6.0]].map(|[scalar, extinction]| [scalar, strength * extinction]);
    let transfer = TransferFunction::new(&color, &extinction).unwrap();
    Plan::new(view, transfer, OpticalModel::DensityEmitter)
}

fn with_surfaces(plan: Plan) -> Plan {
    let surface = |value, opacity| Isosurface {
        value,
        color: [0.9, 0.5, 0.25],
        back_color: [0.125, 0.25, 0.75],
        opacity,
        shading: SurfaceShading::None,
    };
    let surfaces = Isosurfaces::new(vec![surface(0.25, 0.4), surface(0.5, 0.7), surface(0.85, 0.3)]).unwrap();
    Plan { isosurfaces: Some(IsosurfacePlan { surfaces, method: IsosurfaceMethod::Exact }), ..plan }
}

/// The largest difference in any channel.
fn distance(a: &LinearImage, b: &LinearImage) -> f32 {
    let pairs = a.pixels().iter().flatten().zip(b.pixels().iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn cut_rings_are_drawn_as_rays_meet_them() {
    let soup = rings();
    for (index, view) in views().into_iter().enumerate() {
        let plan = plan(view, 1.0);
        let reference = soup.reference(&plan);
        let cut = soup.fast(&plan, CycleRemedy::Cut);
        let found = distance(&cut.image, &reference);
        assert!(found <= 1e-5, "view {index}: {found}");
        assert_eq!(cut.counts.cyclic, soup.cells.len() as u64, "rings as the order found them");
        // Where a ring is seen, the picture differs without the remedy, and there are more parts than cells.
        let reported = soup.fast(&plan, CycleRemedy::Report);
        assert!(cut.counts.drawn > reported.counts.drawn);
        let without = distance(&reported.image, &reference);
        assert!(without > 2e-3, "view {index}: no ring to be seen, {without}");
    }
}

/// A surface is met once, also where a cut goes through it.
#[test]
fn surfaces_go_on_from_piece_to_piece() {
    let soup = rings();
    for (index, view) in views().into_iter().enumerate() {
        let plan = with_surfaces(plan(view, 0.3));
        let reference = soup.reference(&plan);
        let cut = soup.fast(&plan, CycleRemedy::Cut);
        let found = distance(&cut.image, &reference);
        // The fast renderer moves surfaces by 1e-5 of a cell's range of scalars.
        assert!(found <= 1e-4, "view {index}: {found}");
        let whole = soup.fast(&plan, CycleRemedy::Report);
        assert_eq!(cut.counts.crossings, whole.counts.crossings, "view {index}");
    }
}

/// The opacity of a cell whose optics are homogeneous does not depend on how often it is cut, nor on the method.
#[test]
fn every_method_draws_pieces() {
    let soup = rings();
    let transfer = TransferFunction::new(&[[0.0, 0.2, 0.4, 0.6]], &[[0.0, 8.0]]).unwrap();
    for view in views() {
        let plan = Plan::new(view, transfer.clone(), OpticalModel::DensityEmitter);
        let reference = soup.reference(&plan);
        for integration in [Integration::Average, Integration::Opacity2d, Integration::Partial, Integration::Cumulative]
        {
            let cut = soup.fast(&Plan { integration, ..plan.clone() }, CycleRemedy::Cut);
            let found = distance(&cut.image, &reference);
            assert!(found <= 1e-5, "{integration}: {found}");
        }
    }
}

#[test]
fn a_fan_is_not_cut() {
    let soup = rings();
    let mesh = soup.mesh();
    let renderer = CpuRenderer::new(&mesh, &soup.scalars).unwrap();
    let plan = plan(views()[0], 1.0);
    let plan = Plan { integration: Integration::Vertex, cycles: CycleRemedy::Cut, ..plan };
    assert!(matches!(renderer.render(&plan, &Silent), Err(RenderError::Plan(PlanError::FanWithCut))));
}

/// Pixel centers that lie in the plane of a cut: their rays belong to one of the two pieces, and nothing is drawn twice.
#[test]
fn rays_in_a_cut_belong_to_one_piece() {
    use crate::geometry::{ClipCell, PixelSpace};
    let flat = Projection::Orthographic { height: 8.0 };
    let through = Projection::Perspective { fov_y: 1.0 };
    for projection in [flat, through] {
        let camera = Camera { eye: DVec3::Z * 6.0, target: DVec3::ZERO, up: DVec3::Y, projection };
        let view = View::new(&camera, 9, 9).unwrap();
        let space = PixelSpace::new(&view, 1.0);
        let shape = [DVec3::new(-2.1, -2.0, 0.1), DVec3::new(2.2, -1.7, 0.0), DVec3::new(0.1, 2.6, 0.3), DVec3::Z];
        let cell = ClipCell::new(&shape.map(|p| space.transform(p)), &[0.0, 1.0, 2.0, 3.0], true)
            .or_else(|| ClipCell::new(&shape.map(|p| space.transform(p)), &[0.0, 1.0, 2.0, 3.0], false))
            .unwrap();
        // Planes through the middle column, the middle row, a diagonal, and one that rays cross.
        for normal in [DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.3, -0.2, 0.9)] {
            let [behind, before] = [normal, -normal].map(|n| [space.face(DVec3::Z * 0.4, n)]);
            for pixel in 0..81 {
                let [u, w] = [pixel % 9, pixel / 9].map(|p| PixelSpace::center(p, 9));
                let chord = |cuts: &[_]| {
                    let span = cell.span_behind(cuts, space.is_perspective, u, w);
                    span.map_or(0.0, |span| span.depth[1] - span.depth[0])
                };
                let (whole, parts) = (chord(&[]), [chord(&behind), chord(&before)]);
                assert!((whole - parts[0] - parts[1]).abs() < 1e-13, "{normal}, pixel {pixel}: {whole}, {parts:?}");
            }
        }
    }
}
