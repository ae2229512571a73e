//! Pictures against rays.

use glam::{DVec2, DVec3};
use tetrascope_classify::FanVertex;
use tetrascope_shaders::layout::EFFECT_CONSTANTS;
use tetrascope_shaders::{BindingKind, Constant, Program, Slot};

use super::scene::{EXTINCTION, EXTINCTION_SLOPE, Random, SIZE, Scene, Uploaded, layers, random_cell};
use crate::Gpu;
use crate::draw::opacity_of;
use tetrascope_scene::TargetBits;

use crate::stopwatch::Laps;
use crate::targets::{Display, Target, best_target, blends, texture};
use crate::testing::{checked, contents, gpu};
use crate::triangles::{BlockToDraw, LightAt, TrianglePath};
use crate::view::Part;

const SLOTS: &[Slot<'static>] = &[
    ("effects", "effects/none.wgsl"),
    ("volume", "integrate/average.wgsl"),
    ("model", "integrate/density_emitter.wgsl"),
];

/// A picture of a scene in blocks of `cells` cells, back to front: rgb and transmittance.
fn draw(gpu: &Gpu, scene: &Scene, light_at: LightAt, precision: TargetBits, cells: u32) -> Vec<[f32; 4]> {
    checked(gpu, || {
        let path = TrianglePath::new(gpu, light_at, SLOTS, &[], precision, cells).unwrap();
        let target = Target::new(gpu, [SIZE; 2], precision).unwrap();
        let uploaded = Uploaded::new(gpu, scene);
        let mut encoder = gpu.encoder("test");
        let blocks = (scene.cells.len() as u32).div_ceil(cells);
        for number in (0..blocks).rev() {
            let first = number * cells;
            let block = gpu.uniform_of("block", &[first, cells, 0, 0]);
            // Every block gathers its own cells.
            let end = (first + cells).min(scene.cells.len() as u32);
            let drawn = gpu.storage_of("drawn", &scene.cells[first as usize..end as usize]);
            let mut resources = uploaded.named();
            resources.push(("block", block.as_entire_binding()));
            resources.push(("drawn", drawn.as_entire_binding()));
            let place =
                BlockToDraw { cells, is_first: number + 1 == blocks, is_last: number == 0, extent: scene.part.extent };
            path.record(gpu, &mut encoder, &mut Laps::new(None), &resources, &target, place);
        }
        let pixels: Vec<[f32; 4]> = contents(gpu, encoder, &uploaded.picture, (SIZE * SIZE) as usize);
        pixels.into_iter().map(|[r, g, b, packed]| [r, g, b, 1.0 - opacity_of(packed)]).collect()
    })
}

/// The largest difference of any channel from the rays.
fn worst(scene: &Scene, picture: &[[f32; 4]]) -> f64 {
    let mut worst = 0.0_f64;
    for (place, pixel) in picture.iter().enumerate() {
        let [columns, rows] = scene.part.extent;
        let (x, y) = (place as u32 % columns, place as u32 / columns);
        if y >= rows {
            break;
        }
        let traced = scene.trace(scene.part.origin[0] + x, scene.part.origin[1] + y);
        for (found, expected) in pixel.iter().zip(traced) {
            let difference = (f64::from(*found) - expected).abs();
            assert!(difference.is_finite(), "pixel {place} is {pixel:?}");
            worst = worst.max(difference);
        }
    }
    worst
}

fn check_pictures(scene: &Scene, what: &str) {
    let Some(gpu) = gpu() else { return };
    for (precision, tolerance) in [(TargetBits::ThirtyTwo, 3e-4), (TargetBits::Sixteen, 1e-2)] {
        if !blends(&gpu, precision) {
            println!("skipped: 32-bit blending");
            continue;
        }
        for cells in [100, 2] {
            let picture = draw(&gpu, scene, LightAt::Pixels, precision, cells);
            let lit = picture.iter().filter(|pixel| pixel[3] < 0.99).count();
            let worst = worst(scene, &picture);
            println!("{what}, {precision:?}, blocks of {cells}: {worst:e}, {lit} pixels");
            assert!(lit > 200, "{what}: {lit} pixels");
            assert!(worst < tolerance, "{what}, {precision:?}: {worst}");
        }
    }
}

#[test]
fn pictures_agree_with_rays() {
    check_pictures(&layers(DVec3::new(0.02, 0.03, -1.0), 0.01, true, -0.8, 0.1, 6), "perspective");
    check_pictures(&layers(DVec3::new(0.02, 0.03, -1.0), 0.004, false, -0.8, 0.1, 6), "orthographic");
    check_pictures(&layers(DVec3::new(0.02, 0.03, -300.0), 1.7e-5, true, -0.5, 0.1, 5), "far");
}

#[test]
fn pictures_of_many_layers_agree_with_rays() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(5);
    let mut scene = Scene::new(DVec3::new(0.0, 0.0, -1.0), 0.01, true);
    for layer in 0..500 {
        let (mut corners, scalars) = random_cell(&mut random, DVec3::ZERO, 0.4);
        for corner in &mut corners {
            corner.z = -0.6 + 0.002 * (f64::from(layer) + corner.z);
        }
        scene.add(corners, scalars);
    }
    for (precision, cells, tolerance) in
        [(TargetBits::ThirtyTwo, 500, 3e-4), (TargetBits::Sixteen, 500, 1e-2), (TargetBits::Sixteen, 64, 1e-2)]
    {
        if blends(&gpu, precision) {
            let worst = worst(&scene, &draw(&gpu, &scene, LightAt::Pixels, precision, cells));
            println!("{precision:?}, blocks of {cells}: {worst:e}");
            assert!(worst < tolerance, "{precision:?}: {worst}");
        }
    }
}

#[test]
fn all_variants_are_programs() {
    let mut count = 0;
    for light_at in [LightAt::Pixels, LightAt::Vertices] {
        for effects in ["none", "lit", "surfaces", "maps"].map(|name| format!("effects/{name}.wgsl")) {
            for volume in ["exact", "average", "ends", "partial", "cumulative", "table_2d", "table_3d"] {
                let volume = format!("integrate/{volume}.wgsl");
                let mut slots = SLOTS.to_vec();
                slots.retain(|(slot, _)| !["effects", "volume"].contains(slot));
                slots.extend([
                    ("pieces", "integrate/pieces.wgsl"),
                    ("effects", &effects),
                    ("volume", &volume),
                    ("surface_visibility", "effects/visible_surfaces.wgsl"),
                    ("volume_light", "effects/volume_lit.wgsl"),
                    ("surface_light", "effects/surface_lit.wgsl"),
                    ("gradient", "effects/gradient_points.wgsl"),
                ]);
                let mut constants = EFFECT_CONSTANTS.to_vec();
                constants.extend([
                    ("CARRIES_JOINTS", Constant::Bool(false)),
                    ("MAP_PASSES", Constant::U32(0)),
                    ("MOST_LIGHT", Constant::F32(1e30)),
                    ("NEAR_SHARE", Constant::F32(1e-2)),
                ]);
                let program = Program::compose(light_at.file(), &slots, &constants).unwrap();
                for stage in ["vertex", "fragment"] {
                    let bindings = program.bindings(stage);
                    let storage = bindings.iter().filter(|b| matches!(b.kind, BindingKind::Storage(_)));
                    assert!(storage.count() <= 8, "{effects} {volume} {stage}: {bindings:?}");
                }
                count += 1;
            }
        }
    }
    assert_eq!(count, 56);
}

#[test]
fn parts_of_pictures_agree_with_rays() {
    let mut scene = layers(DVec3::new(0.02, 0.03, -1.0), 0.01, true, -0.8, 0.1, 6);
    scene.part = Part { origin: [19, 23], extent: [35, 30] };
    check_pictures(&scene, "part");
}

#[test]
fn pictures_from_close_up_agree_with_rays() {
    check_pictures(&layers(DVec3::new(0.0, 0.0, 0.0), 0.01, true, 0.4, 0.2, 1), "two cell sizes");
    check_pictures(&layers(DVec3::new(0.01, 0.0, -0.02), 0.04, true, 0.03, 0.2, 2), "a tenth of a cell size");
}

#[test]
fn pictures_from_inside_of_a_cell_agree_with_rays() {
    let mut scene = layers(DVec3::ZERO, 0.02, true, 0.4, 0.2, 2);
    let mut around = Scene::new(DVec3::ZERO, 0.02, true);
    let corners = [(-0.4, -0.3, -0.2), (0.5, -0.2, -0.1), (0.0, 0.5, -0.1), (0.05, 0.02, 0.3)];
    around.add(corners.map(DVec3::from), [-0.4, 0.2, 0.4, 0.1]);
    let moved = around.cells[0].map(|vertex| vertex + scene.points.len() as u32);
    scene.points.extend(&around.points);
    scene.cells.insert(0, moved);
    check_pictures(&scene, "inside");
}

#[test]
fn color_at_the_thick_vertex_is_interpolated() {
    let Some(gpu) = gpu() else { return };
    let scene = layers(DVec3::new(0.02, 0.03, -1.0), 0.01, true, -0.8, 0.2, 1);
    let precision = best_target(&gpu);
    let picture = draw(&gpu, &scene, LightAt::Vertices, precision, 10);
    let (projected, order) = scene.project(scene.cells[0]);
    let thick = projected.thick.unwrap();
    let (corners, scalars) = scene.corners(scene.cells[0]);
    let on_screen = |p: DVec3| p.truncate() / p.z / scene.pixel;
    let center = on_screen(thick.ray);
    let color = |s: f64| [0.9, 0.5 + 0.5 * s, 0.2];
    let extinction = |s: f64| f64::from(EXTINCTION) + f64::from(EXTINCTION_SLOPE) * s;
    let mean = 0.5 * (extinction(thick.scalar_front) + extinction(thick.scalar_back));
    let opacity = 1.0 - (-mean * thick.chord_length).exp();
    let [f, b] = [color(thick.scalar_front), color(thick.scalar_back)];
    let peak = [0, 1, 2].map(|c| 0.5 * (f[c] + b[c]));
    let tolerance = if precision == TargetBits::ThirtyTwo { 3e-4 } else { 1e-2 };
    let mut covered = 0;
    for (place, found) in picture.iter().enumerate() {
        let at = DVec2::new((place as u32 % SIZE) as f64, (place as u32 / SIZE) as f64) + 0.5 - f64::from(SIZE) / 2.0;
        let mut expected = [0.0, 0.0, 0.0, 1.0];
        for [_, i, j] in projected.fan.triangles() {
            let (FanVertex::Corner(i), FanVertex::Corner(j)) = (i, j) else { panic!("no corner") };
            let (i, j) = (order[i], order[j]);
            let [p, q] = [i, j].map(|corner| on_screen(corners[corner] - scene.eye) - center);
            let area = p.perp_dot(q);
            let (v, w) = ((at - center).perp_dot(q) / area, p.perp_dot(at - center) / area);
            if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
                let share = 1.0 - v - w;
                let [of_p, of_q] = [i, j].map(|corner| color(scalars[corner]));
                for c in 0..3 {
                    expected[c] = (share * peak[c] + v * of_p[c] + w * of_q[c]) * share * opacity;
                }
                expected[3] = 1.0 - share * opacity;
                covered += 1;
            }
        }
        for (a, b) in found.iter().zip(expected) {
            assert!((f64::from(*a) - b).abs() < tolerance, "{place}: {found:?} is not {expected:?}");
        }
    }
    assert!(covered > 300);
}

#[test]
fn pictures_are_shown_over_a_background() {
    let Some(gpu) = gpu() else { return };
    let shown = checked(&gpu, || {
        let scene = Scene::new(DVec3::ZERO, 0.01, true);
        let uploaded = Uploaded::new(&gpu, &scene);
        let pixels: Vec<[f32; 4]> = (0..SIZE * SIZE).map(|i| [i as f32 / 4096.0, 0.1, 0.0, 0.5]).collect();
        gpu.queue.write_buffer(&uploaded.picture, 0, bytemuck::cast_slice(&pixels));
        let background = gpu.uniform_of("background", &[0.2_f32, 0.4, 1.0, 0.0]);
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let texture = texture(&gpu, "shown", [SIZE; 2], format, usage);
        let mut resources = uploaded.named();
        resources.push(("background", background.as_entire_binding()));
        let mut encoder = gpu.encoder("test");
        let display = Display::new(&gpu, format).unwrap();
        display.record(&gpu, &mut encoder, &resources, &texture.create_view(&Default::default()));
        let buffer = gpu.storage("read", u64::from(SIZE * SIZE) * 4);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE * 4), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            texture.size(),
        );
        contents::<[u8; 4]>(&gpu, encoder, &buffer, (SIZE * SIZE) as usize)
    });
    let encode = |x: f64| if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    for (place, pixel) in shown.iter().enumerate() {
        let expected = [place as f64 / 4096.0 + 0.1, 0.3, 0.5].map(|x| 255.0 * encode(x.min(1.0)));
        for (found, expected) in pixel.iter().zip(expected) {
            assert!((f64::from(*found) - expected).abs() < 1.0, "{place}: {pixel:?} is not {expected:?}");
        }
        assert_eq!(pixel[3], 255);
    }
}
