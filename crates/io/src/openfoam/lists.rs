//! OpenFOAM's lists: `3(1 2 3)`, `(1 2 3)`, `3{1}`, and their binary forms.

use tetrascope_mesh::ArrayValues;

use super::{
    file::Header,
    words::{Bad, Words},
};
use crate::bytes::{ByteCursor, Number};

/// A label that stands for none: a face without a neighbor.
pub(super) const NONE: u32 = u32::MAX;

/// Rows of labels, as faces are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Rows {
    /// Where the rows end in [`Rows::labels`].
    pub(super) ends: Vec<usize>,
    /// All labels.
    pub(super) labels: Vec<u32>,
}

impl Rows {
    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// One row; empty where there is none.
    pub(super) fn row(&self, index: usize) -> &[u32] {
        let start = index.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0);
        self.ends.get(index).and_then(|&end| self.labels.get(start..end)).unwrap_or_default()
    }
}

/// Reads lists from the content of a file.
pub(super) struct ListReader<'a, 'w> {
    pub(super) words: &'w mut Words<'a>,
    pub(super) header: &'a Header,
}

/// The start of a list.
enum Start {
    /// In parentheses, with the number of its elements where that is stated.
    Elements(Option<usize>),
    /// So many times one element.
    Repeated(usize),
    /// Without elements, and without parentheses.
    Nothing,
}

impl<'a> ListReader<'a, '_> {
    fn start(&mut self) -> Result<Start, Bad> {
        let count = match self.words.peek() {
            Some(b'(') => None,
            _ => Some(self.words.number::<usize>("a list, as `3(...)`,")?),
        };
        match self.words.peek() {
            Some(b'(') => {
                self.words.at += 1;
                Ok(Start::Elements(count))
            }
            Some(b'{') => {
                self.words.at += 1;
                Ok(Start::Repeated(count.unwrap_or(0)))
            }
            _ if count == Some(0) => Ok(Start::Nothing),
            _ => Err(self.words.bad_next("`(`")),
        }
    }

    /// The number of elements that parentheses hold, once they are at their end.
    fn finish(&mut self, declared: Option<usize>, held: usize) -> Result<(), Bad> {
        self.words.expect(b')')?;
        match declared {
            Some(declared) if declared != held => Err(Bad {
                at: self.words.at,
                problem: format!("the list should have {declared} elements and has {held}"),
            }),
            _ => Ok(()),
        }
    }

    /// The numbers of a binary list, in the first of `sizes` behind which the list ends with its parenthesis.
    fn bytes_of(&mut self, count: usize, components: usize, sizes: &[usize]) -> Result<(usize, &'a [u8]), Bad> {
        let rest = self.words.rest();
        let ends = |size: usize| {
            let length = count.checked_mul(components)?.checked_mul(size)?;
            (*rest.get(length)? == b')').then_some((size, length))
        };
        let Some((size, length)) = sizes.iter().find_map(|&size| ends(size)) else {
            let size = sizes.first().copied().unwrap_or_default();
            let problem = format!(
                "a list of {count} elements of {} bytes does not end there with `)`; {} bytes are left",
                components * size,
                rest.len()
            );
            return Err(Bad { at: self.words.at, problem });
        };
        self.words.at += length + 1;
        Ok((size, rest.get(..length).unwrap_or_default()))
    }

    fn numbers<T: Number>(&self, bytes: &[u8]) -> Vec<T> {
        ByteCursor::new(bytes, self.header.order).many(bytes.len() / T::SIZE).unwrap_or_default()
    }

    /// Labels; -1 becomes [`NONE`].
    ///
    /// - `most`: how many a list may have that repeats one label
    pub(super) fn labels(&mut self, most: usize) -> Result<Vec<u32>, Bad> {
        let start_at = self.words.at;
        let declared = match self.start()? {
            Start::Nothing => return Ok(Vec::new()),
            Start::Repeated(count) => {
                let label = self.label()?;
                self.words.expect(b'}')?;
                return match count <= most {
                    true => Ok(vec![label; count]),
                    false => Err(Bad {
                        at: start_at,
                        problem: format!("one label is repeated {count} times, {most} at most belong here"),
                    }),
                };
            }
            Start::Elements(declared) => declared,
        };
        if let (true, Some(count)) = (self.header.binary, declared) {
            return self.binary_labels(count);
        }
        let mut labels = Vec::new();
        while !matches!(self.words.peek(), None | Some(b')')) {
            labels.push(self.label()?);
        }
        self.finish(declared, labels.len())?;
        Ok(labels)
    }

    fn binary_labels(&mut self, count: usize) -> Result<Vec<u32>, Bad> {
        let at = self.words.at;
        let stated = [self.header.label_size];
        let (size, bytes) = self.bytes_of(count, 1, if self.header.sizes_known { &stated } else { &[4, 8] })?;
        let label = |(index, wide): (usize, i64)| {
            to_label(wide).ok_or_else(|| Bad { at: at + index * size, problem: format!("{wide} is no label") })
        };
        match size {
            4 => self.numbers::<i32>(bytes).into_iter().map(i64::from).enumerate().map(label).collect(),
            _ => self.numbers::<i64>(bytes).into_iter().enumerate().map(label).collect(),
        }
    }

    fn label(&mut self) -> Result<u32, Bad> {
        let at = self.words.at;
        let wide = self.words.number::<i64>("a label")?;
        to_label(wide).ok_or_else(|| Bad { at, problem: format!("{wide} is no label") })
    }

    /// A list of lists of labels: `2(3(0 1 2) 4(3 4 5 6))`.
    pub(super) fn rows(&mut self) -> Result<Rows, Bad> {
        let declared = match self.start()? {
            Start::Nothing => return Ok(Rows::default()),
            Start::Repeated(_) => return Err(self.words.bad_next("a list of faces in parentheses")),
            Start::Elements(declared) => declared,
        };
        let mut rows = Rows::default();
        while !matches!(self.words.peek(), None | Some(b')')) {
            // A face names no point twice: none is written as a repetition.
            rows.labels.extend(self.labels(0)?);
            rows.ends.push(rows.labels.len());
        }
        self.finish(declared, rows.len())?;
        Ok(rows)
    }

    /// Rows as the labels where they start, the last one where they end, and all labels.
    pub(super) fn compact_rows(&mut self) -> Result<Rows, Bad> {
        let at = self.words.at;
        let starts = self.labels(0)?;
        let labels = self.labels(0)?;
        if starts.is_empty() && labels.is_empty() {
            return Ok(Rows::default());
        }
        let sorted = starts.is_sorted() && starts.first() == Some(&0);
        if !sorted || starts.last().is_none_or(|&last| last as usize != labels.len()) {
            let problem = format!("where faces start does not rise from 0 to the {} labels that follow", labels.len());
            return Err(Bad { at, problem });
        }
        Ok(Rows { ends: starts.iter().skip(1).map(|&end| end as usize).collect(), labels })
    }

    /// Tuples of `components` scalars: Float32 where the file has binary ones of 4 bytes, else Float64.
    ///
    /// - `most`: how many a list may have that repeats one tuple
    pub(super) fn tuples(&mut self, components: usize, most: usize) -> Result<ArrayValues, Bad> {
        let start_at = self.words.at;
        let declared = match self.start()? {
            Start::Nothing => return Ok(ArrayValues::F64(Vec::new())),
            Start::Repeated(count) => {
                let mut tuple = Vec::new();
                self.tuple(components, &mut tuple)?;
                self.words.expect(b'}')?;
                return match count <= most {
                    true => Ok(ArrayValues::F64(tuple.repeat(count))),
                    false => Err(Bad {
                        at: start_at,
                        problem: format!("one value is repeated {count} times, {most} at most belong here"),
                    }),
                };
            }
            Start::Elements(declared) => declared,
        };
        if let (true, Some(count)) = (self.header.binary, declared) {
            let stated = [self.header.scalar_size];
            let (size, bytes) =
                self.bytes_of(count, components, if self.header.sizes_known { &stated } else { &[8, 4] })?;
            return Ok(match size {
                4 => ArrayValues::F32(self.numbers(bytes)),
                _ => ArrayValues::F64(self.numbers(bytes)),
            });
        }
        let mut values = Vec::new();
        while !matches!(self.words.peek(), None | Some(b')')) {
            self.tuple(components, &mut values)?;
        }
        self.finish(declared, values.len() / components.max(1))?;
        Ok(ArrayValues::F64(values))
    }

    /// One tuple: `(1 2 3)`, and a scalar without parentheses.
    fn tuple(&mut self, components: usize, values: &mut Vec<f64>) -> Result<(), Bad> {
        if components == 1 && self.words.peek() != Some(b'(') {
            values.push(self.words.number("a number")?);
            return Ok(());
        }
        self.words.expect(b'(')?;
        for _ in 0..components {
            values.push(self.words.number("a number")?);
        }
        self.words.expect(b')')
    }
}

fn to_label(wide: i64) -> Option<u32> {
    match wide {
        -1 => Some(NONE),
        _ => u32::try_from(wide).ok().filter(|&label| label != NONE),
    }
}
