//! The same plan gives the same bits.

use glam::DVec3;
use tetrascope::{
    CpuRenderer, Integration, OpticalModel, OrderMethod, Plan, Silent, TransferFunction, View, reference,
};
use tetrascope_tests::meshes::{Random, Tets};
use tetrascope_tests::pictures::{Renderer, SMALL_TABLES, mean_opacity, plan, random_camera};

const EXTINCTION: &[[f64; 2]] = &[[-1.0, 0.0], [-0.2, 3.0], [0.1, 0.2], [1.0, 2.0]];
const COLOR: &[[f64; 4]] = &[[-1.0, 0.9, 0.1, 0.2], [0.0, 0.1, 0.8, 0.3], [1.2, 1.0, 0.9, 0.1]];

/// More cells than one task sets up, more tiles than threads, and tiles that are cut off.
fn case(is_perspective: bool) -> (Tets, Plan) {
    let tets = Tets::block(10, 1200);
    let camera = random_camera(&mut Random::new(3), DVec3::ZERO, 1.0, is_perspective);
    let plan = plan(View::new(&camera, 131, 77).unwrap(), COLOR, EXTINCTION);
    (tets, Plan { tables: SMALL_TABLES, ..plan })
}

#[test]
fn threads_change_no_bit() {
    for is_perspective in [false, true] {
        let (tets, plan) = case(is_perspective);
        let mesh = tets.mesh();
        for renderer in Renderer::ALL.into_iter().chain(Renderer::BETWEEN) {
            let alone = renderer.draw(&mesh, &tets.scalars, &Plan { threads: Some(1), ..plan.clone() });
            assert!(mean_opacity(&alone) > 0.1);
            for threads in [None, Some(2), Some(3), Some(7)] {
                let image = renderer.draw(&mesh, &tets.scalars, &Plan { threads, ..plan.clone() });
                assert_eq!(alone, image, "{renderer:?} on {threads:?} threads");
            }
        }
        for (order, model) in
            [(OrderMethod::None, OpticalModel::Absorption), (OrderMethod::Bucket { slabs: 7 }, OpticalModel::Emitter)]
        {
            let draw = |threads| {
                let plan = Plan { threads, order, model, ..plan.clone() };
                Renderer::Fast(Integration::Exact).draw(&mesh, &tets.scalars, &plan)
            };
            assert_eq!(draw(Some(1)), draw(Some(3)), "{order}, {model}");
        }
    }
}

#[test]
fn what_was_drawn_before_changes_no_bit() {
    let (tets, plan) = case(true);
    let mesh = tets.mesh();
    let renderer = CpuRenderer::new(&mesh, &tets.scalars).unwrap();
    let draw = |plan: &Plan| renderer.render(plan, &Silent).unwrap().image;
    let first = draw(&plan);
    assert_eq!(first, draw(&plan), "a second time");

    // Each of these changes something that the renderer may keep.
    let other_transfer = TransferFunction::new(COLOR, &[[0.0, 0.0], [0.5, 4.0]]).unwrap();
    let others = [
        Plan { transfer: other_transfer, ..plan.clone() },
        Plan { model: OpticalModel::Emission, ..plan.clone() },
        Plan { integration: Integration::Vertex, ..plan.clone() },
        Plan { order: OrderMethod::None, ..plan.clone() },
        Plan { view: View { width: 64, height: 100, ..plan.view }, ..plan.clone() },
    ];
    for (i, other) in others.iter().enumerate() {
        let there = draw(other);
        assert_ne!(first.pixels(), there.pixels(), "change {i} shows");
        assert_eq!(first, draw(&plan), "after change {i}");
        let fresh = CpuRenderer::new(&mesh, &tets.scalars).unwrap().render(other, &Silent).unwrap().image;
        assert_eq!(there, fresh, "change {i} by a renderer that has drawn before");
    }

    let reference = || reference::render(&mesh, &tets.scalars, &plan, &Silent).unwrap().image;
    assert_eq!(reference(), reference());
}

/// Many threads asking one renderer at once, with two transfer functions: each gets its own picture.
#[test]
fn one_renderer_serves_many_threads() {
    let (tets, plan) = case(false);
    let renderer = CpuRenderer::new(&tets.mesh(), &tets.scalars).unwrap();
    let other = Plan { transfer: TransferFunction::new(COLOR, &[[0.0, 0.0], [0.5, 4.0]]).unwrap(), ..plan.clone() };
    let expected = [&plan, &other].map(|p| renderer.render(p, &Silent).unwrap().image);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            for (p, expected) in [&plan, &other].into_iter().zip(&expected) {
                scope.spawn(|| {
                    for _ in 0..3 {
                        assert_eq!(renderer.render(p, &Silent).unwrap().image, *expected);
                    }
                });
            }
        }
    });
}
