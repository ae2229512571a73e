//! The types that the samples of a volume have, from bytes and from words.

use std::fmt;

use tetrascope_mesh::ArrayValues;

use crate::bytes::{ByteOrder, Number};

/// The type of a volume's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names are the definitions")]
pub enum SampleType {
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

/// Runs one expression with `$t` as the Rust type of a sample type, and wraps the vector that it gives.
macro_rules! of_type {
    ($sample:expr, $t:ident => $body:expr) => {
        match $sample {
            SampleType::I8 => {
                type $t = i8;
                ArrayValues::I8($body)
            }
            SampleType::U8 => {
                type $t = u8;
                ArrayValues::U8($body)
            }
            SampleType::I16 => {
                type $t = i16;
                ArrayValues::I16($body)
            }
            SampleType::U16 => {
                type $t = u16;
                ArrayValues::U16($body)
            }
            SampleType::I32 => {
                type $t = i32;
                ArrayValues::I32($body)
            }
            SampleType::U32 => {
                type $t = u32;
                ArrayValues::U32($body)
            }
            SampleType::I64 => {
                type $t = i64;
                ArrayValues::I64($body)
            }
            SampleType::U64 => {
                type $t = u64;
                ArrayValues::U64($body)
            }
            SampleType::F32 => {
                type $t = f32;
                ArrayValues::F32($body)
            }
            SampleType::F64 => {
                type $t = f64;
                ArrayValues::F64($body)
            }
        }
    };
}

impl SampleType {
    /// Bytes that a sample takes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The type of a name as C, numpy, NRRD or Rust have it, in capitals or not: "unsigned short", "uint16", "uint16_t", "u16".
    pub fn of_name(name: &str) -> Option<Self> {
        let lower = name.to_ascii_lowercase();
        let words: Vec<&str> = lower.split_whitespace().collect();
        Some(match words.join(" ").as_str() {
            "i8" | "int8" | "int8_t" | "signed char" | "schar" => Self::I8,
            "u8" | "uint8" | "uint8_t" | "unsigned char" | "uchar" | "byte" => Self::U8,
            "i16" | "int16" | "int16_t" | "short" | "short int" | "signed short" | "signed short int" => Self::I16,
            "u16" | "uint16" | "uint16_t" | "ushort" | "unsigned short" | "unsigned short int" => Self::U16,
            "i32" | "int32" | "int32_t" | "int" | "signed int" => Self::I32,
            "u32" | "uint32" | "uint32_t" | "uint" | "unsigned int" => Self::U32,
            "i64"
            | "int64"
            | "int64_t"
            | "longlong"
            | "long long"
            | "long long int"
            | "signed long long"
            | "signed long long int" => Self::I64,
            "u64" | "uint64" | "uint64_t" | "ulonglong" | "unsigned long long" | "unsigned long long int" => Self::U64,
            "f32" | "float32" | "float" => Self::F32,
            "f64" | "float64" | "double" => Self::F64,
            _ => return None,
        })
    }

    /// All samples in some bytes; what is left over behind the last whole one is not read.
    pub(crate) fn decode(self, bytes: &[u8], order: ByteOrder) -> ArrayValues {
        of_type!(self, T => bytes.chunks_exact(T::SIZE).filter_map(|bytes| T::from_bytes(bytes, order)).collect())
    }

    /// Appends the sample that a word stands for, as bytes of this machine's order ([`ByteOrder::NATIVE`]); false where it stands for none.
    pub(crate) fn append_word(self, word: &str, bytes: &mut Vec<u8>) -> bool {
        macro_rules! append {
            ($t:ty) => {
                word.parse::<$t>().is_ok_and(|sample| {
                    bytes.extend_from_slice(&sample.to_ne_bytes());
                    true
                })
            };
        }
        match self {
            Self::I8 => append!(i8),
            Self::U8 => append!(u8),
            Self::I16 => append!(i16),
            Self::U16 => append!(u16),
            Self::I32 => append!(i32),
            Self::U32 => append!(u32),
            Self::I64 => append!(i64),
            Self::U64 => append!(u64),
            Self::F32 => append!(f32),
            Self::F64 => append!(f64),
        }
    }
}

impl fmt::Display for SampleType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::I8 => "int8",
            Self::U8 => "uint8",
            Self::I16 => "int16",
            Self::U16 => "uint16",
            Self::I32 => "int32",
            Self::U32 => "uint32",
            Self::I64 => "int64",
            Self::U64 => "uint64",
            Self::F32 => "float32",
            Self::F64 => "float64",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_back() {
        use SampleType::*;
        for sample in [I8, U8, I16, U16, I32, U32, I64, U64, F32, F64] {
            assert_eq!(SampleType::of_name(&sample.to_string()), Some(sample));
            let mut bytes = Vec::new();
            assert!(sample.append_word("7", &mut bytes));
            assert_eq!(bytes.len(), sample.size());
            assert_eq!(sample.decode(&bytes, ByteOrder::NATIVE).to_f64(), [7.0]);
        }
        assert_eq!(SampleType::of_name("Unsigned  SHORT"), Some(U16));
        // Whether it has a sign is up to the compiler.
        assert_eq!(SampleType::of_name("char"), None);
    }

    #[test]
    fn words_that_are_no_samples() {
        for (sample, word) in [(SampleType::U8, "256"), (SampleType::I8, "1.0"), (SampleType::F32, "1,5")] {
            assert!(!sample.append_word(word, &mut Vec::new()), "{word}");
        }
        let mut bytes = Vec::new();
        assert!(SampleType::F64.append_word("-NaN", &mut bytes) && SampleType::F64.append_word("-inf", &mut bytes));
        let ArrayValues::F64(samples) = SampleType::F64.decode(&bytes, ByteOrder::NATIVE) else { panic!() };
        assert!(samples[0].is_nan() && samples[1] == f64::NEG_INFINITY);
    }
}
