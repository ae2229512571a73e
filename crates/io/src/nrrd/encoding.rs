//! From the bytes of a part to its samples: as they are, compressed, or as text.

use std::{borrow::Cow, ops::Range};

use super::header::{Header, MEND};
use crate::{IoError, SampleType, Source, bytes::ByteOrder, raw::most_packed_samples, unpack::Packing};

/// How samples are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Raw,
    Packed(Packing),
    Hex,
    Text,
}

/// How the samples of every part are to be found in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) encoding: Encoding,
    pub(super) sample: SampleType,
    /// Of what [`Layout::samples`] gives.
    pub(super) order: ByteOrder,
    /// Lines before the data, compressed or not.
    lines: usize,
    /// Bytes before the data, behind the lines and once it is unpacked. A negative number says that the data ends -1 - `skip` bytes before the end.
    skip: i64,
}

/// The bytes of samples, and whether there is more behind the part.
type Samples<'a> = (Cow<'a, [u8]>, bool);

impl Layout {
    /// What a header says.
    pub(super) fn new(source: &Source, header: &Header<'_>, warnings: &mut Vec<String>) -> Result<Self, IoError> {
        let field = header.needed(source, "type")?;
        let sample = SampleType::of_name(&field.text).ok_or_else(|| match field.text.as_str() {
            "block" => source.unsupported("an NRRD file of blocks", "write it with samples of a type of numbers"),
            text => {
                field.invalid(source, format!("`{text}` is no type of samples: uint8, short, float and their kin are"))
            }
        })?;
        let field = header.needed(source, "encoding")?;
        let encoding = match field.text.to_ascii_lowercase().as_str() {
            "raw" => Encoding::Raw,
            "txt" | "text" | "ascii" => Encoding::Text,
            "hex" => Encoding::Hex,
            "gz" | "gzip" => Encoding::Packed(Packing::Gzip),
            "bz2" | "bzip2" => Encoding::Packed(Packing::Bzip2),
            _ => {
                let what = format!("the NRRD encoding `{}`", field.text);
                return Err(source.unsupported(what, "write it with raw, gzip, bzip2, hex or text"));
            }
        };
        let order = match header.field("endian") {
            _ if encoding == Encoding::Text => ByteOrder::NATIVE,
            Some(field) => match field.text.to_ascii_lowercase().as_str() {
                "little" => ByteOrder::Little,
                "big" => ByteOrder::Big,
                _ => return Err(field.invalid(source, format!("`{}` is neither little nor big", field.text))),
            },
            None => {
                if sample.size() > 1 {
                    warnings.push("the header does not say which byte comes first; little-endian was taken".to_owned());
                }
                ByteOrder::Little
            }
        };
        let lines = header.integer(source, "line skip")?;
        let lines = usize::try_from(lines)
            .map_err(|_| source.invalid("the field `line skip`", format!("{lines} lines cannot be skipped"), MEND))?;
        let skip = header.integer(source, "byte skip")?;
        if skip < 0 && matches!(encoding, Encoding::Hex | Encoding::Text) {
            let problem = format!("{skip} counts from the end, where data as text does not begin at any place");
            return Err(source.invalid("the field `byte skip`", problem, MEND));
        }
        Ok(Self { encoding, sample, order, lines, skip })
    }

    /// Whether so many bytes can hold so many samples at all. Nothing is reserved for samples before this was asked.
    ///
    /// - `place`: where the bytes are, for messages
    pub(super) fn check_capacity(
        &self,
        source: &Source,
        place: &str,
        samples: usize,
        bytes: usize,
    ) -> Result<(), IoError> {
        let (most, why) = match self.encoding {
            Encoding::Raw => (bytes / self.sample.size(), "hold"),
            Encoding::Hex => (bytes / 2 / self.sample.size(), "hold"),
            Encoding::Text => (bytes.div_ceil(2), "hold"),
            Encoding::Packed(_) => (most_packed_samples(bytes), "may stand for, compressed,"),
        };
        if samples <= most {
            return Ok(());
        }
        let problem =
            format!("{samples} samples of {} are declared, and {bytes} bytes {why} {most} at most", self.sample);
        let remedy = match self.encoding {
            Encoding::Packed(_) => "check that the file is complete, or write it with the encoding raw",
            _ => "check that the file is complete",
        };
        Err(source.invalid(place, problem, remedy))
    }

    /// Some samples of a part.
    ///
    /// - `place`: the part, for messages
    /// - `count`: how many samples the part has
    /// - `range`: which of these are wanted
    pub(super) fn samples<'a>(
        &self,
        source: &Source,
        place: &str,
        part: &'a [u8],
        count: usize,
        range: Range<usize>,
    ) -> Result<Samples<'a>, IoError> {
        let invalid = |problem: String| source.invalid(place, problem, "check that the file is complete");
        self.check_capacity(source, place, count, part.len())?;
        let data = behind_lines(part, self.lines)
            .ok_or_else(|| invalid(format!("it has fewer than the {} lines to be skipped", self.lines)))?;
        let size = self.sample.size();
        // Within `count`, of which the capacity was checked; compressed it is beyond what can be counted only where that is beyond the limit.
        let [start, end, whole] = [range.start, range.end, count].map(|samples| samples.saturating_mul(size));
        match self.encoding {
            Encoding::Raw => {
                let short =
                    || format!("{whole} bytes are needed behind a skip of {}, and there are {}", self.skip, data.len());
                let at = self.start(data.len(), whole).ok_or_else(|| invalid(short()))?;
                let all = data.get(at..).and_then(|data| data.get(..whole)).ok_or_else(|| invalid(short()))?;
                let more = self.skip >= 0 && data.len() - at > whole;
                all.get(start..end).map(|bytes| (Cow::Borrowed(bytes), more)).ok_or_else(|| invalid(short()))
            }
            Encoding::Packed(packing) => self.unpack(packing, data, start..end, whole).map_err(invalid),
            Encoding::Hex => self.unhex(data, start..end, whole).map_err(invalid),
            Encoding::Text => self.words(data, range, count).map_err(invalid),
        }
    }

    /// Where the data begins in so many bytes, of which it takes `whole`.
    fn start(&self, bytes: usize, whole: usize) -> Option<usize> {
        match usize::try_from(self.skip) {
            Ok(skip) => Some(skip),
            Err(_) => bytes.checked_sub(whole)?.checked_sub(usize::try_from(-1 - self.skip).ok()?),
        }
    }

    fn unpack(
        &self,
        packing: Packing,
        data: &[u8],
        range: Range<usize>,
        whole: usize,
    ) -> Result<Samples<'static>, String> {
        let most = most_packed_samples(data.len()).saturating_mul(self.sample.size());
        let beyond = || {
            format!(
                "with what is to be skipped it stands for more than {most} bytes, which a compressed file of its length may"
            )
        };
        let declared = format!("{whole} bytes behind a skip of {}", self.skip);
        let short = |found: usize| format!("it unpacks to {found} bytes, where {declared} are declared");
        let Ok(skip) = usize::try_from(self.skip) else {
            let all = packing.inflate(data, 0, most)?;
            if all.more && all.bytes.len() == most {
                return Err(beyond());
            }
            let at = self.start(all.bytes.len(), whole).ok_or_else(|| short(all.bytes.len()))?;
            let bytes = all.bytes.get(at + range.start..at + range.end).ok_or_else(|| short(all.bytes.len()))?;
            return Ok((Cow::Owned(bytes.to_vec()), false));
        };
        if skip.saturating_add(whole) > most {
            return Err(beyond());
        }
        let unpacked = packing.inflate(data, skip + range.start, range.len())?;
        if unpacked.bytes.len() < range.len() {
            return Err(short((skip + range.start).saturating_add(unpacked.bytes.len())));
        }
        Ok((Cow::Owned(unpacked.bytes), unpacked.more && range.end == whole))
    }

    /// Two digits a byte; white space counts for nothing.
    fn unhex(&self, data: &[u8], range: Range<usize>, whole: usize) -> Result<Samples<'static>, String> {
        let data = self.behind_skip(data)?;
        let mut digits = data.iter().filter(|byte| !byte.is_ascii_whitespace());
        let mut bytes = Vec::new();
        for index in 0..range.end {
            let mut digit = || -> Result<u8, String> {
                let &byte =
                    digits.next().ok_or_else(|| format!("it ends behind {index} bytes, where {whole} are declared"))?;
                let value = char::from(byte).to_digit(16).and_then(|value| u8::try_from(value).ok());
                value.ok_or_else(|| format!("byte {index} has `{}` for a hexadecimal digit", char::from(byte)))
            };
            let byte = digit()? << 4 | digit()?;
            if index >= range.start {
                bytes.push(byte);
            }
        }
        let more = range.end == whole && digits.next().is_some();
        Ok((Cow::Owned(bytes), more))
    }

    /// Numbers with white space or commas between them, as bytes of this machine's order.
    fn words(&self, data: &[u8], range: Range<usize>, count: usize) -> Result<Samples<'static>, String> {
        let data = self.behind_skip(data)?;
        let is_between = |byte: &u8| byte.is_ascii_whitespace() || *byte == b',';
        let mut words = data.split(is_between).filter(|word| !word.is_empty());
        let mut bytes = Vec::new();
        for index in 0..range.end {
            let word =
                words.next().ok_or_else(|| format!("it ends behind {index} samples, where {count} are declared"))?;
            if index < range.start {
                continue;
            }
            if !std::str::from_utf8(word).is_ok_and(|word| self.sample.append_word(word, &mut bytes)) {
                let found: String = String::from_utf8_lossy(word).chars().take(40).collect();
                return Err(format!("sample {index}, `{found}`, is no {}", self.sample));
            }
        }
        let more = range.end == count && words.next().is_some();
        Ok((Cow::Owned(bytes), more))
    }

    fn behind_skip<'a>(&self, data: &'a [u8]) -> Result<&'a [u8], String> {
        let skip = usize::try_from(self.skip).ok();
        let behind = skip.and_then(|skip| data.get(skip..));
        behind.ok_or_else(|| format!("it has {} bytes, fewer than the {} to be skipped", data.len(), self.skip))
    }
}

impl Encoding {
    /// Its name for users.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Raw => "raw",
            Self::Packed(packing) => packing.label(),
            Self::Hex => "hex",
            Self::Text => "text",
        }
    }
}

/// What comes behind so many lines.
fn behind_lines(bytes: &[u8], lines: usize) -> Option<&[u8]> {
    let mut rest = bytes;
    for _ in 0..lines {
        let end = rest.iter().position(|&byte| byte == b'\n')?;
        rest = rest.get(end + 1..)?;
    }
    Some(rest)
}
