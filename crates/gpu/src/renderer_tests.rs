//! Whole pictures: in blocks and in parts, twice, after the device is gone; what is bound, and what it takes.

use std::sync::Arc;

use glam::DVec3;
use tetrascope_integrate::{Integration, Isosurface, Isosurfaces, OpticalModel, SurfaceShading, TransferFunction};
use tetrascope_mesh::{ArrayValues, Decomposition, decompose, rings_sample};
use tetrascope_order::{MeshVisibility, OrderMethod};
use tetrascope_scene::{
    BufferRole, GpuPath, IsosurfaceMethod, IsosurfacePlan, Lighting, Mixing, Plan, Rendered, Silent,
};
use tetrascope_view::{Camera, Projection, View};

use crate::testing::{adapter, gpu};
use crate::{AdapterChoice, Gpu, GpuError, GpuRenderer};

/// Cubes of five or six tetrahedra along a side of the mesh.
const SIDE: usize = 12;

fn field(side: usize) -> (Decomposition, Vec<f64>) {
    let dataset = rings_sample(side);
    let ArrayValues::F64(values) = &dataset.point_arrays[0].values else { panic!("the sample has doubles") };
    let scalars = values.clone();
    (decompose(&dataset).unwrap(), scalars)
}

fn plan(size: u32) -> Plan {
    let camera = Camera {
        eye: DVec3::new(3.0, 2.0, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.6 },
    };
    let transfer =
        TransferFunction::new(&[[-0.6, 0.1, 0.2, 0.9], [1.2, 1.0, 0.5, 0.1]], &[[-0.6, 0.0], [1.2, 3.0]]).unwrap();
    let view = View::new(&camera, size, size).unwrap();
    Plan { order: OrderMethod::Mpvo, ..Plan::new(view, transfer, OpticalModel::DensityEmitter) }
}

fn renderer(gpu: &Arc<Gpu>) -> GpuRenderer {
    renderer_of(gpu, SIDE)
}

fn renderer_of(gpu: &Arc<Gpu>, side: usize) -> GpuRenderer {
    let (decomposition, scalars) = field(side);
    GpuRenderer::new(Arc::clone(gpu), &decomposition.mesh, &scalars, Arc::new(MeshVisibility::new())).unwrap()
}

fn largest(a: &Rendered, b: &Rendered) -> f32 {
    let pairs = a.image.pixels().iter().flatten().zip(b.image.pixels().iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn blocks_and_parts_give_the_same_picture() {
    let Some(whole) = gpu() else { return };
    // 64 KiB: 4096 cells a part of the mesh and a block, 4096 pixels a part of the picture.
    let choice = AdapterChoice { name: Some(adapter()), default_limits: true, largest_binding: Some(1 << 16) };
    let small = Arc::new(Gpu::open(&choice).unwrap());
    for path in [GpuPath::Compute, GpuPath::Triangles] {
        for order in [OrderMethod::Mpvo, OrderMethod::Centroid] {
            let mut plan = Plan { order, ..plan(96) };
            plan.gpu.path = Some(path);
            let [expected, drawn] = [&whole, &small].map(|gpu| renderer(gpu).render(&plan, &Silent).unwrap());
            assert!(expected.counts.drawn > 8000 && drawn.counts.drawn > 0);
            assert!(expected.image.pixel(48, 48)[3] > 0.2);
            // Centroids are sorted on the CPU where the mesh is in parts, which rounds otherwise: far cells in another order.
            let within = if order == OrderMethod::Mpvo { 2e-6 } else { 2e-2 };
            let found = largest(&expected, &drawn);
            assert!(found <= within, "{path} {order}: {found:e}");
        }
    }
}

#[test]
fn a_picture_has_the_same_bits_again() {
    let Some(gpu) = gpu() else { return };
    let renderer = renderer(&gpu);
    for order in [OrderMethod::Centroid, OrderMethod::Mpvo, OrderMethod::PerPixel, OrderMethod::KBuffer { window: 6 }] {
        let plan = Plan { order, ..plan(48) };
        let [first, second] = [0, 1].map(|_| renderer.render(&plan, &Silent).unwrap());
        assert_eq!(first.image, second.image, "{order}");
        assert_eq!(first.counts, second.counts, "{order}");
    }
}

#[test]
fn pixels_that_sort_agree_with_a_right_order() {
    let Some(gpu) = gpu() else { return };
    let renderer = renderer(&gpu);
    let ordered = renderer.render(&plan(64), &Silent).unwrap();
    for (order, within) in
        [(OrderMethod::PerPixel, 2e-6), (OrderMethod::KBuffer { window: 24 }, 2e-6), (OrderMethod::Centroid, 0.1)]
    {
        let sorted = renderer.render(&Plan { order, ..plan(64) }, &Silent).unwrap();
        assert!(largest(&ordered, &sorted) <= within, "{order}: {:e}", largest(&ordered, &sorted));
    }
    let refused = renderer.render(&Plan { order: OrderMethod::KBuffer { window: 64 }, ..plan(64) }, &Silent);
    assert_eq!(refused.unwrap_err(), GpuError::WindowTooLarge { window: 64, most: 63 });
}

/// Drivers that are programs for processors end the loops of an invocation after 65536 turns together, which the middle tile of this picture takes.
#[test]
fn a_loop_that_a_driver_ends_makes_no_wrong_picture() {
    let Some(gpu) = gpu() else { return };
    let renderer = renderer_of(&gpu, 24);
    let expected = renderer.render(&plan(48), &Silent).unwrap();
    let sorted = |window| Plan { order: OrderMethod::KBuffer { window }, ..plan(48) };
    for window in [24, 63] {
        let drawn = renderer.render(&sorted(window), &Silent).unwrap();
        assert!(largest(&expected, &drawn) <= 2e-6, "{window}: {:e}", largest(&expected, &drawn));
    }
    // All cells in one run: there is no remedy then.
    renderer.set_slice(0);
    match renderer.render(&sorted(24), &Silent) {
        Ok(drawn) => assert!(largest(&expected, &drawn) <= 2e-6, "{:e}", largest(&expected, &drawn)),
        Err(error) => assert!(matches!(error, GpuError::LoopCut { .. }), "{error}"),
    }
}

#[test]
fn pixels_that_sort_draw_the_same_in_slices() {
    let Some(gpu) = gpu() else { return };
    // Some hundreds of cells a tile: many runs, that take little time.
    let renderer = renderer_of(&gpu, 6);
    let surface =
        Isosurface { value: 0.2, color: [1.0; 3], back_color: [1.0; 3], opacity: 0.5, shading: SurfaceShading::None };
    let surfaces = Isosurfaces::new(vec![surface]).unwrap();
    let isosurfaces = Some(IsosurfacePlan { surfaces, method: IsosurfaceMethod::Exact });
    for order in [OrderMethod::PerPixel, OrderMethod::KBuffer { window: 6 }] {
        for isosurfaces in [None, isosurfaces.clone()] {
            // Three tiles that are not whole.
            let plan = Plan { order, isosurfaces, ..plan(20) };
            let [whole, many, few] = [0, 64, 200].map(|slice| {
                renderer.set_slice(slice);
                renderer.render(&plan, &Silent).unwrap()
            });
            assert!(whole.image.pixel(10, 10)[3] > 0.2);
            assert_eq!(whole.image, many.image, "{order}");
            assert_eq!(whole.image, few.image, "{order}");
            assert_eq!(whole.counts, many.counts, "{order}");
        }
    }
}

#[test]
fn a_lost_device_is_an_error_that_names_the_frame() {
    if gpu().is_none() {
        return;
    }
    let choice = AdapterChoice { name: Some(adapter()), default_limits: true, ..AdapterChoice::default() };
    let own = Arc::new(Gpu::open(&choice).unwrap());
    let renderer = renderer(&own);
    renderer.render(&plan(16), &Silent).unwrap();
    own.device.destroy();
    match renderer.render(&plan(16), &Silent) {
        Err(GpuError::Lost { frame: 2, .. }) => {}
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_plan_pays_for_what_it_asks_for() {
    let Some(gpu) = gpu() else { return };
    let renderer = renderer(&gpu);
    let bound = |plan: &Plan| {
        let device = renderer.render(plan, &Silent).unwrap().device.unwrap();
        assert_eq!(device.pipelines.len(), 1);
        device.pipelines[0].rsplit("binds ").next().unwrap().to_owned()
    };
    let plain = "frame, points, optics, pieces, drawn, tile_starts, tile_items, picture";
    assert_eq!(bound(&plan(16)), plain);
    let surface = |shading| Isosurface { value: 0.2, color: [1.0; 3], back_color: [1.0; 3], opacity: 0.5, shading };
    let with = |shading, lighting| Plan {
        isosurfaces: Some(IsosurfacePlan {
            surfaces: Isosurfaces::new(vec![surface(shading)]).unwrap(),
            method: IsosurfaceMethod::Exact,
        }),
        lighting,
        ..plan(16)
    };
    assert_eq!(bound(&with(SurfaceShading::None, None)), format!("{plain}, surfaces"));
    let light = Some(Lighting::default());
    assert_eq!(bound(&with(SurfaceShading::Flat, light)), format!("{plain}, surfaces, lamp"));
    assert_eq!(bound(&with(SurfaceShading::Smooth, light)), format!("{plain}, surfaces, gradients, lamp"));
    let lit = Plan { lighting: Some(Lighting { volume: true, ..Lighting::default() }), ..plan(16) };
    assert_eq!(bound(&lit), format!("{plain}, gradients, lamp"));
}

#[test]
fn a_tetrahedron_takes_20_bytes_and_its_order_the_rest() {
    let Some(gpu) = gpu() else { return };
    let renderer = renderer(&gpu);
    let (decomposition, _) = field(SIDE);
    let cells = decomposition.mesh.tetrahedra().len() as u64;
    let points = decomposition.mesh.positions().len() as u64;
    let bytes = |plan: &Plan, role| renderer.render(plan, &Silent).unwrap().device.unwrap().bytes(role);
    assert_eq!(bytes(&plan(16), BufferRole::Mesh), 20 * cells + 32 * points);
    // A permutation that the CPU made; or keys, and room to sort them.
    assert!(bytes(&plan(16), BufferRole::Order) <= 13 * cells + 65_536);
    let sorted = Plan { order: OrderMethod::Centroid, ..plan(16) };
    assert!(bytes(&sorted, BufferRole::Order) <= 25 * cells + 65_536);
    let lit = Plan { lighting: Some(Lighting { volume: true, ..Lighting::default() }), ..plan(16) };
    assert_eq!(bytes(&lit, BufferRole::Mesh), 20 * cells + 48 * points);
}

#[test]
fn a_new_transfer_function_makes_new_lookups_and_nothing_else() {
    let Some(gpu) = gpu() else { return };
    let renderer = renderer(&gpu);
    renderer.render(&plan(16), &Silent).unwrap();
    let before = renderer.kept_buffers();
    let transfer = TransferFunction::new(&[[0.0, 0.9, 0.1, 0.1]], &[[-0.6, 2.0], [1.2, 0.0]]).unwrap();
    renderer.render(&Plan { transfer, ..plan(16) }, &Silent).unwrap();
    let after = renderer.kept_buffers();
    assert_eq!(before.permutation, after.permutation);
    assert_eq!(before.order, after.order);
    assert_eq!(before.kernels, after.kernels, "no pipeline is built anew");
    assert_ne!(before.lookups, after.lookups);
}

/// What WebGPU's least devices bind at once is enough for the plans that bind most.
#[test]
fn no_program_binds_more_than_eight_storage_buffers() {
    let Some(gpu) = gpu() else { return };
    let renderer = renderer(&gpu);
    let surface =
        Isosurface { value: 0.2, color: [1.0; 3], back_color: [1.0; 3], opacity: 0.5, shading: SurfaceShading::Smooth };
    let surfaces = Isosurfaces::new(vec![surface]).unwrap();
    for integration in [Integration::Partial, Integration::Table2d] {
        for method in [IsosurfaceMethod::Exact, IsosurfaceMethod::Map { size: 16, mixing: Mixing::Smooth }] {
            for order in [OrderMethod::Mpvo, OrderMethod::PerPixel] {
                let isosurfaces = Some(IsosurfacePlan { surfaces: surfaces.clone(), method });
                let lighting = Some(Lighting { volume: true, ..Lighting::default() });
                let drawn = renderer.render(&Plan { integration, order, isosurfaces, lighting, ..plan(16) }, &Silent);
                assert!(drawn.is_ok(), "{integration} {method:?} {order}: {:?}", drawn.err());
            }
        }
    }
}
