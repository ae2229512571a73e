//! 8-bit PNG pictures over a background.

use std::path::Path;

use tetrascope_view::LinearImage;

use super::{refuse_empty, whole_file::write_whole};
use crate::IoError;

/// Writes a picture as 8-bit sRGB PNG without alpha, with an sRGB chunk.
///
/// `background` is linear RGB; the picture is laid over it in linear light and encoded afterwards
/// ([`LinearImage::to_srgb8`]). The file appears whole or not at all. The same picture gives the same bytes.
///
/// # Errors
/// [`IoError::Write`] when the picture has no pixels or the file cannot be written; nothing is left of it then.
pub fn write_png(path: &Path, image: &LinearImage, background: [f32; 3]) -> Result<(), IoError> {
    refuse_empty(path, image)?;
    let bytes = encode(image, background)
        .map_err(|error| IoError::Write { path: path.to_owned(), problem: error.to_string() })?;
    write_whole(path, &bytes)
}

/// The bytes that [`write_png`] writes, for a picture that goes into something else; `None` for a picture without pixels.
///
/// `background` is linear RGB.
pub fn encode_png(image: &LinearImage, background: [f32; 3]) -> Option<Vec<u8>> {
    encode(image, background).ok()
}

fn encode(image: &LinearImage, background: [f32; 3]) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&image.to_srgb8(background))?;
    writer.finish()?;
    Ok(bytes)
}
