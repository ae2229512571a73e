//! OpenEXR pictures: 32-bit linear, premultiplied.

use std::{io, path::Path};

use exr::prelude::{
    Blocks, Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, MetaData, ReadChannels, ReadLayers,
    RgbaChannels, SpecificChannels, Vec2, WritableImage, read,
};
use tetrascope_view::LinearImage;

use super::{
    refuse_empty,
    whole_file::{ask_for_memory, write_whole},
};
use crate::{IoError, ReadOptions, opened::read_whole};

/// How many bytes of samples, of all channels, a byte of a compressed file may stand for. Deflate reaches 1032; three times that leaves room
/// for half floats, which count as whole ones here, and for the other methods on constant pictures.
const SAMPLES_PER_BYTE: u64 = 3072;

/// Pictures up to this size are read whatever the file's length is: 4 megapixels of four channels are 64 MiB.
const SAMPLES_ALWAYS_READ: u64 = 1 << 26;

/// Memory that a pixel takes on its way out: at most as much as in the picture, as channels and in the file.
const BYTES_PER_PIXEL: u64 = 32;

/// Writes a picture as OpenEXR: channels R, G, B, A, 32-bit float, linear, premultiplied, with no background; ZIP
/// compression, which loses nothing. NaN and infinities are written as they are. The same picture gives the same bytes, whatever the
/// number of threads.
///
/// The file appears whole or not at all.
///
/// # Errors
/// [`IoError::Write`] when the picture has no pixels or the file cannot be written, [`IoError::Memory`] when it is too large; nothing is
/// left of it then.
pub fn write_exr(path: &Path, image: &LinearImage) -> Result<(), IoError> {
    refuse_empty(path, image)?;
    ask_for_memory(path, BYTES_PER_PIXEL * image.pixels().len() as u64)?;
    let bytes = encode(image).map_err(|error| IoError::Write {
        path: path.to_owned(),
        problem: error.to_string(),
        remedy: "draw a smaller picture",
    })?;
    write_whole(path, &bytes)
}

fn encode(image: &LinearImage) -> exr::error::Result<Vec<u8>> {
    let pixel = |at: Vec2<usize>| {
        let [r, g, b, a] = image.pixels()[at.y() * image.width() as usize + at.x()];
        (r, g, b, a)
    };
    // Blocks are compressed on all cores. In increasing order of lines they are written in that order, not as they are done, so that
    // one picture always gives the same bytes.
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let size = (image.width() as usize, image.height() as usize);
    // A layer without a name: its channels are then called R, G, B, A, which all programs look for.
    let layer = Layer::new(size, LayerAttributes::default(), encoding, SpecificChannels::rgba(pixel));
    let mut bytes = io::Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// Reads an OpenEXR picture: the first layer that has R, G and B, of any of the format's number types.
///
/// A missing A is 1. The picture is the data window; pixels are taken as they are (premultiplied by the format's rule).
///
/// # Errors
/// [`IoError::Read`] when the system does not give the file, [`IoError::Invalid`] when it is no such picture, is broken,
/// or declares more pixels than a file of its length can hold.
pub fn read_exr(path: &Path) -> Result<LinearImage, IoError> {
    decode(path, &read_whole(path, &ReadOptions::default())?)
}

/// [`read_exr`] of what is in the file.
pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<LinearImage, IoError> {
    let invalid = |problem: String| IoError::Invalid {
        path: path.to_owned(),
        place: "OpenEXR picture".to_owned(),
        problem,
        remedy: "write it again as flat RGB or RGBA OpenEXR".to_owned(),
    };
    refuse_oversized(bytes).map_err(invalid)?;

    let read = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size: Vec2<usize>, _: &RgbaChannels| (size.width(), vec![[0.0_f32; 4]; size.area()]),
            |(width, pixels), at, (r, g, b, a): (f32, f32, f32, f32)| {
                if let Some(pixel) = pixels.get_mut(at.y() * *width + at.x()) {
                    *pixel = [r, g, b, a];
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(io::Cursor::new(bytes))
        .map_err(|error| invalid(error.to_string()))?;

    let size = read.layer_data.size;
    let (_, pixels) = read.layer_data.channel_data.pixels;
    u32::try_from(size.width())
        .ok()
        .zip(u32::try_from(size.height()).ok())
        .and_then(|(width, height)| LinearImage::from_pixels(width, height, pixels))
        .ok_or_else(|| invalid(format!("its size of {} x {} does not fit", size.width(), size.height())))
}

/// Refuses sizes that the file cannot hold, before anything is reserved for them.
fn refuse_oversized(bytes: &[u8]) -> Result<(), String> {
    let meta = MetaData::read_from_buffered(io::Cursor::new(bytes), false).map_err(|error| error.to_string())?;
    let limit = (bytes.len() as u64).saturating_mul(SAMPLES_PER_BYTE).max(SAMPLES_ALWAYS_READ);
    for header in &meta.headers {
        let (width, height) = (header.layer_size.width() as u64, header.layer_size.height() as u64);
        // Channels that are not wanted are decompressed with the others. Here a pixel of any picture takes the 16 bytes of R, G, B, A.
        let pixel = header.channels.bytes_per_pixel.max(16) as u64;
        if width.checked_mul(height).and_then(|pixels| pixels.checked_mul(pixel)).is_none_or(|size| size > limit) {
            let channels = header.channels.list.len();
            return Err(format!(
                "{width} x {height} pixels of {channels} channels are declared, a file of this length holds {} at most",
                limit / pixel
            ));
        }
    }
    Ok(())
}
