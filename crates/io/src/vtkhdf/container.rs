//! Groups, datasets and attributes of an HDF5 file, as far as VTKHDF needs them.

use hdf5_reader::group::Group;
use hdf5_reader::{Dataset, Datatype, H5Type, Hdf5File, OpenOptions, SliceInfo, SliceInfoElem};
use tetrascope_mesh::ArrayValues;

use crate::budget::Budget;
use crate::vtk::scalars::to_indices;
use crate::{IoError, Source};

/// What to advise when a file is damaged rather than of an odd form.
pub(super) const DAMAGED: &str =
    "the file is cut off or damaged; write it again, or open it in ParaView to see what is left";

/// What is decoded in one piece: VTK's chunks have 25000 tuples, whatever an array's length.
const CHUNK_AT_LEAST: u64 = 16 << 20;

/// Arrays of points, arrays of cells, or blocks.
const MOST_MEMBERS: usize = 10_000;

/// An open file.
pub(super) struct Container<'a> {
    pub(super) source: &'a Source,
    file: Hdf5File,
    budget: Budget,
}

impl<'a> Container<'a> {
    /// Reads the file's first structures.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where they are damaged.
    pub(super) fn open(source: &'a Source) -> Result<Self, IoError> {
        let most_bytes = Budget::whole(source).saturating_mul(8);
        let options = OpenOptions::default()
            .with_max_chunk_bytes(usize::try_from(most_bytes.max(CHUNK_AT_LEAST)).unwrap_or(usize::MAX))
            .with_max_read_bytes(usize::try_from(most_bytes).unwrap_or(usize::MAX))
            .with_chunk_cache_bytes(16 << 20);
        let file = Hdf5File::from_bytes_with_options(&source.bytes, options);
        let file = file.map_err(|error| source.invalid("header", error.to_string(), DAMAGED))?;
        Ok(Self { source, file, budget: Budget::of(source) })
    }

    /// What the arrays may still come to.
    pub(super) fn budget(&self) -> &Budget {
        &self.budget
    }

    /// The group of this name below the root.
    pub(super) fn root(&self, name: &str) -> Result<Group, IoError> {
        self.file.group(name).map_err(|error| self.problem(format!("group `{name}`"), &error))
    }

    /// The group of this name in another; nothing where there is none.
    pub(super) fn group(&self, parent: &Group, name: &str) -> Option<Group> {
        parent.group(name).ok()
    }

    /// The names of a group's groups.
    pub(super) fn groups(&self, parent: &Group) -> Result<Vec<String>, IoError> {
        let names = parent.member_names().map_err(|error| self.problem(place(parent), &error))?;
        self.limited(parent, names.0)
    }

    /// The names of a group's datasets.
    pub(super) fn datasets(&self, parent: &Group) -> Result<Vec<String>, IoError> {
        let names = parent.member_names().map_err(|error| self.problem(place(parent), &error))?;
        self.limited(parent, names.1)
    }

    /// The library looks every name up among all of its group, so that without a limit a file of nothing but names would take time with the
    /// square of its length.
    fn limited(&self, parent: &Group, names: Vec<String>) -> Result<Vec<String>, IoError> {
        if names.len() <= MOST_MEMBERS {
            return Ok(names);
        }
        let problem = format!("it has {} members, more than the limit of {MOST_MEMBERS}", names.len());
        Err(self.source.invalid(place(parent), problem, "write the mesh with fewer arrays, or fewer blocks"))
    }

    /// A text attribute.
    pub(super) fn text(&self, group: &Group, name: &str) -> Option<String> {
        let text = group.attribute(name).ok()?.read_string().ok()?;
        Some(text.trim_matches(['\0', ' ']).to_owned())
    }

    /// A numeric attribute; nothing where there is none of this name, or it holds no numbers.
    pub(super) fn attribute(&self, group: &Group, name: &str) -> Option<Vec<f64>> {
        let attribute = group.attribute(name).ok()?;
        let all = match &attribute.datatype {
            Datatype::FixedPoint { size: 4, signed: true, .. } => as_f64(attribute.read_1d::<i32>().ok()?),
            Datatype::FixedPoint { size: 4, .. } => as_f64(attribute.read_1d::<u32>().ok()?),
            Datatype::FixedPoint { size: 8, signed: true, .. } => ArrayValues::I64(attribute.read_1d().ok()?).to_f64(),
            Datatype::FixedPoint { size: 8, .. } => ArrayValues::U64(attribute.read_1d().ok()?).to_f64(),
            Datatype::FloatingPoint { size: 4, .. } => as_f64(attribute.read_1d::<f32>().ok()?),
            Datatype::FloatingPoint { size: 8, .. } => attribute.read_1d().ok()?,
            _ => return None,
        };
        Some(all)
    }

    /// The lengths of a dataset's dimensions; nothing where there is no such dataset.
    pub(super) fn shape(&self, group: &Group, name: &str) -> Option<Vec<u64>> {
        group.dataset(name).ok().map(|dataset| dataset.shape().to_vec())
    }

    /// The numbers of `count` rows from `first` of a dataset.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where there is no such dataset, where it has fewer rows, holds no numbers, or is damaged.
    pub(super) fn rows(&self, group: &Group, name: &str, first: u64, count: u64) -> Result<ArrayValues, IoError> {
        let place = format!("dataset `{name}` of {}", place(group));
        let dataset = group.dataset(name).map_err(|error| self.problem(place.clone(), &error))?;
        let invalid = |problem: String| self.source.invalid(place.clone(), problem, DAMAGED);
        let Some((&rows, rest)) = dataset.shape().split_first() else {
            return Err(invalid("it has no dimensions".to_owned()));
        };
        let end = first.checked_add(count).filter(|&end| end <= rows);
        let end =
            end.ok_or_else(|| invalid(format!("it has {rows} rows, where {count} from row {first} are needed")))?;
        let numbers = rest.iter().try_fold(count, |product, &length| product.checked_mul(length));
        let numbers = numbers.unwrap_or(u64::MAX);
        self.budget.take(self.source, place.clone(), numbers)?;
        if numbers == 0 {
            return Ok(ArrayValues::I64(Vec::new()));
        }
        let whole = rest.iter().map(|_| SliceInfoElem::Slice { start: 0, end: u64::MAX, step: 1 });
        let selection = SliceInfo {
            selections: std::iter::once(SliceInfoElem::Slice { start: first, end, step: 1 }).chain(whole).collect(),
        };
        let failed = |error| self.problem(place.clone(), &error);
        let values = match dataset.dtype() {
            Datatype::FixedPoint { size: 1, signed: true, .. } => slice(&dataset, &selection).map(ArrayValues::I8),
            Datatype::FixedPoint { size: 1, .. } => slice(&dataset, &selection).map(ArrayValues::U8),
            Datatype::FixedPoint { size: 2, signed: true, .. } => slice(&dataset, &selection).map(ArrayValues::I16),
            Datatype::FixedPoint { size: 2, .. } => slice(&dataset, &selection).map(ArrayValues::U16),
            Datatype::FixedPoint { size: 4, signed: true, .. } => slice(&dataset, &selection).map(ArrayValues::I32),
            Datatype::FixedPoint { size: 4, .. } => slice(&dataset, &selection).map(ArrayValues::U32),
            Datatype::FixedPoint { size: 8, signed: true, .. } => slice(&dataset, &selection).map(ArrayValues::I64),
            Datatype::FixedPoint { size: 8, .. } => slice(&dataset, &selection).map(ArrayValues::U64),
            Datatype::FloatingPoint { size: 4, .. } => slice(&dataset, &selection).map(ArrayValues::F32),
            Datatype::FloatingPoint { size: 8, .. } => slice(&dataset, &selection).map(ArrayValues::F64),
            _ => return Err(invalid("it holds no numbers of 8 to 64 bits".to_owned())),
        };
        let values = values.map_err(failed)?;
        if values.len() as u64 != numbers {
            return Err(invalid(format!("it has {} numbers, where {numbers} were expected", values.len())));
        }
        Ok(values)
    }

    /// As [`rows`](Self::rows), of whole numbers.
    pub(super) fn index_rows(&self, group: &Group, name: &str, first: u64, count: u64) -> Result<Vec<i64>, IoError> {
        to_indices(&self.rows(group, name, first, count)?).ok_or_else(|| {
            let place = format!("dataset `{name}` of {}", place(group));
            self.source.invalid(place, "it holds no whole numbers", DAMAGED)
        })
    }

    fn problem(&self, place: String, error: &hdf5_reader::error::Error) -> IoError {
        if matches!(error, hdf5_reader::error::Error::UnsupportedFilter(_)) {
            return self
                .source
                .unsupported(format!("{place}: {error}"), "write it again with deflate or without compression");
        }
        self.source.invalid(place, error.to_string(), DAMAGED)
    }
}

fn place(group: &Group) -> String {
    format!("group `{}`", group.name())
}

fn as_f64<T: Into<f64>>(values: Vec<T>) -> Vec<f64> {
    values.into_iter().map(Into::into).collect()
}

fn slice<T: H5Type>(dataset: &Dataset, selection: &SliceInfo) -> Result<Vec<T>, hdf5_reader::error::Error> {
    // Row after row, whatever the order that the library keeps them in.
    Ok(dataset.read_slice::<T>(selection)?.into_iter().collect())
}
