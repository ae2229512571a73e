//! Checked reading of numbers from bytes in either byte order.

use std::fmt;

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// The least significant one, as on most machines of today.
    Little,
    /// The most significant one.
    Big,
}

impl ByteOrder {
    /// That of the machine that this runs on.
    pub(crate) const NATIVE: Self = if cfg!(target_endian = "big") { Self::Big } else { Self::Little };
}

impl fmt::Display for ByteOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Little => "little-endian",
            Self::Big => "big-endian",
        })
    }
}

/// A number of fixed size that can stand in a binary file.
pub(crate) trait Number: Copy {
    /// Bytes a number.
    const SIZE: usize;

    /// The number in the first [`Number::SIZE`] bytes; `None` when there are fewer.
    fn from_bytes(bytes: &[u8], order: ByteOrder) -> Option<Self>;
}

macro_rules! number {
    ($($type:ty),*) => {$(
        impl Number for $type {
            const SIZE: usize = size_of::<$type>();

            fn from_bytes(bytes: &[u8], order: ByteOrder) -> Option<Self> {
                let &bytes = bytes.first_chunk()?;
                Some(match order {
                    ByteOrder::Little => Self::from_le_bytes(bytes),
                    ByteOrder::Big => Self::from_be_bytes(bytes),
                })
            }
        }
    )*};
}
number!(i8, u8, i16, u16, i32, u32, i64, u64, f32, f64);

/// More bytes were asked for than there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{wanted} bytes are needed at byte {at}, {held} are left")]
pub(crate) struct TooShort {
    /// Where the read began.
    pub(crate) at: usize,
    /// What was asked for; `usize::MAX` when the count does not fit.
    pub(crate) wanted: usize,
    /// What was there.
    pub(crate) held: usize,
}

/// A place in a byte slice, which only moves forward and never past the end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByteCursor<'a> {
    bytes: &'a [u8],
    position: usize,
    order: ByteOrder,
}

impl<'a> ByteCursor<'a> {
    /// Starts at the first byte.
    pub(crate) fn new(bytes: &'a [u8], order: ByteOrder) -> Self {
        Self { bytes, position: 0, order }
    }

    /// Bytes read so far.
    pub(crate) fn position(&self) -> usize {
        self.position
    }

    /// All that was not read yet.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.position..).unwrap_or_default()
    }

    /// The next `count` bytes; a failed read does not move.
    pub(crate) fn take(&mut self, count: usize) -> Result<&'a [u8], TooShort> {
        let rest = self.rest();
        let taken = rest.get(..count).ok_or(TooShort { at: self.position, wanted: count, held: rest.len() })?;
        self.position += count;
        Ok(taken)
    }

    /// The next number.
    pub(crate) fn one<T: Number>(&mut self) -> Result<T, TooShort> {
        let short = TooShort { at: self.position, wanted: T::SIZE, held: self.rest().len() };
        T::from_bytes(self.take(T::SIZE)?, self.order).ok_or(short)
    }

    /// The next `count` numbers. Memory is reserved only once the bytes are known to be there.
    pub(crate) fn many<T: Number>(&mut self, count: usize) -> Result<Vec<T>, TooShort> {
        let wanted = count.saturating_mul(T::SIZE);
        let order = self.order;
        Ok(self.take(wanted)?.chunks_exact(T::SIZE).filter_map(|bytes| T::from_bytes(bytes, order)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_orders() {
        let bytes = [0, 0, 1, 2, 0x3f, 0x80, 0, 0];
        let mut big = ByteCursor::new(&bytes, ByteOrder::Big);
        assert_eq!(big.one::<i32>(), Ok(0x102));
        assert_eq!(big.one::<f32>(), Ok(1.0));
        let mut little = ByteCursor::new(&bytes, ByteOrder::Little);
        assert_eq!(little.many::<u16>(2), Ok(vec![0, 0x201]));
        assert_eq!(little.position(), 4);
    }

    #[test]
    fn a_count_that_is_only_declared_reserves_nothing() {
        let mut cursor = ByteCursor::new(&[1, 2, 3], ByteOrder::Little);
        assert_eq!(cursor.many::<f64>(usize::MAX), Err(TooShort { at: 0, wanted: usize::MAX, held: 3 }));
        assert_eq!(cursor.one::<i32>(), Err(TooShort { at: 0, wanted: 4, held: 3 }));
        assert_eq!(cursor.take(3), Ok(&[1, 2, 3][..]), "a failed read does not move");
        assert_eq!(cursor.many::<f64>(0), Ok(vec![]));
    }
}
