//! One file of a case: its bytes, unpacked, and the header that says how its numbers are written.

use std::{
    fs::File,
    io::Read,
    path::{Path, PathBuf},
};

use flate2::read::MultiGzDecoder;

use super::words::{Bad, Token, Words};
use crate::{IoError, ReadOptions, Source, bytes::ByteOrder, opened::read_whole};

/// What to advise when a file is damaged.
pub(super) const DAMAGED: &str = "the file is cut off or damaged; write it again, or take another time step";

/// Bytes that a compressed file may hold a byte of its own. Text of one repeated digit comes to 1000; real meshes and fields come to 3 to 20.
const UNPACKED_PER_BYTE: u64 = 256;
/// What a compressed file may hold whatever its length.
const UNPACKED_ALWAYS: u64 = 16 << 20;
/// How much of a file is looked at for its header; the banner and a long note before it take about one KiB.
const PEEKED: u64 = 8 << 10;

/// What the dictionary `FoamFile` at the start says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// What the file holds: `vectorField`, `volScalarField`.
    pub(super) class: String,
    /// Whether lists are in binary.
    pub(super) binary: bool,
    /// Of the numbers of binary lists.
    pub(super) order: ByteOrder,
    /// Bytes of a label: 4 or 8.
    pub(super) label_size: usize,
    /// Bytes of a scalar: 4 or 8.
    pub(super) scalar_size: usize,
    /// Whether the sizes are stated; older programs do not.
    pub(super) sizes_known: bool,
    /// Where the content begins.
    pub(super) end: usize,
}

/// A file in memory.
#[derive(Debug)]
pub(super) struct FoamFile {
    /// Its path and unpacked bytes.
    pub(super) source: Source,
    /// Its header.
    pub(super) header: Header,
    /// Which processor's block of a larger file it is.
    pub(super) block: Option<usize>,
}

/// The path of a file, which may be there compressed instead.
pub(super) fn existing(path: &Path) -> Option<PathBuf> {
    if path.is_file() {
        return Some(path.to_owned());
    }
    let mut packed = path.as_os_str().to_owned();
    packed.push(".gz");
    let packed = PathBuf::from(packed);
    packed.is_file().then_some(packed)
}

/// The class in a file's header without reading the rest; nothing for files of other kinds.
pub(super) fn peek_class(path: &Path) -> Option<String> {
    let mut start = Vec::new();
    let file = File::open(path).ok()?;
    if is_packed(path) {
        // A damaged or short stream may still have given the header.
        let _ = MultiGzDecoder::new(file).take(PEEKED).read_to_end(&mut start);
    } else {
        file.take(PEEKED).read_to_end(&mut start).ok()?;
    }
    Header::parse(&start).map(|header| header.class)
}

fn is_packed(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "gz")
}

impl FoamFile {
    /// Reads a file, compressed or not.
    ///
    /// # Errors
    /// Where the system does not give it, it is packed more tightly than [`UNPACKED_PER_BYTE`], or has no header.
    pub(super) fn open(path: &Path, options: &ReadOptions) -> Result<Self, IoError> {
        let mut source = Source { path: path.to_owned(), bytes: read_whole(path, options)?, ..Source::default() };
        if is_packed(path) {
            source.bytes = unpack(&source)?;
        }
        Self::of(source)
    }

    /// From unpacked bytes.
    pub(super) fn of(source: Source) -> Result<Self, IoError> {
        let Some(header) = Header::parse(&source.bytes) else {
            return Err(source.invalid(
                "the start",
                "there is no whole header `FoamFile { ... }` with a class",
                DAMAGED,
            ));
        };
        Ok(Self { source, header, block: None })
    }

    /// The content behind the header.
    pub(super) fn words(&self) -> Words<'_> {
        Words::new(&self.source.bytes, self.header.end)
    }

    /// What was wrong, with its line; a byte where the file is binary.
    pub(super) fn invalid(&self, bad: Bad) -> IoError {
        let before = self.source.bytes.get(..bad.at).unwrap_or_default();
        let place = if self.header.binary {
            format!("byte {}", bad.at)
        } else {
            format!("line {}", before.iter().filter(|&&b| b == b'\n').count() + 1)
        };
        let place = match self.block {
            Some(block) => format!("the block of processor {block}, {place}"),
            None => place,
        };
        self.source.invalid(place, bad.problem, DAMAGED)
    }

    /// Fails unless the class is one of these.
    pub(super) fn expect_class(&self, classes: &[&str]) -> Result<(), IoError> {
        let class = self.header.class.as_str();
        if classes.contains(&class) {
            return Ok(());
        }
        let problem = format!("its class is `{class}`, not {}", classes.join(" or "));
        Err(self.source.invalid(
            "the header",
            problem,
            "name the folder of a case; this is another file under its name",
        ))
    }
}

fn unpack(source: &Source) -> Result<Vec<u8>, IoError> {
    let limit = UNPACKED_ALWAYS.max(UNPACKED_PER_BYTE.saturating_mul(source.bytes.len() as u64));
    let mut unpacked = Vec::new();
    MultiGzDecoder::new(source.bytes.as_slice()).take(limit + 1).read_to_end(&mut unpacked).map_err(|error| {
        let problem =
            format!("the compressed data cannot be unpacked beyond {} bytes: {error}", unpacked_length(&source.bytes));
        source.invalid("the compressed data", problem, DAMAGED)
    })?;
    if unpacked.len() as u64 > limit {
        let problem = format!("more than {UNPACKED_PER_BYTE} bytes are packed into each byte, {limit} and more in all");
        return Err(source.invalid("the compressed data", problem, "unpack it with gunzip"));
    }
    Ok(unpacked)
}

/// How far a damaged stream goes; told in messages, so that a user knows what was lost.
fn unpacked_length(bytes: &[u8]) -> u64 {
    let mut counted = 0_u64;
    let mut block = [0_u8; 4096];
    let mut decoder = MultiGzDecoder::new(bytes);
    while let Ok(read @ 1..) = decoder.read(&mut block) {
        counted += read as u64;
        if counted > UNPACKED_ALWAYS {
            break;
        }
    }
    counted
}

impl Header {
    /// The header at the start of a file, behind comments; nothing where there is none.
    pub(super) fn parse(bytes: &[u8]) -> Option<Self> {
        let mut words = Words::new(bytes, 0);
        if words.next()? != Token::Word(b"FoamFile") || words.next()? != Token::Mark(b'{') {
            return None;
        }
        let mut header = Self {
            class: String::new(),
            binary: false,
            order: ByteOrder::Little,
            label_size: 4,
            scalar_size: 8,
            sizes_known: false,
            end: 0,
        };
        loop {
            let key = match words.next()? {
                Token::Mark(b'}') => break,
                Token::Word(key) => key,
                Token::Mark(b';') => continue,
                _ => return None,
            };
            let value = match words.next()? {
                Token::Word(value) | Token::Quoted(value) => value,
                Token::Mark(b';') => continue,
                Token::Mark(_) => return None,
            };
            match key {
                b"class" => header.class = String::from_utf8_lossy(value).into_owned(),
                b"format" => header.binary = value == b"binary",
                b"arch" => header.take_arch(&String::from_utf8_lossy(value)),
                _ => {}
            }
            words.skip_entry();
        }
        header.end = words.at;
        (!header.class.is_empty()).then_some(header)
    }

    /// `LSB;label=32;scalar=64`
    fn take_arch(&mut self, arch: &str) {
        for part in arch.split(';') {
            match part.trim() {
                "LSB" => self.order = ByteOrder::Little,
                "MSB" => self.order = ByteOrder::Big,
                "label=32" => (self.label_size, self.sizes_known) = (4, true),
                "label=64" => (self.label_size, self.sizes_known) = (8, true),
                "scalar=32" => (self.scalar_size, self.sizes_known) = (4, true),
                "scalar=64" => (self.scalar_size, self.sizes_known) = (8, true),
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers() {
        let text = "/* banner */\nFoamFile\n{\n version 2.0;\n format binary;\n arch \"MSB;label=64;scalar=32\";\n \
                    note \"a; b }\";\n class volScalarField;\n}\nrest";
        let header = Header::parse(text.as_bytes()).unwrap();
        assert_eq!((header.label_size, header.scalar_size, header.order), (8, 4, ByteOrder::Big));
        assert!(header.binary && header.sizes_known && header.class == "volScalarField");
        assert_eq!(&text[header.end..], "\nrest");
        for broken in
            ["", "FoamFile", "FoamFile {", "FoamFile { class x;", "FoamFile { }", "Foam { class x; }", "FoamFile { ( }"]
        {
            assert_eq!(Header::parse(broken.as_bytes()), None, "{broken}");
        }
    }
}
