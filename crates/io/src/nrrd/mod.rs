//! NRRD: "nearly raw raster data", volumes with a header in text, in one file or many.
//!
//! Of an array of more than three axes those that do not run in space are the components of a sample, or steps that are looked at one by one.
//! Coordinates are those of the space that the header names, and its unit, if any, is the user's to know.
//!
//! Source: the definition of the NRRD file format, <https://teem.sourceforge.net/nrrd/format.html>.

mod axes;
mod encoding;
mod files;
mod gather;
mod geometry;
mod header;
mod pattern;

use std::{borrow::Cow, ops::Range};

use tetrascope_mesh::DataArray;

use self::{
    axes::{Axes, Role},
    encoding::Layout,
    files::Data,
    gather::Gather,
    geometry::Directions,
    header::Header,
};
use crate::{IoError, Loaded, MeshReader, Source, grid::check_dims, opened::read_whole, raw::ARRAY_NAME};

/// The reader of NRRD.
pub(crate) static NRRD: Nrrd = Nrrd;

/// See [`NRRD`].
#[derive(Debug)]
pub(crate) struct Nrrd;

/// The newest version of the format that is known here.
const NEWEST: u32 = 6;

impl MeshReader for Nrrd {
    fn name(&self) -> &'static str {
        "NRRD"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["nrrd", "nhdr"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        Header::begins(bytes)
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let mut warnings = Vec::new();
        let header = Header::parse(source)?;
        let layout = Layout::new(source, &header, &mut warnings)?;
        let directions = Directions::parse(source, &header, header.sizes(source)?.len())?;
        let axes = Axes::new(source, &header, directions.as_ref(), &mut warnings)?;
        let grid = geometry::grid(source, &header, &axes, directions.as_ref(), &mut warnings)?;
        check_dims(grid.dims).map_err(|problem| source.invalid("the field `sizes`", problem, header::MEND))?;

        let data = Data::find(source, &header, &axes)?;
        layout.check_capacity(source, "the data", axes.sample_count(), data.length())?;
        let times = geometry::times(source, &header, &axes, directions.as_ref())?;
        let step = source.step(&times)?;

        let wanted = Wanted::new(&axes, step);
        let (bytes, more) = read_range(source, &layout, &data, &axes, wanted.range)?;
        if more {
            warnings.push("there is more data than the sizes of the header ask for; the rest was not read".to_owned());
        }
        let values = wanted.gather.run(layout.sample.decode(&bytes, layout.order));
        drop(bytes);
        warn_of_header(&header, &grid.dims, &mut warnings);

        let mut dataset = grid.dataset();
        let components = axes.count(Role::Component);
        dataset.point_arrays.push(DataArray { name: ARRAY_NAME.to_owned(), components, values });
        let format = in_words(&header, &layout, &axes, &data);
        Ok(Loaded { dataset, format, warnings, times, step })
    }
}

/// The samples of one step.
struct Wanted {
    /// Those that are read, of all that the file has.
    range: Range<usize>,
    /// Where they stand among these.
    gather: Gather,
}

impl Wanted {
    fn new(axes: &Axes, step: usize) -> Self {
        let all = axes.sample_count();
        let stride = axes.step_axis().and_then(|axis| axes.strides().get(axis).copied()).unwrap_or(all);
        // Along the slowest axis, the samples of a step stand together.
        if axes.step_axis().is_some_and(|axis| axis + 1 == axes.sizes.len()) {
            return Self { range: step * stride..(step + 1) * stride, gather: Gather::new(axes, 0) };
        }
        Self { range: 0..all, gather: Gather::new(axes, if axes.step_axis().is_some() { step * stride } else { 0 }) }
    }
}

/// Samples in a range of all, from the parts that hold them, and whether the last of these has more than it should.
fn read_range<'a>(
    source: &Source,
    layout: &Layout,
    data: &Data<'a>,
    axes: &Axes,
    range: Range<usize>,
) -> Result<(Cow<'a, [u8]>, bool), IoError> {
    let all = axes.sample_count();
    let files = match data {
        Data::Attached(bytes) => return layout.samples(source, "the data", bytes, all, range),
        Data::Files(files) => files,
    };
    let a_part = (all / data.part_count()).max(1);
    let mut samples = Vec::new();
    let mut any_more = false;
    for (index, file) in files.iter().enumerate() {
        let first = index * a_part;
        let here = range.start.max(first)..range.end.min(first + a_part);
        if here.is_empty() {
            continue;
        }
        let place = format!("the data file `{}`", file.name);
        let cannot = |error: IoError| match error {
            stopped @ IoError::Interrupted { .. } => stopped,
            error => source.invalid(place.as_str(), error.to_string(), "check that it is complete"),
        };
        let bytes = read_whole(&file.path, &source.options).map_err(cannot)?;
        let (part, more) = layout.samples(source, &place, &bytes, a_part, here.start - first..here.end - first)?;
        any_more |= more;
        samples.extend_from_slice(&part);
    }
    Ok((samples.into(), any_more))
}

fn warn_of_header(header: &Header<'_>, dims: &[usize; 3], warnings: &mut Vec<String>) {
    if header.version > NEWEST {
        warnings.push(format!("the file is of version {} of NRRD; {NEWEST} is the newest known here", header.version));
    }
    if let Some((count, first)) = &header.unknown {
        warnings.push(format!(
            "{count} lines of the header are of no field of NRRD and were left out; the first is `{first}`"
        ));
    }
    if let (Some(low), Some(high)) = (header.field("old min"), header.field("old max")) {
        warnings.push(format!(
            "samples are taken as they stand: the header says that they were {} to {} before they were quantized",
            low.text, high.text
        ));
    }
    if dims.contains(&1) {
        warnings.push("the volume is one sample thick and has no cells".to_owned());
    }
}

/// The format as a user would call it.
fn in_words(header: &Header<'_>, layout: &Layout, axes: &Axes, data: &Data<'_>) -> String {
    let [x, y, z] = axes.dims();
    let mut words = vec![format!("NRRD {}", header.version), format!("{x}x{y}x{z} samples of {}", layout.sample)];
    let components = axes.count(Role::Component);
    if components > 1 {
        words.push(format!("{components} components"));
    }
    words.push(layout.encoding.label().to_owned());
    if layout.sample.size() > 1 && layout.encoding != encoding::Encoding::Text {
        words.push(layout.order.to_string());
    }
    if let Data::Files(files) = data {
        words.push(if files.len() == 1 { "detached".to_owned() } else { format!("{} data files", files.len()) });
    }
    if let Some(space) = header.lower("space") {
        words.push(format!("space {space}"));
    }
    words.join(", ")
}

#[cfg(test)]
mod file_tests;
#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod shared_tests;
#[cfg(test)]
mod tests;
