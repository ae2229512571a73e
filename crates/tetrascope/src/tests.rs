//! From a mesh to a picture through the facade, where the answer is known.

use tetrascope_mesh::rings_sample;

use crate::{
    Backend, Choice, CycleRemedy, Error, GpuError, IsosurfaceSection, OpticalModel, OrderMethod, ReadOptions,
    SceneFile, Silent, Volume, render_scene, render_volume,
};

fn small_scene() -> SceneFile {
    let mut scene = SceneFile::of_mesh(crate::SAMPLE);
    (scene.image.width, scene.image.height) = (40, 40);
    scene
}

/// The tolerance is the fast renderer's where its order is right: 5e-4. The centroid order is not right everywhere on
/// these bent cells, and the largest step that a pair in the wrong order makes here was measured as 5.4e-3.
#[test]
fn both_back_ends_draw_the_same_sample() {
    let volume = Volume::from_dataset(rings_sample(4), "rings").unwrap();
    for (model, tolerance) in
        [(OpticalModel::Absorption, 5e-4), (OpticalModel::Emission, 5e-4), (OpticalModel::DensityEmitter, 1e-2)]
    {
        let mut scene = small_scene();
        scene.optics.model = model;
        let fast = render_volume(&volume, &scene, &Silent).unwrap();
        scene.quality.backend = Choice::Named(Backend::Reference);
        let slow = render_volume(&volume, &scene, &Silent).unwrap();
        let pairs = || fast.image.pixels().iter().flatten().zip(slow.image.pixels().iter().flatten());
        let largest = pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(pairs().any(|(a, _)| *a > 0.5), "{model}");
        assert!(largest < tolerance, "{model}: {largest}");
    }
}

/// The picture is the same however large the mesh is: nothing in the defaults is a length.
#[test]
fn pictures_do_not_depend_on_scale() {
    let pictures = [1e-9, 1.0, 1e6].map(|factor| {
        let mut dataset = rings_sample(4);
        dataset.points.iter_mut().for_each(|point| *point *= factor);
        render_volume(&Volume::from_dataset(dataset, "rings").unwrap(), &small_scene(), &Silent).unwrap().image
    });
    for other in [&pictures[0], &pictures[2]] {
        let pairs = pictures[1].pixels().iter().flatten().zip(other.pixels().iter().flatten());
        let largest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(largest < 1e-4, "{largest}");
    }
}

#[test]
fn absorption_needs_no_order() {
    let mut scene = small_scene();
    scene.optics.model = OpticalModel::Absorption;
    let plain = render_scene(&scene, ".".as_ref(), &Silent).unwrap();
    assert_eq!(plain.plan.order, OrderMethod::None);
    scene.quality.order = Choice::Named(OrderMethod::Centroid);
    let sorted = render_scene(&scene, ".".as_ref(), &Silent).unwrap();
    for (a, b) in plain.image.pixels().iter().zip(sorted.image.pixels()) {
        assert!((a[3] - b[3]).abs() < 1e-5);
        assert_eq!(a[..3], [0.0; 3]);
    }
}

#[test]
fn every_step_is_timed_and_the_scene_is_given_back_complete() {
    let picture = render_scene(&small_scene(), ".".as_ref(), &Silent).unwrap();
    for step in ["read", "decompose", "prepare", "rasterize"] {
        assert!(picture.timings.iter().any(|(name, _)| name == step), "{step}: {:?}", picture.timings);
    }
    assert_eq!(picture.completed.mesh.field.as_deref(), Some("distance"));
    let again = render_scene(&picture.completed, ".".as_ref(), &Silent).unwrap();
    assert_eq!(again.image, picture.image);
    assert_eq!(again.warnings, Vec::<String>::new());
}

#[test]
fn what_a_scene_asks_in_vain_is_said() {
    let mut scene = small_scene();
    scene.isosurface.push(IsosurfaceSection::new(99.0, [1.0; 3]));
    let picture = render_scene(&scene, ".".as_ref(), &Silent).unwrap();
    let says = |w: &String| w.contains("isosurface[0].value is 99") && w.contains("not seen");
    assert!(picture.warnings.iter().any(says), "{:?}", picture.warnings);
    assert_eq!(picture.plan.isosurfaces.unwrap().surfaces.as_slice().len(), 1);
    scene.isosurface[0].opacity = -1.0;
    let text = render_scene(&scene, ".".as_ref(), &Silent).unwrap_err().to_string();
    assert!(text.contains("isosurface[0].opacity is -1"), "{text}");
}

#[test]
fn errors_name_what_they_are_about() {
    let mut scene = small_scene();
    scene.mesh.field = Some("pressure".to_owned());
    let error = render_scene(&scene, ".".as_ref(), &Silent).unwrap_err();
    assert!(matches!(error, Error::Field { .. }));
    let text = error.to_string();
    assert!(text.contains(crate::SAMPLE) && text.contains("\"pressure\"") && text.contains("\"distance\""), "{text}");
    scene.mesh.path = "builtin:teapot".into();
    assert!(matches!(render_scene(&scene, ".".as_ref(), &Silent), Err(Error::NoSuchSample { .. })));
    scene.mesh.path = "absent.vtu".into();
    let text = render_scene(&scene, "somewhere".as_ref(), &Silent).unwrap_err().to_string();
    assert!(text.contains("absent.vtu") && text.contains("somewhere"), "{text}");
}

#[test]
fn a_blank_picture_says_why() {
    let mut scene = small_scene();
    scene.transfer.extinction = Some(vec![[5.0, 0.0], [6.0, 1.0]]);
    let picture = render_scene(&scene, ".".as_ref(), &Silent).unwrap();
    assert!(picture.warnings.iter().any(|w| w.contains("whole range")), "{:?}", picture.warnings);
}

#[test]
fn an_open_order_is_settled_for_the_mesh() {
    // The sample bulges inwards at no place but is no Delaunay mesh.
    let picture = render_scene(&small_scene(), ".".as_ref(), &Silent).unwrap();
    let volume = Volume::sample().unwrap();
    let field = volume.field(None).unwrap();
    let renderer = field.renderer().unwrap();
    let choice = renderer.visibility().choose(renderer.cells());
    assert_eq!(picture.plan.order, choice.method);
    assert_eq!(picture.completed.quality.order, Choice::Named(choice.method));
    let said = picture.plan.decisions.iter().find(|d| d.subject == "order").unwrap();
    assert_eq!((said.choice.as_str(), said.reason.as_str()), (choice.method.to_string().as_str(), choice.reason));
    assert!(picture.order.summary.contains("exact"), "{}", picture.order.summary);
    assert!(picture.order.warnings.is_empty() && picture.order.rings.is_none());
}

#[test]
fn power_that_is_not_proven_is_a_warning_with_figures() {
    // Whether it is or not, the picture says what the certificate does.
    let volume = Volume::from_dataset(rings_sample(4), "rings").unwrap();
    let mut scene = small_scene();
    scene.quality.order = Choice::Named(OrderMethod::Power);
    let picture = render_volume(&volume, &scene, &Silent).unwrap();
    let field = volume.field(None).unwrap();
    let renderer = field.renderer().unwrap();
    let certificate = renderer.visibility().power(renderer.cells()).certificate();
    let warned =
        picture.warnings.iter().any(|w| w.contains("is not proven for this mesh") && w.contains("faces between cells"));
    assert_eq!(warned, !certificate.is_exact(), "{:?}", picture.warnings);
    assert_eq!(picture.order.summary.contains("proven for all"), certificate.is_exact());
}

/// Two cells that are convex together and not Delaunay.
const NEEDS_HEIGHTS: &str = "# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n\
    0 0 0 1 0 0 0 1 0 0 0 1 0.9 0.9 0.9\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n\
    POINT_DATA 5\nSCALARS s double 1\nLOOKUP_TABLE default\n0 1 2 3 4\n";

#[test]
fn heights_from_a_file_make_no_mesh_delaunay() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.vtk");
    std::fs::write(&path, NEEDS_HEIGHTS).unwrap();
    let mut scene = SceneFile::of_mesh(&path);
    (scene.image.width, scene.image.height) = (8, 8);
    scene.quality.keep_heights = Some(true);
    let picture = render_scene(&scene, ".".as_ref(), &Silent).unwrap();
    assert_eq!(picture.plan.order, OrderMethod::Power);

    let volume = Volume::load(&path, &ReadOptions::default()).unwrap();
    for reads_heights in [false, true] {
        let field = volume.field(None).unwrap();
        let mut completed = scene.complete(&field.facts).unwrap();
        completed.scene.threads = Some(2);
        if reads_heights {
            field.plan(&mut completed).unwrap();
            let renderer = field.renderer().unwrap();
            assert!(renderer.visibility().quick_certificate(renderer.cells()).is_exact(), "they were read");
        }
        let check = field.check_mesh(&volume.decomposition, false, Some(2)).unwrap();
        assert_eq!((check.delaunay.faces, check.delaunay.violated), (1, 1));
        assert_eq!(check.power.is_some_and(|power| power.is_exact_across_gaps()), reads_heights);
    }
}

/// Threads of their own for the choice of an order give the same order and the same picture.
#[test]
fn the_number_of_threads_changes_nothing() {
    let volume = Volume::from_dataset(rings_sample(4), "rings").unwrap();
    let [one, three] = [1, 3].map(|threads| {
        let field = volume.field(None).unwrap();
        let mut completed = small_scene().complete(&field.facts).unwrap();
        completed.scene.threads = Some(threads);
        let plan = field.plan(&mut completed).unwrap();
        let relations = field.relations(&plan).unwrap();
        let exact = field.exact_picture(&plan, &Silent).unwrap();
        let checked = field.check_order(&plan, plan.order, &relations, &exact, &Silent).unwrap();
        (plan.order, checked.verdict, checked.pixels, field.render(&plan, &Silent).unwrap().image)
    });
    assert!(one == three);
    assert!(crate::seen_pixels(&one.3) > 100);
    assert_eq!(crate::seen_pixels(&crate::LinearImage::transparent(4, 4)), 0);
}

/// A scene that asks for a card that no machine has.
fn on_no_card(backend: Choice<Backend>) -> SceneFile {
    let mut scene = small_scene();
    scene.quality.backend = backend;
    scene.quality.adapter = Some("a card that no machine has".to_owned());
    scene
}

#[test]
fn auto_takes_the_cpu_where_the_gpu_fails_and_says_why() {
    let volume = Volume::from_dataset(rings_sample(4), "rings").unwrap();
    let plain = render_volume(&volume, &small_scene(), &Silent).unwrap();
    let open = render_volume(&volume, &on_no_card(Choice::Auto), &Silent).unwrap();
    assert_eq!((open.plan.backend, open.device.is_none()), (Backend::Cpu, true));
    assert_eq!(open.image.pixels(), plain.image.pixels());
    let [warning] = open.warnings.as_slice() else { panic!("{:?}", open.warnings) };
    assert!(
        warning.starts_with("the back end is cpu, as the GPU failed: no graphics adapter's name contains"),
        "{warning}"
    );
    let said: Vec<_> = open.plan.decisions.iter().filter(|d| d.subject == "backend").collect();
    assert!(said.len() == 1 && said[0].choice == "cpu", "{said:?}");
    // Drawn again the scene takes the CPU without a word.
    assert_eq!((open.completed.quality.backend, &open.completed.quality.adapter), (Choice::Named(Backend::Cpu), &None));
}

#[test]
fn a_gpu_that_is_asked_for_is_not_replaced() {
    let volume = Volume::from_dataset(rings_sample(4), "rings").unwrap();
    let error = render_volume(&volume, &on_no_card(Choice::Named(Backend::Gpu)), &Silent).unwrap_err();
    assert!(matches!(error, Error::Gpu(GpuError::NoSuchAdapter { .. })), "{error:?}");
    let text = error.to_string();
    assert!(text.contains("\"a card that no machine has\""), "{text}");
}

#[test]
fn auto_takes_the_cpu_for_what_no_gpu_draws() {
    let volume = Volume::from_dataset(rings_sample(4), "rings").unwrap();
    let mut scene = on_no_card(Choice::Auto);
    scene.quality.order = Choice::Named(OrderMethod::BspXmpvo);
    scene.quality.cycles = Some(CycleRemedy::Cut);
    let picture = render_volume(&volume, &scene, &Silent).unwrap();
    assert_eq!((picture.plan.backend, picture.warnings.as_slice()), (Backend::Cpu, &[][..]));
    let said = picture.plan.decisions.iter().find(|d| d.subject == "backend").unwrap();
    assert!(said.reason.contains("draws whole ones"), "{said}");
    scene.quality.backend = Choice::Named(Backend::Gpu);
    let error = render_volume(&volume, &scene, &Silent).unwrap_err();
    assert!(matches!(error, Error::Scene(_)) && error.to_string().contains("quality.cycles"), "{error}");
}

/// Clones of a field share what is learned of its mesh, and the renderer has the same.
#[test]
fn what_is_known_of_a_mesh_is_shared() {
    let volume = Volume::from_dataset(rings_sample(4), "rings").unwrap();
    let field = volume.field(None).unwrap();
    let copy = field.clone();
    let is_convex = copy.visibility().is_convex(copy.cells());
    let own: Vec<_> = copy.cells().tetrahedra.to_vec();
    let renderer = field.renderer().unwrap();
    assert_eq!(renderer.cells().tetrahedra, own);
    assert_eq!(renderer.visibility().is_convex(renderer.cells()), is_convex);
    assert!(std::sync::Arc::ptr_eq(renderer.visibility(), copy.visibility()));
    assert!(std::ptr::eq(copy.renderer().unwrap(), renderer));
}
