//! PNG pictures: 8-bit ones over a background are written, all kinds are read.

use std::{io, path::Path};

use tetrascope_view::LinearImage;

use super::{
    refuse_empty,
    whole_file::{ask_for_memory, write_whole},
};
use crate::{IoError, ReadOptions, opened::read_whole};

/// How many bytes of samples a byte of a file may stand for: what deflate reaches. A pixel counts as a byte at least; what more a picture of
/// single bits could hold is no picture.
const SAMPLES_PER_BYTE: u64 = 1032;

/// Pictures up to this size are read whatever the file's length is: 4 megapixels are 32 MiB.
const PIXELS_ALWAYS_READ: u64 = 1 << 22;

/// Larger ones are not read at all: they take 2 GiB.
const MOST_PIXELS: u64 = 1 << 28;

/// Memory that the decoder may take for itself: lines, palettes, profiles and texts.
const DECODER_BYTES: usize = 64 << 20;

/// Memory that a pixel takes on its way out: its three bytes, and at most as many in the file.
const BYTES_PER_PIXEL: u64 = 6;

/// A picture as a PNG file has it: encoded samples, with straight alpha.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PngImage {
    /// Pixels a row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Red, green, blue and alpha, 0 to 65535, row after row from the top. Samples of 8 bits are here times 257, so that either kind
    /// has its largest value at 65535.
    pub pixels: Vec<[u16; 4]>,
}

/// Writes a picture as 8-bit sRGB PNG without alpha, with an sRGB chunk.
///
/// `background` is linear RGB; the picture is laid over it in linear light and encoded afterwards
/// ([`LinearImage::to_srgb8`]). The file appears whole or not at all. The same picture gives the same bytes.
///
/// # Errors
/// [`IoError::Write`] when the picture has no pixels or the file cannot be written, [`IoError::Memory`] when it is too large; nothing is
/// left of it then.
pub fn write_png(path: &Path, image: &LinearImage, background: [f32; 3]) -> Result<(), IoError> {
    refuse_empty(path, image)?;
    ask_for_memory(path, BYTES_PER_PIXEL * image.pixels().len() as u64)?;
    let bytes = encode(image, background).map_err(|error| IoError::Write {
        path: path.to_owned(),
        problem: error.to_string(),
        remedy: "draw a smaller picture",
    })?;
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

/// Reads a PNG picture of any kind: gray, RGB or palette, with or without alpha, of 1 to 16 bits, interlaced or not. Of an animation it
/// is the picture that programs without animations show.
///
/// A gray sample stands for red, green and blue; where nothing is transparent alpha is 65535. Profiles and gamma are not looked at.
///
/// # Errors
/// [`IoError::Read`] when the system does not give the file, [`IoError::Invalid`] when it is no such picture, is broken, declares more
/// pixels than a file of its length can hold (1032 bytes of samples a byte, and 2²² pixels whatever the length is), or more than 2²⁸.
pub fn read_png(path: &Path) -> Result<PngImage, IoError> {
    decode(path, &read_whole(path, &ReadOptions::default())?)
}

/// [`read_png`] of what is in the file.
pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<PngImage, IoError> {
    decode_samples(bytes).map_err(|problem| IoError::Invalid {
        path: path.to_owned(),
        place: "PNG picture".to_owned(),
        problem,
        remedy: "write it again as PNG".to_owned(),
    })
}

fn decode_samples(bytes: &[u8]) -> Result<PngImage, String> {
    let limits = png::Limits { bytes: DECODER_BYTES };
    let mut decoder = png::Decoder::new_with_limits(io::Cursor::new(bytes), limits);
    // Palettes and single bits to 8 bits, a transparent color to alpha.
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    // The decoder copies entries of three bytes into a table of 256 and panics on any other palette.
    if let Some(palette) = reader.info().palette.as_deref()
        && !(palette.len().is_multiple_of(3) && palette.len() <= 768)
    {
        return Err(format!("its palette has {} bytes, where three each for at most 256 colors belong", palette.len()));
    }
    let (width, height) = reader.info().size();
    let pixel = reader.info().bytes_per_pixel().max(1) as u64;
    let limit = ((bytes.len() as u64).saturating_mul(SAMPLES_PER_BYTE) / pixel).clamp(PIXELS_ALWAYS_READ, MOST_PIXELS);
    if u64::from(width) * u64::from(height) > limit {
        return Err(format!("{width} x {height} pixels are declared, a file of this length holds {limit} at most"));
    }
    let size = reader.output_buffer_size().ok_or_else(|| format!("its size of {width} x {height} does not fit"))?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(|error| error.to_string())?;
    if (frame.width, frame.height) != (width, height) {
        return Err(format!("its picture has {} x {} pixels, not {width} x {height}", frame.width, frame.height));
    }
    samples.truncate(frame.buffer_size());
    // Each pixel from its own bytes: a second copy of all samples would be as large as the picture.
    let channels = frame.color_type.samples();
    let pixels: Vec<[u16; 4]> = match frame.bit_depth {
        png::BitDepth::Sixteen => {
            let sample = |pixel: &[u8], at: usize| u16::from_be_bytes([pixel[2 * at], pixel[2 * at + 1]]);
            samples.chunks_exact(2 * channels).map(|pixel| to_rgba(channels, |at| sample(pixel, at))).collect()
        }
        _ => {
            let pixel = |pixel: &[u8]| to_rgba(channels, |at| u16::from(pixel[at]) * 257);
            samples.chunks_exact(channels).map(pixel).collect()
        }
    };
    if pixels.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(format!("{} pixels were found in a picture of {width} x {height}", pixels.len()));
    }
    Ok(PngImage { width, height, pixels })
}

/// A pixel from its samples: gray, gray and alpha, RGB, or RGBA.
fn to_rgba(channels: usize, sample: impl Fn(usize) -> u16) -> [u16; 4] {
    let alpha = if channels.is_multiple_of(2) { sample(channels - 1) } else { u16::MAX };
    let color = if channels < 3 { [sample(0); 3] } else { [sample(0), sample(1), sample(2)] };
    [color[0], color[1], color[2], alpha]
}
