//! Every integration with every optical model that it covers, in whole pictures.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{
    Camera, CpuRenderer, Integration, IsosurfaceMethod, Lighting, Mixing, OpticalModel, OrderMethod, Plan, PlanError,
    Projection, RenderError, Silent, SurfaceShading, TransferFunction, View, reference,
};
use tetrascope_tests::chords::{boundary, chords};
use tetrascope_tests::compare::difference;
use tetrascope_tests::meshes::{Random, Tets, bent_block};
use tetrascope_tests::pictures::{Renderer, WHITE, Worst, largest, mean_opacity, plan, random_camera};
use tetrascope_tests::surfaces::{by_method, white, with_surfaces};

/// All that integrate along a ray, with the models that they cover.
fn along_rays() -> Vec<(Integration, OpticalModel)> {
    let all = Integration::ALL.into_iter().filter(|integration| !integration.needs_fan());
    all.flat_map(|integration| OpticalModel::ALL.map(|model| (integration, model)))
        .filter(|(integration, model)| integration.covers(*model))
        .collect()
}

/// Tetrahedra in slabs across the line of sight, so that their centroids come in the right order from far away.
fn row(seed: u64) -> Tets {
    let mut random = Random::new(seed);
    let mut tets = Tets::default();
    while tets.cells.len() < 6 {
        let layer = tets.cells.len() as f64;
        let corners: Vec<DVec3> = (0..4)
            .map(|_| {
                let p = random.point();
                DVec3::new(1.5 * p.x, 1.5 * p.y, layer + 0.45 * p.z)
            })
            .collect();
        if (corners[1] - corners[0]).dot((corners[2] - corners[0]).cross(corners[3] - corners[0])).abs() < 0.6 {
            continue;
        }
        let first = tets.points.len() as u32;
        tets.points.extend(corners);
        tets.scalars.extend((0..4).map(|_| random.between(-1.2, 1.2)));
        tets.cells.push([0, 1, 2, 3].map(|c| first + c));
    }
    tets
}

fn view_of_row(is_perspective: bool, side: u32) -> View {
    let projection =
        if is_perspective { Projection::Perspective { fov_y: 0.09 } } else { Projection::Orthographic { height: 2.6 } };
    let camera = Camera { eye: DVec3::Z * 33.0, target: DVec3::Z * 2.5, up: DVec3::Y, projection };
    View::new(&camera, side, side).unwrap()
}

const COLOR: &[[f64; 4]] = &[[-1.0, 0.9, 0.1, 0.2], [0.0, 0.1, 0.8, 0.3], [0.8, 0.4, 0.6, 0.9], [1.2, 1.0, 0.9, 0.1]];
const EXTINCTION: &[[f64; 2]] = &[[-1.0, 0.0], [-0.4, 3.0], [0.0, 0.2], [0.5, 2.0], [1.0, 0.6]];

/// With isosurfaces light is added in every model, also in those whose volume adds none, and each surface has its own shading beside
/// others and in a lit volume. Tolerance 5e-5: the fast renderer's surfaces lie 1e-5 of a cell's range beside.
#[test]
fn fast_renderer_has_every_method_with_isosurfaces_and_light() {
    let surface = |value, opacity, shading| tetrascope::Isosurface { shading, ..white(value, opacity) };
    let surfaces = vec![
        surface(-0.5, 0.3, SurfaceShading::Flat),
        surface(0.1, 0.5, SurfaceShading::None),
        surface(0.4, 0.4, SurfaceShading::Smooth),
    ];
    for (integration, model) in along_rays() {
        for volume in [false, true] {
            let tets = row(7100);
            let mesh = tets.mesh();
            let plan = Plan { model, ..plan(view_of_row(true, 48), COLOR, EXTINCTION) };
            let lighting = Some(Lighting { volume, ..Lighting::default() });
            let plan = Plan { lighting, ..with_surfaces(&plan, surfaces.clone()) };
            let fast = Renderer::Fast(integration).draw(&mesh, &tets.scalars, &plan);
            let slow = Renderer::Reference(integration).draw(&mesh, &tets.scalars, &plan);
            let found = difference(&fast, &slow, 5e-5, &[]);
            println!("isosurfaces, {integration}, {model}, lit {volume}: {found:?}");
            assert_eq!(found.beyond, 0, "{integration}, {model}, lit {volume}: {found:?}");
        }
    }
}

/// Tolerance 5e-6: a slope of 7, scalars that are off by 1e-7, six cells. A table's look-up has its coordinates in f32, 256 nodes
/// at most: off by 1e-5 of a step between two entries, which differ by up to a tenth.
#[test]
fn fast_renderer_has_every_method_of_the_reference() {
    for (integration, model) in along_rays() {
        let mut worst = Worst::new(format!("{integration}, {model}, against the reference"), 5e-6);
        for seed in 0..3 {
            let tets = row(seed + 7000);
            let mesh = tets.mesh();
            for is_perspective in [false, true] {
                let plan = Plan { model, ..plan(view_of_row(is_perspective, 40), COLOR, EXTINCTION) };
                let fast = Renderer::Fast(integration).draw(&mesh, &tets.scalars, &plan);
                let slow = Renderer::Reference(integration).draw(&mesh, &tets.scalars, &plan);
                assert!(slow.pixels().iter().flatten().any(|c| *c > 0.1));
                worst.note(largest(&fast, &slow, 0..4), || format!("seed {seed}, perspective {is_perspective}"));
            }
        }
        worst.finish();
    }
}

/// One color and one extinction: every method is the closed form, tables too, but for what they interpolate between lengths.
#[test]
fn constant_volume_is_the_closed_form() {
    let mesh = bent_block(3, 0.12, 7100).mesh;
    let view = View::new(&random_camera(&mut Random::new(7100), DVec3::ZERO, 1.0, true), 36, 30).unwrap();
    let known = chords(&boundary(&mesh), &view);
    let scalars: Vec<f64> = (0..mesh.positions().len()).map(|i| (i as f64 * 0.37).sin()).collect();
    let (rho, kappa) = (0.8, 0.6);
    for (integration, model) in along_rays() {
        // Rounding of f32; a table is linear between lengths of a 63rd of the longest: (0.8 l / 63)^2 / 8 a cell, of 10 cells.
        // The two-dimensional one is linear in all lengths, right at 0 and at the mean one: some 0.01 a cell.
        let within = match integration {
            Integration::Table2d => 0.12,
            Integration::Table3d => 1e-4,
            _ => 1e-5,
        };
        let mut worst = Worst::new(format!("constant volume, {integration}, {model}"), within);
        let plan = Plan { model, ..plan(view, &[[0.0, kappa, kappa, kappa]], &[[0.0, rho]]) };
        for renderer in [Renderer::Fast(integration), Renderer::Reference(integration)] {
            let image = renderer.draw(&mesh, &scalars, &plan);
            for (pixel, chord) in image.pixels().iter().zip(&known) {
                let Some(chord) = chord else { continue };
                let opacity = -(-rho * chord).exp_m1();
                let expected = match model {
                    OpticalModel::DensityEmitter => [kappa * opacity, opacity],
                    OpticalModel::Emitter => [kappa / rho * opacity, opacity],
                    OpticalModel::Absorption => [0.0, opacity],
                    OpticalModel::Emission => [kappa * chord, 0.0],
                };
                for (value, expected) in [pixel[0], pixel[3]].into_iter().zip(expected) {
                    worst.note((f64::from(value) - expected).abs(), || format!("{renderer:?}: {value} not {expected}"));
                }
            }
        }
        worst.finish();
    }
}

/// Linear extinction and one color: what looks at both ends is exact.
#[test]
fn linear_extinction_is_exact_at_both_ends() {
    let tets = Tets::block(3, 7200);
    let mesh = tets.mesh();
    let view = View::new(&random_camera(&mut Random::new(7200), DVec3::ZERO, 1.0, true), 40, 40).unwrap();
    let plan = plan(view, &[[0.0, 0.9, 0.5, 0.2]], &[[-2.0, 0.0], [2.0, 3.0]]);
    let exact = Renderer::Reference(Integration::Exact).draw(&mesh, &tets.scalars, &plan);
    assert!(mean_opacity(&exact) > 0.1);
    let mut worst = Worst::new("linear extinction", 1e-5);
    for integration in [
        Integration::Average,
        Integration::Opacity2d,
        Integration::Partial,
        Integration::Cumulative,
        Integration::Exact,
    ] {
        for renderer in [Renderer::Fast(integration), Renderer::Reference(integration)] {
            let image = renderer.draw(&mesh, &tets.scalars, &plan);
            worst.note(largest(&image, &exact, 0..4), || format!("{renderer:?}"));
        }
    }
    worst.finish();
}

/// Shells thinner than cells: running integrals have the opacity of the closed form; the ends alone do not.
#[test]
fn cumulative_opacity_of_thin_shells_is_exact() {
    let tets = Tets::block(3, 7300);
    let mesh = tets.mesh();
    let shells = [[-0.51, 0.0], [-0.5, 60.0], [-0.49, 0.0], [0.19, 0.0], [0.2, 80.0], [0.21, 0.0]];
    // A scalar is off by 1e-7 where the slope is 8000, which rising and falling sides nearly make up for.
    let mut worst = Worst::new("opacity of thin shells", 2e-5);
    for is_perspective in [false, true] {
        let view = View::new(&random_camera(&mut Random::new(7300), DVec3::ZERO, 1.0, is_perspective), 40, 40).unwrap();
        let plan = plan(view, WHITE, &shells);
        let draw = |renderer: Renderer| renderer.draw(&mesh, &tets.scalars, &plan);
        let exact = draw(Renderer::Reference(Integration::Exact));
        for renderer in [Renderer::Fast(Integration::Cumulative), Renderer::Reference(Integration::Cumulative)] {
            worst.note(largest(&draw(renderer), &exact, 3..4), || format!("{renderer:?}"));
        }
        assert!(largest(&draw(Renderer::Fast(Integration::Partial)), &exact, 3..4) > 0.1);
    }
    worst.finish();
}

/// Emission is linear in the length, as the two-dimensional table has it: what is left is what it interpolates between scalars.
#[test]
fn emission_by_the_2d_table_is_exact() {
    let tets = Tets::block(3, 7400);
    let mesh = tets.mesh();
    let view = View::new(&random_camera(&mut Random::new(7400), DVec3::ZERO, 1.0, true), 40, 40).unwrap();
    // Linear over all scalars: nothing is lost between the table's nodes.
    let color = [[-3.0, 0.0, 0.1, 0.9], [3.0, 0.9, 0.4, 0.0]];
    let plan = Plan { model: OpticalModel::Emission, ..plan(view, &color, &[[0.0, 0.0]]) };
    let exact = Renderer::Reference(Integration::Exact).draw(&mesh, &tets.scalars, &plan);
    let mut worst = Worst::new("emission by table-2d", 1e-5);
    for renderer in [Renderer::Fast(Integration::Table2d), Renderer::Reference(Integration::Table2d)] {
        let image = renderer.draw(&mesh, &tets.scalars, &plan);
        worst.note(largest(&image, &exact, 0..4), || format!("{renderer:?}"));
    }
    worst.finish();
}

/// What does not go together is said, with what does.
#[test]
fn methods_that_do_not_go_together_are_refused() {
    let tets = Tets::block(1, 7500);
    let mesh: TetMesh = tets.mesh();
    let base = plan(view_of_row(true, 8), COLOR, EXTINCTION);
    let renderer = CpuRenderer::new(&mesh, &tets.scalars).unwrap();
    let refused = |plan: &Plan| renderer.render(plan, &Silent).unwrap_err();

    let partial = Plan { integration: Integration::Partial, model: OpticalModel::Emitter, ..base.clone() };
    for error in [refused(&partial), reference::render(&mesh, &tets.scalars, &partial, &Silent).unwrap_err()] {
        let message = error.to_string();
        assert!(message.contains("\"exact\"") && message.contains("\"cumulative\""), "{message}");
    }
    let vertex = Plan { integration: Integration::Vertex, ..with_surfaces(&base, vec![white(0.0, 0.5)]) };
    assert_eq!(refused(&vertex), PlanError::FanWithIsosurfaces.into());
    let stopped = IsosurfaceMethod::Map { size: 64, mixing: Mixing::Stopped };
    let without_table = by_method(&base, vec![white(0.0, 0.5)], stopped);
    assert_eq!(refused(&without_table), PlanError::NoTableToStop { integration: Integration::Exact }.into());
    for size in [0, 1, 4097] {
        let map = IsosurfaceMethod::Map { size, mixing: Mixing::Smooth };
        assert!(
            matches!(
                refused(&by_method(&base, vec![white(0.0, 0.5)], map)),
                RenderError::Plan(PlanError::Isosurfaces(_))
            ),
            "{size}"
        );
    }
}

/// Tables, maps and optics are kept from frame to frame: what was drawn before changes no bit.
#[test]
fn going_back_and_forth_changes_no_bit() {
    let tets = Tets::block(4, 7600);
    let mesh = tets.mesh();
    let view = View::new(&random_camera(&mut Random::new(7600), DVec3::ZERO, 1.0, true), 50, 40).unwrap();
    let transfer = |peak: f64| TransferFunction::new(COLOR, &[[-1.0, 0.0], [0.0, peak], [1.0, 0.2]]).unwrap();
    let renderer = CpuRenderer::new(&mesh, &tets.scalars).unwrap();
    let draw = |plan: &Plan| renderer.render(plan, &Silent).unwrap().image;
    let plans: Vec<Plan> = Integration::ALL
        .into_iter()
        .flat_map(|integration| [1.0, 2.0, 3.0].map(|peak| (integration, peak)))
        .map(|(integration, peak)| Plan {
            integration,
            transfer: transfer(peak),
            order: OrderMethod::Centroid,
            ..plan(view, COLOR, EXTINCTION)
        })
        .collect();
    let first: Vec<_> = plans.iter().map(&draw).collect();
    for (i, (plan, image)) in plans.iter().zip(&first).enumerate().rev() {
        assert_eq!(*image, draw(plan), "{} again", plan.integration);
        if i > 0 {
            assert_ne!(image.pixels(), first[i - 1].pixels(), "{} shows", plan.integration);
        }
    }
}
