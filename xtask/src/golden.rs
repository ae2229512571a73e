//! `cargo xtask golden`: compares the golden images, renews them, and shows what changed.

use std::process::Command;

use tetrascope::{LinearImage, read_exr};
use tetrascope_tests::golden::{self, SCENES};

use crate::Failure;

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    task: Option<Task>,
}

#[derive(Clone, Copy, Debug, clap::Subcommand)]
enum Task {
    /// Draw every scene with both renderers and compare (the default)
    Check,
    /// Write what the f64 reference draws, where that is another picture
    Regenerate,
    /// Put what changed since the last commit side by side: old, new, difference
    Review,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match args.task.unwrap_or(Task::Check) {
        Task::Check => check(),
        Task::Regenerate => regenerate(),
        Task::Review => review(),
    }
}

fn check() -> Result<(), Failure> {
    let evidence = golden::evidence_folder();
    let mut failures = Vec::new();
    for outcome in golden::check(&golden::folder(), SCENES, &evidence) {
        let shown = |difference: Option<tetrascope_tests::compare::Difference>| {
            difference.map_or("not drawn".to_owned(), |d| format!("{:.1e}", d.largest))
        };
        println!("{:<20} reference {}, cpu {}", outcome.name, shown(outcome.reference), shown(outcome.fast));
        failures.extend(outcome.failures);
    }
    if failures.is_empty() {
        return Ok(());
    }
    Err(format!(
        "{}\npictures of it are in {}; if the new ones are right, `cargo xtask golden regenerate` accepts them",
        failures.join("\n"),
        evidence.display()
    )
    .into())
}

fn regenerate() -> Result<(), Failure> {
    let written = golden::regenerate(&golden::folder(), SCENES)?;
    if written.is_empty() {
        println!("nothing changed");
        return Ok(());
    }
    // A run that writes its own references has proved nothing.
    Err(format!(
        "written: {}; look at them with `cargo xtask golden review`, and say in the commit why they changed",
        written.join(", ")
    )
    .into())
}

fn review() -> Result<(), Failure> {
    let reviews = golden::review(&golden::folder(), SCENES, &golden::evidence_folder(), committed)?;
    if reviews.is_empty() {
        println!("no scene draws another picture than the last commit has");
    }
    for review in reviews {
        let difference = review.factor.map_or("no old picture of this size".to_owned(), |factor| {
            format!("old, new, difference times {factor:.3e}")
        });
        println!("{}: {} ({difference})", review.name, review.picture.display());
    }
    Ok(())
}

/// The picture of a scene in the last commit; `None` where there is none.
fn committed(name: &str) -> Option<LinearImage> {
    let shown = Command::new("git")
        .current_dir(crate::root())
        .args(["show", &format!("HEAD:tests/golden/{name}.exr")])
        .output()
        .ok()
        .filter(|shown| shown.status.success())?;
    // The reader of pictures takes files.
    let path = golden::evidence_folder().join(format!("{name}-committed.exr"));
    std::fs::write(&path, shown.stdout).ok()?;
    let image = read_exr(&path);
    let _ = std::fs::remove_file(&path);
    image.ok()
}
