//! Pictures as files.

mod exr_file;
mod png_file;
mod read;
mod whole_file;

use std::path::Path;

use tetrascope_view::LinearImage;

pub use exr_file::{read_exr, write_exr};
pub use png_file::{PngImage, encode_png, read_png, write_png};
pub use read::{PictureFile, read_picture};
pub use whole_file::{check_writable, end_writing, make_folder, write_bytes, write_files};
pub(crate) use whole_file::{write_by, write_whole};

use crate::{IoError, read::extension};

/// Writes a picture in the format that the extension names: `.png` over `background`, or `.exr` without one.
///
/// `background` is linear RGB.
///
/// # Errors
/// [`IoError::Unsupported`] for any other extension, else as [`write_png`] and [`write_exr`].
pub fn write_image(path: &Path, image: &LinearImage, background: [f32; 3]) -> Result<(), IoError> {
    match extension(path).as_str() {
        "png" => write_png(path, image, background),
        "exr" => write_exr(path, image),
        other => Err(IoError::Unsupported {
            path: path.to_owned(),
            what: if other.is_empty() {
                "a picture without an extension".to_owned()
            } else {
                format!("the picture format .{other}")
            },
            remedy: "name it .png (8-bit sRGB over the background) or .exr (32-bit linear)".to_owned(),
        }),
    }
}

/// Refuses a picture without pixels, which neither format can hold.
fn refuse_empty(path: &Path, image: &LinearImage) -> Result<(), IoError> {
    if image.width() == 0 || image.height() == 0 {
        let problem = format!("the picture has {} x {} pixels", image.width(), image.height());
        return Err(IoError::Write { path: path.to_owned(), problem, remedy: "give it a size" });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
