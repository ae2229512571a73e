//! Estimates of errors against the errors themselves, and what `auto` takes against the fastest that would do, over scenes of chance and
//! the reference scenes.

use std::fmt::Write as _;
use std::path::Path;

use tetrascope::{
    Choice, ErrorFigures, Integration, LinearImage, OrderMethod, Plan, ReadOptions, SceneFile, Silent, TableSettings,
    Volume, VolumeField, resolve_path, short,
};
use tetrascope_tests::scenes::random_scene;

use crate::Failure;

/// Errors that are wished for.
const WISHES: [f64; 3] = [1.0 / 255.0, 1e-3, 1e-4];

/// Frames of each setting; the fastest counts, as others use the machine.
const FRAMES: usize = 25;

/// A scene with what it is called.
struct Subject {
    name: String,
    volume: Volume,
    scene: SceneFile,
}

/// What a setting came to.
struct Outcome {
    name: String,
    plan: Plan,
    truth: f64,
    expected: f64,
    bound: f64,
    /// Whether the integration alone stays within its bound.
    parts_hold: bool,
    /// Seconds of a picture, its table included.
    seconds: f64,
}

pub(super) fn run(scenes: u64, detail: bool) -> Result<(), Failure> {
    let mut tally = Tally::default();
    for seed in 0..scenes {
        let made = random_scene(seed);
        let name = format!("random {seed} ({}, {})", made.transfer, made.scene.optics.model);
        tally.add(&Subject { name, volume: made.volume, scene: made.scene }, detail)?;
    }
    let references = Path::new("../shared/reference");
    if references.is_dir() {
        for file in
            ["cube5", "bluntfin", "bluntfin-inside", "bluntfin-isosurfaces", "combustor", "block", "fire", "cyclic"]
        {
            let path = references.join(file).with_extension("toml");
            let scene = SceneFile::parse(&std::fs::read_to_string(&path)?, &path)?;
            let solution = scene.mesh.solution.as_ref().map(|path| resolve_path(references, path));
            let volume = Volume::load(
                &resolve_path(references, &scene.mesh.path),
                &ReadOptions::with_solution(solution.as_deref()),
            )?;
            tally.add(&Subject { name: file.to_owned(), volume, scene }, detail)?;
        }
    } else {
        eprintln!("ATTENTION: there is no {}; the reference scenes are left out", references.display());
    }
    println!("{tally}");
    Ok(())
}

/// Every integration in the right order, and other orders with the exact one.
fn settings(base: &Plan) -> Vec<(String, Plan)> {
    let mut settings = Vec::new();
    for integration in Integration::ALL.into_iter().rev() {
        let plan = Plan { integration, tables: TableSettings::of(integration), ..base.clone() };
        settings.push((integration.to_string(), plan));
    }
    for order in [
        OrderMethod::None,
        OrderMethod::Centroid,
        OrderMethod::Bucket { slabs: 20 },
        OrderMethod::KBuffer { window: 4 },
    ] {
        if order != base.order {
            settings.push((format!("exact, {order}"), Plan { order, ..base.clone() }));
        }
    }
    settings.retain(|(_, plan)| plan.check().is_ok());
    settings
}

/// - `wished`: plans of `auto`, which are measured whatever they are
fn outcomes(
    field: &VolumeField<'_>,
    base: &Plan,
    wished: &[Plan],
    exact: &LinearImage,
) -> Result<Vec<Outcome>, Failure> {
    let mut all = settings(base);
    for plan in wished {
        if !all.iter().any(|(_, known)| is_alike(known, plan)) {
            all.push((format!("{}, {}", plan.integration, plan.order), plan.clone()));
        }
    }
    let mut outcomes = Vec::new();
    for (name, plan) in all {
        let rendered = field.render(&plan, &Silent)?;
        let truth = ErrorFigures::between(&rendered.image, exact).ok_or("a picture without pixels")?.largest;
        let estimate = field.estimate_error(&plan, &rendered)?;
        let tabulated = rendered.timings.iter().filter(|(stage, _)| *stage == tetrascope::Stage::Tabulate);
        let tabulated: f64 = tabulated.map(|(_, time)| time.as_secs_f64()).sum();
        let parts_hold = estimate
            .parts
            .iter()
            .all(|part| part.bound.is_none_or(|bound| part.expected <= bound * (1.0 + 1e-9) + 1e-9));
        outcomes.push((
            tabulated,
            Outcome {
                name,
                plan,
                truth,
                expected: estimate.expected,
                bound: estimate.bound,
                parts_hold,
                seconds: f64::INFINITY,
            },
        ));
    }
    for _ in 0..FRAMES {
        for (_, outcome) in &mut outcomes {
            let rendered = field.render(&outcome.plan, &Silent)?;
            let seconds: f64 = rendered.timings.iter().map(|(_, time)| time.as_secs_f64()).sum();
            outcome.seconds = outcome.seconds.min(seconds);
        }
    }
    Ok(outcomes
        .into_iter()
        .map(|(tabulated, outcome)| Outcome { seconds: outcome.seconds + tabulated, ..outcome })
        .collect())
}

fn is_alike(a: &Plan, b: &Plan) -> bool {
    a.integration == b.integration && a.order == b.order
}

#[derive(Default)]
struct Tally {
    settings: usize,
    within: usize,
    below: usize,
    above: usize,
    bounds_broken: usize,
    parts_broken: usize,
    /// For each wish: scenes, those that meet it, those within 1.3 of the fastest, and the ratios.
    wishes: [(usize, usize, Vec<f64>); 3],
}

impl Tally {
    fn add(&mut self, subject: &Subject, detail: bool) -> Result<(), Failure> {
        let field = subject.volume.field(subject.scene.mesh.field.as_deref())?;
        let mut scene = subject.scene.clone();
        scene.quality.integration = Choice::Named(Integration::Exact);
        let mut completed = scene.complete(&field.facts)?;
        let base = field.plan(&mut completed)?;
        let exact = field.reference_picture(&base, &Silent)?;
        let mut wished = Vec::new();
        for wish in WISHES {
            let mut scene = subject.scene.clone();
            (scene.quality.integration, scene.quality.max_error) = (Choice::Auto, Some(wish));
            wished.push(field.plan(&mut scene.complete(&field.facts)?)?);
        }
        let outcomes = outcomes(&field, &base, &wished, &exact)?;
        for outcome in &outcomes {
            let ratio = outcome.expected / outcome.truth;
            self.settings += 1;
            // A right picture is right, whatever was expected.
            let is_below = outcome.truth > outcome.expected;
            let is_above = outcome.truth > 0.0 && ratio > 10.0;
            self.below += usize::from(is_below);
            self.above += usize::from(is_above);
            self.within += usize::from(!is_below && !is_above);
            self.bounds_broken += usize::from(outcome.truth > outcome.bound);
            self.parts_broken += usize::from(!outcome.parts_hold);
            if detail {
                println!(
                    "{}: {}: error {:.2e}, expected {:.2e} ({:.2}), at most {:.2e}, {:.3} ms{}",
                    subject.name,
                    outcome.name,
                    outcome.truth,
                    outcome.expected,
                    ratio,
                    outcome.bound,
                    1e3 * outcome.seconds,
                    if is_below || is_above || !outcome.parts_hold || outcome.truth > outcome.bound {
                        " OUT"
                    } else {
                        ""
                    }
                );
            }
        }
        for ((wish, plan), (scenes, met, ratios)) in WISHES.into_iter().zip(&wished).zip(&mut self.wishes) {
            let taken = outcomes.iter().find(|outcome| is_alike(&outcome.plan, plan));
            let taken = taken.ok_or("auto took what was not measured")?;
            let fastest = outcomes.iter().filter(|o| o.truth <= wish).min_by(|a, b| a.seconds.total_cmp(&b.seconds));
            *scenes += 1;
            *met += usize::from(taken.truth <= wish);
            let ratio = fastest.map_or(1.0, |fastest| taken.seconds / fastest.seconds);
            if detail {
                println!(
                    "{}: wish {}: {} with error {:.2e} in {:.3} ms; fastest {} {:.2}{}",
                    subject.name,
                    short(wish),
                    taken.name,
                    taken.truth,
                    1e3 * taken.seconds,
                    fastest.map_or("none", |fastest| &fastest.name),
                    ratio,
                    if taken.truth > wish { " MISSED" } else { "" }
                );
            }
            ratios.push(ratio);
        }
        Ok(())
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let share =
            |part: usize, all: usize| format!("{} of {} ({:.1} %)", part, all, 100.0 * part as f64 / all.max(1) as f64);
        writeln!(f, "estimates between once and ten times the error: {}", share(self.within, self.settings))?;
        writeln!(
            f,
            "  below the error: {}; above ten times: {}",
            share(self.below, self.settings),
            share(self.above, self.settings)
        )?;
        writeln!(f, "bounds of the whole that were broken: {}; of parts: {}", self.bounds_broken, self.parts_broken)?;
        for (wish, (scenes, met, ratios)) in WISHES.into_iter().zip(&self.wishes) {
            let mut ratios = ratios.clone();
            ratios.sort_by(f64::total_cmp);
            let at = |share: f64| ratios.get((share * (ratios.len() - 1) as f64) as usize).copied().unwrap_or(1.0);
            let near = ratios.iter().filter(|ratio| **ratio <= 1.3).count();
            let mut line = String::new();
            write!(line, "auto at {}: met in {}; ", short(wish), share(*met, *scenes))?;
            write!(
                line,
                "within 1.3 of the fastest in {}; ratio median {:.2}, 95 % {:.2}, most {:.2}",
                share(near, *scenes),
                at(0.5),
                at(0.95),
                at(1.0)
            )?;
            writeln!(f, "{line}")?;
        }
        Ok(())
    }
}
