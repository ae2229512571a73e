//! Has a file read and says what must not be.

use std::fs;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use tetrascope::{
    Backend, Choice, ReadOptions, SceneFile, Silent, Volume, read_exr, read_heights, read_mesh, read_picture, read_png,
    render_volume,
};
use tetrascope_colors::read_presets;

use super::promises::{cell_count, check_dataset, check_length, check_presets, check_words, is_read};
use super::{Target, corpus};

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
        Target::VtkGrid | Target::Vti | Target::Vtr | Target::Vts | Target::VtkNaming | Target::Raw | Target::Nrrd => {
            (1 << 12, 256 << 20)
        }
        Target::MshText | Target::MshBinary | Target::Openfoam => (1 << 11, 96 << 20),
        Target::Exodus | Target::ExodusHdf5 | Target::Vtkhdf => (1 << 11, 96 << 20),
        Target::PresetJson | Target::PresetXml => (1 << 11, 1 << 20),
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
        let folder = tempfile::tempdir()?;
        for (name, bytes) in corpus::companions() {
            fs::write(folder.path().join(name), bytes)?;
        }
        Ok(Self { folder, allocated })
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

    /// Writes a file below the folder.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, String> {
        let path = self.folder.path().join(name);
        path.parent()
            .map_or(Ok(()), fs::create_dir_all)
            .and_then(|()| fs::write(&path, bytes))
            .map_err(|e| e.to_string())?;
        Ok(path)
    }

    /// Puts an input where its reader finds it: the path to read, or `None` where what was said of it is refused.
    fn lay(&self, target: Target, bytes: &[u8], options: &mut ReadOptions) -> Result<Option<PathBuf>, String> {
        let name = format!("hostile.{}", target.extension());
        match target {
            Target::Plot3dSolution => {
                let (grid, solution) = corpus::split(bytes);
                options.solution = Some(self.write("solution.q", solution)?);
                self.write(&name, grid).map(Some)
            }
            Target::Raw => {
                let (word, samples) = corpus::word_and_samples(bytes);
                match word.parse() {
                    Ok(volume) => {
                        options.raw = Some(volume);
                        self.write(&name, samples).map(Some)
                    }
                    Err(problem) => check_length(&problem).map(|()| None),
                }
            }
            Target::Openfoam => {
                for (name, file) in corpus::openfoam::FILES.iter().zip(corpus::openfoam::files(bytes)) {
                    self.write(&format!("case/{name}"), file)?;
                }
                Ok(Some(self.folder.path().join("case")))
            }
            _ => self.write(&name, bytes).map(Some),
        }
    }

    fn run(&self, target: Target, bytes: &[u8]) -> Result<Verdict, String> {
        let mut options = ReadOptions::default();
        let Some(path) = self.lay(target, bytes, &mut options)? else {
            return Ok(Verdict { is_read: false, is_drawn: false, allocated: 0 });
        };
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
            Target::PresetJson | Target::PresetXml => {
                let name = path.display().to_string();
                let result = read_presets(&name, bytes);
                let allocated = spent()?;
                match result {
                    Ok(presets) => {
                        presets.warnings().iter().try_for_each(|warning| check_length(warning))?;
                        check_presets(&presets)?;
                        Ok(Verdict { is_read: true, is_drawn: true, allocated })
                    }
                    Err(error) => {
                        check_words(&error.to_string(), &[&path])?;
                        Ok(Verdict { is_read: false, is_drawn: false, allocated })
                    }
                }
            }
            _ => {
                let result = read_mesh(&path, &options);
                let allocated = spent()?;
                // Of a file that is named, or goes with another, its own name is said, which begins with the folder's.
                let beside = if target == Target::VtkNaming { self.folder.path().to_owned() } else { path.clone() };
                let is_read = is_read(&result, &[&path, &beside, options.solution.as_deref().unwrap_or(&path)])?;
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
