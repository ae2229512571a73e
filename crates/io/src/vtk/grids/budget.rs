//! What the arrays of files may come to.

use std::cell::Cell;

/// What arrays may come to, a byte of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::vtk) enum Limit {
    /// Numbers of any type. Without compression a byte is one number at most, as text or as bytes; what is more is compressed, or is named by several
    /// arrays at one offset.
    NumbersAByte(usize),
    /// Bytes in memory.
    BytesAByte(usize),
}

/// Granted whatever the files' length is: 8 MiB, in bytes or as numbers of the widest type.
const BYTES_ALWAYS: usize = 8 << 20;

impl Limit {
    /// What so many numbers cost, and what is granted always.
    fn cost(self, numbers: usize, size: usize) -> (usize, usize) {
        match self {
            Self::NumbersAByte(_) => (numbers, BYTES_ALWAYS / 8),
            Self::BytesAByte(_) => (numbers.saturating_mul(size), BYTES_ALWAYS),
        }
    }

    fn unit(self) -> (usize, &'static str) {
        match self {
            Self::NumbersAByte(count) => (count, "numbers"),
            Self::BytesAByte(count) => (count, "bytes"),
        }
    }
}

/// What all arrays of some files together may come to. Without the bound, 100 kB of arrays that share an offset, or of zeros that were compressed,
/// are gigabytes.
#[derive(Debug)]
pub(in crate::vtk) struct Budget {
    limit: Limit,
    granted: Cell<usize>,
    spent: Cell<usize>,
}

impl Budget {
    /// A budget for files of one kind.
    pub(in crate::vtk) fn new(limit: Limit) -> Self {
        Self { limit, granted: Cell::new(0), spent: Cell::new(0) }
    }

    /// Grants what a file of this length may come to.
    pub(in crate::vtk) fn grant(&self, bytes: usize) {
        let (per_byte, _) = self.limit.unit();
        self.granted.set(self.granted.get().saturating_add(bytes.saturating_mul(per_byte)));
    }

    /// What was taken so far, to be [restored](Self::restore).
    pub(in crate::vtk) fn spent(&self) -> usize {
        self.spent.get()
    }

    /// Gives back all that was taken since: it is to be taken again.
    pub(in crate::vtk) fn restore(&self, spent: usize) {
        self.spent.set(spent);
    }

    /// Takes so many numbers of `size` bytes. The error says what the limit is, for the caller to add the place.
    pub(in crate::vtk) fn spend(&self, numbers: usize, size: usize) -> Result<(), String> {
        let (cost, always) = self.limit.cost(numbers, size);
        let spent = self.spent.get().saturating_add(cost);
        if spent > self.granted.get().max(always) {
            let (per_byte, unit) = self.limit.unit();
            return Err(format!(
                "with its {numbers} numbers the mesh comes to more than {per_byte} {unit} a byte of the file (and to more than {always}), \
                 which is the limit; if the file is whole, save it without compression"
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
        let budget = Budget::new(Limit::NumbersAByte(16));
        budget.grant(100_000);
        budget.spend(1_500_000, 4).unwrap();
        let error = budget.spend(200_000, 1).unwrap_err();
        assert!(error.contains("16 numbers a byte") && error.contains("limit"), "{error}");
        budget.grant(100_000);
        budget.spend(200_000, 8).unwrap();
        assert!(budget.spend(usize::MAX, 8).is_err());
        let budget = Budget::new(Limit::BytesAByte(1024));
        budget.spend(1 << 20, 8).unwrap();
        let error = budget.spend(1, 1).unwrap_err();
        assert!(error.contains("1024 bytes a byte"), "{error}");
    }
}
