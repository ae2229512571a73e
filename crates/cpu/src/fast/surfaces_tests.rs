//! Isosurfaces in single cells where 32 bits are short: a tenth of what went wrong is allowed.

use glam::DVec3;
use tetrascope_integrate::{Integration, Isosurface, Isosurfaces, OpticalModel, SurfaceShading, TransferFunction};
use tetrascope_mesh::TetMesh;
use tetrascope_scene::{IsosurfaceMethod, IsosurfacePlan, Plan, Silent};
use tetrascope_view::{Camera, Projection, View};

use super::CpuRenderer;
use crate::reference;

/// In how many pixels a cell with a surface differs by more than `allowed` from the reference, and the largest difference.
fn off(points: [[f64; 3]; 4], scalars: [f64; 4], mut plan: Plan, value: f64, allowed: f32) -> (usize, f32) {
    let points = points.map(DVec3::from_array);
    let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]]).unwrap().mesh;
    let (color, back_color, shading) = ([0.42, 0.11, 0.73], [0.9, 0.1, 0.0], SurfaceShading::None);
    let surfaces = Isosurfaces::new(vec![Isosurface { value, color, back_color, opacity: 1.0, shading }]).unwrap();
    plan.isosurfaces = Some(IsosurfacePlan { surfaces, method: IsosurfaceMethod::Exact });
    let rendered = CpuRenderer::new(&mesh, &scalars).unwrap().render(&plan, &Silent).unwrap();
    let expected = reference::render(&mesh, &scalars, &plan, &Silent).unwrap().image;
    assert!(rendered.counts.crossings > 0);
    let pixels = rendered.image.pixels().iter().zip(expected.pixels());
    let differences: Vec<f32> = pixels.map(|(a, b)| (0..4).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max)).collect();
    (differences.iter().filter(|&&d| d > allowed).count(), differences.iter().copied().fold(0.0, f32::max))
}

fn view(eye: DVec3, target: DVec3, up: DVec3, projection: Projection, size: [u32; 2]) -> View {
    View::new(&Camera { eye, target, up, projection }, size[0], size[1]).unwrap()
}

/// What lets a surface in a face be seen once, a scalar within 1e-5 of it counts as on it, used to move the cut too, along a ray that runs nearly along
/// the surface by ever so much more.
#[test]
fn a_segment_is_cut_at_the_value_of_the_surface() {
    let points = [[0.719, -0.531, -0.332], [0.486, 0.672, -0.996], [-0.311, -0.037, -0.286], [0.308, 0.419, 0.477]];
    let (eye, target) = (DVec3::new(1.13, 0.175, -0.822), DVec3::new(0.217, 0.275, -0.3));
    let perspective = Projection::Perspective { fov_y: 68.8_f64.to_radians() };
    let view = view(eye, target, DVec3::new(0.105, 0.934, -0.109), perspective, [97, 65]);
    let transfer = TransferFunction::new(&[[-3.0, 0.19, 0.576, 0.292]], &[[0.356, 0.605]]).unwrap();
    let plan = Plan::new(view, transfer, OpticalModel::Emitter);
    let (count, worst) = off(points, [-2.0, 2.0, -1.0, -3.0], plan, 0.0, 5e-6);
    assert!(count <= 2, "{count} pixels, up to {worst:e}");
}

/// Running integrals hold no part of a piece deeper than a million, and of two that are deeper count each for half.
#[test]
fn cells_with_surfaces_deeper_than_32_bits_know() {
    let points = [[-0.5, -0.5, 0.0], [-0.5, -0.25, 0.0], [-0.5, -0.25, 0.25], [-0.25, -0.25, 0.25]];
    let (eye, target) = (DVec3::new(1.01, -0.625, 0.125), DVec3::new(-0.625, -0.625, 0.125));
    let view = view(eye, target, DVec3::Y, Projection::Orthographic { height: 1.09 }, [32, 32]);
    let colors = [
        [-0.984, 0.234, 0.0357, 0.466],
        [-0.324, 0.849, 0.571, 0.977],
        [0.335, 0.93, 0.998, 0.758],
        [0.995, 0.353, 0.663, 0.145],
    ];
    let transfer = TransferFunction::new(&colors, &[[0.995, 1.07e10]]).unwrap();
    for integration in [Integration::Exact, Integration::Cumulative] {
        let plan = Plan::new(view, transfer.clone(), OpticalModel::DensityEmitter);
        let plan = Plan { integration, ..plan };
        let (count, worst) = off(points, [-0.552, -0.612, 0.779, -0.574], plan, 0.35670478391291915, 1e-4);
        assert!(count <= 2, "{integration}: {count} pixels, up to {worst:e}");
    }
}
