//! Pictures to look at: what failed, and what would change.

use std::fs;
use std::path::{Path, PathBuf};

use tetrascope::{Backend, LinearImage, write_exr, write_png};

use super::{Golden, draw, is_same};

/// What pictures with an opacity are shown over: neither black, which hides absorption, nor white, which hides light.
const BEHIND: [f32; 3] = [0.12, 0.12, 0.12];

/// A pixel of a picture is a square of this many on the screen.
const ENLARGED: u32 = 4;

/// Removes what earlier runs left for a scene.
pub(super) fn forget(evidence: &Path, name: &str) {
    let Ok(entries) = fs::read_dir(evidence) else { return };
    for entry in entries.flatten() {
        let file = entry.file_name();
        let Some(rest) = file.to_str().and_then(|f| f.strip_prefix(name)) else { continue };
        if rest.starts_with('-') {
            // What cannot be removed is overwritten or reported when it is written.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Leaves the expected picture, the drawn one, their difference and a summary.
pub(super) fn leave(
    evidence: &Path,
    name: &str,
    backend: Backend,
    expected: &LinearImage,
    drawn: &LinearImage,
    summary: &str,
) -> Result<(), String> {
    fs::create_dir_all(evidence).map_err(|e| format!("{}: {e}", evidence.display()))?;
    let write = |what: &str, image: &LinearImage| -> Result<(), String> {
        let stem = format!("{name}-{backend}-{what}");
        write_exr(&evidence.join(format!("{stem}.exr")), image).map_err(|e| e.to_string())?;
        write_png(&evidence.join(format!("{stem}.png")), image, BEHIND).map_err(|e| e.to_string())
    };
    write("expected", expected)?;
    write("actual", drawn)?;
    let mut text = format!("{summary}\n");
    if let Some((difference, factor)) = amplified(expected, drawn) {
        write("difference", &difference)?;
        text.push_str(&format!("differences in the picture are shown {factor:.3e} times as large; opacity as white\n"));
    }
    let path = evidence.join(format!("{name}-{backend}-summary.txt"));
    fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))
}

/// Absolute differences, the largest made 1, and the factor that made it so; `None` for pictures of different size.
fn amplified(a: &LinearImage, b: &LinearImage) -> Option<(LinearImage, f32)> {
    if (a.width(), a.height()) != (b.width(), b.height()) {
        return None;
    }
    let apart = |p: &[f32; 4], q: &[f32; 4]| {
        let channels: [f32; 4] = std::array::from_fn(|c| (p[c] - q[c]).abs());
        // A difference of opacity alone shall be seen as well.
        [channels[0].max(channels[3]), channels[1].max(channels[3]), channels[2].max(channels[3])]
    };
    let pixels: Vec<[f32; 3]> = a.pixels().iter().zip(b.pixels()).map(|(p, q)| apart(p, q)).collect();
    let largest = pixels.iter().flatten().fold(0.0_f32, |most, &c| most.max(c));
    let factor = if largest > 0.0 && largest.is_finite() { 1.0 / largest } else { 1.0 };
    let pixels = pixels.iter().map(|p| [p[0] * factor, p[1] * factor, p[2] * factor, 1.0]).collect();
    Some((LinearImage::from_pixels(a.width(), a.height(), pixels)?, factor))
}

/// A scene whose picture is another one now.
#[derive(Clone, Debug)]
pub struct Review {
    /// The scene.
    pub name: &'static str,
    /// Old, new and difference side by side.
    pub picture: PathBuf,
    /// What the difference is multiplied by to be seen; `None` where there is no old picture of this size.
    pub factor: Option<f32>,
}

/// Draws every scene with the reference and puts those that changed beside the old pictures: old, new, difference.
///
/// `old` gives the picture to compare with, or `None` where the scene is new.
///
/// # Errors
/// In words, if a scene is not drawn or a picture not written.
pub fn review(
    folder: &Path,
    scenes: &[Golden],
    evidence: &Path,
    old: impl Fn(&str) -> Option<LinearImage>,
) -> Result<Vec<Review>, String> {
    fs::create_dir_all(evidence).map_err(|e| format!("{}: {e}", evidence.display()))?;
    let mut reviews = Vec::new();
    for scene in scenes {
        let new = draw(folder, scene.name, Backend::Reference)?;
        let old = old(scene.name);
        if old.as_ref().is_some_and(|old| is_same(old, &new)) {
            continue;
        }
        let apart = old.as_ref().and_then(|old| amplified(old, &new));
        let nothing = LinearImage::transparent(new.width(), new.height());
        let columns = [old.as_ref().unwrap_or(&nothing), &new, apart.as_ref().map_or(&nothing, |(image, _)| image)];
        let picture = evidence.join(format!("{}-review.png", scene.name));
        write_png(&picture, &side_by_side(&columns), BEHIND).map_err(|e| e.to_string())?;
        reviews.push(Review { name: scene.name, picture, factor: apart.map(|(_, factor)| factor) });
    }
    Ok(reviews)
}

/// Pictures in a row, enlarged, with a white line between them.
fn side_by_side(images: &[&LinearImage]) -> LinearImage {
    let height = images.iter().map(|i| i.height()).max().unwrap_or(1) * ENLARGED;
    let width = images.iter().map(|i| i.width() * ENLARGED + 2).sum::<u32>().saturating_sub(2).max(1);
    let mut sheet = LinearImage::transparent(width, height);
    let mut left = 0;
    for image in images {
        for y in 0..image.height() * ENLARGED {
            for x in 0..image.width() * ENLARGED {
                let at = y as usize * width as usize + (left + x) as usize;
                sheet.pixels_mut()[at] = image.pixel(x / ENLARGED, y / ENLARGED);
            }
        }
        left += image.width() * ENLARGED + 2;
        if left < width {
            for y in 0..height {
                for x in left - 2..left {
                    sheet.pixels_mut()[y as usize * width as usize + x as usize] = [1.0; 4];
                }
            }
        }
    }
    sheet
}
