//! Runs VTK in Python: one process a picture, which may end in a signal or not at all.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tetrascope::LinearImage;

use super::errors::Errors;
use super::job::{Job, Mapper, Subset};
use crate::Failure;

/// What Python runs; its own words say how.
const SCRIPT: &str = include_str!("../../peers/vtk_mappers.py");
/// Pictures of some hundred cells take a second; more than this is never.
const PATIENCE: Duration = Duration::from_secs(180);
const PAUSE: Duration = Duration::from_millis(20);

/// What came of one job.
#[derive(Debug)]
pub(super) enum Drawn {
    /// Pictures.
    Pictures { first: LinearImage, second: LinearImage },
    /// Why there are none.
    Nothing(String),
}

impl Drawn {
    /// The second frame's distance from the reference, or why there is none.
    pub(super) fn errors(&self, exact: &LinearImage) -> Option<Result<Errors, String>> {
        Some(match self {
            Self::Pictures { second, .. } => Ok(Errors::between(second, exact)),
            Self::Nothing(reason) => Err(reason.clone()),
        })
    }
}

/// Puts the script beside the jobs.
pub(super) fn write_script(folder: &Path) -> Result<PathBuf, Failure> {
    let path = folder.join("vtk_mappers.py");
    fs::write(&path, SCRIPT)?;
    Ok(path)
}

/// VTK's version; else why there is none.
pub(super) fn version(python: &Path, script: &Path) -> Result<String, String> {
    let said = Command::new(python).arg(script).output().map_err(|e| e.to_string())?;
    if said.status.success() {
        return Ok(String::from_utf8_lossy(&said.stdout).trim().to_owned());
    }
    let words = String::from_utf8_lossy(&said.stderr);
    Err(words.lines().last().unwrap_or("it ended without a word").to_owned())
}

/// What is said where VTK cannot be reached.
pub(super) fn absent(python: &Path, reason: &str) -> String {
    format!(
        "SKIPPED: {} has no module vtk ({reason}). To compare with VTK, make a Python that has it, and name it:\n\
         \x20   python3 -m venv FOLDER\n    FOLDER/bin/pip install vtk\n    cargo xtask peers --python FOLDER/bin/python",
        python.display()
    )
}

/// Draws two frames in a process of its own.
pub(super) fn draw(
    python: &Path,
    script: &Path,
    job: &Job,
    mapper: Mapper,
    subset: Subset,
    is_aligned: bool,
) -> Result<Drawn, Failure> {
    let (order, pictures) = job.order(mapper, subset, is_aligned)?;
    // VTK's warnings are many and go nowhere else; a file cannot fill up as a pipe does.
    let words = order.with_extension("txt");
    let mut process = Command::new(python)
        .args([script, &order])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(fs::File::create(&words)?)
        .spawn()?;
    let start = Instant::now();
    let status = loop {
        if let Some(status) = process.try_wait()? {
            break status;
        }
        if start.elapsed() > PATIENCE {
            process.kill()?;
            process.wait()?;
            return Ok(Drawn::Nothing(format!("not done after {} s", PATIENCE.as_secs())));
        }
        thread::sleep(PAUSE);
    };
    if !status.success() {
        return Ok(Drawn::Nothing(ended(status, &String::from_utf8_lossy(&fs::read(&words)?))));
    }
    let [first, second] = pictures;
    Ok(Drawn::Pictures { first: picture(&first, job.size)?, second: picture(&second, job.size)? })
}

/// How a process ended that did not end well.
fn ended(status: ExitStatus, words: &str) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return format!("crash, signal {signal}");
    }
    format!("no picture: {}", words.lines().last().unwrap_or("it ended without a word"))
}

/// A picture of 32-bit floats in the order of this machine, upper row first.
fn picture(path: &Path, [width, height]: [u32; 2]) -> Result<LinearImage, Failure> {
    let bytes = fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    pixels(&bytes)
        .and_then(|pixels| LinearImage::from_pixels(width, height, pixels))
        .ok_or_else(|| format!("{}: {} bytes are no {width} x {height} picture", path.display(), bytes.len()).into())
}

/// Four floats each; `None` if something is left over.
pub(super) fn pixels(bytes: &[u8]) -> Option<Vec<[f32; 4]>> {
    let (pixels, rest) = bytes.as_chunks::<16>();
    let floats = |pixel: &[u8; 16]| {
        let (channels, _) = pixel.as_chunks::<4>();
        std::array::from_fn(|channel| f32::from_ne_bytes(channels[channel]))
    };
    rest.is_empty().then(|| pixels.iter().map(floats).collect())
}
