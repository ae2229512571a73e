//! `cargo xtask soak`: scenes of chance in every way, for as long as it is told.

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use tetrascope_tests::soak::{Case, Failure, Judged, Tally, draw, judge, read_case, reduce, write_case};
use tetrascope_tests::ways::Way;

use crate::Failure as TaskFailure;

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// How long scenes are drawn; the one at hand is finished, and failures are reduced besides
    #[arg(long, value_name = "N", default_value_t = 1.0)]
    minutes: f64,
    /// The first seed; the same seeds give the same scenes
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Draw and write this one seed as it is, instead
    #[arg(long, value_name = "SEED")]
    scene_of: Option<u64>,
    /// Judge this scene that failed before, instead
    #[arg(long, value_name = "SCENE", conflicts_with = "scene_of")]
    scene: Option<PathBuf>,
    /// Every how many-th scene the GPU draws too: a driver that is software compiles longer than all others draw
    #[arg(long, value_name = "K", default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..))]
    gpu_every: u64,
    /// Leave the GPU out
    #[arg(long)]
    no_gpu: bool,
    /// The folder of what fails
    #[arg(short, long, value_name = "FOLDER", default_value = "target/soak")]
    output: PathBuf,
}

/// Where the last panic was: what a caught one does not say.
static PANICKED: Mutex<String> = Mutex::new(String::new());

pub(crate) fn run(args: &Args) -> Result<(), TaskFailure> {
    if !(args.minutes >= 0.0 && args.minutes <= 1e6) {
        return Err(format!("--minutes is {}; give a number from 0 to 1000000", args.minutes).into());
    }
    std::panic::set_hook(Box::new(|info| {
        if let Ok(mut place) = PANICKED.lock() {
            *place = info.location().map_or(String::new(), |at| format!(" ({}, line {})", at.file(), at.line()));
        }
    }));
    let ways = if args.no_gpu { Way::CPU.to_vec() } else { Way::here("cargo xtask soak") };
    let names: Vec<String> = ways.iter().map(Way::to_string).collect();
    println!("ways: {}", names.join(", "));
    if let Some(seed) = args.scene_of {
        let case = Case::of(seed);
        println!("{}", case.describe());
        let judged = judge(&case, &ways, &draw);
        println!("written: {}", write_case(&args.output, &case, &judged.failures)?.scene.display());
        return say(&judged);
    }
    if let Some(scene) = &args.scene {
        let case = read_case(scene, args.seed)?;
        println!("{}", case.describe());
        return say(&judge(&case, &ways, &draw));
    }
    let end = Duration::from_secs_f64(args.minutes * 60.0);
    let start = Instant::now();
    let mut tally = Tally::default();
    let mut said = Duration::ZERO;
    for seed in args.seed.. {
        if start.elapsed() >= end {
            break;
        }
        let case = Case::of(seed);
        let judged = judge(&case, if seed % args.gpu_every == 0 { &ways } else { &Way::CPU }, &draw);
        tally.add(&case, &judged);
        if !judged.failures.is_empty() {
            report(args, &case, &judged.failures)?;
        }
        // A line that is renewed, or in a log one a minute.
        let every = if std::io::stdout().is_terminal() { Duration::from_millis(500) } else { Duration::from_secs(60) };
        if start.elapsed() - said > every {
            said = start.elapsed();
            let line = format!(
                "{} scenes, {} pictures, {} failed, {:.1} of {} minutes",
                tally.scenes,
                tally.pictures,
                tally.failed,
                said.as_secs_f64() / 60.0,
                args.minutes
            );
            if std::io::stdout().is_terminal() {
                print!("\r{line} ");
                std::io::stdout().flush()?;
            } else {
                println!("{line}");
            }
        }
    }
    println!("\nseeds {} to {}", args.seed, args.seed + tally.scenes.saturating_sub(1) as u64);
    print!("{tally}");
    if tally.failed > 0 {
        return Err(format!("{} scenes failed; they are in {}", tally.failed, args.output.display()).into());
    }
    Ok(())
}

/// Says what is wrong with a case, makes it small and writes it.
fn report(args: &Args, case: &Case, failures: &[Failure]) -> Result<(), TaskFailure> {
    println!("\n{}", case.describe());
    for failure in failures {
        println!("  {failure}{}", place_of(failure));
    }
    let reduced = reduce(case, &failures[0], &draw);
    let small = &reduced.case;
    let written = write_case(&args.output, small, std::slice::from_ref(&reduced.failure))?;
    let ways = [Way::Reference, reduced.failure.way];
    let again = judge(&read_case(&written.scene, case.seed)?, &ways, &draw);
    let fails = again.failures.iter().any(|f| f.fault == reduced.failure.fault);
    println!(
        "  reduced in {} tries to {} cells, {} x {} pixels: {}{}",
        reduced.tries,
        small.tets.cells.len(),
        small.scene.image.width,
        small.scene.image.height,
        written.scene.display(),
        if fails { "" } else { "; as read back it does not fail" }
    );
    println!("  {}", reduced.failure);
    Ok(())
}

fn place_of(failure: &Failure) -> String {
    let is_panic = failure.fault == tetrascope_tests::soak::Fault::Panic;
    if is_panic { PANICKED.lock().map_or(String::new(), |place| place.clone()) } else { String::new() }
}

/// What came of one case.
fn say(judged: &Judged) -> Result<(), TaskFailure> {
    for (way, words) in &judged.refusals {
        println!("refused, {way}: {words}");
    }
    for margin in &judged.margins {
        println!("{}: {:.2e} of {:.1e} that is allowed", margin.way, margin.difference, margin.limit);
    }
    println!("compared: {}; {} pixels at edges", judged.agreement, judged.at_edges);
    if judged.failures.is_empty() {
        return Ok(());
    }
    let said: Vec<String> = judged.failures.iter().map(|failure| format!("{failure}{}", place_of(failure))).collect();
    Err(said.join("\n").into())
}
