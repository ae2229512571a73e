//! Files into which several processors have written together, one block each (`decomposedBlockData`).

use std::{
    collections::HashMap,
    path::{Path, PathBuf},
};

use super::{
    file::{FoamFile, Header, existing},
    words::{Bad, Words},
};
use crate::{IoError, ReadOptions, Source};

/// The class of such files.
const COLLATED: &str = "decomposedBlockData";

/// Files that were read once and are handed out block by block, so that none is read once for every processor.
#[derive(Debug)]
pub(super) struct Blocks {
    files: HashMap<PathBuf, Collated>,
    /// Who is told how far it is, with nothing else.
    options: ReadOptions,
}

#[derive(Debug)]
struct Collated {
    /// What every block holds.
    class: String,
    /// Number of blocks.
    count: usize,
    /// Those that were not taken yet.
    blocks: Vec<Option<FoamFile>>,
}

impl Blocks {
    /// None yet; all files are read with the progress of these options.
    pub(super) fn new(options: &ReadOptions) -> Self {
        let options = ReadOptions { progress: options.progress.clone(), ..ReadOptions::default() };
        Self { files: HashMap::new(), options }
    }

    /// Opens a file by its path without `.gz`, or what one processor has written into it.
    pub(super) fn open(&mut self, path: &Path, block: Option<usize>) -> Result<FoamFile, IoError> {
        let path = existing(path).unwrap_or_else(|| path.to_owned());
        let Some(block) = block else { return FoamFile::open(&path, &self.options) };
        let file = self.load(&path)?;
        let count = file.count;
        file.blocks.get_mut(block).and_then(Option::take).ok_or_else(|| {
            let source = Source { path: path.clone(), ..Source::default() };
            let problem = format!("there are {count} blocks, and processor {block} has none");
            source.invalid("the end", problem, super::file::DAMAGED)
        })
    }

    /// How many processors have written into a file.
    pub(super) fn count(&mut self, path: &Path) -> Result<usize, IoError> {
        let path = existing(path).unwrap_or_else(|| path.to_owned());
        Ok(self.load(&path)?.count)
    }

    /// What a file holds.
    pub(super) fn class(&mut self, path: &Path) -> Result<String, IoError> {
        Ok(self.load(path)?.class.clone())
    }

    /// Gives up the content of a file that is not needed.
    pub(super) fn forget(&mut self, path: &Path) {
        if let Some(file) = self.files.get_mut(path) {
            file.blocks = Vec::new();
        }
    }

    fn load(&mut self, path: &Path) -> Result<&mut Collated, IoError> {
        if !self.files.contains_key(path) {
            let read = Collated::read(path, &self.options)?;
            self.files.insert(path.to_owned(), read);
        }
        self.files
            .get_mut(path)
            .ok_or_else(|| IoError::Read { path: path.to_owned(), source: std::io::ErrorKind::NotFound.into() })
    }
}

impl Collated {
    fn read(path: &Path, options: &ReadOptions) -> Result<Self, IoError> {
        let file = FoamFile::open(path, options)?;
        file.expect_class(&[COLLATED])?;
        let contents = split(file.words()).map_err(|bad| file.invalid(bad))?;
        // The first block alone has a header of its own, which holds for all.
        let Some(first) = contents.first().and_then(|bytes| Header::parse(bytes)) else {
            let problem = "the first block has no header that says what the blocks hold".to_owned();
            return Err(file.invalid(Bad { at: file.header.end, problem }));
        };
        let block = |(number, bytes): (usize, &&[u8])| {
            let header = Header::parse(bytes).unwrap_or_else(|| Header { end: 0, ..first.clone() });
            let source = Source { path: path.to_owned(), bytes: bytes.to_vec(), ..Source::default() };
            Some(FoamFile { source, header, block: Some(number) })
        };
        let blocks: Vec<_> = contents.iter().enumerate().map(block).collect();
        Ok(Self { class: first.class, count: blocks.len(), blocks })
    }
}

/// Lists of characters, one behind the other: `12(............)`.
fn split(mut words: Words<'_>) -> Result<Vec<&[u8]>, Bad> {
    let mut blocks = Vec::new();
    while words.peek().is_some() {
        let length = words.number::<usize>("the length of a block")?;
        if length == 0 && words.peek() != Some(b'(') {
            blocks.push(b"".as_slice());
            continue;
        }
        words.expect(b'(')?;
        let Some(block) = words.rest().get(..length) else {
            let problem = format!("a block of {length} bytes begins there, {} are left", words.rest().len());
            return Err(Bad { at: words.at, problem });
        };
        blocks.push(block);
        words.at += length;
        words.expect(b')')?;
    }
    Ok(blocks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_by_their_lengths() {
        let text = b"// Processor0\n3\n(a)b)\n\n// Processor1\n0()\n0\n2(()) // end";
        assert_eq!(split(Words::new(text, 0)), Ok(vec![&b"a)b"[..], b"", b"", b"()"]));
        for (broken, part) in
            [(&b"x"[..], "length"), (b"4(ab)", "4 bytes"), (b"1(ab)", "`)`"), (b"9999999999999(", "0 are left")]
        {
            let bad = split(Words::new(broken, 0)).unwrap_err();
            assert!(bad.problem.contains(part), "{}", bad.problem);
        }
    }
}
