//! Isosurfaces in plans, and where rays meet a plane in a box.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::view::Ray;
use tetrascope::{Isosurface, IsosurfaceMethod, IsosurfacePlan, Isosurfaces, Plan, SurfaceShading, View};

use crate::pictures::{WHITE, plan};

/// A white, unshaded surface.
pub fn white(value: f64, opacity: f64) -> Isosurface {
    Isosurface { value, color: [1.0; 3], back_color: [1.0; 3], opacity, shading: SurfaceShading::None }
}

/// A plan with these surfaces, cut along the ray.
///
/// # Panics
/// If a surface has numbers out of range.
pub fn with_surfaces(plan: &Plan, surfaces: Vec<Isosurface>) -> Plan {
    by_method(plan, surfaces, IsosurfaceMethod::Exact)
}

/// A plan with these surfaces, drawn as the method says.
///
/// # Panics
/// If a surface has numbers out of range.
pub fn by_method(plan: &Plan, surfaces: Vec<Isosurface>, method: IsosurfaceMethod) -> Plan {
    let surfaces = Isosurfaces::new(surfaces).expect("the surfaces are good");
    Plan { isosurfaces: Some(IsosurfacePlan { surfaces, method }), ..plan.clone() }
}

/// A plan that shows surfaces and no volume.
pub fn surfaces_alone(view: View, surfaces: Vec<Isosurface>) -> Plan {
    with_surfaces(&plan(view, WHITE, &[[0.0, 0.0]]), surfaces)
}

/// World coordinates of all points of a mesh.
pub fn points(mesh: &TetMesh) -> Vec<DVec3> {
    mesh.positions().iter().map(|&p| mesh.frame().to_world(p)).collect()
}

/// The ray of a pixel, by its number from the upper left.
pub fn ray_of(view: &View, pixel: usize) -> Ray {
    let [x, y] = place(view, pixel);
    view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// Column and row of a pixel, by its number from the upper left.
pub fn place(view: &View, pixel: usize) -> [u32; 2] {
    [pixel as u32 % view.width, pixel as u32 / view.width]
}
