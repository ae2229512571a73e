//! How much a file may stand for, where few bytes can stand for many: compressed arrays, arrays at one place, fill values.

use std::cell::Cell;

use crate::{IoError, Source};

/// Numbers that all arrays of a file together may have for each of its bytes; real ones stay below 1, and 4 where they are compressed.
const NUMBERS_PER_BYTE: u64 = 16;
/// What any file may have, however short.
const NUMBERS_AT_LEAST: u64 = 1 << 20;

/// Numbers that may still be taken from a file.
#[derive(Debug)]
pub(crate) struct Budget {
    left: Cell<u64>,
}

impl Budget {
    /// All that a file of this length may stand for.
    pub(crate) fn of(source: &Source) -> Self {
        Self { left: Cell::new(Self::whole(source)) }
    }

    /// The numbers that a file may stand for.
    pub(crate) fn whole(source: &Source) -> u64 {
        Self::of_length(source.bytes.len() as u64)
    }

    /// The numbers that a file of so many bytes may stand for.
    pub(crate) fn of_length(bytes: u64) -> u64 {
        bytes.saturating_mul(NUMBERS_PER_BYTE).saturating_add(NUMBERS_AT_LEAST)
    }

    /// Takes so many numbers; nothing may be reserved for them before.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where there are fewer left.
    pub(crate) fn take(&self, source: &Source, place: impl Into<String>, numbers: u64) -> Result<(), IoError> {
        match self.left.get().checked_sub(numbers) {
            Some(left) => {
                self.left.set(left);
                Ok(())
            }
            None => Err(source.invalid(
                place,
                format!(
                    "with its {numbers} numbers all arrays together have more than {NUMBERS_PER_BYTE} numbers a byte of the file, the limit"
                ),
                "write the file again without compression, or with fewer arrays",
            )),
        }
    }
}
