//! Scalars far from 0 count from their lowest: a field of 1e9 + x is drawn as the field of x is, by every method, and told as it was given.
//!
//! All numbers are sums of few powers of two, so that moving them by 1e9 rounds nothing: what differs is the renderer's.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{Integration, IsosurfaceMethod, Mixing, OpticalModel, Plan, Silent, TransferFunction, View};
use tetrascope_cpu::rays::{RaySegment, RayTracer, Rays};
use tetrascope_tests::meshes::{Random, Tets};
use tetrascope_tests::pictures::{Renderer, SMALL_TABLES, Worst, largest, random_camera};
use tetrascope_tests::surfaces::{by_method, white};

const LIMIT: f64 = 1e-6;

/// The same field twice: where the renderers take it as it is, and where they count from another number than 0.
struct Moved {
    place: &'static str,
    /// Lowest scalar of the one.
    near: f64,
    /// Lowest scalar of the other.
    far: f64,
    /// Width of their range. At 1e9 a step is 2^-23.
    width: f64,
}

const NARROW: f64 = 1.0 / 8192.0;

const MOVED: [Moved; 5] = [
    Moved { place: "1e9 and up", near: 0.0, far: 1e9, width: NARROW },
    Moved { place: "-1e9 and down", near: -NARROW, far: -1e9 - NARROW, width: NARROW },
    Moved { place: "twice the lowest", near: 0.0, far: 1.0, width: 1.0 },
    Moved { place: "twice the highest", near: -1.0, far: -2.0, width: 1.0 },
    Moved { place: "1e9, as wide as 1", near: 0.0, far: 1e9, width: 1.0 },
];

/// A mesh with scalars from 0 to 1 in steps of 1/1024, both ends among them.
struct Field {
    mesh: TetMesh,
    scalars: Vec<f64>,
    view: View,
}

impl Field {
    fn new() -> Self {
        let tets = Tets::block(3, 7_700);
        let (low, high) = tets.range();
        let scalars = tets.scalars.iter().map(|s| ((s - low) / (high - low) * 1024.0).round() / 1024.0).collect();
        let camera = random_camera(&mut Random::new(7_701), DVec3::ZERO, 1.0, true);
        Self { mesh: tets.mesh(), scalars, view: View::new(&camera, 40, 37).unwrap() }
    }

    fn scalars(&self, low: f64, width: f64) -> Vec<f64> {
        self.scalars.iter().map(|s| low + s * width).collect()
    }

    fn plan(&self, low: f64, width: f64) -> Plan {
        let at = |s: f64| low + s * width;
        let color = [[0.0, 0.1, 0.2, 0.9], [0.375, 0.1, 0.9, 0.8], [0.625, 0.9, 0.9, 0.1], [1.0, 1.0, 0.1, 0.1]];
        let extinction = [[0.0, 0.0], [0.25, 3.0], [0.5, 0.2], [0.75, 5.0], [1.0, 1.0]];
        let transfer = TransferFunction::new(
            &color.map(|[s, r, g, b]| [at(s), r, g, b]),
            &extinction.map(|[s, extinction]| [at(s), extinction]),
        )
        .unwrap();
        Plan { tables: SMALL_TABLES, ..Plan::new(self.view, transfer, OpticalModel::DensityEmitter) }
    }

    /// Draws both and notes what they differ by.
    fn compare(
        &self,
        renderer: Renderer,
        worst: &mut Worst,
        what: &str,
        plan: impl Fn(Plan, &dyn Fn(f64) -> f64) -> Plan,
    ) {
        for Moved { place, near, far, width } in MOVED {
            let [as_it_is, moved] = [near, far].map(|low| {
                let plan = plan(self.plan(low, width), &|s| low + s * width);
                renderer.draw(&self.mesh, &self.scalars(low, width), &plan)
            });
            // Not every optical model has an opacity.
            let brightest = as_it_is.pixels().iter().flatten().fold(0.0, |most: f32, &c| most.max(c));
            assert!(brightest > 0.1, "{what}, {place}, {renderer:?} shows nothing");
            worst.note(largest(&as_it_is, &moved, 0..4), || format!("{what}, {place}, {renderer:?}"));
        }
    }
}

fn renderers(integration: Integration) -> Vec<Renderer> {
    let fast = Renderer::Fast(integration);
    if integration.needs_fan() { vec![fast] } else { vec![fast, Renderer::Reference(integration)] }
}

#[test]
fn far_scalars_are_drawn_alike_by_every_integration() {
    let field = Field::new();
    let mut worst = Worst::new("far scalars, integrations", LIMIT);
    for integration in Integration::ALL {
        for model in OpticalModel::ALL.into_iter().filter(|&model| integration.covers(model)) {
            for renderer in renderers(integration) {
                field.compare(renderer, &mut worst, &format!("{model}"), |plan, _| Plan { model, ..plan });
            }
        }
    }
    worst.finish();
}

#[test]
fn far_scalars_have_their_isosurfaces_where_they_were() {
    let field = Field::new();
    let mut worst = Worst::new("far scalars, isosurfaces", LIMIT);
    for (what, method) in
        [("cut", IsosurfaceMethod::Exact), ("smooth map", IsosurfaceMethod::Map { size: 64, mixing: Mixing::Smooth })]
    {
        for renderer in Renderer::EXACT {
            field.compare(renderer, &mut worst, what, |plan, at| {
                by_method(&plan, vec![white(at(0.4375), 0.4), white(at(0.6875), 1.0)], method)
            });
        }
    }
    // Opaque ones end the integral of a table.
    for integration in [Integration::Table2d, Integration::Table3d] {
        let stopped = IsosurfaceMethod::Map { size: 64, mixing: Mixing::Stopped };
        field.compare(Renderer::Fast(integration), &mut worst, "stopped map", |plan, at| {
            by_method(&plan, vec![white(at(0.4375), 1.0)], stopped)
        });
    }
    worst.finish();
}

/// Segments of single rays have the scalars that the field was given with, whoever joined them; and light as before.
#[test]
fn far_scalars_of_rays_are_those_of_the_field() {
    let field = Field::new();
    let pixels: Vec<[u32; 2]> =
        (0..field.view.height).step_by(5).flat_map(|y| (0..field.view.width).step_by(3).map(move |x| [x, y])).collect();
    let (first, second) = pixels.split_at(pixels.len() / 3);
    let mut lights = Worst::new("far scalars, light of rays", LIMIT);
    for Moved { place, near, far, width } in MOVED {
        let [near_scalars, far_scalars] = [near, far].map(|low| field.scalars(low, width));
        let as_it_is = RayTracer::new(&field.mesh, &near_scalars, &field.view).unwrap();
        let moved = RayTracer::new(&field.mesh, &far_scalars, &field.view).unwrap();
        let expected = as_it_is.trace(&pixels);
        let parts = [first, second].map(|pixels| moved.trace(pixels));
        let ways: [(&str, Rays); 3] = [
            ("traced at once", moved.trace(&pixels)),
            ("joined", parts[0].clone().joined(&parts[1])),
            ("joined to nothing", Rays::default().joined(&parts[0]).joined(&parts[1])),
        ];
        let light = as_it_is.shader(&field.plan(near, width), &Silent).unwrap();
        let moved_light = moved.shader(&field.plan(far, width), &Silent).unwrap();
        // A sum with 1e9 is rounded.
        let limit = LIMIT * width + 2.0 * f64::EPSILON * far.abs();
        let mut met = 0;
        for (way, rays) in &ways {
            assert_eq!(rays.pixels(), expected.pixels(), "{way}");
            for ray in 0..rays.len() {
                let segments: Vec<RaySegment> = rays.segments(ray).collect();
                assert_eq!(segments.len(), expected.segments(ray).len(), "{place}, {way}, ray {ray}");
                for (found, known) in segments.iter().zip(expected.segments(ray)) {
                    assert_eq!(found.cell, known.cell, "{place}, {way}, ray {ray}");
                    let off = |found: f64, known: f64| (found - (known + (far - near))).abs();
                    let (found, known) = (found.segment, known.segment);
                    let off =
                        off(found.scalar_front, known.scalar_front).max(off(found.scalar_back, known.scalar_back));
                    assert!(
                        off <= limit,
                        "{place}, {way}, ray {ray}: scalars are off by {off:e} of {limit:e}: {found:?}"
                    );
                    assert!((found.chord_length - known.chord_length).abs() <= 1e-12, "{place}, {way}, ray {ray}");
                    met += 1;
                }
                let (known, found) = (light.light(&expected, ray), moved_light.light(rays, ray));
                let off = known.rgb.iter().zip(found.rgb).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                lights.note(off.max((known.opacity - found.opacity).abs()), || format!("{place}, {way}, ray {ray}"));
            }
        }
        assert!(met > 500, "{place}: {met} segments");
    }
    lights.finish();
}
