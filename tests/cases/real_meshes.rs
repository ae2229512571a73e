//! Real meshes: what is in them, and both renderers on them.

use tetrascope::{Backend, Choice, Picture, ReadOptions, SceneFile, Silent, Volume, render_volume};
use tetrascope_tests::pictures::{Worst, largest, mean_opacity};
use tetrascope_tests::shared;

struct Case {
    grid: &'static str,
    solution: Option<&'static str>,
    field: Option<&'static str>,
    points: usize,
    /// Before those without volume are left out.
    tetrahedra: usize,
    no_volume: usize,
}

const CASES: &[Case] = &[
    Case {
        grid: "plot3d/bluntfinxyz.bin",
        solution: Some("plot3d/bluntfinq.bin"),
        field: Some("Density"),
        points: 40_960,
        tetrahedra: 187_395,
        no_volume: 77,
    },
    Case {
        grid: "plot3d/combxyz.bin",
        solution: Some("plot3d/combq.bin"),
        field: Some("Density"),
        points: 47_025,
        tetrahedra: 215_040,
        no_volume: 0,
    },
    Case {
        grid: "plot3d/postxyz.bin",
        solution: Some("plot3d/postq.bin"),
        field: Some("Momentum:mag"),
        points: 109_744,
        tetrahedra: 513_375,
        no_volume: 0,
    },
    Case {
        grid: "vtk/delaunay_unitcube_binary_v4.2.vtk",
        solution: None,
        field: Some("marschner_like"),
        points: 4_000,
        tetrahedra: 26_410,
        no_volume: 0,
    },
];

/// Opacity needs no order, and the limit is that of the easiest reference picture: 2e-5.
#[test]
fn real_meshes_look_the_same_to_both_renderers() {
    let Some(folder) = shared::folder("real meshes") else { return };
    let data = folder.join("data");
    let mut worst = Worst::new("real meshes, opacity of fast against reference", 2e-5);
    for case in CASES {
        let solution = case.solution.map(|s| data.join(s));
        let volume = Volume::load(&data.join(case.grid), &ReadOptions::with_solution(solution.as_deref())).unwrap();
        let counts = &volume.decomposition.counts;
        assert_eq!(volume.dataset.points.len(), case.points, "{}", case.grid);
        assert_eq!((counts.tetrahedra, counts.no_volume), (case.tetrahedra, case.no_volume), "{}", case.grid);
        assert_eq!(volume.decomposition.mesh.tetrahedra().len(), case.tetrahedra - case.no_volume);

        let mut scene = SceneFile::of_mesh(case.grid);
        (scene.image.width, scene.image.height) = (64, 64);
        scene.mesh.field = case.field.map(str::to_owned);
        let mut draw = |backend| -> Picture {
            scene.quality.backend = Choice::Named(backend);
            render_volume(&volume, &scene, &Silent).unwrap()
        };
        let (fast, slow) = (draw(Backend::Cpu), draw(Backend::Reference));
        assert!(mean_opacity(&slow.image) > 0.02, "{}: nearly nothing to see", case.grid);
        println!(
            "{}: mean opacity {:.3}, color differs by {:.1e}",
            case.grid,
            mean_opacity(&slow.image),
            largest(&fast.image, &slow.image, 0..3)
        );
        worst.note(largest(&fast.image, &slow.image, 3..4), || case.grid.to_owned());
    }
    worst.finish();
}
