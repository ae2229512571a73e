//! Automation: `cargo xtask` without more lists what there is.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program speaks to its user")]

mod accuracy;
mod bench;
mod ci;
mod figures;
mod fuzz;
mod golden;
mod hard_cases;
mod peers;
mod soak;
mod tidy;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;

/// Anything that stops a task.
type Failure = Box<dyn std::error::Error>;

#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", about = "Automation of the workspace")]
enum Task {
    /// Everything that is checked before a change is taken
    Ci(ci::Args),
    /// Whether what the texts promise is so
    Tidy,
    /// Golden images: compare, renew, look at
    Golden(golden::Args),
    /// Milliseconds a frame of the CPU renderer
    Bench(bench::Args),
    /// The error of every integration method and of every visibility order against the exact ones
    Accuracy(accuracy::Args),
    /// The pictures of docs/gallery.md
    Figures(figures::Args),
    /// The pictures and figures of docs/hard-cases.md
    HardCases(hard_cases::Args),
    /// Hard cases and known faults drawn by VTK, beside our pictures of them
    Peers(peers::Args),
    /// Random scenes in every way, compared with one another; what fails is reduced and written
    Soak(soak::Args),
    /// Hostile files of chance for every reader
    Fuzz(fuzz::Args),
}

fn main() -> ExitCode {
    let done = match Task::parse() {
        Task::Ci(args) => ci::run(&args),
        Task::Tidy => tidy::run(&root()),
        Task::Golden(args) => golden::run(&args),
        Task::Bench(args) => bench::run(&args),
        Task::Accuracy(args) => accuracy::run(&args),
        Task::Figures(args) => figures::run(&args),
        Task::HardCases(args) => hard_cases::run(&args),
        Task::Peers(args) => peers::run(&args),
        Task::Soak(args) => soak::run(&args),
        Task::Fuzz(args) => fuzz::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

/// The workspace's root, where it was when this program was built.
fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_owned()
}
