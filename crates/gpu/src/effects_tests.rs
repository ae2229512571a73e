//! Effects on the device against their formulas in 64 bits.

use std::sync::Arc;

use tetrascope_scene::{IsosurfacePlan, Mixing};
use tetrascope_shaders::Program;

use super::*;
use crate::kernel::Kernel;
use crate::testing::{checked, contents, gpu};
use scene::{Dice, Scene, TestSegment, UNITS, frame, lighting, plan, surface};
use twin::Twin;

#[path = "effects_tests/scene.rs"]
mod scene;
#[path = "effects_tests/twin.rs"]
mod twin;

fn program(effects: &Effects, carries_joints: bool) -> Program {
    let mut slots = effects.slots();
    slots.push(("volume", "test/volume_grey.wgsl"));
    Program::compose("test/effects.wgsl", &slots, &effects.constants(carries_joints)).unwrap_or_else(|e| panic!("{e}"))
}

/// Light and crossings of all rays.
fn drawn(gpu: &Gpu, scene: &Scene, effects: &Effects, carries_joints: bool) -> Vec<([f32; 4], u32)> {
    checked(gpu, || {
        let kernel = Kernel::new(gpu, &program(effects, carries_joints), "shade_rays");
        let rays = scene.rays.len();
        let buffers = [
            ("points", gpu.storage_of("points", &scene.points)),
            ("gradients", gpu.storage_of("gradients", &scene.gradients)),
            ("segments", gpu.storage_of("segments", &scene.segments)),
            ("rays", gpu.storage_of("rays", &scene.rays)),
            ("lights", gpu.storage("lights", rays as u64 * 16)),
            ("counts", gpu.storage("counts", rays as u64 * 4)),
            ("frame", gpu.uniform_of("frame", &frame(scene.is_perspective))),
        ];
        let mut resources = effects.resources();
        resources.extend(buffers.iter().map(|(name, buffer)| (*name, buffer.as_entire_binding())));
        let group = kernel.bind(gpu, &resources);
        let mut encoder = gpu.encoder("test");
        kernel.run_alone(&mut encoder, &group, (rays as u32).div_ceil(64));
        let lights: Vec<[f32; 4]> = contents(gpu, encoder, &buffers[4].1, rays);
        let counts: Vec<u32> = contents(gpu, gpu.encoder("test"), &buffers[5].1, rays);
        lights.into_iter().zip(counts).collect()
    })
}

/// The larger of two errors; what is not a number is the largest.
fn larger(worst: f64, error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { worst.max(error.abs()) }
}

/// Draws random cells as a plan says, and gives the largest difference from the formulas.
fn compare(gpu: &Gpu, plan: &Plan, seed: u64, name: &str) -> f64 {
    let mut worst = 0.0_f64;
    for is_perspective in [true, false] {
        let scene = Scene::random(&mut Dice(seed), 3000, is_perspective);
        let effects = Effects::new(gpu, plan, UNITS, None).unwrap();
        let twin = Twin { scene: &scene, plan, effects: &effects };
        let mut all_crossings = 0;
        for (ray, (light, crossings)) in drawn(gpu, &scene, &effects, true).into_iter().enumerate() {
            let (known, known_crossings) = twin.ray(scene.rays[ray]);
            assert_eq!(crossings, known_crossings, "{name}: ray {ray}");
            all_crossings += crossings;
            let [r, g, b] = known.rgb;
            for (channel, known) in light.into_iter().zip([r, g, b, known.opacity]) {
                worst = larger(worst, f64::from(channel) - known);
            }
        }
        assert!(plan.isosurfaces.is_none() || all_crossings > 1000, "{all_crossings}");
    }
    println!("{name}: {worst:.1e}");
    worst
}

fn several(seed: u64, opacity: f64, shading: [SurfaceShading; 2]) -> Vec<Isosurface> {
    let mut dice = Dice(seed);
    let values = [-0.5, -0.45, -0.1, 0.0, 0.3, 0.301, 0.62];
    let one = |(place, value)| surface(&mut dice, value, if place == 3 { 1.0 } else { opacity }, shading[place % 2]);
    values.into_iter().enumerate().map(one).collect()
}

#[test]
fn surfaces_cut_segments() {
    let Some(gpu) = gpu() else { return };
    let none = [SurfaceShading::None; 2];
    let error = compare(&gpu, &plan(several(1, 0.3, none), IsosurfaceMethod::Exact, None), 2, "cut");
    assert!(error < 2e-6, "{error}");
}

#[test]
fn surfaces_are_lit() {
    let Some(gpu) = gpu() else { return };
    let direction = Some(DVec3::new(-0.48, 0.6, -0.64));
    for shading in [
        [SurfaceShading::Flat, SurfaceShading::None],
        [SurfaceShading::Smooth; 2],
        [SurfaceShading::Smooth, SurfaceShading::Flat],
    ] {
        for (direction, shininess) in [(None, 4.0), (direction, 0.0), (direction, 8.0), (direction, 200.0)] {
            for volume in [false, true] {
                let lighting = Some(lighting(direction, volume, shininess));
                let plan = plan(several(3, 0.4, shading), IsosurfaceMethod::Exact, lighting);
                let error = compare(&gpu, &plan, 4, &format!("lit {shading:?}, {shininess}, volume {volume}"));
                // A sharp highlight magnifies the rounding of directions.
                assert!(error < 2e-6 + 2e-7 * shininess, "{error}");
            }
        }
    }
}

/// Flat light in cells so thin that the differences of f32 alone would tilt their normals.
#[test]
fn thin_cells_keep_their_normals() {
    let Some(gpu) = gpu() else { return };
    let flat = surface(&mut Dice(20), 0.0, 1.0, SurfaceShading::Flat);
    let plan = plan(vec![flat], IsosurfaceMethod::Exact, Some(lighting(Some(DVec3::Z), false, 2.0)));
    let effects = Effects::new(&gpu, &plan, UNITS, None).unwrap();
    for thickness in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        let mut dice = Dice(21);
        let mut scene = Scene { is_perspective: true, ..Scene::default() };
        for _ in 0..1000 {
            let (first, b, c, gradient) = (dice.vector(0.3), dice.vector(0.4), dice.vector(0.4), dice.vector(0.5));
            let normal = b.cross(c);
            if normal.length() < 0.02 {
                continue;
            }
            let d = b * dice.between(0.1, 0.6) + c * dice.between(0.1, 0.4) + normal.normalize() * thickness;
            let corners = [first, first + b, first + c, first + d];
            let middle = corners.iter().sum::<DVec3>() / 4.0;
            scene.add(&mut dice, corners, corners.map(|corner| gradient.dot(corner - middle)));
            let reference = f64::from(scene.segments.last().unwrap().reference) * LATTICE_STEP;
            let segment = scene.segments.last_mut().unwrap();
            (segment.scalars, segment.length) = ([-0.5, 0.5].map(|scalar| (scalar - reference) as f32), 0.01);
        }
        let twin = Twin { scene: &scene, plan: &plan, effects: &effects };
        let mut worst = 0.0_f64;
        for (ray, (light, _)) in drawn(&gpu, &scene, &effects, true).into_iter().enumerate() {
            let known = twin.ray(scene.rays[ray]).0;
            worst = (0..3).fold(worst, |worst, c| larger(worst, f64::from(light[c]) - known.rgb[c]));
        }
        println!("flat, cells {thickness} thick: {worst:.1e}");
        assert!(worst < if thickness < 5e-5 { 1e-4 } else { 1e-6 }, "{worst} in cells {thickness} thick");
    }
}

#[test]
fn volume_is_lit_without_surfaces() {
    let Some(gpu) = gpu() else { return };
    let plan = plan(Vec::new(), IsosurfaceMethod::Exact, Some(lighting(None, true, 16.0)));
    let error = compare(&gpu, &plan, 5, "lit volume");
    assert!(error < 5e-6, "{error}");
}

#[test]
fn maps_are_looked_up() {
    let Some(gpu) = gpu() else { return };
    for mixing in [Mixing::Smooth, Mixing::Stopped] {
        for shading in [SurfaceShading::None, SurfaceShading::Flat, SurfaceShading::Smooth] {
            let lighting = Some(lighting(None, false, 4.0)).filter(|_| shading != SurfaceShading::None);
            let method = IsosurfaceMethod::Map { size: 64, mixing };
            let plan = plan(several(6, 0.5, [shading; 2]), method, lighting);
            let error = compare(&gpu, &plan, 7, &format!("map {mixing:?} {shading:?}"));
            assert!(error < if shading == SurfaceShading::None { 2e-6 } else { 1e-5 }, "{error}");
        }
    }
}

/// Chains of segments whose ends round to either side of a surface.
fn chains(dice: &mut Dice, values: &[f64]) -> Scene {
    let mut scene = Scene { is_perspective: true, ..Scene::default() };
    let scalars = [-0.8, 0.8, -0.7, 0.5];
    scene.add(dice, [DVec3::ZERO, DVec3::X * 0.3, DVec3::Y * 0.3, DVec3::Z * 0.4], scalars);
    let cell = scene.segments[0];
    let reference = f64::from(cell.reference) * LATTICE_STEP;
    scene.segments.clear();
    scene.rays.clear();
    for number in 0..2000 {
        let value = values[number % values.len()] - reference;
        let first = scene.segments.len() as u32;
        // Around the value: exactly on it, or off by what rounding makes of it.
        let mut near = || value - 1.6e-5 - 2e-6 + dice.between(-3e-7, 3e-7);
        // Exits rise; entries are where rounding has them.
        let exit = near();
        let ends = [[value - 0.05, exit], [near(), exit + 2e-7], [near(), value + 0.05]];
        let mut depth = 0.5;
        for [front, back] in ends {
            let begins = depth + dice.between(-3e-7, 3e-7);
            depth += 0.1;
            let flipped = number % 2 == 1;
            let turn = |scalar: f64| (if flipped { 2.0 * value - 3.6e-5 - scalar } else { scalar }) as f32;
            let depth = [begins as f32, depth as f32];
            scene.segments.push(TestSegment { scalars: [turn(front), turn(back)], depth, length: 0.0, ..cell });
        }
        scene.rays.push([first, 3]);
    }
    scene
}

#[test]
fn a_surface_at_a_joint_is_met_once() {
    let Some(gpu) = gpu() else { return };
    let mut dice = Dice(11);
    let values = [-0.3, 0.1, 0.25];
    let surfaces = values.map(|value| surface(&mut dice, value, 0.5, SurfaceShading::None)).to_vec();
    let exact = Effects::new(&gpu, &plan(surfaces.clone(), IsosurfaceMethod::Exact, None), UNITS, None).unwrap();
    let scene = chains(&mut dice, &values);
    for (ray, (light, crossings)) in drawn(&gpu, &scene, &exact, true).into_iter().enumerate() {
        assert_eq!((crossings, light[3]), (1, 0.5), "ray {ray}");
    }
    let mut twice = 0;
    for (ray, (_, crossings)) in drawn(&gpu, &scene, &exact, false).into_iter().enumerate() {
        assert!(crossings >= 1, "ray {ray} misses its surface where no joint is carried");
        twice += u32::from(crossings > 1);
    }
    println!("without joints, all at the surface: {twice} of {} met twice", scene.rays.len());

    let method = IsosurfaceMethod::Map { size: 128, mixing: Mixing::Smooth };
    let maps = Effects::new(&gpu, &plan(surfaces, method, None), UNITS, None).unwrap();
    let moved: Vec<f64> = maps.surfaces().as_slice().iter().map(|surface| surface.value).collect();
    let scene = chains(&mut dice, &moved.iter().map(|value| value + 1.8e-5).collect::<Vec<_>>());
    for (ray, (light, crossings)) in drawn(&gpu, &scene, &maps, true).into_iter().enumerate() {
        // The two passes of a map multiply to it.
        assert!(crossings == 1 && (light[3] - 0.5).abs() < 1e-6, "ray {ray} with maps: {crossings}, {light:?}");
    }
    for (ray, (_, crossings)) in drawn(&gpu, &scene, &maps, false).into_iter().enumerate() {
        assert!(crossings >= 1, "ray {ray} misses its surface in a map where no joint is carried");
    }
}

#[test]
fn cells_near_a_surface_may_show_it() {
    let Some(gpu) = gpu() else { return };
    let mut dice = Dice(12);
    let values: Vec<f64> = (0..37).map(|_| dice.between(-1.1, 1.1)).collect();
    let surfaces = values.iter().map(|&value| surface(&mut dice, value, 1.0, SurfaceShading::None)).collect();
    let effects = Effects::new(&gpu, &plan(surfaces, IsosurfaceMethod::Exact, None), UNITS, None).unwrap();
    let mut ranges: Vec<[i32; 2]> = Vec::new();
    for _ in 0..2000 {
        let (low, width) = (dice.between(-0.95, 0.9), dice.between(-12.0, -1.0).exp());
        ranges.push([low, (low + width).min(0.95)].map(|scalar| UNITS.to_lattice(scalar)));
        let at = values[ranges.len() % values.len()].clamp(-0.9, 0.9) + dice.between(-6e-6, 6e-6);
        ranges.push([UNITS.to_lattice(at); 2]);
    }
    let shown: Vec<u32> = checked(&gpu, || {
        let kernel = Kernel::new(&gpu, &program(&effects, true), "ask");
        let counts = gpu.storage("counts", ranges.len() as u64 * 4);
        let asked = gpu.storage_of("ranges", &ranges);
        let mut resources = effects.resources();
        resources.push(("scalar_ranges", asked.as_entire_binding()));
        resources.push(("counts", counts.as_entire_binding()));
        let group = kernel.bind(&gpu, &resources);
        let mut encoder = gpu.encoder("test");
        kernel.run_alone(&mut encoder, &group, (ranges.len() as u32).div_ceil(64));
        contents(&gpu, encoder, &counts, ranges.len())
    });
    for (&[low, high], shown) in ranges.iter().zip(shown) {
        let [low, high] = [low, high].map(|scalar| f64::from(scalar) * LATTICE_STEP);
        let margin = 1e-4 * (high - low) + 4e-6;
        let is_near = |slack: f64| values.iter().any(|&v| v > low - margin - slack && v < high + margin + slack);
        assert!(shown == 1 || !is_near(-1e-8), "{low} {high}");
        assert!(shown == 0 || is_near(1e-8 + 1e-6 * (high - low)), "{low} {high}");
    }
}

/// Shading of surfaces if there are any, how they are drawn, whether there is a light and it falls on the volume; and what is bound.
type Case = (Vec<[SurfaceShading; 2]>, IsosurfaceMethod, Option<bool>, &'static [&'static str]);

/// A scene pays for what it uses and for nothing else.
#[test]
fn variants_bind_what_they_use() {
    let Some(gpu) = gpu() else { return };
    use SurfaceShading as S;
    let map = |mixing| IsosurfaceMethod::Map { size: 2, mixing };
    let exact = IsosurfaceMethod::Exact;
    let cases: [Case; 9] = [
        (vec![], exact, None, &[]),
        (vec![], exact, Some(false), &[]),
        (vec![], exact, Some(true), &["frame", "points", "gradients", "lamp"]),
        (vec![[S::None; 2]], exact, Some(false), &["frame", "points", "surfaces"]),
        (vec![[S::Flat; 2]], exact, None, &["frame", "points", "surfaces"]),
        (vec![[S::Flat; 2]], exact, Some(false), &["frame", "points", "surfaces", "lamp"]),
        (vec![[S::Smooth; 2]], exact, Some(false), &["frame", "points", "surfaces", "gradients", "lamp"]),
        (vec![[S::None; 2]], map(Mixing::Stopped), None, &["frame", "points", "maps"]),
        (vec![[S::Smooth; 2]], map(Mixing::Smooth), Some(false), &["frame", "points", "maps", "gradients", "lamp"]),
    ];
    for (number, (shading, method, light, known)) in cases.into_iter().enumerate() {
        let surfaces = shading.first().map_or_else(Vec::new, |&shading| several(1, 0.5, shading));
        let lighting = light.map(|volume| lighting(None, volume, 1.0));
        let effects = Effects::new(&gpu, &plan(surfaces, method, lighting), UNITS, None).unwrap();
        let bindings = program(&effects, true).bindings("shade_rays");
        let names: Vec<&str> =
            bindings.iter().filter(|binding| binding.number < 70).map(|binding| binding.name.as_str()).collect();
        assert_eq!(names, known, "case {number}");
        assert_eq!(effects.needs_gradients(), names.contains(&"gradients"), "case {number}");
        let asks = program(&effects, false).bindings("ask");
        let is_asked = asks.iter().any(|binding| binding.name == "surfaces");
        assert_eq!(is_asked, !shading.is_empty(), "case {number}");
    }
}

#[test]
fn what_is_the_same_is_kept() {
    let Some(gpu) = gpu() else { return };
    let method = IsosurfaceMethod::Map { size: 16, mixing: Mixing::Smooth };
    let dark = plan(several(1, 0.5, [SurfaceShading::Flat; 2]), method, None);
    let lit = Plan { lighting: Some(lighting(None, false, 1.0)), ..dark.clone() };
    let first = Effects::new(&gpu, &dark, UNITS, None).unwrap();
    assert!(first.is_for(&dark, UNITS) && !first.is_for(&lit, UNITS));
    let second = Effects::new(&gpu, &lit, UNITS, Some(&first)).unwrap();
    assert!(Arc::ptr_eq(first.maps.as_ref().unwrap(), second.maps.as_ref().unwrap()));

    let too_large = IsosurfaceMethod::Map { size: 4096, mixing: Mixing::Smooth };
    let plan = plan(several(1, 0.5, [SurfaceShading::None; 2]), too_large, None);
    let refused = Effects::new(&gpu, &plan, UNITS, None);
    assert!(matches!(refused, Err(GpuError::TooLarge { needed, .. }) if needed > 1 << 29), "{refused:?}");
    let method = IsosurfaceMethod::Map { size: 1, mixing: Mixing::Smooth };
    let plan = Plan { isosurfaces: Some(IsosurfacePlan { method, ..plan.isosurfaces.clone().unwrap() }), ..plan };
    assert!(matches!(Effects::new(&gpu, &plan, UNITS, None), Err(GpuError::Isosurfaces(_))));
}

#[test]
fn gradients_of_points_are_those_of_the_mesh() {
    let Some(gpu) = gpu() else { return };
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let slope = DVec3::new(0.25, -0.5, 2.0);
    let cell = [0, 1, 2, 3].map(VertexId);
    let buffer = point_gradients(&gpu, &positions, &[cell], &positions.map(|p| p.dot(slope))).unwrap();
    let gradients: Vec<[f32; 4]> = contents(&gpu, gpu.encoder("test"), &buffer, 4);
    for gradient in gradients {
        let error = (DVec3::from_slice(&gradient.map(f64::from)[..3]) - slope).length();
        assert!(error < 1e-6, "{gradient:?}");
    }
}
