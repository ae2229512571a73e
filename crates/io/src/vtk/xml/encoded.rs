//! Bytes of an array in their encoding, of which headers are taken at once and data in pieces.

use std::borrow::Cow;
use std::ops::Range;

use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{DecodeError, Engine};

use crate::{IoError, OpenFile};

/// Writers differ in whether they pad the end, and in the bits that fill the last character.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// What is wrong with an array: in words, for the caller to add the place, or with the file or the patience of the user.
#[derive(Debug)]
pub(super) enum Problem {
    Words(String),
    Failed(IoError),
}

impl From<String> for Problem {
    fn from(words: String) -> Self {
        Self::Words(words)
    }
}

impl From<IoError> for Problem {
    fn from(error: IoError) -> Self {
        Self::Failed(error)
    }
}

/// Bytes that stand somewhere.
#[derive(Clone, Debug)]
pub(super) enum Stored<'a> {
    Memory(Cow<'a, [u8]>),
    /// From `start` to `end` of a file that is not in memory.
    Open {
        file: &'a OpenFile,
        start: usize,
        end: usize,
    },
}

impl Stored<'_> {
    /// How many there are.
    pub(super) fn length(&self) -> usize {
        match self {
            Self::Memory(bytes) => bytes.len(),
            Self::Open { start, end, .. } => end.saturating_sub(*start),
        }
    }

    /// Some of them, which are there; those of a file go into `room`.
    pub(super) fn get<'s>(&'s self, range: Range<usize>, room: &'s mut Vec<u8>) -> Result<&'s [u8], IoError> {
        match self {
            Self::Memory(bytes) => Ok(bytes.get(range).unwrap_or_default()),
            Self::Open { file, start, .. } => {
                file.read_at(start + range.start, range.len(), room)?;
                Ok(room)
            }
        }
    }
}

/// Bytes still in their encoding; what was taken is gone.
#[derive(Clone, Debug)]
pub(super) enum Encoded<'a> {
    Raw(&'a [u8]),
    Open { file: &'a OpenFile, start: usize, end: usize },
    Base64(&'a [u8]),
}

impl<'a> Encoded<'a> {
    /// The next `count` bytes, which in base64 were encoded together: they end with a whole group of four characters.
    pub(super) fn take(&mut self, count: usize) -> Result<Cow<'a, [u8]>, Problem> {
        if let Self::Base64(rest) = self {
            // More bytes than characters cannot be there, and below that the sum does not overflow.
            if count > rest.len() {
                return Err(too_short(count, rest.len() / 4 * 3));
            }
            let (taken, left) = rest.split_at(characters(count).min(rest.len()));
            let mut bytes = Vec::new();
            decode(taken, 0, &mut bytes)?;
            if bytes.len() < count {
                return Err(too_short(count, bytes.len()));
            }
            bytes.truncate(count);
            *rest = left;
            return Ok(Cow::Owned(bytes));
        }
        Ok(match self.take_stored(count)? {
            Stored::Memory(bytes) => bytes,
            stored @ Stored::Open { .. } => {
                let mut bytes = Vec::new();
                stored.get(0..count, &mut bytes)?;
                Cow::Owned(bytes)
            }
        })
    }

    /// The same, left where they are unless they are base64.
    pub(super) fn take_stored(&mut self, count: usize) -> Result<Stored<'a>, Problem> {
        match self {
            Self::Raw(rest) => {
                let (taken, left) = rest.split_at_checked(count).ok_or_else(|| too_short(count, rest.len()))?;
                *rest = left;
                Ok(Stored::Memory(Cow::Borrowed(taken)))
            }
            Self::Open { file, start, end } => {
                let there = end.saturating_sub(*start);
                if count > there {
                    return Err(too_short(count, there));
                }
                let taken = Stored::Open { file, start: *start, end: *start + count };
                *start += count;
                Ok(taken)
            }
            Self::Base64(_) => self.take(count).map(Stored::Memory),
        }
    }

    /// Whether the next `count` bytes were encoded apart from what follows: their last group is padded just so.
    pub(super) fn is_apart(&self, count: usize) -> bool {
        match self {
            Self::Raw(_) | Self::Open { .. } => true,
            Self::Base64(rest) => {
                let padding = (3 - count % 3) % 3;
                padding > 0 && rest.get(characters(count) - padding) == Some(&b'=')
            }
        }
    }
}

/// Characters of so many bytes in base64, the last group filled up.
pub(super) fn characters(bytes: usize) -> usize {
    bytes.div_ceil(3) * 4
}

/// Appends the bytes of some characters.
///
/// - `at`: how many characters are before them, for messages
pub(super) fn decode(characters: &[u8], at: usize, bytes: &mut Vec<u8>) -> Result<(), String> {
    BASE64.decode_vec(characters, bytes).map_err(|error| {
        let error = match error {
            DecodeError::InvalidByte(offset, byte) => DecodeError::InvalidByte(offset + at, byte),
            DecodeError::InvalidLength(length) => DecodeError::InvalidLength(length + at),
            other => other,
        };
        format!("its base64 is damaged ({error})")
    })
}

/// More was declared than there is.
pub(super) fn too_short(needed: usize, there: usize) -> Problem {
    Problem::Words(format!("{needed} bytes are declared, but only {there} are left in the file"))
}
