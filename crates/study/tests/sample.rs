//! Studies of the built-in sample and of scenes made for the purpose.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::sync::Mutex;

use tetrascope::{
    Choice, GpuPath, Integration, IsosurfaceSection, OpticalModel, OrderMethod, Plan, ProjectionName, SceneFile,
    Silent, Volume, VolumeField,
};
use tetrascope_study::{
    Axis, Error, Figure, Options, Place, Setting, Study, StudyProgress, chart_svg, csv, html, json, settings_of,
};

fn scene() -> SceneFile {
    let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
    (scene.image.width, scene.image.height) = (40, 30);
    scene
}

fn plan_of(field: &VolumeField<'_>, scene: &SceneFile) -> Plan {
    field.plan(&mut scene.complete(&field.facts).unwrap()).unwrap()
}

fn quick() -> Options {
    Options { name: "a & b".to_owned(), is_quick: true, frames: Some(1), uses_gpu: false, ..Options::default() }
}

fn names(settings: &[Setting]) -> Vec<&str> {
    settings.iter().map(|setting| setting.name.as_str()).collect()
}

/// The settings of a scene and what is left out, as text.
fn listed(scene: &SceneFile, options: &Options) -> (Vec<Setting>, String) {
    let volume = Volume::sample().unwrap();
    let field = volume.field(None).unwrap();
    let (settings, left_out) = settings_of(&field, &plan_of(&field, scene), options).unwrap();
    let mut sorted = names(&settings);
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(sorted.len(), settings.len(), "two settings have one name: {:?}", names(&settings));
    (settings, left_out.iter().map(|one| format!("{}: {}\n", one.name, one.reason)).collect())
}

struct Steps(Mutex<Vec<(u64, u64)>>);

impl StudyProgress for Steps {
    fn report(&self, _step: &str, done: u64, total: u64) {
        self.0.lock().unwrap().push((done, total));
    }
}

#[test]
fn every_setting_of_the_sample_has_its_figures() {
    let volume = Volume::sample().unwrap();
    let field = volume.field(None).unwrap();
    let start = plan_of(&field, &scene());
    let steps = Steps(Mutex::default());
    let study = Study::run(&field, &start, &quick(), &steps).unwrap();

    let (listed, _) = settings_of(&field, &start, &quick()).unwrap();
    let drawn: Vec<Setting> = study.outcomes.iter().map(|outcome| outcome.setting.clone()).collect();
    assert_eq!(names(&drawn), names(&listed), "left out: {:?}", study.left_out);
    for outcome in &study.outcomes {
        let (name, errors) = (&outcome.setting.name, &outcome.errors);
        assert!(errors.largest.is_finite() && errors.root_mean_square <= errors.largest, "{name}: {errors:?}");
        assert!(
            outcome.frame.fastest <= outcome.frame.median && outcome.frame.median <= outcome.frame.slowest,
            "{name}"
        );
        assert!(!outcome.frame.median.is_zero() && outcome.bytes() > 0 && outcome.dominant().is_some(), "{name}");
        assert_eq!((outcome.picture.width(), outcome.difference.height()), (40, 30), "{name}");
        let plan = &outcome.setting.plan;
        let is_exact = plan.integration == Integration::Exact
            && plan.order == start.order
            && outcome.setting.axis != Axis::Interpolation;
        assert!(!is_exact || errors.largest < 1e-5, "{name}: {errors:?}");
    }
    // Without an order the shells of the sample lie in the wrong order, and a study that sees no difference there sees none at all.
    let unordered = study.outcomes.iter().find(|outcome| outcome.setting.plan.order == OrderMethod::None).unwrap();
    assert!(unordered.errors.largest > 1e-3, "{:?}", unordered.errors);
    assert!(study.outcomes.iter().any(|outcome| outcome.is_on_frontier(Figure::Largest)));

    let steps = steps.0.into_inner().unwrap();
    assert!(steps.is_sorted_by_key(|(done, _)| *done), "{steps:?}");
    assert!(steps.iter().all(|(_, total)| *total == steps[0].1) && steps.last().unwrap().0 == steps[0].1, "{steps:?}");
    check_files(&study);
}

/// What is written of a study: complete, alike, and of itself alone.
fn check_files(study: &Study) {
    let count = study.outcomes.len();
    let table = csv(study);
    assert_eq!(table.lines().count(), count + 1);
    let comma = study.outcomes.iter().find(|outcome| outcome.setting.name.contains(',')).unwrap();
    assert!(table.contains(&format!("\r\n\"{}\",", comma.setting.name)), "{table}");
    let object = json(study);
    assert_eq!(object["settings"].as_array().unwrap().len(), count);
    assert_eq!(object["scene"]["cells"], study.mesh[0]);

    let page = html(study);
    assert!(page.contains("a &amp; b") && !page.contains("a & b"));
    assert!(!page.contains("{{"), "a place of the template was left empty");
    // The namespace of SVG is a name and is never loaded.
    let own = page.replace("http://www.w3.org/2000/svg", "");
    for foreign in ["http:", "https:", "//cdn", "@import", "url(", "src=\"/", "<link rel=\"stylesheet"] {
        assert!(!own.contains(foreign), "the page has {foreign}");
    }
    assert_eq!(page.matches("class=\"detail\"").count(), count);
    assert_eq!(page.matches("data:image/png;base64,").count(), 2 * count + 1);
    for figure in Figure::ALL {
        let svg = chart_svg(study, figure);
        assert_eq!(svg.matches("class=\"point").count(), count, "{figure:?}");
        assert!(svg.contains("<title>") && svg.contains("class=\"frontier\"") && !svg.contains("NaN"), "{figure:?}");
    }
}

#[test]
fn what_does_not_go_together_is_left_out_with_its_reason() {
    let mut emitter = scene();
    emitter.optics.model = OpticalModel::Emitter;
    emitter.camera.projection = ProjectionName::Orthographic;
    let (settings, left_out) = listed(&emitter, &quick());
    assert!(left_out.contains("partial") && left_out.contains("emitter"), "{left_out}");
    assert!(left_out.contains("without perspective all ways to interpolate are the same"), "{left_out}");
    assert!(!settings.iter().any(|setting| setting.plan.integration == Integration::Partial));
    assert!(!settings.iter().any(|setting| setting.axis == Axis::Interpolation));

    let mut glow = scene();
    glow.optics.model = OpticalModel::Absorption;
    let (settings, left_out) = listed(&glow, &quick());
    assert!(left_out.contains("nothing depends on the order"), "{left_out}");
    assert!(settings.iter().all(|setting| setting.plan.order == settings[0].plan.order), "{:?}", names(&settings));

    let mut surfaces = scene();
    let transparent = IsosurfaceSection { opacity: 0.5, ..IsosurfaceSection::new(0.1, [1.0, 0.5, 0.2]) };
    surfaces.isosurface.push(transparent);
    let (settings, left_out) = listed(&surfaces, &quick());
    assert!(left_out.contains("only opaque isosurfaces") && left_out.contains("cannot be cut"), "{left_out}");
    assert!(settings.iter().any(|setting| setting.name.contains("map-smooth 256")), "{:?}", names(&settings));
}

#[test]
fn a_long_study_has_more_settings_than_a_quick_one() {
    let (few, _) = listed(&scene(), &quick());
    let (many, _) = listed(&scene(), &Options { is_quick: false, ..quick() });
    for setting in &few {
        assert!(names(&many).contains(&setting.name.as_str()), "{} is only in the quick one", setting.name);
    }
    for name in ["table-2d 512", "table-3d 128 log", "k-buffer 20", "bucket 20", "power"] {
        assert!(many.iter().any(|setting| setting.name.contains(name)), "{name} is not in {:?}", names(&many));
    }
}

#[test]
fn what_the_scene_asks_for_is_marked_or_added() {
    let volume = Volume::sample().unwrap();
    let field = volume.field(None).unwrap();
    let start = plan_of(&field, &scene());
    for (integration, table_size, added) in
        [(Integration::Average, None, 0), (Integration::Table2d, Some(48), 1), (Integration::Exact, None, 0)]
    {
        let mut own = scene();
        own.quality.integration = Choice::Named(integration);
        own.quality.table_size = table_size;
        let count = settings_of(&field, &start, &quick()).unwrap().0.len();
        let options = Options { scene_plan: Some(plan_of(&field, &own)), ..quick() };
        let (settings, _) = settings_of(&field, &start, &options).unwrap();
        let marked: Vec<&Setting> = settings.iter().filter(|setting| setting.is_scene).collect();
        assert_eq!((marked.len(), settings.len()), (1, count + added), "{integration}");
        assert_eq!(marked[0].plan.integration, integration);
    }
}

#[test]
fn software_that_poses_as_a_card_is_studied_if_asked_for() {
    let found = tetrascope::adapters();
    let Some(number) = found.iter().position(|adapter| adapter.is_capable) else {
        assert!(std::env::var_os("TETRASCOPE_REQUIRE_GPU").is_none(), "no adapter can draw: {found:?}");
        eprintln!("SKIPPED: no adapter can draw");
        return;
    };
    let volume = Volume::from_dataset(tetrascope::mesh::rings_sample(6), "rings").unwrap();
    let field = volume.field(None).unwrap();
    // Every program that a setting needs is compiled, which takes a processor a second: three settings a place.
    let keeps = |setting: &Setting| {
        setting.axis == Axis::Start
            || (setting.axis == Axis::Integration && setting.plan.integration == Integration::Average)
    };
    let options = Options { uses_gpu: true, adapter: Some(number.to_string()), keeps, ..quick() };
    let study = Study::run(&field, &plan_of(&field, &scene()), &options, &Silent).unwrap();
    let compute = study
        .outcomes
        .iter()
        .find(|outcome| outcome.setting.place == Place::GpuCompute && outcome.setting.axis == Axis::Start);
    let compute = compute.unwrap();
    assert!(compute.errors.largest < 3e-5, "{:?}", compute.errors);
    assert!(compute.device.is_some() && compute.bytes() > 0 && !study.opened.is_empty());
    let is_by_triangles = |setting: &Setting| setting.plan.gpu.path == Some(GpuPath::Triangles);
    assert!(study.outcomes.iter().any(|outcome| is_by_triangles(&outcome.setting)), "{:?}", study.left_out);
    assert!(study.left_out.iter().any(|one| one.reason.contains("\"compute\"")), "{:?}", study.left_out);
    assert!(study.outcomes.len() <= 8, "settings that were not to be kept: {}", study.outcomes.len());
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let volume = Volume::sample().unwrap();
    let field = volume.field(None).unwrap();
    let options = Options { kept_side: 8, ..quick() };
    let study = Study::run(&field, &plan_of(&field, &scene()), &options, &Silent).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "here first").unwrap();
    let error = study.write(&file.join("study")).unwrap_err();
    assert!(matches!(error, Error::Tetrascope(_)) && error.to_string().contains("file"), "{error}");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "here first");

    let paths = study.write(&folder.path().join("new/study")).unwrap();
    let found = paths.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect::<Vec<_>>();
    assert_eq!(found, ["study.csv", "study.json", "study.svg", "study.html"]);
    assert!(paths.iter().all(|path| path.metadata().unwrap().len() > 1000));
    let left = std::fs::read_dir(folder.path().join("new/study")).unwrap().count();
    assert_eq!(left, 4, "a temporary file was left");
    assert_eq!(study.outcomes[0].picture.width(), 8);
}
