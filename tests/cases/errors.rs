//! What is said of a picture's error against the error, and what `auto` takes against what was wished for: over scenes of chance and the
//! reference scenes.

use std::path::Path;

use proptest::prelude::*;
use rayon::prelude::*;
use tetrascope::{
    Choice, ErrorFigures, Integration, Interpolation, LinearImage, OrderMethod, Plan, ReadOptions, SceneFile, Silent,
    TableSettings, Volume, VolumeField, resolve_path,
};
use tetrascope_tests::scenes::random_scene;
use tetrascope_tests::shared;

/// Random scenes.
const SCENES: u64 = 200;

/// Pixels of their pictures: enough that rays are a sample of them.
const SIZE: [u32; 2] = [96, 72];

/// Errors that are wished for.
const WISHES: [f64; 3] = [1.0 / 255.0, 1e-3, 1e-4];

/// What a scene came to.
#[derive(Clone, Debug, Default)]
struct Tally {
    /// For each setting its name, the error, and what was expected.
    estimates: Vec<(String, f64, f64)>,
    /// What must not be.
    broken: Vec<String>,
}

/// The plan of `auto` for an error.
fn plan_of(field: &VolumeField<'_>, scene: &SceneFile, integration: Choice<Integration>, wish: Option<f64>) -> Plan {
    let mut scene = scene.clone();
    (scene.quality.integration, scene.quality.max_error) = (integration, wish);
    let mut completed = scene.complete(&field.facts).unwrap();
    field.plan(&mut completed).unwrap()
}

/// Settings of a scene: the exact one, one of each kind of error by `pick`, and one that has all of them.
fn settings(base: &Plan, pick: u64) -> Vec<Plan> {
    let of = |all: &[Integration]| all[(pick % all.len() as u64) as usize];
    let integration = of(&Integration::ALL);
    let along_rays = of(&[Integration::Average, Integration::Cumulative, Integration::Opacity2d]);
    let orders = [OrderMethod::Centroid, OrderMethod::None, OrderMethod::Bucket { slabs: 20 }, OrderMethod::Centroid];
    let order = orders[(pick / 8 % 4) as usize];
    let interpolation = Interpolation::ALL[(pick / 3 % 3) as usize];
    let with = |integration, order, interpolation| Plan {
        integration,
        tables: TableSettings::of(integration),
        order,
        interpolation,
        ..base.clone()
    };
    let plans = [
        base.clone(),
        with(integration, base.order, Interpolation::Exact),
        with(Integration::Exact, order, Interpolation::Exact),
        with(Integration::Exact, base.order, interpolation),
        with(along_rays, order, interpolation),
    ];
    plans.into_iter().filter(|plan| plan.check().is_ok()).collect()
}

fn error_of(picture: &LinearImage, exact: &LinearImage) -> f64 {
    ErrorFigures::between(picture, exact).unwrap().largest
}

/// Holds every setting of a scene, and every wish, against the reference.
fn look_at(name: &str, volume: &Volume, scene: &SceneFile, pick: u64) -> Tally {
    let mut tally = Tally::default();
    let field = volume.field(scene.mesh.field.as_deref()).unwrap();
    let base = plan_of(&field, scene, Choice::Named(Integration::Exact), None);
    let exact = field.reference_picture(&base, &Silent).unwrap();
    for plan in settings(&base, pick) {
        let setting = format!("{name}: {}, {}, {}", plan.integration, plan.order, plan.interpolation);
        let rendered = field.render(&plan, &Silent).unwrap();
        let truth = error_of(&rendered.image, &exact);
        let estimate = field.estimate_error(&plan, &rendered).unwrap();
        if truth > estimate.bound {
            tally.broken.push(format!("{setting}: {truth:e} is more than the bound {:e}", estimate.bound));
        }
        // Each part by itself: what was measured of it on rays is not cut off at its bound. Then their sum.
        for part in &estimate.parts {
            if part.bound.is_some_and(|bound| part.expected > bound * (1.0 + 1e-9) + 1e-9) {
                tally.broken.push(format!("{setting}: {part:?}"));
            }
        }
        let bounds: f64 = estimate.parts.iter().map(|part| part.bound.unwrap_or(1e-3)).sum();
        if truth > bounds {
            tally.broken.push(format!("{setting}: {truth:e} is more than all bounds together, {bounds:e}"));
        }
        tally.estimates.push((setting, truth, estimate.expected));
    }
    for wish in WISHES {
        let plan = plan_of(&field, scene, Choice::Auto, Some(wish));
        let error = error_of(&field.render(&plan, &Silent).unwrap().image, &exact);
        if error > wish {
            tally.broken.push(format!("{name}: {error:e} where {wish:e} was wished for, by {}", plan.integration));
        }
    }
    tally
}

fn judge(what: &str, tallies: &[Tally]) {
    let broken: Vec<&String> = tallies.iter().flat_map(|tally| &tally.broken).collect();
    let all: Vec<_> = tallies.iter().flat_map(|tally| &tally.estimates).collect();
    let below: Vec<_> = all.iter().filter(|(_, truth, expected)| truth > expected).collect();
    let above = all.iter().filter(|(_, truth, expected)| *truth > 0.0 && *expected > 10.0 * truth).count();
    let within = all.len() - below.len() - above;
    println!(
        "{what}: {within} of {} estimates are between once and ten times the error, {} below and {above} above",
        all.len(),
        below.len()
    );
    for (setting, truth, expected) in below {
        println!("  below: {setting}: {truth:.2e}, expected {expected:.2e}");
    }
    assert!(broken.is_empty(), "{broken:#?}");
    assert!(100 * within >= 95 * all.len(), "{within} of {}", all.len());
}

#[test]
fn errors_of_random_scenes_are_foreseen() {
    let tallies: Vec<Tally> = (0..SCENES)
        .into_par_iter()
        .map(|seed| {
            let made = random_scene(seed);
            let mut scene = made.scene;
            (scene.image.width, scene.image.height) = (SIZE[0], SIZE[1]);
            look_at(&format!("scene {seed} ({})", made.transfer), &made.volume, &scene, seed)
        })
        .collect();
    judge("random scenes", &tallies);
}

#[test]
fn errors_of_reference_scenes_are_foreseen() {
    let Some(shared) = shared::folder("errors_of_reference_scenes_are_foreseen") else { return };
    let folder = shared.join("reference");
    let tallies: Vec<Tally> =
        ["cube5", "bluntfin", "bluntfin-inside", "bluntfin-isosurfaces", "combustor", "block", "fire", "cyclic"]
            .iter()
            .enumerate()
            .map(|(index, name)| {
                let (volume, scene) = read(&folder, name);
                look_at(name, &volume, &scene, 1 + 3 * index as u64)
            })
            .collect();
    judge("reference scenes", &tallies);
}

fn read(folder: &Path, name: &str) -> (Volume, SceneFile) {
    let path = folder.join(name).with_extension("toml");
    let scene = SceneFile::parse(&std::fs::read_to_string(&path).unwrap(), &path).unwrap();
    let solution = scene.mesh.solution.as_ref().map(|path| resolve_path(folder, path));
    (
        Volume::load(&resolve_path(folder, &scene.mesh.path), &ReadOptions::with_solution(solution.as_deref()))
            .unwrap(),
        scene,
    )
}

/// What `auto` took is in the scene that is written, and gives the same picture.
#[test]
fn errors_wished_for_are_written_down() {
    let made = random_scene(2);
    let field = made.volume.field(None).unwrap();
    let mut scene = made.scene.clone();
    scene.quality.max_error = Some(0.05);
    let mut completed = scene.complete(&field.facts).unwrap();
    let plan = field.plan(&mut completed).unwrap();
    assert_ne!(plan.integration, Integration::Exact, "{:?}", plan.decisions);
    let decision = plan.decisions.iter().find(|decision| decision.subject == "integration").unwrap();
    assert!(decision.reason.contains("within 0.050") && decision.reason.contains("its error is"), "{decision}");
    assert_eq!(completed.file.quality.integration, Choice::Named(plan.integration));
    let mut again = completed.file.complete(&field.facts).unwrap();
    let second = field.plan(&mut again).unwrap();
    let [a, b] = [&plan, &second].map(|plan| field.render(plan, &Silent).unwrap().image);
    assert_eq!(a, b);
}

/// A wish that 32 bits cannot promise is told, and with the back end left open it is the reference's.
#[test]
fn errors_below_32_bits_are_the_references() {
    let made = random_scene(3);
    let field = made.volume.field(None).unwrap();
    let with = |backend| {
        let mut scene = made.scene.clone();
        (scene.quality.max_error, scene.quality.backend) = (Some(1e-7), backend);
        let mut completed = scene.complete(&field.facts).unwrap();
        let plan = field.plan(&mut completed).unwrap();
        (plan, completed.warnings)
    };
    let (plan, warnings) = with(Choice::Auto);
    assert_eq!(plan.backend, tetrascope::Backend::Reference);
    assert!(warnings.is_empty(), "{warnings:?}");
    let rendered = field.render(&plan, &Silent).unwrap();
    let estimate = field.estimate_error(&plan, &rendered).unwrap();
    assert!(estimate.expected <= 1e-6, "{estimate:?}");
    let (plan, warnings) = with(Choice::Named(tetrascope::Backend::Cpu));
    assert_eq!(plan.backend, tetrascope::Backend::Cpu);
    assert!(warnings.iter().any(|text| text.contains("32 bits") && text.contains("reference")), "{warnings:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Neither bounds nor wishes fail in scenes that nobody has looked at.
    #[test]
    fn errors_stay_within_bounds_and_wishes(seed in 1000_u64..1_000_000) {
        let made = random_scene(seed);
        let mut scene = made.scene;
        (scene.image.width, scene.image.height) = (64, 48);
        let tally = look_at("a scene", &made.volume, &scene, seed);
        prop_assert!(tally.broken.is_empty(), "{:#?}", tally.broken);
    }
}
