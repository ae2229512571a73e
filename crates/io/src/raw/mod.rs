//! Raw volumes: samples and nothing else, of which the user or the file's name says what they are.

mod name;
mod words;

use std::path::Path;

use glam::DVec3;
use tetrascope_mesh::DataArray;

use crate::{
    IoError, Loaded, MeshReader, SampleType, Source,
    bytes::ByteOrder,
    grid::{RegularGrid, check_dims},
    unpack::Packing,
};

/// What a file of samples alone does not say of itself.
///
/// On the command line it is a word, for which see [`RawVolume::from_str`](std::str::FromStr).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RawVolume {
    /// Number of samples along x, y and z; x is the fastest. Each at least 1.
    pub size: [usize; 3],
    /// Their type.
    pub sample: SampleType,
    /// Which byte of a sample comes first.
    pub order: ByteOrder,
    /// Numbers a sample, which stand beside each other; at least 1.
    pub components: usize,
    /// World length from a sample to the next along x, y and z; finite and not 0.
    pub spacing: [f64; 3],
    /// World coordinates of the first sample; finite.
    pub origin: [f64; 3],
    /// Bytes of the file before the first sample.
    pub skip: usize,
}

/// The reader of raw volumes.
pub(crate) static RAW: Raw = Raw;

/// See [`RAW`].
#[derive(Debug)]
pub(crate) struct Raw;

/// What ParaView calls the samples of files that do not name them.
pub(crate) const ARRAY_NAME: &str = "ImageFile";

/// Samples that a byte of a compressed file may stand for: a byte of DEFLATE stands for 1032 bytes at most, one of bzip2 for many more.
const PACKED_SAMPLES: usize = 128;

/// Samples that a compressed file may hold whatever its length: small files are mostly small volumes with little in them.
const PACKED_SAMPLES_ALWAYS: usize = 1 << 22;

const SAY: &str =
    "say what it holds with --raw, as in --raw 64x64x64:uint8, or in its name, as in name_64x64x64_uint8.raw";

impl RawVolume {
    /// One component a sample, little-endian, at unit distances from the origin, with nothing before it.
    pub fn new(size: [usize; 3], sample: SampleType) -> Self {
        Self { size, sample, order: ByteOrder::Little, components: 1, spacing: [1.0; 3], origin: [0.0; 3], skip: 0 }
    }

    /// What a file's name says, `neghip_64x64x64_uint8.raw` for instance, if the file is as long as that says or is a compressed one.
    pub fn of_name(path: &Path, length: u64) -> Option<Self> {
        let fits = |volume: &Self| volume.data_size().is_some_and(|size| size as u64 == length);
        name::volume(path).filter(|volume| name::is_packed(path) || fits(volume))
    }

    /// Bytes that the samples take; `None` where they are more than can be counted.
    fn data_size(&self) -> Option<usize> {
        let tuple = self.sample.size().checked_mul(self.components)?;
        self.size.iter().try_fold(tuple, |product, &count| product.checked_mul(count))
    }
}

/// How many samples a compressed file of so many bytes may hold.
pub(crate) fn most_packed_samples(bytes: usize) -> usize {
    bytes.saturating_mul(PACKED_SAMPLES).max(PACKED_SAMPLES_ALWAYS)
}

impl MeshReader for Raw {
    fn name(&self) -> &'static str {
        "raw volume"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["raw"]
    }

    /// Never: samples can be any bytes. `read_mesh` asks what the user and the name say.
    fn recognizes(&self, _bytes: &[u8]) -> bool {
        false
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let said = source.options.raw;
        let volume = match said.or_else(|| name::volume(&source.path)) {
            Some(volume) => volume,
            None => return Err(source.invalid("the whole file", "nothing in it says what its samples are", SAY)),
        };
        let mut warnings = Vec::new();
        if said.is_none() {
            let [x, y, z] = volume.size;
            let order = if volume.sample.size() > 1 { format!(", {}", volume.order) } else { String::new() };
            warnings.push(format!(
                "size and type, {x}x{y}x{z} samples of {}{order}, were taken from the file's name",
                volume.sample
            ));
        }
        load(source, &volume, warnings)
    }
}

fn load(source: &Source, volume: &RawVolume, mut warnings: Vec<String>) -> Result<Loaded, IoError> {
    let says = if source.options.raw.is_some() { "the size that was given" } else { "the size in the file's name" };
    if volume.components == 0 {
        return Err(source.invalid(says, "there are no components a sample: at least 1 is needed", SAY));
    }
    check_dims(volume.size).map_err(|problem| source.invalid(says, problem, SAY))?;
    let [x, y, z] = volume.size;
    let text = format!("{x}x{y}x{z} samples of {} {}", volume.components, volume.sample);
    let wanted = volume
        .data_size()
        .ok_or_else(|| source.invalid(says, format!("{text} are more bytes than can be counted"), SAY))?;

    let whole = volume.skip.saturating_add(wanted);
    // Samples may begin as a compressed file does, but then hardly are as many as that.
    let packing = [Packing::Gzip, Packing::Bzip2]
        .into_iter()
        .find(|packing| source.bytes.starts_with(packing.magic()) && source.bytes.len() != whole);
    let unpacked = packing.map(|packing| inflate(source, volume, packing, wanted)).transpose()?;
    let (data, more) = match &unpacked {
        Some(unpacked) => (&unpacked[..], 0),
        None => source.bytes.get(volume.skip..).and_then(|data| data.split_at_checked(wanted)).map_or_else(
            || {
                let length = source.bytes.len();
                let problem =
                    format!("{text} behind {} bytes are {whole} bytes, and the file has {length}", volume.skip);
                Err(source.invalid("the whole file", problem, SAY))
            },
            |(data, behind)| Ok((data, behind.len())),
        )?,
    };
    if more > 0 {
        warnings.push(format!(
            "{more} bytes behind the {wanted} of the volume were not read; where they are a header before it, say skip={more}"
        ));
    }
    if volume.size.contains(&1) {
        warnings.push("the volume is one sample thick and has no cells".to_owned());
    }

    let [dx, dy, dz] = volume.spacing;
    let steps = [DVec3::X * dx, DVec3::Y * dy, DVec3::Z * dz];
    let grid = RegularGrid { dims: volume.size, origin: volume.origin.into(), steps };
    let mut dataset = grid.dataset();
    let values = volume.sample.decode(data, volume.order);
    dataset.point_arrays.push(DataArray { name: ARRAY_NAME.to_owned(), components: volume.components, values });
    let mut format = format!("raw volume, {text}");
    if volume.sample.size() > 1 {
        format.push_str(&format!(", {}", volume.order));
    }
    if let Some(packing) = packing {
        format.push_str(&format!(", {}", packing.label()));
    }
    Ok(Loaded::without_time(dataset, format, warnings))
}

fn inflate(source: &Source, volume: &RawVolume, packing: Packing, wanted: usize) -> Result<Vec<u8>, IoError> {
    let most = most_packed_samples(source.bytes.len());
    let remedy = "unpack it and name the file inside";
    let bytes = volume.skip.saturating_add(wanted);
    if bytes / volume.sample.size() > most {
        let problem =
            format!("it would stand for more than the {most} samples that a compressed file of its length may hold");
        return Err(source.invalid("the whole file", problem, remedy));
    }
    let unpacked = packing
        .inflate(&source.bytes, volume.skip, wanted)
        .map_err(|problem| source.invalid("the whole file", problem, remedy))?;
    if unpacked.bytes.len() < wanted || unpacked.more {
        let problem = format!("what it unpacks to is not the {wanted} bytes of the volume behind {}", volume.skip);
        return Err(source.invalid("the whole file", problem, SAY));
    }
    Ok(unpacked.bytes)
}

#[cfg(test)]
mod tests;
