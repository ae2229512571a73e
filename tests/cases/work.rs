//! What is done is what the plan says, and nothing else: counted, in every back end, with every effect on and off.

use std::sync::Arc;

use tetrascope::{
    Backend, Choice, Counts, CpuRenderer, GpuPath, GpuRenderer, Integration, IsosurfaceMethodName, IsosurfaceSection,
    LightSection, OpticalModel, OrderMethod, Plan, Rendered, SceneFile, Shading, Silent, Stage, Volume, VolumeField,
    Work, reference,
};
use tetrascope_tests::effects::{only_above, pairs, thin_extinction};
use tetrascope_tests::gpu;

/// Cells along a side of the sample.
const CELLS: usize = 8;

fn volume() -> Volume {
    Volume::from_dataset(tetrascope::mesh::rings_sample(CELLS), "sample").unwrap()
}

/// The plan of a scene on a field.
fn plan_of(scene: &SceneFile, field: &VolumeField<'_>) -> Plan {
    let mut completed = scene.complete(&field.facts).unwrap();
    field.plan(&mut completed).unwrap()
}

/// A renderer that has drawn nothing else, and a picture by it.
fn draw(plan: &Plan, field: &VolumeField<'_>) -> Rendered {
    let (mesh, scalars) = (field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars);
    match plan.backend {
        Backend::Cpu => CpuRenderer::new(mesh, scalars).unwrap().render(plan, &Silent).unwrap(),
        Backend::Reference => reference::render(mesh, scalars, plan, &Silent).unwrap(),
        Backend::Gpu => {
            let device = gpu::gpu("work").unwrap();
            GpuRenderer::new(device, mesh, scalars, Arc::default()).unwrap().render(plan, &Silent).unwrap()
        }
    }
}

/// Scenes that switch every effect on and off, with a name each.
fn scenes(field: &VolumeField<'_>) -> Vec<(String, SceneFile)> {
    let mut all = Vec::new();
    for pair in pairs(&field.facts, thin_extinction(field, 0.1), 48) {
        all.push((format!("{}: never", pair.name), pair.never));
        all.push((format!("{}: off", pair.name), pair.off));
        all.extend(pair.on.into_iter().map(|(what, scene)| (format!("{}: {what}", pair.name), scene)));
    }
    let plain = all[0].1.clone();
    let (low, high) = field.facts.scalar_range;
    let surface =
        |shading| IsosurfaceSection { shading, opacity: 0.5, ..IsosurfaceSection::new(0.5 * (low + high), [0.9; 3]) };
    let mut add = |name: &str, change: &dyn Fn(&mut SceneFile)| {
        let mut scene = plain.clone();
        change(&mut scene);
        all.push((name.to_owned(), scene));
    };
    add("surface lit flat", &|scene| scene.isosurface = vec![surface(Shading::Flat)]);
    add("surfaces lit flat and smooth", &|scene| {
        scene.isosurface = vec![surface(Shading::Flat), surface(Shading::Smooth)];
        scene.isosurface[1].value += 0.1 * (high - low);
    });
    add("a flat one, and a smooth one of opacity 0", &|scene| {
        scene.isosurface = vec![surface(Shading::Flat), IsosurfaceSection { opacity: 0.0, ..surface(Shading::Smooth) }];
        scene.isosurface[1].value += 0.1 * (high - low);
    });
    add("maps", &|scene| {
        scene.isosurface = vec![surface(Shading::Smooth)];
        scene.quality.isosurfaces = Some(IsosurfaceMethodName::MapSmooth);
        scene.quality.map_size = Some(32);
    });
    add("maps that stop a table", &|scene| {
        scene.isosurface = vec![IsosurfaceSection { opacity: 1.0, ..surface(Shading::None) }];
        scene.quality.isosurfaces = Some(IsosurfaceMethodName::MapStopped);
        (scene.quality.map_size, scene.quality.table_size) = (Some(32), Some(16));
    });
    add("surfaces alone", &|scene| {
        scene.isosurface = vec![surface(Shading::Smooth)];
        scene.transfer.extinction = Some(vec![[low, 0.0]]);
    });
    add("surfaces and absorption", &|scene| {
        scene.isosurface = vec![surface(Shading::None)];
        scene.optics.model = OpticalModel::Absorption;
    });
    add("both lit", &|scene| {
        scene.isosurface = vec![surface(Shading::Smooth)];
        scene.light = Some(LightSection { volume: true, ..LightSection::default() });
    });
    add("absorption with a light", &|scene| {
        scene.optics.model = OpticalModel::Absorption;
        scene.light = Some(LightSection { volume: true, ..LightSection::default() });
    });
    add("nothing to see", &|scene| scene.transfer.extinction = Some(vec![[low, 0.0]]));
    add("out of view", &|scene| scene.camera.target = scene.camera.eye.map(|eye| eye.map(|x| 3.0 * x)));
    for integration in [Integration::Table2d, Integration::Cumulative, Integration::Average, Integration::Vertex] {
        add(&integration.to_string(), &|scene| scene.quality.integration = Choice::Named(integration));
    }
    for order in [
        OrderMethod::None,
        OrderMethod::Bucket { slabs: 20 },
        OrderMethod::Centroid,
        OrderMethod::Power,
        OrderMethod::Mpvo,
        OrderMethod::BspXmpvo,
        OrderMethod::KBuffer { window: 6 },
        OrderMethod::PerPixel,
    ] {
        add(&format!("order {order}"), &|scene| scene.quality.replace_order(Choice::Named(order)));
    }
    all
}

/// Draws all scenes by a back end and says where more or less was done than foreseen.
fn check_scenes(backend: Backend, path: Option<GpuPath>) {
    let volume = volume();
    let field = volume.field(None).unwrap();
    let mut failures = Vec::new();
    let mut drawn = 0;
    for (name, scene) in scenes(&field) {
        let mut scene = scene;
        scene.quality.replace_backend(Choice::Named(backend));
        if backend == Backend::Gpu {
            scene.quality.adapter = Some(gpu::adapter());
            scene.quality.gpu_path = path.map(Choice::Named);
        }
        // What a back end does not draw it says beforehand.
        let Ok(mut completed) = scene.complete(&field.facts) else { continue };
        let Ok(plan) = field.plan(&mut completed) else { continue };
        let can_sort = plan.order.pixel_sort() == tetrascope::order::PixelSort::None;
        if path == Some(GpuPath::Triangles) && !can_sort
            || backend == Backend::Reference && plan.integration.needs_fan()
        {
            continue;
        }
        let work = field.work(&plan).unwrap();
        let rendered = draw(&plan, &field);
        failures.extend(work.differences(&rendered).into_iter().map(|what| format!("{name}: {what}")));
        drawn += 1;
    }
    assert!(drawn > 20, "{drawn} scenes alone");
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn work_of_the_cpu_is_what_the_plan_says() {
    check_scenes(Backend::Cpu, None);
}

#[test]
fn work_of_the_reference_is_what_the_plan_says() {
    check_scenes(Backend::Reference, None);
}

#[test]
fn work_of_the_gpu_is_what_the_plan_says() {
    if gpu::gpu("work_of_the_gpu_is_what_the_plan_says").is_none() {
        return;
    }
    check_scenes(Backend::Gpu, Some(GpuPath::Compute));
    check_scenes(Backend::Gpu, Some(GpuPath::Triangles));
}

/// The comparison sees work that was not asked for: a picture is held against the plan of another.
#[test]
fn work_that_was_not_asked_for_is_found() {
    let volume = volume();
    let field = volume.field(None).unwrap();
    let all = scenes(&field);
    let of = |name: &str| plan_of(&all.iter().find(|(known, _)| known == name).unwrap().1, &field);
    let plain = field.work(&of("lighting: never")).unwrap();
    for (name, said) in [
        ("lighting: volume lit", &["gradients of points", "gradients of cells", "fragments that are lit"][..]),
        ("isosurfaces: 100", &["cells with effects", "crossings"]),
        ("table: 64 x 64 x 64", &["entries of the table", "stages"]),
        ("maps", &["texels of maps"]),
        ("order per-pixel", &["cells in order", "fragments sorted by pixels"]),
        ("cells that show nothing: off", &["transparent cells"]),
        ("vertex", &["fans"]),
    ] {
        let found = plain.differences(&draw(&of(name), &field));
        for part in said {
            assert!(found.iter().any(|text| text.starts_with(part)), "{name}: {part} is not in {found:?}");
        }
    }
    let absorption = field.work(&of("order, absorption: never")).unwrap();
    let found = absorption.differences(&draw(&of("order, absorption: density emitter"), &field));
    assert!(found.iter().any(|text| text.starts_with("cells in order")), "{found:?}");
}

/// What two pictures took, but for the cells that one of the meshes has not.
fn without_cells(counts: Counts) -> Counts {
    Counts { cells: 0, transparent: 0, ..counts }
}

/// An effect that is switched off takes the work of a scene that never had it, to the last cell, entry and byte; and switched on it
/// takes more.
fn check_pairs(backend: Backend) {
    let volume = volume();
    let field = volume.field(None).unwrap();
    let shown = thin_extinction(&field, 0.1);
    let threshold = shown[0][0];
    for pair in pairs(&field.facts, shown, 48) {
        let by = |scene: &SceneFile| {
            let mut scene = scene.clone();
            scene.quality.replace_backend(Choice::Named(backend));
            scene.quality.adapter = (backend == Backend::Gpu).then(gpu::adapter);
            // The cheapest order for one mesh need not be the one for a part of it.
            if pair.is_of_fewer_cells {
                scene.quality.replace_order(Choice::Named(OrderMethod::Centroid));
            }
            scene
        };
        let made = |scene: &SceneFile, field: &VolumeField<'_>| -> (Work, Rendered) {
            let plan = plan_of(&by(scene), field);
            (field.work(&plan).unwrap(), draw(&plan, field))
        };
        let (off_work, off) = made(&pair.off, &field);
        let stages = |rendered: &Rendered| rendered.timings.iter().map(|(stage, _)| *stage).collect::<Vec<Stage>>();
        let never = if pair.is_of_fewer_cells {
            let fewer = only_above(&field, threshold).unwrap();
            let never = made(&pair.never, &fewer.field(None).unwrap()).1;
            let share = off.counts.transparent as f64 / off.counts.cells as f64;
            assert!((0.85..0.95).contains(&share), "{share} of the cells are transparent");
            assert_eq!((never.counts.cells, never.counts.transparent), (off.counts.cells - off.counts.transparent, 0));
            assert_eq!(without_cells(never.counts).drawn, off.counts.drawn, "{}", pair.name);
            assert_eq!(never.counts.fragments, off.counts.fragments, "{}", pair.name);
            assert_eq!(never.counts.ordered, off.counts.ordered, "{}", pair.name);
            never
        } else {
            let (never_work, never) = made(&pair.never, &field);
            assert_eq!(never.counts, off.counts, "{}", pair.name);
            assert_eq!(never_work, off_work, "{}", pair.name);
            assert!(never.image == off.image, "{}: other pixels", pair.name);
            let devices = [&never, &off].map(|r| r.device.as_ref().map(|d| (d.buffers.clone(), d.pipelines.clone())));
            assert_eq!(devices[0], devices[1], "{}", pair.name);
            never
        };
        assert_eq!(stages(&never), stages(&off), "{}", pair.name);
        for (what, scene) in &pair.on {
            let on = made(scene, &field).1;
            assert_ne!(on.counts, off.counts, "{}, {what}: nothing was done for it", pair.name);
        }
    }
}

#[test]
fn work_of_an_effect_that_is_off_is_none_cpu() {
    check_pairs(Backend::Cpu);
}

#[test]
fn work_of_an_effect_that_is_off_is_none_gpu() {
    if gpu::gpu("work_of_an_effect_that_is_off_is_none_gpu").is_some() {
        check_pairs(Backend::Gpu);
    }
}
