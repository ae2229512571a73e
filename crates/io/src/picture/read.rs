//! Pictures of either kind, told apart by their content.

use std::path::Path;

use tetrascope_view::LinearImage;

use super::{PngImage, exr_file, png_file};
use crate::{IoError, ReadOptions, opened::read_whole};

/// The first bytes of each format.
const PNG: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// A picture as its file has it.
#[derive(Clone, Debug, PartialEq)]
pub enum PictureFile {
    /// Encoded samples of 8 or 16 bits.
    Png(PngImage),
    /// Linear floats, premultiplied.
    Exr(LinearImage),
}

/// Reads a PNG or an OpenEXR picture; the content decides which it is, not the extension.
///
/// # Errors
/// [`IoError::Unsupported`] for a file that begins like neither, else as [`read_png`](super::read_png) and [`read_exr`](super::read_exr).
pub fn read_picture(path: &Path) -> Result<PictureFile, IoError> {
    let bytes = read_whole(path, &ReadOptions::default())?;
    if bytes.starts_with(&PNG) {
        png_file::decode(path, &bytes).map(PictureFile::Png)
    } else if bytes.starts_with(&EXR) {
        exr_file::decode(path, &bytes).map(PictureFile::Exr)
    } else {
        Err(IoError::Unsupported {
            path: path.to_owned(),
            what: "a picture that begins like neither PNG nor OpenEXR".to_owned(),
            remedy: "give a .png or an .exr".to_owned(),
        })
    }
}
