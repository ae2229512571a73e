//! What names of raw files say by custom: `neghip_64x64x64_uint8.raw`.

use std::path::Path;

use super::{
    RawVolume,
    words::{byte_order, size},
};
use crate::SampleType;

/// Extensions that raw files have.
const EXTENSIONS: [&str; 7] = ["raw", "bin", "dat", "img", "vol", "gz", "bz2"];

/// Size, type and byte order in the words of a name; nothing unless one word is a size and one a type.
pub(super) fn volume(path: &Path) -> Option<RawVolume> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    if !EXTENSIONS.contains(&extension.as_str()) {
        return None;
    }
    let stem = path.file_stem()?.to_str()?;
    let words = || stem.split(|c: char| !c.is_ascii_alphanumeric());
    let mut volume = RawVolume::new(words().find_map(size)?, words().find_map(SampleType::of_name)?);
    if let Some(order) = words().find_map(byte_order) {
        volume.order = order;
    }
    Some(volume)
}
