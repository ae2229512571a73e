//! What a scene does not call for is not computed, and what it calls for is not left out.

use tetrascope::{CpuRenderer, Gradients, Isosurface, Lighting, Plan, SceneFile, Silent, SurfaceShading, Volume};
use tetrascope_tests::pictures::{WHITE, plan};
use tetrascope_tests::surfaces::{surfaces_alone, white, with_surfaces};

use crate::isosurfaces::{sample, view_from};

/// Gradients are for light alone, and for no more than it needs.
#[test]
fn gradients_only_where_something_is_lit() {
    let view = view_from(6.0, 20);
    let shaded = |shading| Isosurface { shading, ..white(0.0, 0.5) };
    let (bare, light) = (plan(view, WHITE, &[[0.0, 1.0]]), Some(Lighting::default()));
    let with = |lighting, shading| Plan { lighting, ..with_surfaces(&bare, vec![shaded(shading)]) };
    for (expected, plan) in [
        (Gradients::None, bare.clone()),
        (Gradients::None, Plan { lighting: light, ..bare.clone() }),
        (Gradients::None, with(None, SurfaceShading::Smooth)),
        (Gradients::None, with(light, SurfaceShading::None)),
        (Gradients::Cells, with(light, SurfaceShading::Flat)),
        (Gradients::Points, with(light, SurfaceShading::Smooth)),
        (Gradients::Points, Plan { lighting: Some(Lighting { volume: true, ..Lighting::default() }), ..bare.clone() }),
    ] {
        assert_eq!(plan.gradients(), expected, "{:?} {:?}", plan.lighting, plan.isosurfaces);
    }
}

/// A scene says what is left out.
#[test]
fn scene_says_none_for_what_it_does_not_need() {
    let volume = Volume::sample().unwrap();
    let facts = volume.field(None).unwrap().facts;
    let choices = |change: &dyn Fn(&mut SceneFile)| {
        let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
        change(&mut scene);
        let completed = scene.complete(&facts).unwrap();
        move |subject: &str| completed.decisions.iter().find(|d| d.subject == subject).map(|d| d.choice.clone())
    };
    let plain = choices(&|_| ());
    for subject in ["isosurfaces", "gradients", "tables"] {
        assert_eq!(plain(subject).as_deref(), Some("none"), "{subject}");
    }
    let emission = choices(&|scene| scene.optics.model = tetrascope::OpticalModel::Emission);
    assert_eq!(emission("order").as_deref(), Some("none"));
}

/// With no volume to see only the cells that a surface crosses are drawn; the others count as transparent.
#[test]
fn only_crossed_cells_are_drawn() {
    let (mesh, scalars) = sample(12);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let view = view_from(6.0, 60);
    let counts = |plan: &Plan| renderer.render(plan, &Silent).unwrap().counts;
    let crossed = mesh
        .tetrahedra()
        .iter()
        .filter(|cell| {
            let values = cell.map(|v| scalars[v.index()]);
            values.iter().any(|s| *s < 0.05) && values.iter().any(|s| *s > 0.05)
        })
        .count() as u64;
    let found = counts(&surfaces_alone(view, vec![white(0.05, 0.5)]));
    assert_eq!(found.cells - found.transparent, crossed);
    assert!(found.crossings > 0 && crossed * 5 < found.cells, "{found:?}");

    // Nothing to see: no surface, one of opacity 0, one beside the field.
    for plan in [surfaces_alone(view, vec![white(0.05, 0.0)]), surfaces_alone(view, vec![white(7.0, 1.0)])] {
        let found = counts(&plan);
        assert_eq!((found.transparent, found.drawn, found.fragments, found.crossings), (found.cells, 0, 0, 0));
    }
    // With a volume all that it shows in are drawn.
    let all = counts(&with_surfaces(&plan(view, WHITE, &[[0.0, 1.0]]), vec![white(0.05, 0.5)]));
    assert_eq!(all.transparent, 0);
}

/// A peak between the scalars of a cell's corners is not transparent.
#[test]
fn thin_peak_inside_a_cell_counts() {
    let (mesh, scalars) = sample(4);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    for width in [1e-2, 1e-6, 1e-12] {
        let peak = [[0.05 - width, 0.0], [0.05, 3.0 / width], [0.05 + width, 0.0]];
        let found = renderer.render(&plan(view_from(6.0, 40), WHITE, &peak), &Silent).unwrap();
        let crossed = mesh
            .tetrahedra()
            .iter()
            .filter(|cell| {
                let values = cell.map(|v| scalars[v.index()]);
                values.iter().any(|s| *s < 0.05) && values.iter().any(|s| *s > 0.05)
            })
            .count() as u64;
        assert!(found.counts.cells - found.counts.transparent >= crossed, "width {width:e}: {:?}", found.counts);
    }
}
