//! Whether a file fits one layout, judged by its header, its size and its record marks.

use super::{
    layout::{Encoding, Layout, dims_text},
    records::{RecordError, Records},
};

/// Zero bytes after the data that are taken for padding: one large disk block. Files padded to 512 bytes are common.
const MOST_PADDING: usize = 4096;

/// A file that has been read, and told to be text or not.
#[derive(Debug)]
pub(super) enum Content<'a> {
    Binary(&'a [u8]),
    Text(Vec<f64>),
}

/// A layout that a file fits.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fit {
    pub(super) layout: Layout,
    /// Points along each axis, a grid an entry.
    pub(super) dims: Vec<Vec<usize>>,
    /// Zero bytes after the data.
    pub(super) padding: usize,
}

/// A layout that a file does not fit, how far it got, and why.
#[derive(Clone, Debug)]
pub(super) struct Misfit {
    pub(super) layout: Layout,
    /// The first check that failed; a higher one is nearer to a fit.
    pub(super) stage: Stage,
    /// Within a stage, how far off: smaller is nearer.
    pub(super) distance: f64,
    pub(super) problem: String,
}

/// The checks, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stage {
    /// The header can be read.
    Header,
    /// The number of grids is positive and the file is long enough for their dimensions.
    GridCount,
    /// All dimensions are positive.
    Dimensions,
    /// The size is right.
    Size,
    /// Record marks agreed in the header, and this many times after it: that is no accident.
    Marks(usize),
}

impl Fit {
    /// Points of each grid.
    pub(super) fn points(&self) -> impl ExactSizeIterator<Item = usize> {
        // The product fits: `measure` found that many numbers in the file.
        self.dims.iter().map(|dims| dims.iter().product())
    }
}

/// Judges one layout.
pub(super) fn measure(content: &Content<'_>, layout: Layout) -> Result<Fit, Misfit> {
    let misfit = |stage, distance, problem| Misfit { layout, stage, distance, problem };
    let unreadable = |error: RecordError| misfit(Stage::Header, 0.0, format!("its header does not fit: {error}"));
    let mut header = Header::new(content, layout.encoding);
    let length = header.length();

    let count = if layout.multi { header.integers(1).map_err(unreadable)?[0] } else { 1 };
    let dims_size = (layout.axes * layout.integer_size()) as i64;
    if count < 1 || count > length as i64 / dims_size {
        let problem = format!("{count} grids are declared, which a file of this length cannot hold");
        return Err(misfit(Stage::GridCount, count.abs() as f64, problem));
    }
    // At most the number of integers in the file, by the check above.
    let declared = header.integers(count as usize * layout.axes).map_err(unreadable)?;
    if let Some(bad) = declared.chunks_exact(layout.axes).find(|dims| dims.iter().any(|&n| n < 1)) {
        let largest = bad.iter().map(|n| n.unsigned_abs()).max().unwrap_or_default();
        let problem = format!("the dimensions {} are not all positive", dims_text(&[bad.to_vec()]));
        return Err(misfit(Stage::Dimensions, largest as f64, problem));
    }
    let declared: Vec<Vec<i64>> = declared.chunks_exact(layout.axes).map(<[i64]>::to_vec).collect();

    // Dimensions are below 2^31, so that products and sums are far below 2^128.
    let points = declared.iter().map(|dims| dims.iter().map(|&n| n as u128).product::<u128>());
    let needed = layout.file_size(points.clone());
    let distance = (needed as f64 / length as f64).ln().abs();
    let unit = if layout.encoding == Encoding::Text { "numbers" } else { "bytes" };
    let wrong_size =
        |note: &str| format!("a grid of {} needs {needed} {unit}, the file has {length}{note}", dims_text(&declared));
    let padding = match header {
        Header::Text { .. } if needed == length as u128 => 0,
        Header::Text { .. } => return Err(misfit(Stage::Size, distance, wrong_size(""))),
        Header::Binary(mut records) => {
            let has_marks = records.has_marks();
            if has_marks {
                let depth = |d: &Vec<i64>| d.last().copied().unwrap_or(1).unsigned_abs();
                let first_depth = declared.first().map_or(1, depth);
                walk(&mut records, layout, points).map_err(|(agreed, error)| {
                    let problem = match error {
                        RecordError::Mark { found, expected, .. }
                            if first_depth > 1 && u64::from(found).checked_mul(first_depth) == Some(expected) =>
                        {
                            "its records hold one k plane each; files written plane by plane are not read".to_owned()
                        }
                        RecordError::TooShort(_) => wrong_size(""),
                        RecordError::Mark { .. } => format!("{error} (grid of {})", dims_text(&declared)),
                    };
                    misfit(Stage::Marks(agreed), distance, problem)
                })?;
            } else if needed > length as u128 {
                return Err(misfit(Stage::Size, distance, wrong_size("")));
            }
            // Not above the length: measured, or walked through.
            let rest = (length as u128 - needed) as usize;
            let zeros = records.tail(rest).iter().all(|&b| b == 0);
            if rest > MOST_PADDING || !zeros {
                let note = if zeros { "; that is too much for padding" } else { ", and the rest is not zero" };
                let stage = if has_marks { Stage::Marks(usize::MAX) } else { Stage::Size };
                return Err(misfit(stage, distance, wrong_size(note)));
            }
            rest
        }
    };
    let dims = declared.iter().map(|dims| dims.iter().map(|&n| n as usize).collect()).collect();
    Ok(Fit { layout, dims, padding })
}

/// Goes over the records after the header; a failure tells how many marks had agreed.
fn walk(
    records: &mut Records<'_>,
    layout: Layout,
    points: impl Iterator<Item = u128>,
) -> Result<(), (usize, RecordError)> {
    let mut agreed = 0;
    for points in points {
        let reference = (layout.floats_per_block() * layout.float_size()) as u128;
        for size in [reference, layout.points_record(points)].into_iter().filter(|&size| size > 0) {
            let size = u64::try_from(size).unwrap_or(u64::MAX);
            // A record that was cut off is nearer than one whose first mark differs.
            records.record(size).map_err(|error| match error {
                RecordError::TooShort(_) => (agreed + 1, error),
                RecordError::Mark { .. } => (agreed, error),
            })?;
            agreed += 2;
        }
    }
    Ok(())
}

/// The integers at the start of a file.
enum Header<'a> {
    Binary(Records<'a>),
    Text { values: &'a [f64], next: usize },
}

impl<'a> Header<'a> {
    fn new(content: &'a Content<'_>, encoding: Encoding) -> Self {
        match (content, encoding) {
            (Content::Text(values), _) => Self::Text { values, next: 0 },
            (Content::Binary(bytes), Encoding::Binary { order, marks, .. }) => {
                Self::Binary(Records::new(bytes, order, marks))
            }
            // Layouts of text are never tried on binary content; one with no number fits none of them.
            (Content::Binary(_), Encoding::Text) => Self::Text { values: &[], next: 0 },
        }
    }

    /// Bytes or numbers of the whole file.
    fn length(&self) -> usize {
        match self {
            Self::Binary(records) => records.length(),
            Self::Text { values, .. } => values.len(),
        }
    }

    /// The next record of integers, `count` of them; text gives -1 for what is no integer of 32 bits.
    fn integers(&mut self, count: usize) -> Result<Vec<i64>, RecordError> {
        match self {
            Self::Binary(records) => Ok(records.integers(count)?.into_iter().map(i64::from).collect()),
            Self::Text { values, next } => {
                let taken = values[*next..].get(..count).ok_or(RecordError::too_short(*next, count, values.len()))?;
                *next += count;
                let integer = |v: &f64| if v.fract() == 0.0 && v.abs() <= f64::from(i32::MAX) { *v as i64 } else { -1 };
                Ok(taken.iter().map(integer).collect())
            }
        }
    }
}
