//! Rays by themselves against the pictures that they are taken from.

use glam::DVec3;
use tetrascope_integrate::{Integration, Isosurface, Isosurfaces, OpticalModel, SurfaceShading, TransferFunction};
use tetrascope_mesh::{TetMesh, decompose, rings_sample};
use tetrascope_scene::{IsosurfaceMethod, IsosurfacePlan, Lighting, Plan, Silent};
use tetrascope_view::{Camera, Projection, View};

use crate::rays::RayTracer;
use crate::{CpuRenderer, reference};

fn sample() -> (TetMesh, Vec<f64>) {
    let mesh = decompose(&rings_sample(5)).unwrap().mesh;
    let scalars = mesh.positions().iter().map(|p| (2.0 * p.x).sin() + p.y * p.z).collect();
    (mesh, scalars)
}

fn plan(integration: Integration, model: OpticalModel) -> Plan {
    let projection = Projection::Perspective { fov_y: 0.7 };
    let camera = Camera { eye: DVec3::new(1.5, 2.0, 3.0), target: DVec3::ZERO, up: DVec3::Y, projection };
    let color = [[-1.0, 0.2, 0.1, 0.9], [0.1, 0.9, 0.8, 0.7], [1.2, 0.9, 0.2, 0.1]];
    let transfer = TransferFunction::new(&color, &[[-1.0, 0.0], [0.0, 1.5], [1.0, 0.4]]).unwrap();
    let plan = Plan::new(View::new(&camera, 48, 40).unwrap(), transfer, model);
    Plan { integration, ..plan }
}

/// Every pixel, in rows.
fn all_pixels(plan: &Plan) -> Vec<[u32; 2]> {
    (0..plan.view.height).flat_map(|y| (0..plan.view.width).map(move |x| [x, y])).collect()
}

#[test]
fn rays_have_the_colors_of_the_reference() {
    let (mesh, scalars) = sample();
    let surface = Isosurface {
        value: 0.3,
        color: [0.9, 0.5, 0.1],
        back_color: [0.1, 0.5, 0.9],
        opacity: 0.6,
        shading: SurfaceShading::Smooth,
    };
    let surfaces = Isosurfaces::new(vec![surface]).unwrap();
    for integration in [Integration::Exact, Integration::Average, Integration::Table3d] {
        for effects in [false, true] {
            let mut plan = plan(integration, OpticalModel::DensityEmitter);
            if effects {
                plan.isosurfaces = Some(IsosurfacePlan { surfaces: surfaces.clone(), method: IsosurfaceMethod::Exact });
                plan.lighting = Some(Lighting { volume: true, ..Lighting::default() });
            }
            let picture = reference::render(&mesh, &scalars, &plan, &Silent).unwrap().image;
            let tracer = RayTracer::new(&mesh, &scalars, &plan.view).unwrap();
            let shader = tracer.shader(&plan, &Silent).unwrap();
            // Some pixels, in no order, and one outside of the picture.
            let pixels: Vec<[u32; 2]> = (0..300).map(|i| [i * 7 % 48, i * 11 % 40]).chain([[48, 3]]).collect();
            let rays = tracer.trace(&pixels);
            assert_eq!(rays.len(), 301);
            for (ray, &[x, y]) in pixels.iter().enumerate().take(300) {
                let light = shader.light(&rays, ray);
                let [r, g, b] = light.rgb.map(|channel| channel as f32);
                assert_eq!([r, g, b, light.opacity as f32], picture.pixel(x, y), "{integration} ({x}, {y})");
            }
            assert_eq!(rays.segments(300).len(), 0);
        }
    }
}

/// The fans of `vertex` in f64 are those of the fast renderer, but for its rounding.
#[test]
fn painted_fans_are_those_of_the_renderer() {
    let (mesh, scalars) = sample();
    for model in OpticalModel::ALL {
        let plan = Plan { order: tetrascope_order::OrderMethod::PerPixel, ..plan(Integration::Vertex, model) };
        let picture = CpuRenderer::new(&mesh, &scalars).unwrap().render(&plan, &Silent).unwrap().image;
        let tracer = RayTracer::new(&mesh, &scalars, &plan.view).unwrap();
        let shader = tracer.shader(&plan, &Silent).unwrap();
        let rays = tracer.trace(&all_pixels(&plan));
        let mut seen = 0;
        for (ray, pixel) in picture.pixels().iter().enumerate() {
            let light = shader.light(&rays, ray);
            let known = [light.rgb[0], light.rgb[1], light.rgb[2], light.opacity];
            let difference = known.iter().zip(pixel).map(|(a, b)| (a - f64::from(*b)).abs()).fold(0.0, f64::max);
            assert!(difference < 2e-5, "{model} pixel {ray}: {known:?} {pixel:?}");
            seen += usize::from(pixel.iter().any(|channel| *channel > 0.01));
        }
        assert!(seen > 200, "{model}: {seen}");
    }
}

#[test]
fn ranks_and_windows_change_the_order_and_nothing_else() {
    let (mesh, scalars) = sample();
    let plan = plan(Integration::Exact, OpticalModel::DensityEmitter);
    let tracer = RayTracer::new(&mesh, &scalars, &plan.view).unwrap();
    let shader = tracer.shader(&plan, &Silent).unwrap();
    let rays = tracer.trace(&all_pixels(&plan));
    let mut changed = 0;
    for ray in 0..rays.len() {
        let right = shader.light(&rays, ray);
        let cells: Vec<u32> = rays.segments(ray).map(|segment| segment.cell).collect();
        let rank = |cell: u32| cells.iter().position(|&other| other == cell).unwrap() as u32;
        assert_eq!(shader.light_by_rank(&rays, ray, rank), right);
        let last = cells.len() as u32;
        let backwards = shader.light_by_rank(&rays, ray, |cell| last - rank(cell));
        assert!((backwards.opacity - right.opacity).abs() < 1e-14);
        changed += usize::from((backwards.rgb[0] - right.rgb[0]).abs() > 1e-3);
        // A window that holds all sorts all, one of a single cell nothing.
        assert_eq!(shader.light_in_window(&rays, ray, |cell| last - rank(cell), cells.len()), right);
        assert_eq!(shader.light_in_window(&rays, ray, |cell| last - rank(cell), 0), backwards);
    }
    assert!(changed > 100, "{changed}");
}

#[test]
fn joined_rays_are_both() {
    let (mesh, scalars) = sample();
    let plan = plan(Integration::Exact, OpticalModel::DensityEmitter);
    let tracer = RayTracer::new(&mesh, &scalars, &plan.view).unwrap();
    let [a, b] = [[[20, 20], [3, 39]], [[24, 19], [30, 22]]].map(|pixels| tracer.trace(&pixels));
    let all = a.clone().joined(&b);
    assert_eq!(all.pixels(), [[20, 20], [3, 39], [24, 19], [30, 22]]);
    for ray in 0..4 {
        let alone: Vec<_> = if ray < 2 { a.segments(ray).collect() } else { b.segments(ray - 2).collect() };
        assert_eq!(all.segments(ray).collect::<Vec<_>>(), alone);
    }
}
