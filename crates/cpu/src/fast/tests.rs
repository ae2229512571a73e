//! What the fast renderer does and leaves out: counts, memory of transfer functions, early ends, careful cells.

use glam::DVec3;
use tetrascope_integrate::{Integration, Isosurfaces, OpticalModel, TransferFunction};
use tetrascope_mesh::TetMesh;

use tetrascope_scene::{Plan, Silent};
use tetrascope_view::{Camera, Projection, View};

use super::{CpuRenderer, KEPT};
use crate::rays::RayTracer;
use crate::reference::render as reference;

/// A row of small tetrahedra along -z, whose scalar is their number.
fn row(count: u32) -> (TetMesh, Vec<f64>) {
    let shape = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 1.0)];
    let points: Vec<DVec3> =
        (0..count).flat_map(|i| shape.map(|p| p - DVec3::new(0.3, 0.3, 1.2 * f64::from(i)))).collect();
    let cells: Vec<[u32; 4]> = (0..count).map(|i| [0, 1, 2, 3].map(|v| 4 * i + v)).collect();
    let scalars = (0..count).flat_map(|i| [f64::from(i); 4]).collect();
    (TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh, scalars)
}

fn plan(extinction: &[[f64; 2]]) -> Plan {
    let camera = Camera {
        eye: DVec3::new(0.03, 0.07, 6.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.4 },
    };
    let transfer = TransferFunction::new(&[[0.0, 0.9, 0.5, 0.1], [9.0, 0.1, 0.5, 0.9]], extinction).unwrap();
    Plan::new(View::new(&camera, 40, 40).unwrap(), transfer, OpticalModel::DensityEmitter)
}

#[test]
fn what_cannot_be_seen_is_left_out_and_counted() {
    let (mesh, scalars) = row(10);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    // Cells 0 to 4 are transparent.
    let mut transparent = plan(&[[4.0, 0.0], [5.0, 1.0]]);
    let counts = renderer.render(&transparent, &Silent).unwrap().counts;
    assert_eq!((counts.cells, counts.transparent, counts.outside, counts.drawn), (10, 5, 0, 5));
    // The eye between cell 6 and cell 7: what lies behind it is outside.
    transparent.view.eye.z = -1.2 * 7.0 + 1.1;
    let counts = renderer.render(&transparent, &Silent).unwrap().counts;
    assert_eq!((counts.transparent, counts.outside, counts.drawn), (5, 2, 3));
}

#[test]
fn two_transfer_functions_are_remembered_and_no_more() {
    let (mesh, scalars) = row(4);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let plans = [0.5, 1.0, 2.0].map(|rho| plan(&[[0.0, rho]]));
    let none = Isosurfaces::default();
    let first = renderer.optics(&plans[0], &none);
    let _second = renderer.optics(&plans[1], &none);
    assert!(std::sync::Arc::ptr_eq(&first, &renderer.optics(&plans[0], &none)), "made anew though it was remembered");
    let _third = renderer.optics(&plans[2], &none);
    assert_eq!(renderer.optics.lock().unwrap().len(), KEPT);
    assert!(std::sync::Arc::ptr_eq(&first, &renderer.optics(&plans[0], &none)), "the least recently used goes first");
}

#[test]
fn an_opaque_block_ends_early_within_the_error_promised() {
    let (mesh, scalars) = row(10);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let mut opaque = plan(&[[0.0, 30.0]]);
    let full = renderer.render(&opaque, &Silent).unwrap();
    opaque.termination = 1e-3;
    let ended = renderer.render(&opaque, &Silent).unwrap();
    assert!(ended.counts.fragments < full.counts.fragments, "{} fragments", ended.counts.fragments);
    for (a, b) in full.image.pixels().iter().zip(ended.image.pixels()) {
        for (a, b) in a.iter().zip(b) {
            // The largest color behind is 0.9.
            assert!((a - b).abs() <= 1e-3, "{a} {b}");
        }
    }
}

#[test]
fn only_cells_with_a_face_on_edge_or_at_the_eye_are_drawn_carefully() {
    let (mesh, scalars) = row(3);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let mut plan = plan(&[[0.0, 1.0]]);
    assert_eq!(renderer.render(&plan, &Silent).unwrap().counts.careful, 0);
    // In the plane of the middle cell's face z = 0 of its own: exactly edge-on, and the cell behind is seen past it.
    plan.view.eye = DVec3::new(5.0, 0.02, -1.2);
    (plan.view.forward, plan.view.right) = (DVec3::NEG_X, DVec3::NEG_Z);
    assert_eq!(renderer.render(&plan, &Silent).unwrap().counts.careful, 1);
    // Inside the first cell.
    plan.view.eye = DVec3::new(0.0, 0.0, 0.1);
    (plan.view.forward, plan.view.right) = (DVec3::NEG_Z, DVec3::X);
    let inside = renderer.render(&plan, &Silent).unwrap();
    assert!(inside.counts.careful >= 1);
    assert!(inside.image.pixels().iter().all(|p| p[3] > 0.0), "the eye's own cell covers the picture");
}

/// Four points in a line and four in a plane, but for the rounding of their coordinates: which rays meet them is rounding alone, and both renderers
/// had other ones, with chords as long as an edge.
#[test]
fn cells_without_thickness_are_those_of_the_reference() {
    let needle = [
        DVec3::new(0.123_176_791_761_620_91, -0.408_174_557_585_253_2, -0.711_140_639_052_077_8),
        DVec3::new(0.634_528_251_758_370_4, -0.651_359_774_252_211_9, -0.219_327_021_150_095_17),
        DVec3::new(0.464_077_765_092_787_25, -0.570_298_035_363_225_7, -0.383_264_893_784_089_4),
        DVec3::new(-0.047_273_694_903_962_216, -0.327_112_818_696_266_9, -0.875_078_511_686_072_1),
    ];
    let sheet = [
        DVec3::new(0.0, 0.0, 1.008_090_512_171_663_4e-9),
        DVec3::new(-0.666_660_112_222_972_2, -0.666_666_666_666_666_6, 3.360_301_707_238_878e-10),
        DVec3::new(-0.999_980_336_668_916_6, -1.0, 0.0),
        DVec3::new(-1.0, -1.0, 0.0),
    ];
    let along_the_needle = Camera {
        eye: DVec3::new(-1.196_809_693_300_385_1, -5.516_445_103_350_505, -6.195_717_526_408_599),
        target: DVec3::new(0.056_902_505_602_627_9, -0.516_301_120_607_377_3, 0.139_574_466_968_289_04),
        up: DVec3::new(-0.172_869_430_179_800_4, -0.596_993_315_573_841_8, 0.742_264_226_195_095_6),
        projection: Projection::Orthographic { height: 4.992_596_304_265_343 },
    };
    let across_the_sheet = Camera {
        eye: DVec3::new(0.0, 4.242_640_687_119_286, 5.040_452_560_858_317e-10),
        target: DVec3::new(0.0, 0.0, 5.040_452_560_858_317e-10),
        up: DVec3::Z,
        projection: Projection::Orthographic { height: 2.828_427_124_746_190_1 },
    };
    for (points, camera, [width, height]) in [(needle, along_the_needle, [31, 25]), (sheet, across_the_sheet, [21, 17])]
    {
        // Either way round.
        for cell in [[0, 3, 2, 1], [3, 2, 0, 1], [0, 1, 2, 3], [0, 1, 3, 2]] {
            let mesh = TetMesh::from_tetrahedra(&points, &[cell]).unwrap().mesh;
            let transfer = TransferFunction::new(&[[0.0; 4]], &[[0.0, 1.0]]).unwrap();
            let plan = Plan::new(View::new(&camera, width, height).unwrap(), transfer, OpticalModel::Absorption);
            let [fast, right] = [
                CpuRenderer::new(&mesh, &[0.0; 4]).unwrap().render(&plan, &Silent).unwrap().image,
                reference(&mesh, &[0.0; 4], &plan, &Silent).unwrap().image,
            ];
            for (pixel, (a, b)) in fast.pixels().iter().zip(right.pixels()).enumerate() {
                assert!((a[3] - b[3]).abs() < 1e-6, "{cell:?} pixel {pixel}: {a:?}, the reference has {b:?}");
            }
        }
    }
}

/// Fans of cells that come as near to the eye as 1e-7 of their depth were cut at 1e-4 of it, so that another fan was painted than that of the cell.
#[test]
fn a_cell_near_the_eye_is_painted_whole() {
    let shape = [DVec3::new(-1.0, -1.0, -2.0), DVec3::new(1.2, -1.0, -2.0), DVec3::new(0.1, 1.3, -2.0)];
    for near in [1e-2, 1e-4, 1e-5, 1e-7] {
        let points = [shape[0], shape[1], shape[2], DVec3::new(near, near, -near)];
        let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]]).unwrap().mesh;
        let scalars = [0.0, 4.0, 9.0, 2.0];
        let mut plan = plan(&[[0.0, 1.0], [9.0, 3.0]]);
        plan.integration = Integration::Vertex;
        plan.view.eye = DVec3::ZERO;
        (plan.view.forward, plan.view.right, plan.view.up) = (DVec3::NEG_Z, DVec3::X, DVec3::Y);
        check_fans(&format!("{near}"), &mesh, &scalars, &plan);
    }
}

/// Holds the fans of a mesh against those in f64, ray by ray.
fn check_fans(name: &str, mesh: &TetMesh, scalars: &[f64], plan: &Plan) {
    let image = CpuRenderer::new(mesh, scalars).unwrap().render(plan, &Silent).unwrap().image;
    let tracer = RayTracer::new(mesh, scalars, &plan.view).unwrap();
    let (width, height) = (plan.view.width, plan.view.height);
    let pixels: Vec<[u32; 2]> = (0..width * height).map(|pixel| [pixel % width, pixel / width]).collect();
    let rays = tracer.trace(&pixels);
    let shader = tracer.shader(plan, &Silent).unwrap();
    let mut seen = 0;
    for (ray, pixel) in image.pixels().iter().enumerate() {
        let light = shader.light(&rays, ray);
        seen += usize::from(light.opacity > 0.0);
        assert!((f64::from(pixel[3]) - light.opacity).abs() < 2e-5, "{name} {ray}: {pixel:?} {light:?}");
        for (a, b) in pixel.iter().zip(light.rgb) {
            assert!((f64::from(*a) - b).abs() < 2e-5, "{name} {ray}: {pixel:?} {light:?}");
        }
    }
    assert!(seen > 0, "{name}: nothing is seen");
}

/// A face that is seen edge-on has the thick vertex on the outline, and one triangle of the fan has no area. Pixels on its line belonged to
/// none of the others, and with another order of the corners a whole triangle was left out.
#[test]
fn a_thick_vertex_on_the_outline_leaves_no_triangle_out() {
    let points = [[-0.4, -0.6, -0.6], [0.0, -0.6, -0.6], [0.0, -0.6, -0.2], [0.0, -0.2, -0.2]].map(DVec3::from);
    let values = [-0.683, -0.74, 0.835, 0.843];
    let color = [[-0.98, 0.965, 0.0309, 0.65], [0.995, 0.0575, 0.676, 0.041]];
    let transfer = TransferFunction::new(&color, &[[0.995, 2.0]]).unwrap();
    let camera = Camera {
        eye: DVec3::NEG_Z * 2.81,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 45_f64.to_radians() },
    };
    let view = View::new(&camera, 39, 39).unwrap();
    let plan = Plan { integration: Integration::Vertex, ..Plan::new(view, transfer, OpticalModel::DensityEmitter) };
    for first in 0..4 {
        for second in (0..4).filter(|&c| c != first) {
            let rest: Vec<usize> = (0..4).filter(|&c| c != first && c != second).collect();
            for order in [[first, second, rest[0], rest[1]], [first, second, rest[1], rest[0]]] {
                let mesh = TetMesh::from_tetrahedra(&order.map(|c| points[c]), &[[0, 1, 2, 3]]).unwrap().mesh;
                check_fans(&format!("{order:?}"), &mesh, &order.map(|c| values[c]), &plan);
            }
        }
    }
}
