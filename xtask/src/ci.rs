//! `cargo xtask ci`: everything that is checked before a change is taken, step by step, until one fails.
//!
//! Every step builds with the release profile: tests draw whole pictures, and what is built once serves tests, this program
//! and the command line alike.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use crate::Failure;

/// The command with which README.md runs all tests.
pub(crate) const TEST_COMMAND: &str = "cargo test --release --workspace";

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Leave out the documentation, the examples in it, and the crates built alone
    #[arg(long)]
    fast: bool,
}

struct Step {
    name: String,
    work: Work,
    /// What to do when it fails.
    repair: String,
}

enum Work {
    Tidy,
    Sample,
    Cargo { command: String, environment: Option<(&'static str, &'static str)> },
}

impl Step {
    fn cargo(name: &str, command: impl Into<String>, repair: impl Into<String>) -> Self {
        let work = Work::Cargo { command: command.into(), environment: None };
        Self { name: name.to_owned(), work, repair: repair.into() }
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let root = crate::root();
    let start = Instant::now();
    let steps = steps(&root, args.fast)?;
    let count = steps.len();
    for (index, step) in steps.iter().enumerate() {
        let begin = Instant::now();
        println!("[{}/{count}] {}", index + 1, step.name);
        let done = match &step.work {
            Work::Tidy => crate::tidy::run(&root),
            Work::Sample => sample(&root),
            Work::Cargo { command, environment } => cargo(&root, command, *environment),
        };
        let seconds = begin.elapsed().as_secs_f64();
        if let Err(problem) = done {
            return Err(
                format!("{} failed after {seconds:.1} s: {problem}\nto repair: {}", step.name, step.repair).into()
            );
        }
        println!("[{}/{count}] {}: {seconds:.1} s", index + 1, step.name);
    }
    println!("all good in {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// The quick ones first, so that a slip is said at once.
fn steps(root: &Path, fast: bool) -> Result<Vec<Step>, Failure> {
    let tidy = Step { name: "tidy".to_owned(), work: Work::Tidy, repair: "as each line says".to_owned() };
    let mut steps = vec![
        Step::cargo("formatting", "cargo fmt --all --check", "run `cargo fmt --all`"),
        tidy,
        Step::cargo(
            "clippy",
            "cargo clippy --release --workspace --all-targets -- -D warnings",
            "change the code; where the lint is wrong there, `#[expect(..., reason = \"...\")]`",
        ),
    ];
    if fast {
        steps.push(Step::cargo(
            "tests",
            format!("{TEST_COMMAND} --lib --bins --tests"),
            "run one alone: `cargo test --release -p CRATE NAME`; golden images: `cargo xtask golden`",
        ));
        return Ok(steps);
    }
    steps.push(Step::cargo(
        "tests",
        TEST_COMMAND,
        "run one alone: `cargo test --release -p CRATE NAME`; golden images: `cargo xtask golden`",
    ));
    let sample = "run `cargo run --release` in the root; it must draw tetrascope.png with no argument";
    steps.push(Step { name: "the built-in sample".to_owned(), work: Work::Sample, repair: sample.to_owned() });
    steps.push(Step {
        name: "documentation".to_owned(),
        work: Work::Cargo {
            command: "cargo doc --release --workspace --no-deps".to_owned(),
            environment: Some(("RUSTDOCFLAGS", "-D warnings")),
        },
        repair: "mend the link or the comment that rustdoc names".to_owned(),
    });
    for package in packages(root)? {
        let mut ways = vec![""];
        if package.has_features {
            ways.extend([" --no-default-features", " --all-features"]);
        }
        for way in ways {
            steps.push(Step::cargo(
                &format!("{} alone{way}", package.name),
                format!("cargo check --release --package {}{way}", package.name),
                "name the features of dependencies that the crate itself needs in its Cargo.toml",
            ));
        }
    }
    Ok(steps)
}

struct Package {
    name: String,
    has_features: bool,
}

/// The crates in `crates/`.
fn packages(root: &Path) -> Result<Vec<Package>, Failure> {
    let mut folders: Vec<_> = fs::read_dir(root.join("crates"))?.collect::<Result<_, _>>()?;
    folders.sort_by_key(fs::DirEntry::file_name);
    let mut packages = Vec::new();
    for folder in folders {
        let manifest: toml::Table = fs::read_to_string(folder.path().join("Cargo.toml"))?.parse()?;
        let name = manifest.get("package").and_then(|p| p.get("name")).and_then(toml::Value::as_str);
        packages.push(Package {
            name: name.ok_or_else(|| format!("{}: no package.name", folder.path().display()))?.to_owned(),
            has_features: manifest.contains_key("features"),
        });
    }
    Ok(packages)
}

fn cargo(root: &Path, command: &str, environment: Option<(&str, &str)>) -> Result<(), Failure> {
    let mut words = command.split(' ');
    // The cargo that runs this program, where it does.
    let program =
        words.next().map_or_else(String::new, |word| std::env::var("CARGO").unwrap_or_else(|_| word.to_owned()));
    let status = Command::new(program).args(words).envs(environment).current_dir(root).status()?;
    if status.success() { Ok(()) } else { Err(format!("`{command}` ended with {status}").into()) }
}

/// The README's first command, in a folder of its own.
fn sample(root: &Path) -> Result<(), Failure> {
    let target = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    let folder = root.join(target).join("ci-sample");
    fs::create_dir_all(&folder)?;
    let picture = folder.join("tetrascope.png");
    if picture.exists() {
        fs::remove_file(&picture)?;
    }
    let manifest = root.join("Cargo.toml");
    cargo_in(&folder, &["run", "--release", "--manifest-path"], &manifest)?;
    let bytes = fs::metadata(&picture).map_err(|e| format!("no tetrascope.png was drawn: {e}"))?.len();
    // A blank picture of this size compresses to less.
    if bytes < 20_000 {
        return Err(format!("tetrascope.png has {bytes} bytes, as a blank picture would have").into());
    }
    Ok(())
}

fn cargo_in(folder: &Path, words: &[&str], manifest: &Path) -> Result<(), Failure> {
    let program = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let status = Command::new(program).args(words).arg(manifest).current_dir(folder).status()?;
    if status.success() { Ok(()) } else { Err(format!("`cargo {} ...` ended with {status}", words.join(" ")).into()) }
}
