//! The program `tetrascope`: draws unstructured meshes as volumes.
//!
//! Reports go to standard output, warnings, errors and the progress bar to standard error. Exit codes: 0 good, 1 wrong input,
//! 2 wrong usage, 3 pictures differ by more than a threshold.

mod args;
mod check;
mod compare;
mod devices;
mod info;
mod plan;
mod progress;
mod render;
mod report;
mod sample;
mod scene_paths;
mod study;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};

/// Where it says what may be said.
const fn help_of(command: Option<&Command>) -> &'static str {
    match command {
        None => "tetrascope --help",
        Some(Command::Render(_)) => "tetrascope render --help",
        Some(Command::Info(_)) => "tetrascope info --help",
        Some(Command::Check(_)) => "tetrascope check --help",
        Some(Command::Study(_)) => "tetrascope study --help",
        Some(Command::Devices(_)) => "tetrascope devices --help",
        Some(Command::Plan(_)) => "tetrascope plan --help",
        Some(Command::Compare(_)) => "tetrascope compare --help",
    }
}

/// Why a command gave up.
#[derive(Debug)]
enum Failure {
    /// The command line asks for what cannot be: exit code 2.
    Usage(String),
    /// A file or a scene is wrong: exit code 1.
    Input(String),
    /// Pictures differ by more than was allowed, which was reported: exit code 3.
    Differs,
}

impl From<tetrascope::Error> for Failure {
    fn from(error: tetrascope::Error) -> Self {
        Self::Input(error.to_string())
    }
}

fn main() -> ExitCode {
    // Prints by itself and exits with 2 for a wrong command line, with 0 for --help and --version.
    let cli = Cli::parse();
    let done = match &cli.command {
        None => sample::run(),
        Some(Command::Render(args)) => render::run(args),
        Some(Command::Info(args)) => info::run(args),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::Study(args)) => study::run(args),
        Some(Command::Devices(args)) => devices::run(args),
        Some(Command::Plan(args)) => plan::run(args),
        Some(Command::Compare(args)) => compare::run(args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Usage(message)) => {
            let help = help_of(cli.command.as_ref());
            report::error(&format!("{message}\n\nFor more information, try '{help}'."));
            ExitCode::from(2)
        }
        Err(Failure::Input(message)) => {
            report::error(&message);
            ExitCode::from(1)
        }
        Err(Failure::Differs) => ExitCode::from(3),
    }
}
