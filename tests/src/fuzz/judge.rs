//! Has a file read and says what must not be.

use std::fs;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use tetrascope::{
    Backend, Cells, Choice, DataArray, Dataset, Error, IoError, ReadOptions, SceneFile, Silent, StructuredBlock,
    Volume, read_exr, read_heights, read_mesh, read_picture, read_png, render_volume,
};

use super::{Target, corpus};

/// Longest message, and longest warning, in bytes: names and words of a file are in it, but not whole files.
const LONGEST_MESSAGE: usize = 4096;

/// Points and cells of a mesh that is drawn as well.
const DRAWN: usize = 4096;

/// What became of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Whether it was read.
    pub is_read: bool,
    /// Whether it went on to a picture, or to another end that is not the reader's.
    pub is_drawn: bool,
    /// Bytes that reading allocated, all of them together, whether given back or not; 0 where nobody counts.
    pub allocated: usize,
}

/// Bytes that reading a file of a length may allocate in all: as a multiple of the length, and beyond that.
///
/// What is counted is never given back, so that twice as much may be counted as is ever held. Compressed files and pictures may
/// stand for more than they are: VTK's files for 16 numbers a byte, PNG for 1032 bytes of samples a byte, OpenEXR for 3072.
pub const fn most_allocated(target: Target, length: usize) -> usize {
    let (times, more) = match target {
        Target::VtuText | Target::VtuBase64 | Target::VtuRaw | Target::VtuCompressed => (1 << 11, 96 << 20),
        Target::VtkText | Target::VtkBinary => (1 << 9, 1 << 20),
        Target::Plot3dGrid | Target::Plot3dSolution => (1 << 10, 64 << 20),
        Target::Heights => (16, 1 << 16),
        Target::Png | Target::Exr => (1 << 14, 256 << 20),
        Target::SceneToml | Target::SceneJson => (1 << 11, 1 << 20),
    };
    length.saturating_mul(times).saturating_add(more)
}

/// Has files read: each is written into a folder of its own first.
pub struct Judge {
    folder: tempfile::TempDir,
    /// How many bytes were allocated since the program began.
    allocated: fn() -> usize,
}

impl Judge {
    /// A judge who is told how much is allocated; without a counter give `|| 0`.
    ///
    /// # Errors
    /// If there is no folder for temporary files.
    pub fn new(allocated: fn() -> usize) -> io::Result<Self> {
        Ok(Self { folder: tempfile::tempdir()?, allocated })
    }

    /// Reads a file of a target, and draws what was read if it is small.
    ///
    /// # Errors
    /// What must not be: a panic, a message without file, place or remedy, a mesh that breaks its promises, memory beyond
    /// [`most_allocated`].
    pub fn judge(&self, target: Target, bytes: &[u8]) -> Result<Verdict, String> {
        catch_unwind(AssertUnwindSafe(|| self.run(target, bytes))).unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            Err(format!("panics: {}", text.unwrap_or_default()))
        })
    }

    fn run(&self, target: Target, bytes: &[u8]) -> Result<Verdict, String> {
        let path = self.folder.path().join(format!("hostile.{}", target.extension()));
        let (first, second) = if target == Target::Plot3dSolution { corpus::split(bytes) } else { (bytes, &[][..]) };
        fs::write(&path, first).map_err(|e| e.to_string())?;
        let before = (self.allocated)();
        let spent = || {
            let allocated = (self.allocated)() - before;
            let most = most_allocated(target, bytes.len());
            if allocated > most {
                return Err(format!("reading {} bytes allocates {allocated} bytes, the limit is {most}", bytes.len()));
            }
            Ok(allocated)
        };
        match target {
            Target::Heights => {
                let result = read_heights(&path);
                Ok(Verdict { allocated: spent()?, is_read: is_read(&result, &[&path])?, is_drawn: false })
            }
            Target::Png | Target::Exr => {
                let picture = read_picture(&path);
                let allocated = spent()?;
                // As the compare of two pictures and the test of golden ones read them, whatever the content is.
                let (png, exr) = (read_png(&path), read_exr(&path));
                is_read(&png, &[&path])?;
                is_read(&exr, &[&path])?;
                let is_read = is_read(&picture, &[&path])?;
                if is_read != (png.is_ok() || exr.is_ok()) {
                    return Err("by its content a picture is read otherwise than by its kind".to_owned());
                }
                Ok(Verdict { allocated, is_read, is_drawn: false })
            }
            Target::SceneToml | Target::SceneJson => {
                // As the program does with what is no UTF-8.
                let Ok(text) = str::from_utf8(bytes) else {
                    return Ok(Verdict { is_read: false, is_drawn: false, allocated: 0 });
                };
                let result = SceneFile::parse(text, &path);
                let allocated = spent()?;
                match result {
                    Ok(scene) => {
                        draw(&Volume::sample().map_err(|e| e.to_string())?, scene)?;
                        Ok(Verdict { is_read: true, is_drawn: true, allocated })
                    }
                    Err(error) => {
                        let text = error.to_string();
                        check_words(&text, &[&path])?;
                        if error.message.trim().is_empty() {
                            return Err(format!("says nothing of what is wrong: {text}"));
                        }
                        Ok(Verdict { is_read: false, is_drawn: false, allocated })
                    }
                }
            }
            _ => {
                let solution = self.folder.path().join("solution.q");
                if target == Target::Plot3dSolution {
                    fs::write(&solution, second).map_err(|e| e.to_string())?;
                }
                let result = read_mesh(
                    &path,
                    &ReadOptions::with_solution((target == Target::Plot3dSolution).then_some(solution.as_path())),
                );
                let allocated = spent()?;
                let is_read = is_read(&result, &[&path, &solution])?;
                let Ok(loaded) = result else { return Ok(Verdict { is_read, is_drawn: false, allocated }) };
                for warning in &loaded.warnings {
                    check_length(warning)?;
                }
                check_dataset(&loaded.dataset)?;
                let cells = cell_count(&loaded.dataset);
                let is_drawn = loaded.dataset.points.len() <= DRAWN && cells <= DRAWN;
                if is_drawn && let Ok(volume) = Volume::from_dataset(loaded.dataset, "hostile") {
                    let mut scene = SceneFile::of_mesh("hostile");
                    scene.quality.backend = Choice::Named(Backend::Cpu);
                    draw(&volume, scene)?;
                }
                Ok(Verdict { is_read, is_drawn, allocated })
            }
        }
    }
}

/// Draws few pixels; whatever a scene or a mesh is, colors are finite and opacities from 0 to 1, or there is an error.
fn draw(volume: &Volume, mut scene: SceneFile) -> Result<(), String> {
    const SIDE: u32 = 12;
    // What a device makes of a scene is tested elsewhere; sizes and tables that take memory are valid requests.
    scene.quality.backend = Choice::Named(Backend::Cpu);
    (scene.quality.gpu_path, scene.quality.adapter, scene.quality.target_bits) = (None, None, None);
    (scene.mesh.solution, scene.quality.keep_heights) = (None, None);
    let small = |size: u32| if size > 0 { size.min(SIDE) } else { 0 };
    (scene.image.width, scene.image.height) = (small(scene.image.width), small(scene.image.height));
    let capped = |size: &mut Option<u32>, most: u32| *size = size.map(|n| n.min(most));
    capped(&mut scene.quality.table_size, 64);
    capped(&mut scene.quality.table_lengths, 64);
    capped(&mut scene.quality.map_size, 256);
    match render_volume(volume, &scene, &Silent) {
        Ok(picture) => {
            let is_sound = |p: &[f32; 4]| p.iter().all(|c| c.is_finite() && *c >= 0.0) && p[3] <= 1.0;
            match picture.image.pixels().iter().find(|p| !is_sound(p)) {
                Some(pixel) => Err(format!("a pixel is {pixel:?}")),
                None => Ok(()),
            }
        }
        Err(error) => check_length(&error.to_string()),
    }
}

fn cell_count(dataset: &Dataset) -> usize {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells.connectivity.len().max(cells.kinds.len()),
        Cells::Structured(blocks) => blocks.iter().map(StructuredBlock::point_count).sum(),
    }
}

/// Whether it was read; an error has to name one of the files, a place, what is wrong and a remedy.
fn is_read<T>(result: &Result<T, IoError>, paths: &[&Path]) -> Result<bool, String> {
    let Err(error) = result else { return Ok(true) };
    check_error(error)?;
    check_words(&error.to_string(), paths)?;
    Ok(false)
}

/// Fails unless an error of a file has all that its kind promises.
///
/// # Errors
/// In words.
pub(crate) fn check_error(error: &IoError) -> Result<(), String> {
    let missing = |what: &str| Err(format!("the message has no {what}: {error}"));
    match error {
        IoError::Invalid { place, problem, remedy, .. } => {
            for (text, what) in [(place, "place"), (problem, "problem"), (remedy, "remedy")] {
                if text.trim().is_empty() {
                    return missing(what);
                }
            }
        }
        IoError::Unsupported { what, remedy, .. } => {
            for (text, what) in [(what, "problem"), (remedy, "remedy")] {
                if text.trim().is_empty() {
                    return missing(what);
                }
            }
        }
        IoError::Read { .. } => {}
        _ => return Err(format!("a file is not written here: {error}")),
    }
    Ok(())
}

fn check_words(text: &str, paths: &[&Path]) -> Result<(), String> {
    if !paths.iter().any(|path| text.contains(&path.display().to_string())) {
        return Err(format!("the message does not name the file: {text}"));
    }
    check_length(text)
}

fn check_length(text: &str) -> Result<(), String> {
    if text.len() > LONGEST_MESSAGE {
        let start: String = text.chars().take(200).collect();
        return Err(format!("a message of {} bytes: {start}...", text.len()));
    }
    if let Some(control) = text.chars().find(|c| c.is_control() && !"\n\t".contains(*c)) {
        return Err(format!("a message has the control character {control:?}: {text:?}"));
    }
    Ok(())
}

/// Fails unless a dataset keeps what its types promise.
fn check_dataset(dataset: &Dataset) -> Result<(), String> {
    let broken = |what: &str| Err(format!("the dataset breaks its promise: {what}"));
    let points = dataset.points.len();
    let cells = match &dataset.cells {
        Cells::Unstructured(cells) => {
            let rows = &cells.offsets;
            if rows.len() != cells.kinds.len() + 1 || rows[0] != 0 || !rows.is_sorted() {
                return broken("offsets");
            }
            if rows.last() != Some(&cells.connectivity.len()) {
                return broken("connectivity");
            }
            let faces = cells.polyhedra.iter().flatten().flatten();
            if cells.connectivity.iter().chain(faces).any(|&point| point as usize >= points) {
                return broken("a point that is not there");
            }
            if cells.kinds.iter().filter(|&&kind| kind == tetrascope::CellKind::Polyhedron).count()
                != cells.polyhedra.len()
            {
                return broken("faces");
            }
            cells.kinds.len()
        }
        Cells::Structured(blocks) => {
            let mut next = 0;
            for block in blocks {
                let hidden = block.hidden_points.len();
                if block.first_point != next || !(hidden == 0 || hidden == block.point_count()) {
                    return broken("blocks");
                }
                next += block.point_count();
            }
            if next != points {
                return broken("points of blocks");
            }
            blocks.iter().map(StructuredBlock::cell_count).sum()
        }
    };
    let fits = |array: &DataArray, tuples: usize| {
        let values = tuples.checked_mul(array.components);
        array.components > 0 && !array.name.is_empty() && values == Some(array.values.len())
    };
    for (arrays, tuples) in [(&dataset.point_arrays, points), (&dataset.cell_arrays, cells)] {
        if let Some(array) = arrays.iter().find(|array| !fits(array, tuples)) {
            return Err(format!(
                "the array {:?} has not one tuple of {} for each of {tuples}",
                array.name, array.components
            ));
        }
    }
    Ok(())
}

/// Where an error of the whole way from file to picture lies, for the tests of real files.
///
/// # Errors
/// In words, if the error of a file has not all that its kind promises.
pub fn check_whole(error: &Error, path: &Path) -> Result<(), String> {
    if let Error::Io(error) = error {
        check_error(error)?;
    }
    check_words(&error.to_string(), &[path, &PathBuf::from(path).with_extension("q")])
}
