//! The program `tetrascope`: draws unstructured meshes as volumes.
//!
//! Reports go to standard output, warnings, errors and the progress bar to standard error. Exit codes: 0 good, 1 wrong input,
//! 2 wrong usage, 3 pictures differ by more than a threshold, 130 interrupted by Ctrl-C, 143 by the system's request to end, 129 by a
//! closed terminal. Files are written whole or not at all, whatever ends the program.

mod animate;
mod args;
mod check;
mod colormaps;
mod compare;
mod convert;
mod devices;
mod info;
mod interrupt;
mod kinds;
mod plan;
mod progress;
mod read_args;
mod render;
mod report;
mod sample;
mod scene_of;
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
        Some(Command::Animate(_)) => "tetrascope animate --help",
        Some(Command::Convert(_)) => "tetrascope convert --help",
        Some(Command::Colormaps(_)) => "tetrascope colormaps --help",
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
    /// Somebody wants no more of it, which is reported at the end: exit code 130 or 143.
    Interrupted,
}

impl From<tetrascope::Error> for Failure {
    fn from(error: tetrascope::Error) -> Self {
        Self::Input(error.to_string())
    }
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        // A wrong command line, or --help and --version.
        Err(said) => {
            report::note_failure(said.print());
            return code_of(u8::try_from(said.exit_code()).unwrap_or(2));
        }
    };
    if let Err(problem) = interrupt::watch() {
        report::warning(&format!("Ctrl-C ends the program without a word: {problem}"));
    }
    let done = run(&cli);
    interrupt::remove_empty_folders();
    match (done, interrupt::exit_code()) {
        (Ok(()), _) => code_of(0),
        // Whatever failed, failed since the work was to end.
        (Err(_), Some(code)) => {
            interrupt::say();
            ExitCode::from(code)
        }
        (Err(Failure::Usage(message)), None) => {
            let help = help_of(cli.command.as_ref());
            report::error(&format!("{message}\n\nFor more information, try '{help}'."));
            ExitCode::from(2)
        }
        (Err(Failure::Input(message)), None) => {
            report::error(&message);
            ExitCode::from(1)
        }
        (Err(Failure::Differs), None) => code_of(3),
        (Err(Failure::Interrupted), None) => ExitCode::from(130),
    }
}

fn run(cli: &Cli) -> Result<(), Failure> {
    match &cli.command {
        None => sample::run(),
        Some(Command::Render(args)) => render::run(args),
        Some(Command::Info(args)) => info::run(args),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::Study(args)) => study::run(args),
        Some(Command::Devices(args)) => devices::run(args),
        Some(Command::Plan(args)) => plan::run(args),
        Some(Command::Compare(args)) => compare::run(args),
        Some(Command::Animate(args)) => animate::run(args),
        Some(Command::Convert(args)) => convert::run(args),
        Some(Command::Colormaps(args)) => colormaps::run(args),
    }
}

/// The code, unless the report did not reach standard output.
fn code_of(code: u8) -> ExitCode {
    match report::not_said() {
        Some(message) => {
            report::error(&message);
            ExitCode::from(1)
        }
        None => ExitCode::from(code),
    }
}
