//! What names of raw files say by custom: `neghip_64x64x64_uint8.raw`.

use std::path::Path;

use super::{
    RawVolume,
    words::{byte_order, size},
};
use crate::{SampleType, read::extension};

/// Extensions that raw files have.
const EXTENSIONS: [&str; 5] = ["raw", "bin", "dat", "img", "vol"];

/// Extensions behind these where the file is compressed.
const PACKED: [&str; 2] = ["gz", "bz2"];

/// Whether a name is that of a compressed file.
pub(super) fn is_packed(path: &Path) -> bool {
    PACKED.contains(&extension(path).as_str())
}

/// Size, type and byte order in the words of a name; nothing unless one word is a size and one a type.
pub(super) fn volume(path: &Path) -> Option<RawVolume> {
    let name = if is_packed(path) { Path::new(path.file_stem()?) } else { path };
    if !EXTENSIONS.contains(&extension(name).as_str()) {
        return None;
    }
    let stem = name.file_stem()?.to_str()?;
    let words = || stem.split(|c: char| !c.is_ascii_alphanumeric());
    let mut volume = RawVolume::new(words().find_map(size)?, words().find_map(SampleType::of_name)?);
    if let Some(order) = words().find_map(byte_order) {
        volume.order = order;
    }
    Some(volume)
}
