//! The variables of a NetCDF file by name: what Exodus is built on, in all of NetCDF's binary forms.

use std::collections::HashMap;

use netcdf_reader::{
    NcAttrValue, NcFile, NcFormat, NcOpenOptions, NcReadable, NcSliceInfo, NcSliceInfoElem, NcType, NcVariable,
};
use tetrascope_mesh::ArrayValues;

use super::DAMAGED;
use crate::budget::Budget;
use crate::{IoError, Source};

/// What is decoded in one piece: chunks are some megabytes in real files.
const CHUNK_AT_LEAST: u64 = 16 << 20;
/// Reads times variables: the library looks every variable up among all of them, so that without a limit a file of nothing but
/// variables would take time with the square of its length.
const MOST_COMPARISONS: u64 = 1 << 30;

/// An open file.
pub(super) struct Netcdf<'a> {
    pub(super) source: &'a Source,
    file: NcFile,
    variables: HashMap<String, usize>,
    dimensions: HashMap<String, u64>,
    budget: Budget,
    comparisons: std::cell::Cell<u64>,
}

impl<'a> Netcdf<'a> {
    /// Reads the header.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where it is damaged, [`IoError::Unsupported`] where it uses what the library does not know.
    pub(super) fn open(source: &'a Source) -> Result<Self, IoError> {
        let most_bytes = Budget::whole(source).saturating_mul(8);
        let options = NcOpenOptions {
            max_chunk_bytes: usize::try_from(most_bytes.max(CHUNK_AT_LEAST)).unwrap_or(usize::MAX),
            max_read_bytes: usize::try_from(most_bytes).unwrap_or(usize::MAX),
            chunk_cache_bytes: 16 << 20,
            ..NcOpenOptions::default()
        };
        let failed = |error| problem_of(source, "header", error);
        let file = NcFile::from_bytes_with_options(&source.bytes, options).map_err(failed)?;
        let variables = file.variables().map_err(failed)?;
        let variables = variables.iter().enumerate().map(|(index, variable)| (variable.name.clone(), index)).collect();
        let dimensions = file.dimensions().map_err(failed)?;
        let dimensions = dimensions.iter().map(|dimension| (dimension.name.clone(), dimension.size)).collect();
        let comparisons = std::cell::Cell::new(MOST_COMPARISONS);
        Ok(Self { source, file, variables, dimensions, budget: Budget::of(source), comparisons })
    }

    /// The form in words.
    pub(super) fn form(&self) -> &'static str {
        match self.file.format() {
            NcFormat::Classic => "NetCDF-3 (CDF-1)",
            NcFormat::Offset64 => "NetCDF-3 with 64-bit offsets (CDF-2)",
            NcFormat::Cdf5 => "NetCDF-3 with 64-bit data (CDF-5)",
            NcFormat::Nc4 | NcFormat::Nc4Classic => "NetCDF-4 (HDF5)",
        }
    }

    /// What the arrays may still come to.
    pub(super) fn budget(&self) -> &Budget {
        &self.budget
    }

    /// The names of all variables.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.variables.keys().map(String::as_str)
    }

    /// The length of a dimension; 0 where there is none of this name. Nothing may be reserved by it.
    pub(super) fn dimension(&self, name: &str) -> u64 {
        self.dimensions.get(name).copied().unwrap_or(0)
    }

    /// The lengths of a variable's dimensions; nothing where there is no such variable.
    pub(super) fn shape(&self, name: &str) -> Option<Vec<u64>> {
        self.variable(name).map(|variable| variable.shape())
    }

    /// A text that belongs to a variable.
    pub(super) fn attribute(&self, variable: &str, name: &str) -> Option<String> {
        match &self.variable(variable)?.attribute(name)?.value {
            NcAttrValue::Chars(text) => Some(text.trim_matches(['\0', ' ']).to_owned()),
            value => value.as_string(),
        }
    }

    /// The numbers of a variable; its first dimensions are held at `at`.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where there is no such variable, where it holds no numbers, where `at` is outside it, or where its bytes are not
    /// in the file.
    pub(super) fn numbers(&self, name: &str, at: &[u64]) -> Result<ArrayValues, IoError> {
        let place = || format!("variable `{name}`");
        let invalid = |problem: &str| self.source.invalid(place(), problem, DAMAGED);
        let variable = self.variable(name).ok_or_else(|| invalid("it is missing"))?;
        let shape = variable.shape();
        if at.len() > shape.len() || at.iter().zip(&shape).any(|(at, length)| at >= length) {
            return Err(invalid("it has not as many values as it needs"));
        }
        let rest = &shape[at.len()..];
        let count = rest.iter().try_fold(1_u64, |product, &length| product.checked_mul(length));
        self.budget.take(self.source, place(), count.unwrap_or(u64::MAX))?;
        self.look_up(name)?;
        let held = at.iter().map(|&index| NcSliceInfoElem::Index(index));
        let whole = rest.iter().map(|_| NcSliceInfoElem::Slice { start: 0, end: u64::MAX, step: 1 });
        let selection = NcSliceInfo { selections: held.chain(whole).collect() };
        let values = match variable.dtype() {
            _ if count == Some(0) => ArrayValues::F64(Vec::new()),
            NcType::Byte => ArrayValues::I8(self.slice(name, &selection)?),
            NcType::UByte => ArrayValues::U8(self.slice(name, &selection)?),
            NcType::Short => ArrayValues::I16(self.slice(name, &selection)?),
            NcType::UShort => ArrayValues::U16(self.slice(name, &selection)?),
            NcType::Int => ArrayValues::I32(self.slice(name, &selection)?),
            NcType::UInt => ArrayValues::U32(self.slice(name, &selection)?),
            NcType::Int64 => ArrayValues::I64(self.slice(name, &selection)?),
            NcType::UInt64 => ArrayValues::U64(self.slice(name, &selection)?),
            NcType::Float => ArrayValues::F32(self.slice(name, &selection)?),
            NcType::Double => ArrayValues::F64(self.slice(name, &selection)?),
            _ => return Err(invalid("it holds no numbers")),
        };
        if count != Some(values.len() as u64) {
            return Err(invalid("it has not as many values as it declares"));
        }
        Ok(values)
    }

    /// The rows of a table of characters, without the blanks behind them; nothing where there is no such variable or it holds no text.
    pub(super) fn texts(&self, name: &str) -> Result<Vec<String>, IoError> {
        let Some(variable) = self.variable(name) else { return Ok(Vec::new()) };
        let count = variable.shape().iter().try_fold(1_u64, |product, &length| product.checked_mul(length));
        self.budget.take(self.source, format!("variable `{name}`"), count.unwrap_or(u64::MAX))?;
        self.look_up(name)?;
        if count == Some(0) {
            return Ok(Vec::new());
        }
        // Names that are no text are not worth a mesh: what they name gets a number.
        let rows = self.file.read_variable_as_strings(name).unwrap_or_default();
        Ok(rows.iter().map(|row| row.split('\0').next().unwrap_or_default().trim_end().to_owned()).collect())
    }

    fn variable(&self, name: &str) -> Option<&NcVariable> {
        self.file.variables().ok()?.get(*self.variables.get(name)?)
    }

    /// Counts one look at all variables.
    fn look_up(&self, name: &str) -> Result<(), IoError> {
        match self.comparisons.get().checked_sub(self.variables.len() as u64) {
            Some(left) => {
                self.comparisons.set(left);
                Ok(())
            }
            None => Err(self.source.invalid(
                format!("variable `{name}`"),
                format!("there are {} variables, too many to read so many of them", self.variables.len()),
                "write the mesh with fewer element blocks or fewer variables",
            )),
        }
    }

    fn slice<T: NcReadable>(&self, name: &str, selection: &NcSliceInfo) -> Result<Vec<T>, IoError> {
        let array = self.file.read_variable_slice::<T>(name, selection);
        let array = array.map_err(|error| problem_of(self.source, format!("variable `{name}`"), error))?;
        // Row after row, whatever the order that the library keeps them in.
        Ok(array.into_iter().collect())
    }
}

fn problem_of(source: &Source, place: impl Into<String>, error: netcdf_reader::Error) -> IoError {
    use netcdf_reader::Error;
    match &error {
        Error::UnsupportedVersion(_)
        | Error::UnsupportedFeature(_)
        | Error::Hdf5(hdf5_reader::error::Error::UnsupportedFilter(_)) => {
            let what = format!("{}: {error}", place.into());
            source.unsupported(what, "write it again with other options, or as NetCDF-3")
        }
        _ => source.invalid(place, error.to_string(), DAMAGED),
    }
}
