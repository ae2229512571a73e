//! `cargo xtask fuzz`: hostile files of chance for every reader, for as long as one likes.
//!
//! The files are read by another process, batch by batch, so that one that never ends or takes the process down is found as well. A
//! failing file is kept, made small, and told with the command that reads it again.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tetrascope_tests::fuzz::{Target, input, reduce};

use crate::{Failure, root};

/// Files a process; enough that starting it costs little.
const BATCH: u64 = 256;

/// How long a batch may take before it counts as endless. Most take a second.
const LONGEST: Duration = Duration::from_secs(120);

/// Times that a failing file is read anew to make it small.
const ASKED: usize = 400;

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// One reader alone; without it, all take turns
    #[arg(long)]
    target: Option<Target>,
    /// How long, in minutes
    #[arg(long, default_value_t = 1.0)]
    minutes: f64,
    /// Another seed gives other files
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Read this file again, with its target, and nothing else
    #[arg(long, requires = "target")]
    replay: Option<PathBuf>,
}

/// What a process came to.
struct Done {
    is_good: bool,
    text: String,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if !(args.minutes >= 0.0 && args.minutes <= 1e6) {
        return Err(format!("--minutes is {}; give a number from 0 to 1000000", args.minutes).into());
    }
    let reader = build()?;
    let folder = target_folder().join("fuzz");
    fs::create_dir_all(&folder)?;
    if let (Some(path), Some(target)) = (&args.replay, args.target) {
        let done = replay(&reader, target, path)?;
        print!("{}", done.text);
        return if done.is_good { Ok(()) } else { Err("the file does what must not be".into()) };
    }
    let targets = args.target.map_or(Target::ALL.to_vec(), |target| vec![target]);
    let end = Instant::now() + Duration::from_secs_f64(60.0 * args.minutes);
    let mut counts: Vec<[u64; 3]> = vec![[0; 3]; targets.len()];
    let mut failures = Vec::new();
    let mut from = 0;
    while Instant::now() < end && failures.is_empty() {
        for (target, counts) in targets.iter().zip(&mut counts) {
            let arguments = [target.name().to_owned(), args.seed.to_string(), from.to_string(), BATCH.to_string()];
            let done = wait(Command::new(&reader).args(arguments).stdout(Stdio::piped()).spawn()?, LONGEST)?;
            // Lines of a number, and of the three counts at the end.
            let mut last = from;
            for line in done.text.lines() {
                match line.split_once(' ') {
                    Some(("at", number)) => last = number.parse()?,
                    Some(("counts", numbers)) => {
                        for (count, number) in counts.iter_mut().zip(numbers.split(' ')) {
                            *count += number.parse::<u64>()?;
                        }
                    }
                    _ => {}
                }
            }
            if !done.is_good {
                failures.push(keep(&reader, &folder, *target, args.seed, last)?);
            }
            if Instant::now() >= end {
                break;
            }
        }
        from += BATCH;
    }
    println!("target            files     read    drawn");
    for (target, [files, read, drawn]) in targets.iter().zip(&counts) {
        println!("{:16} {files:>6} {read:>8} {drawn:>8}", target.name());
    }
    let total: u64 = counts.iter().map(|count| count[0]).sum();
    println!("{total} files, {} failures", failures.len());
    if !failures.is_empty() {
        return Err(failures.join("\n").into());
    }
    // Time was up before their turn came: nothing is known of them.
    let unread: Vec<&str> =
        targets.iter().zip(&counts).filter(|(_, [files, ..])| *files == 0).map(|(target, _)| target.name()).collect();
    if !unread.is_empty() {
        return Err(format!("no file was read of {}; give more --minutes", unread.join(", ")).into());
    }
    Ok(())
}

/// Builds the program that reads. It is part of this package, so that it shares what was built for this one.
fn build() -> Result<PathBuf, Failure> {
    let arguments = ["build", "--release", "--quiet", "--package", "xtask", "--bin", "read-hostile"];
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    if !Command::new(cargo).args(arguments).current_dir(root()).status()?.success() {
        return Err("the program that reads the files was not built".into());
    }
    Ok(std::env::current_exe()?.with_file_name(format!("read-hostile{}", std::env::consts::EXE_SUFFIX)))
}

fn target_folder() -> PathBuf {
    root().join(std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()))
}

/// Waits for a process, and ends it where it takes too long.
fn wait(mut child: Child, longest: Duration) -> Result<Done, Failure> {
    let output = child.stdout.take().map(|mut out| {
        std::thread::spawn(move || {
            let mut text = String::new();
            let _ = std::io::Read::read_to_string(&mut out, &mut text);
            text
        })
    });
    let start = Instant::now();
    let mut note = "";
    let is_good = loop {
        if let Some(status) = child.try_wait()? {
            break status.success();
        }
        if start.elapsed() > longest {
            child.kill()?;
            child.wait()?;
            note = "it does not end\n";
            break false;
        }
        sleep(Duration::from_millis(2));
    };
    let text = output.and_then(|thread| thread.join().ok()).unwrap_or_default();
    Ok(Done { is_good, text: text + note })
}

fn replay(reader: &Path, target: Target, path: &Path) -> Result<Done, Failure> {
    let mut process = Command::new(reader);
    process.args([target.name(), "--replay"]).arg(path).stdout(Stdio::piped()).stderr(Stdio::null());
    wait(process.spawn()?, LONGEST / 4)
}

/// Keeps a failing file and a small one that fails as well; tells how they are read again.
fn keep(reader: &Path, folder: &Path, target: Target, seed: u64, number: u64) -> Result<String, Failure> {
    let file = input(target, seed, number);
    let name = |end: &str| folder.join(format!("{target}-{seed}-{number}{end}.{}", target.extension()));
    let whole = name("");
    fs::write(&whole, &file)?;
    let first = replay(reader, target, &whole)?;
    let tried = folder.join("tried");
    let small = reduce(&file, ASKED, |part| {
        fs::write(&tried, part).is_ok() && replay(reader, target, &tried).is_ok_and(|done| !done.is_good)
    });
    let short = name("-small");
    fs::write(&short, small)?;
    Ok(format!(
        "{target}, seed {seed}, file {number}: {}\n  kept: {}\n  read it again: cargo xtask fuzz --target {target} --replay {}",
        first.text.trim(),
        whole.display(),
        short.display()
    ))
}
