//! What the arrays of files may come to.

use std::cell::Cell;

/// Numbers that are decoded whatever the files' length is: 8 MiB of the widest type.
const NUMBERS_ALWAYS: usize = 1 << 20;

/// Numbers that all arrays of some files together may come to. Without compression a byte is one number at most, as text or
/// as bytes; what is more is compressed, or is named by several arrays at one offset. Without the bound, 100 kB of arrays that share an offset, or
/// of zeros that were compressed, are gigabytes.
#[derive(Debug, Default)]
pub(in crate::vtk) struct Budget {
    granted: Cell<usize>,
    per_byte: Cell<usize>,
    spent: Cell<usize>,
}

impl Budget {
    /// Grants what a file of this length may come to.
    pub(in crate::vtk) fn grant(&self, bytes: usize, per_byte: usize) {
        self.granted.set(self.granted.get().saturating_add(bytes.saturating_mul(per_byte)));
        self.per_byte.set(per_byte);
    }

    /// Takes so many numbers. The error says what the limit is, for the caller to add the place.
    pub(in crate::vtk) fn spend(&self, numbers: usize) -> Result<(), String> {
        let spent = self.spent.get().saturating_add(numbers);
        if spent > self.granted.get().max(NUMBERS_ALWAYS) {
            return Err(format!(
                "with its {numbers} numbers the arrays come to more than {} numbers a byte of the file \
                 (and to more than {NUMBERS_ALWAYS}), which is the limit; if the file is whole, save it without compression",
                self.per_byte.get()
            ));
        }
        self.spent.set(spent);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_add_up() {
        let budget = Budget::default();
        budget.grant(100_000, 16);
        budget.spend(1_500_000).unwrap();
        let error = budget.spend(200_000).unwrap_err();
        assert!(error.contains("16 numbers a byte") && error.contains("limit"), "{error}");
        budget.grant(100_000, 16);
        budget.spend(200_000).unwrap();
        assert!(budget.spend(usize::MAX).is_err());
    }
}
