//! Errors that are known, and what is said of them.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_cpu::{CpuRenderer, reference};
use tetrascope_integrate::{
    Integration, Isosurface, Isosurfaces, OpticalModel, Phong, SurfaceShading, TransferFunction,
};
use tetrascope_mesh::TetMesh;
use tetrascope_order::OrderMethod;
use tetrascope_scene::{Interpolation, IsosurfaceMethod, IsosurfacePlan, Lighting, Mixing, Plan, Silent};
use tetrascope_view::{Camera, ErrorFigures, LinearImage, Projection, View};

use crate::{BlendingOrder, Cause, ErrorEstimate, EstimateError, Subject, choose_integration, estimate};

/// A cube of six tetrahedra about one diagonal, from -1 to 1.
fn cube() -> TetMesh {
    let points: Vec<DVec3> = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)) * 2.0 - 1.0)
        .collect();
    let cells = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
    TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh
}

fn view(distance: f64, size: u32) -> View {
    let camera = Camera {
        eye: DVec3::new(0.61, 0.47, 1.0).normalize() * distance,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 2.0 * (1.9 / distance).atan() },
    };
    View::new(&camera, size, size).unwrap()
}

const SCALARS: [f64; 8] = [0.0, 0.6, 0.2, 0.9, 0.5, 0.1, 1.0, 0.4];

/// A peak in the middle, a color that changes.
fn peak(height: f64) -> TransferFunction {
    let color = [[0.0, 0.1, 0.4, 0.9], [1.0, 0.9, 0.3, 0.1]];
    TransferFunction::new(&color, &[[0.3, 0.0], [0.5, height], [0.7, 0.0]]).unwrap()
}

fn plan(size: u32) -> Plan {
    Plan::new(view(5.0, size), peak(4.0), OpticalModel::DensityEmitter)
}

fn truth(mesh: &TetMesh, plan: &Plan, picture: &LinearImage) -> f64 {
    let exact = Plan { integration: Integration::Exact, interpolation: Interpolation::Exact, ..plan.clone() };
    let exact = reference::render(mesh, &SCALARS, &exact, &Silent).unwrap().image;
    ErrorFigures::between(picture, &exact).unwrap().largest
}

fn measured(mesh: &TetMesh, plan: &Plan, order: BlendingOrder<'_>) -> (ErrorEstimate, f64) {
    let picture = CpuRenderer::new(mesh, &SCALARS).unwrap().render(plan, &Silent).unwrap().image;
    let estimate = estimate(&Subject { mesh, scalars: &SCALARS, plan, order }, &picture).unwrap();
    (estimate, truth(mesh, plan, &picture))
}

fn part(estimate: &ErrorEstimate, cause: Cause) -> crate::ErrorPart {
    *estimate.parts.iter().find(|part| part.cause == cause).unwrap()
}

#[test]
fn an_exact_picture_has_rounding_alone() {
    let mesh = cube();
    let plan = Plan { order: OrderMethod::PerPixel, ..plan(120) };
    let (estimate, truth) = measured(&mesh, &plan, BlendingOrder::Right);
    for cause in [Cause::Integration, Cause::Order, Cause::Interpolation] {
        assert_eq!(part(&estimate, cause).bound, Some(0.0), "{cause}");
        assert!(part(&estimate, cause).expected < 1e-15, "{cause}");
    }
    assert_eq!(part(&estimate, Cause::Blending).bound, None);
    assert!(truth < 5e-6 && estimate.expected < 2e-5 && truth <= estimate.expected, "{truth:e} {estimate:?}");
}

#[test]
fn a_wrong_integration_is_the_integrations_fault() {
    let mesh = cube();
    for integration in
        [Integration::Average, Integration::Opacity2d, Integration::Partial, Integration::Table2d, Integration::Vertex]
    {
        let plan = Plan { order: OrderMethod::PerPixel, integration, ..plan(120) };
        let (estimate, truth) = measured(&mesh, &plan, BlendingOrder::Right);
        let of_integration = part(&estimate, Cause::Integration);
        assert!(truth > 0.02, "{integration}: the peak is missed by {truth}");
        assert!((truth..=10.0 * truth).contains(&estimate.expected), "{integration}: {truth} {estimate:?}");
        assert!((0.9 * estimate.expected..).contains(&of_integration.expected), "{integration}: {estimate:?}");
        assert!(part(&estimate, Cause::Blending).expected < 1e-3, "{integration}: {estimate:?}");
        assert!(of_integration.bound.unwrap() >= truth - 1e-5, "{integration}: {truth} {estimate:?}");
    }
}

#[test]
fn a_wrong_order_is_the_orders_fault() {
    let mesh = cube();
    // From back to front, which is wrong everywhere.
    let plan = Plan { order: OrderMethod::None, ..plan(120) };
    let ranks: Vec<u32> = (0..6).collect();
    let (estimate, truth) = measured(&mesh, &plan, BlendingOrder::Ranks(&ranks));
    let of_order = part(&estimate, Cause::Order);
    assert!(truth > 0.01, "{truth}");
    assert!((truth..=10.0 * truth).contains(&estimate.expected), "{truth} {estimate:?}");
    assert!(of_order.expected >= truth && of_order.bound.unwrap() >= truth, "{truth} {estimate:?}");
    assert_eq!(part(&estimate, Cause::Integration).bound, Some(0.0));
}

#[test]
fn a_small_picture_is_measured_as_a_whole() {
    let mesh = cube();
    let plan = Plan { order: OrderMethod::PerPixel, integration: Integration::Average, ..plan(24) };
    let (estimate, truth) = measured(&mesh, &plan, BlendingOrder::Right);
    assert!((estimate.expected / truth - 1.0).abs() < 1e-3, "{truth} {estimate:?}");
}

#[test]
fn a_mesh_out_of_view_has_no_error() {
    let mesh = cube();
    let mut plan = plan(40);
    plan.view.eye += plan.view.forward * 100.0;
    let (estimate, truth) = measured(&mesh, &plan, BlendingOrder::Right);
    assert_eq!(truth, 0.0);
    assert!(estimate.expected < 1e-7 && estimate.rays == 0, "{estimate:?}");
}

#[test]
fn what_is_the_same_everywhere_is_not_cut() {
    let mesh = cube();
    let constant = TransferFunction::new(&[[0.0, 0.2, 0.5, 0.9]], &[[0.0, 1.5]]).unwrap();
    let plan = Plan { transfer: constant, ..plan(200) };
    let choice = choose_integration(&mesh, &SCALARS, &plan, 1e-4).unwrap();
    assert_eq!(choice.integration, Integration::Average, "{choice:?}");
    let taken = choice.candidates.iter().find(|candidate| candidate.integration == choice.integration).unwrap();
    assert!(taken.bound.unwrap() < 1e-12 && taken.expected.is_none(), "no ray is needed: {taken:?}");
}

#[test]
fn a_wish_decides_between_cheap_and_right() {
    let mesh = cube();
    let thin = Plan { transfer: peak(0.05), ..plan(200) };
    let coarse = choose_integration(&mesh, &SCALARS, &thin, 0.2).unwrap();
    assert!(coarse.candidates.iter().all(|candidate| candidate.relative_time < 1.0), "{coarse:?}");
    assert_ne!(coarse.integration, Integration::Exact, "{coarse:?}");
    let fine = choose_integration(&mesh, &SCALARS, &thin, 1e-5).unwrap();
    assert_eq!(fine.integration, Integration::Exact, "{fine:?}");
}

/// Near the eye the fans of the literature give lengths that are longer than the mesh: with light per length they shine brighter than it could.
#[test]
fn lengths_on_the_screen_may_be_longer_than_the_mesh() {
    let mesh = cube();
    let glow = TransferFunction::new(&[[0.0, 0.0, 0.0, 1.76], [1.0, 0.0, 0.0, 0.0]], &[[0.0, 0.0]]).unwrap();
    let plan = Plan {
        interpolation: Interpolation::Screen,
        integration: Integration::Average,
        ..Plan::new(view(1.683, 48), glow, OpticalModel::Emitter)
    };
    let (estimate, truth) = measured(&mesh, &plan, BlendingOrder::Right);
    assert!(truth > 1.76 * 12.0_f64.sqrt(), "no ray through the cube is longer than its diagonal: {truth}");
    assert!(
        truth <= estimate.bound && truth <= part(&estimate, Cause::Interpolation).bound.unwrap(),
        "{truth} {estimate:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Whatever the transfer function, the eye, the light and a surface: bounds hold, also where the estimate does not come near.
    #[test]
    fn bounds_are_never_exceeded(
        heights in prop::collection::vec(0.0_f64..6.0, 2..9),
        colors in prop::collection::vec(0.0_f64..2.0, 12),
        distance in 1.2_f64..8.0,
        integration in prop::sample::select(&Integration::ALL[..]),
        model in prop::sample::select(&OpticalModel::ALL[..]),
        interpolation in prop::sample::select(&Interpolation::ALL[..]),
        is_sorted in any::<bool>(),
        surface in prop::option::of((0.0_f64..1.0, 0.1_f64..1.0, 0.0_f64..12.0)),
        light in prop::option::of((0.0_f64..1.0, 0.0_f64..1.0, any::<bool>())),
    ) {
        let mesh = cube();
        let place = |index: usize, count: usize| index as f64 / (count - 1) as f64;
        let extinction: Vec<[f64; 2]> = heights.iter().enumerate().map(|(i, &h)| [place(i, heights.len()), h]).collect();
        // A step of color at a scalar that corners have, and at the lowest.
        let steps = [0.0, 0.0, 0.5, 1.0];
        let color: Vec<[f64; 4]> = colors.chunks(3).zip(steps).map(|(c, at)| [at, c[0], c[1], c[2]]).collect();
        let transfer = TransferFunction::new(&color, &extinction).unwrap();
        let order = if is_sorted { OrderMethod::PerPixel } else { OrderMethod::None };
        let mut plan = Plan { integration, order, interpolation, ..Plan::new(view(distance, 48), transfer, model) };
        if let Some((value, opacity, brightness)) = surface {
            let (color, shading) = ([brightness; 3], SurfaceShading::Smooth);
            let surfaces = vec![Isosurface { value, color, back_color: color, opacity, shading }];
            let surfaces = Isosurfaces::new(surfaces).unwrap();
            plan.isosurfaces = Some(IsosurfacePlan { surfaces, method: IsosurfaceMethod::Exact });
        }
        if let Some((ambient, diffuse, volume)) = light {
            let phong = Phong { ambient, diffuse, specular: 1.0 - ambient, shininess: 8.0 };
            plan.lighting = Some(Lighting { phong, direction: None, volume });
        }
        prop_assume!(plan.check().is_ok());
        let ranks: Vec<u32> = (0..6).collect();
        let blending = if is_sorted || plan.commutes() { BlendingOrder::Right } else { BlendingOrder::Ranks(&ranks) };
        let (estimate, truth) = measured(&mesh, &plan, blending);
        prop_assert!(truth <= estimate.bound, "{} {:?}", truth, estimate);
        for part in &estimate.parts {
            let bound = part.bound.unwrap_or(f64::INFINITY);
            prop_assert!(part.expected <= bound * (1.0 + 1e-9) + 1e-9, "{:?}", estimate);
        }
        // In 32 bits single pixels may lie on the other side of a surface or a step, which has no bound.
        if surface.is_none() {
            let bounds: f64 = estimate.parts.iter().map(|part| part.bound.unwrap_or(0.05)).sum();
            prop_assert!(truth <= bounds, "{} {:?}", truth, estimate);
        }
    }
}

/// The middle of both ends, where the lower one is a scalar of the mesh at which the color steps: the side that no ray lies on counts too.
#[test]
fn steps_at_a_corner_have_two_sides() {
    let mesh = cube();
    let transfer =
        TransferFunction::new(&[[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [1.0, 9.0, 9.0, 9.0]], &[[0.0, 5.0]])
            .unwrap();
    for integration in [Integration::Vertex, Integration::Opacity2d] {
        let order = OrderMethod::PerPixel;
        let plan =
            Plan { integration, order, ..Plan::new(view(4.0, 60), transfer.clone(), OpticalModel::DensityEmitter) };
        let (estimate, _) = measured(&mesh, &plan, BlendingOrder::Right);
        let of_integration = part(&estimate, Cause::Integration);
        assert!(of_integration.expected <= of_integration.bound.unwrap() + 1e-9, "{integration}: {estimate:?}");
    }
}

#[test]
fn maps_are_not_rounding() {
    let mesh = cube();
    let surface =
        Isosurface { value: 0.45, color: [0.9; 3], back_color: [0.9; 3], opacity: 1.0, shading: SurfaceShading::None };
    let surfaces = Isosurfaces::new(vec![surface]).unwrap();
    let method = IsosurfaceMethod::Map { size: 8, mixing: Mixing::Smooth };
    let isosurfaces = Some(IsosurfacePlan { surfaces, method });
    let plan = Plan { order: OrderMethod::PerPixel, isosurfaces, ..plan(100) };
    let (estimate, truth) = measured(&mesh, &plan, BlendingOrder::Right);
    assert!(truth > 0.05, "{truth}");
    let of_surfaces = part(&estimate, Cause::Isosurfaces);
    assert!(of_surfaces.expected > 0.05 && of_surfaces.bound.is_none(), "{estimate:?}");
    assert!(part(&estimate, Cause::Blending).expected < 1e-6, "{estimate:?}");
}

#[test]
fn what_does_not_fit_is_told() {
    let mesh = cube();
    let plan = plan(20);
    let subject = Subject { mesh: &mesh, scalars: &SCALARS, plan: &plan, order: BlendingOrder::Ranks(&[0, 1]) };
    let picture = LinearImage::transparent(20, 20);
    assert_eq!(estimate(&subject, &picture), Err(EstimateError::Ranks { ranks: 2, cells: 6 }));
    let error = estimate(&subject, &LinearImage::transparent(3, 20)).unwrap_err();
    assert!(error.to_string().contains("3 x 20") && error.to_string().contains("20 x 20"), "{error}");
}
