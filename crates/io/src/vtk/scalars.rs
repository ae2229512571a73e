//! Numbers of a declared type, from words of text or from bytes.

use tetrascope_mesh::ArrayValues;

pub(crate) use super::numbers::BadWord;
use super::numbers::{from_bytes, from_words};

/// The type of an array's numbers as its file declares it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ScalarType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// The order of the bytes of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ByteOrder {
    Little,
    Big,
}

/// Runs one expression with `$t` as the Rust type of a scalar type.
macro_rules! with_type {
    ($scalar:expr, $t:ident => $body:expr) => {
        match $scalar {
            ScalarType::I8 => {
                type $t = i8;
                $body
            }
            ScalarType::U8 => {
                type $t = u8;
                $body
            }
            ScalarType::I16 => {
                type $t = i16;
                $body
            }
            ScalarType::U16 => {
                type $t = u16;
                $body
            }
            ScalarType::I32 => {
                type $t = i32;
                $body
            }
            ScalarType::U32 => {
                type $t = u32;
                $body
            }
            ScalarType::I64 => {
                type $t = i64;
                $body
            }
            ScalarType::U64 => {
                type $t = u64;
                $body
            }
            ScalarType::F32 => {
                type $t = f32;
                $body
            }
            ScalarType::F64 => {
                type $t = f64;
                $body
            }
        }
    };
}
pub(crate) use with_type;

/// Runs one expression with `$t` as the Rust type of a scalar type, and wraps the vector that it gives.
macro_rules! for_type {
    ($scalar:expr, $t:ident => $body:expr) => {
        match $scalar {
            ScalarType::I8 => {
                type $t = i8;
                ArrayValues::I8($body)
            }
            ScalarType::U8 => {
                type $t = u8;
                ArrayValues::U8($body)
            }
            ScalarType::I16 => {
                type $t = i16;
                ArrayValues::I16($body)
            }
            ScalarType::U16 => {
                type $t = u16;
                ArrayValues::U16($body)
            }
            ScalarType::I32 => {
                type $t = i32;
                ArrayValues::I32($body)
            }
            ScalarType::U32 => {
                type $t = u32;
                ArrayValues::U32($body)
            }
            ScalarType::I64 => {
                type $t = i64;
                ArrayValues::I64($body)
            }
            ScalarType::U64 => {
                type $t = u64;
                ArrayValues::U64($body)
            }
            ScalarType::F32 => {
                type $t = f32;
                ArrayValues::F32($body)
            }
            ScalarType::F64 => {
                type $t = f64;
                ArrayValues::F64($body)
            }
        }
    };
}
pub(crate) use for_type;

impl ScalarType {
    /// Bytes a number takes.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Whether its numbers are whole.
    pub(crate) fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Numbers from bytes; what is left over behind the last whole number is not read.
    pub(crate) fn decode_bytes(self, bytes: &[u8], order: ByteOrder) -> ArrayValues {
        for_type!(self, T => from_bytes::<T>(bytes, order))
    }

    /// Numbers from words, at most `limit` of them; fewer where the words end before.
    ///
    /// # Errors
    /// [`BadWord`] at the first word that is no number of this type.
    pub(crate) fn parse_words(
        self,
        words: &mut dyn Iterator<Item = &str>,
        limit: usize,
    ) -> Result<ArrayValues, BadWord> {
        Ok(for_type!(self, T => from_words::<T>(words, limit)?))
    }
}

/// Whole numbers as they are used for indices. Nothing for arrays of floating-point numbers; numbers beyond `i64` become
/// its largest, which no index reaches.
pub(crate) fn to_indices(values: &ArrayValues) -> Option<Vec<i64>> {
    Some(match values {
        ArrayValues::I8(v) => v.iter().map(|&x| x.into()).collect(),
        ArrayValues::U8(v) => v.iter().map(|&x| x.into()).collect(),
        ArrayValues::I16(v) => v.iter().map(|&x| x.into()).collect(),
        ArrayValues::U16(v) => v.iter().map(|&x| x.into()).collect(),
        ArrayValues::I32(v) => v.iter().map(|&x| x.into()).collect(),
        ArrayValues::U32(v) => v.iter().map(|&x| x.into()).collect(),
        ArrayValues::I64(v) => v.clone(),
        ArrayValues::U64(v) => v.iter().map(|&x| i64::try_from(x).unwrap_or(i64::MAX)).collect(),
        ArrayValues::F32(_) | ArrayValues::F64(_) => return None,
    })
}

/// Puts the numbers of `more` behind those of `values`; `false`, and nothing done, where their types differ.
pub(crate) fn append(values: &mut ArrayValues, more: ArrayValues) -> bool {
    use ArrayValues::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    match (values, more) {
        (I8(a), I8(b)) => a.extend(b),
        (U8(a), U8(b)) => a.extend(b),
        (I16(a), I16(b)) => a.extend(b),
        (U16(a), U16(b)) => a.extend(b),
        (I32(a), I32(b)) => a.extend(b),
        (U32(a), U32(b)) => a.extend(b),
        (I64(a), I64(b)) => a.extend(b),
        (U64(a), U64(b)) => a.extend(b),
        (F32(a), F32(b)) => a.extend(b),
        (F64(a), F64(b)) => a.extend(b),
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(scalar: ScalarType, text: &str) -> Result<ArrayValues, BadWord> {
        scalar.parse_words(&mut text.split_ascii_whitespace(), usize::MAX)
    }

    #[test]
    fn words_for_what_is_no_number() {
        let ArrayValues::F64(v) = words(ScalarType::F64, "nan -nan NaN inf -inf 1.#INF -1.#IND nan(ind) 2").unwrap()
        else {
            panic!("not Float64")
        };
        assert!(v[0].is_nan() && v[1].is_nan() && v[2].is_nan() && v[6].is_nan() && v[7].is_nan());
        assert_eq!((v[3], v[4], v[5], v[8]), (f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, 2.0));
    }

    #[test]
    fn a_bad_word_is_named_with_its_place() {
        let bad = words(ScalarType::F32, "1 2 three").unwrap_err();
        assert_eq!((bad.index, bad.word.as_str()), (2, "three"));
        assert_eq!(words(ScalarType::U8, "1 300").unwrap_err().word, "300");
    }

    #[test]
    fn bytes_in_either_order() {
        let ArrayValues::I16(v) = ScalarType::I16.decode_bytes(&[1, 0, 0xff, 0xff, 9], ByteOrder::Little) else {
            panic!("not Int16")
        };
        assert_eq!(v, [1, -1]);
        let ArrayValues::U32(v) = ScalarType::U32.decode_bytes(&[0, 0, 1, 2], ByteOrder::Big) else {
            panic!("not UInt32")
        };
        assert_eq!(v, [258]);
    }

    #[test]
    fn indices_beyond_i64_stay_out_of_reach() {
        assert_eq!(to_indices(&ArrayValues::U64(vec![3, u64::MAX])), Some(vec![3, i64::MAX]));
        assert_eq!(to_indices(&ArrayValues::F32(vec![3.0])), None);
    }
}
