//! From an array's name to one scalar a point.

use std::fmt;

use tetrascope_mesh::{Cells, DataArray, Dataset, StructuredBlock, cell_data_to_points};

use crate::text::short;

/// What an array belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Association {
    /// One tuple a point.
    Point,
    /// One tuple a cell.
    Cell,
}

impl fmt::Display for Association {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Point => "point",
            Self::Cell => "cell",
        })
    }
}

/// Which number of a tuple is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The only one.
    Scalar,
    /// One of several, counted from 0.
    Component(usize),
    /// The Euclidean length.
    Magnitude,
}

/// A scalar for every point of a dataset.
#[derive(Clone, Debug)]
pub struct Field {
    /// The name that selects exactly this field again: `"Velocity:mag"`.
    pub name: String,
    /// What the array that it comes from belongs to.
    pub association: Association,
    /// Whether it is one constant a cell, and not a value a point.
    pub is_per_cell: bool,
    /// One value a point of the dataset, or a cell where it is constant in each; may hold NaN and infinities.
    pub values: Vec<f64>,
    /// How the choice was made, where the user did not say it in full.
    pub notes: Vec<String>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// One array in a list of what there is.
#[derive(Clone, Debug, PartialEq)]
pub struct ArraySummary {
    /// As the file has it.
    pub name: String,
    /// Points or cells.
    pub association: Association,
    /// Numbers a tuple.
    pub components: usize,
    /// In VTK's words.
    pub type_name: &'static str,
    /// Number of tuples.
    pub tuples: usize,
    /// Lowest and highest finite number over all components; `None` when no number is finite.
    pub range: Option<(f64, f64)>,
    /// Numbers that are NaN or infinite.
    pub non_finite: usize,
}

impl fmt::Display for ArraySummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} array \"{}\"", self.association, self.name)?;
        if self.components > 1 {
            write!(f, ", {} components", self.components)?;
        }
        match self.range {
            Some((low, high)) => write!(f, ", {} to {}", short(low), short(high))?,
            None => write!(f, ", no finite value")?,
        }
        if self.non_finite > 0 {
            write!(f, ", {} not finite", self.non_finite)?;
        }
        Ok(())
    }
}

/// Why there is no field.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldError {
    /// The dataset has no array of this name.
    #[error("there is no array \"{name}\"; the file has{}", list(known))]
    Unknown {
        /// The name asked for.
        name: String,
        /// All arrays.
        known: Vec<ArraySummary>,
    },
    /// Constants of cells are asked for, and no cell array has this name.
    #[error(
        "there is no cell array \"{name}\", and values of points are not constant in a cell; the file has{}",
        list(known)
    )]
    UnknownOfCells {
        /// The name asked for.
        name: String,
        /// All arrays.
        known: Vec<ArraySummary>,
    },
    /// Constants of cells are asked for, and there are none.
    #[error("there is no cell array: no field is constant in each cell; the file has{}", list(known))]
    NoCellArrays {
        /// All arrays.
        known: Vec<ArraySummary>,
    },
    /// The array is there, the component is not.
    #[error(
        "the array \"{array}\" has no component \"{component}\": it has {components}; ask for {array}:0 to {array}:{} or \
         {array}:mag", components - 1
    )]
    NoSuchComponent {
        /// The array.
        array: String,
        /// What stood behind the colon.
        component: String,
        /// Numbers a tuple.
        components: usize,
    },
    /// Nothing to show.
    #[error("the file has no point or cell array: there is no scalar to draw; add one where the file was written")]
    NoArrays,
    /// The array does not fit the mesh.
    #[error(
        "the {association} array \"{array}\" has {tuples} tuples for {expected} {association}s; the file contradicts itself"
    )]
    WrongLength {
        /// The array.
        array: String,
        /// Points or cells.
        association: Association,
        /// What it has.
        tuples: usize,
        /// What it should have.
        expected: usize,
    },
    /// Every tetrahedron touches a value that is NaN or infinite.
    #[error(
        "the field \"{name}\" has no finite value on any cell ({non_finite} of {all} {of}s are NaN or infinite); choose another field"
    )]
    NothingFinite {
        /// The field.
        name: String,
        /// What has values.
        of: Association,
        /// Those of them with a value that is not finite.
        non_finite: usize,
        /// All of them.
        all: usize,
    },
    /// A point for each corner of each cell are too many.
    #[error("constants a cell: {0}; or let the values be averaged onto the points")]
    TooLarge(tetrascope_mesh::MeshError),
}

fn list(known: &[ArraySummary]) -> String {
    if known.is_empty() {
        return " no arrays at all".to_owned();
    }
    let more = known.len().saturating_sub(MOST_LISTED);
    let end = if more > 0 { format!("\n  and {more} more") } else { String::new() };
    known.iter().take(MOST_LISTED).map(|array| format!("\n  {array}")).chain([end]).collect()
}

/// Arrays that a message lists: a file may have a million.
const MOST_LISTED: usize = 50;

/// Longest name, in characters, of what is not there: a scene may ask for anything.
const LONGEST_NAME: usize = 200;

/// All arrays of a dataset, points' first, in the file's order.
pub fn summarize_arrays(dataset: &Dataset) -> Vec<ArraySummary> {
    arrays(dataset).map(|(association, array)| summarize(association, array)).collect()
}

fn arrays(dataset: &Dataset) -> impl Iterator<Item = (Association, &DataArray)> {
    let points = dataset.point_arrays.iter().map(|array| (Association::Point, array));
    points.chain(dataset.cell_arrays.iter().map(|array| (Association::Cell, array)))
}

fn summarize(association: Association, array: &DataArray) -> ArraySummary {
    let values = array.values.to_f64();
    let (range, finite) = finite_range(values.iter().copied());
    ArraySummary {
        name: array.name.clone(),
        association,
        components: array.components,
        type_name: array.values.type_name(),
        tuples: array.tuple_count(),
        range,
        non_finite: values.len() - finite,
    }
}

/// The range of the finite values, and their number.
pub(crate) fn finite_range(values: impl Iterator<Item = f64>) -> (Option<(f64, f64)>, usize) {
    values.filter(|v| v.is_finite()).fold((None, 0), |(range, count), v| {
        let (low, high) = range.unwrap_or((v, v));
        (Some((v.min(low), v.max(high))), count + 1)
    })
}

/// Finds the array that `wanted` names and makes one scalar a point of it.
///
/// A name is an array's, alone or followed by `:0`, `:1`, ..., `:x`, `:y`, `:z` or `:mag`. An array whose own name has a
/// colon is found by its whole name. A vector alone gives its magnitude, a cell array its average on the points. Of a
/// point and a cell array with one name the point array is taken. Without a name: the first scalar point array, else the
/// first point vector's magnitude, else the first cell array.
///
/// # Errors
/// [`FieldError`] with all arrays and their ranges when there is none of this name.
pub fn select_field(dataset: &Dataset, wanted: Option<&str>) -> Result<Field, FieldError> {
    select(dataset, wanted, &[Association::Point, Association::Cell])
}

/// Finds the cell array that `wanted` names and makes one constant a cell of it.
///
/// Names are those of [`select_field`], of cell arrays alone. Without a name: the first scalar cell array, else the first vector's magnitude.
///
/// # Errors
/// [`FieldError`] with all arrays and their ranges when there is no cell array of this name.
pub fn select_cell_field(dataset: &Dataset, wanted: Option<&str>) -> Result<Field, FieldError> {
    select(dataset, wanted, &[Association::Cell])
}

/// The field of the array that `wanted` names, of those that belong to what `of` lists. Values of cells stay such where no others are looked for.
fn select(dataset: &Dataset, wanted: Option<&str>, of: &[Association]) -> Result<Field, FieldError> {
    let mut notes = Vec::new();
    let (association, array, suffix) = match wanted {
        Some(name) => find(dataset, name, of)?,
        None => {
            let (association, array) = default_array(dataset, of, &mut notes)?;
            (association, array, None)
        }
    };
    let is_per_cell = !of.contains(&Association::Point);
    let expected = match association {
        Association::Point => dataset.points.len(),
        Association::Cell => match &dataset.cells {
            Cells::Unstructured(cells) => cells.kinds.len(),
            Cells::Structured(blocks) => blocks.iter().map(StructuredBlock::cell_count).sum(),
        },
    };
    if array.tuple_count() != expected {
        let (array, tuples) = (array.name.clone(), array.tuple_count());
        return Err(FieldError::WrongLength { array, association, tuples, expected });
    }
    let part = part_of(array, suffix)?;
    let mut warnings = Vec::new();
    if arrays(dataset).filter(|(a, other)| *a == association && other.name == array.name).count() > 1 {
        warnings.push(format!("there are several {association} arrays named \"{}\"; the first is taken", array.name));
    }
    if association == Association::Point && dataset.cell_arrays.iter().any(|other| other.name == array.name) {
        notes.push(format!("\"{}\" is a point array and a cell array; the point array is taken", array.name));
    }
    let (name, values) = match part {
        Part::Scalar => (array.name.clone(), array.component(0)),
        Part::Component(component) => (format!("{}:{component}", array.name), array.component(component)),
        Part::Magnitude => (format!("{}:mag", array.name), array.magnitude()),
    };
    if part == Part::Magnitude && suffix.is_none() {
        notes.push(format!(
            "\"{0}\" has {1} components: its magnitude is taken; for one of them ask for {0}:0 to {0}:{2}",
            array.name,
            array.components,
            array.components - 1
        ));
    }
    let values = match association {
        Association::Cell if !is_per_cell => {
            warnings.push(format!(
                "\"{}\" is a cell array: it is averaged onto the points, which smooths it by about a cell; --cells, or mesh.cells = true, draws it as it is",
                array.name
            ));
            cell_data_to_points(dataset, &values)
        }
        _ => values,
    };
    Ok(Field { name, association, is_per_cell, values, notes, warnings })
}

type Found<'a> = (Association, &'a DataArray, Option<&'a str>);

fn find<'a>(dataset: &'a Dataset, name: &'a str, of: &[Association]) -> Result<Found<'a>, FieldError> {
    let named =
        |wanted: &str| arrays(dataset).find(|(association, array)| of.contains(association) && array.name == wanted);
    if let Some((association, array)) = named(name) {
        return Ok((association, array, None));
    }
    if let Some((stem, suffix)) = name.rsplit_once(':')
        && let Some((association, array)) = named(stem)
    {
        return Ok((association, array, Some(suffix)));
    }
    let (name, known) = (name.chars().take(LONGEST_NAME).collect(), summarize_arrays(dataset));
    Err(if of.contains(&Association::Point) {
        FieldError::Unknown { name, known }
    } else {
        FieldError::UnknownOfCells { name, known }
    })
}

fn default_array<'a>(
    dataset: &'a Dataset,
    of: &[Association],
    notes: &mut Vec<String>,
) -> Result<(Association, &'a DataArray), FieldError> {
    let usable = |array: &&DataArray| array.tuple_count() > 0;
    if !of.contains(&Association::Point) {
        let cells = || dataset.cell_arrays.iter().filter(usable);
        let array = cells().find(|array| array.components == 1).or_else(|| cells().next());
        let array = array.ok_or_else(|| FieldError::NoCellArrays { known: summarize_arrays(dataset) })?;
        let kind = if array.components == 1 { "scalar" } else { "vector" };
        notes.push(format!("\"{}\" is the first {kind} cell array", array.name));
        return Ok((Association::Cell, array));
    }
    let points = || dataset.point_arrays.iter().filter(usable);
    let scalar = points().find(|array| array.components == 1);
    if let Some(array) = scalar {
        notes.push(format!("\"{}\" is the first scalar point array", array.name));
        return Ok((Association::Point, array));
    }
    if let Some(array) = points().next() {
        notes.push(format!("there is no scalar point array; \"{}\" is the first vector", array.name));
        return Ok((Association::Point, array));
    }
    match dataset.cell_arrays.iter().find(usable) {
        Some(array) => {
            notes.push(format!("there is no point array; \"{}\" is the first cell array", array.name));
            Ok((Association::Cell, array))
        }
        None => Err(FieldError::NoArrays),
    }
}

fn part_of(array: &DataArray, suffix: Option<&str>) -> Result<Part, FieldError> {
    let Some(suffix) = suffix else {
        return Ok(if array.components == 1 { Part::Scalar } else { Part::Magnitude });
    };
    let component = match suffix {
        "mag" => return Ok(Part::Magnitude),
        "x" => Some(0),
        "y" => Some(1),
        "z" => Some(2),
        digits => digits.parse().ok(),
    };
    component.filter(|&c| c < array.components).map(Part::Component).ok_or_else(|| FieldError::NoSuchComponent {
        array: array.name.clone(),
        component: suffix.to_owned(),
        components: array.components,
    })
}
