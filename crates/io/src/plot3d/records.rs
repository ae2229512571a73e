//! Fortran records: bytes between two equal marks, or bare bytes where a file has no marks.

use crate::bytes::{ByteCursor, ByteOrder, TooShort};

/// A file as a row of records of known sizes.
#[derive(Clone, Debug)]
pub(super) struct Records<'a> {
    cursor: ByteCursor<'a>,
    bytes: &'a [u8],
    order: ByteOrder,
    marks: bool,
}

/// Why a record is not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum RecordError {
    /// The file ends.
    #[error(transparent)]
    TooShort(#[from] TooShort),
    /// A mark says another size.
    #[error("the record mark at byte {at} says {found} bytes, {expected} are needed")]
    Mark {
        /// Where the mark stands.
        at: usize,
        /// What it says.
        found: u32,
        /// The record's size by the header.
        expected: u64,
    },
}

impl RecordError {
    pub(super) fn too_short(at: usize, wanted: usize, length: usize) -> Self {
        Self::TooShort(TooShort { at, wanted, held: length.saturating_sub(at) })
    }
}

impl<'a> Records<'a> {
    pub(super) fn new(bytes: &'a [u8], order: ByteOrder, marks: bool) -> Self {
        Self { cursor: ByteCursor::new(bytes, order), bytes, order, marks }
    }

    pub(super) fn has_marks(&self) -> bool {
        self.marks
    }

    /// Bytes of the whole file.
    pub(super) fn length(&self) -> usize {
        self.bytes.len()
    }

    /// The last `count` bytes of the file.
    pub(super) fn tail(&self, count: usize) -> &'a [u8] {
        &self.bytes[self.bytes.len().saturating_sub(count)..]
    }

    /// The next record, which must have `size` bytes.
    pub(super) fn record(&mut self, size: u64) -> Result<ByteCursor<'a>, RecordError> {
        self.mark(size)?;
        let body = self.cursor.take(usize::try_from(size).unwrap_or(usize::MAX))?;
        self.mark(size)?;
        Ok(ByteCursor::new(body, self.order))
    }

    /// The next record, which must hold `count` integers of 32 bits.
    pub(super) fn integers(&mut self, count: usize) -> Result<Vec<i32>, RecordError> {
        Ok(self.record((count as u64).saturating_mul(4))?.many(count)?)
    }

    fn mark(&mut self, expected: u64) -> Result<(), RecordError> {
        if !self.marks {
            return Ok(());
        }
        let at = self.cursor.position();
        let found: u32 = self.cursor.one()?;
        if u64::from(found) == expected { Ok(()) } else { Err(RecordError::Mark { at, found, expected }) }
    }
}
