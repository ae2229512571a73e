//! The data of one array behind its header: pieces that are unpacked apart from each other, on all threads, and turned into numbers at once.
//!
//! What is alive at a time is a batch of pieces as they are stored and unpacked, and what was made of all before. Memory for what a batch makes
//! is taken after its pieces were found to be able to hold that much.

use std::ops::Range;

use rayon::prelude::*;

use super::compression::{Compressor, Decompressor};
use super::encoded::{Problem, Stored, characters, decode};
use super::file::XmlFile;
use crate::IoError;

/// Bytes of a batch for each thread, unpacked.
const BATCH: usize = 1 << 20;

/// Most bytes of a batch.
const LARGEST_BATCH: usize = 1 << 24;

/// Most pieces of a batch, which may be empty.
const PIECES: usize = 4096;

/// Bytes of a piece where nothing is compressed: whole numbers of any type, and whole groups of base64.
const PIECE: usize = 3 << 16;

/// Bytes that are not worth a second thread.
const ALONE: usize = 1 << 17;

/// The data of an array, whose length was found to be there.
#[derive(Debug)]
pub(super) enum Body<'a> {
    /// Bytes as they are.
    Plain(Stored<'a>),
    /// `length` bytes of base64, encoded together with `before` bytes before them.
    Base64 { characters: &'a [u8], before: usize, length: usize },
    /// Compressed blocks; the last one may be of another size.
    Blocks(Blocks<'a>),
}

/// Compressed blocks, one behind the other.
#[derive(Debug)]
pub(super) struct Blocks<'a> {
    pub(super) stored: Stored<'a>,
    /// Of each as it is stored; together as many as are stored.
    pub(super) lengths: Vec<usize>,
    pub(super) size: usize,
    pub(super) last_size: usize,
    pub(super) compressor: Compressor,
}

/// What is unpacked at once.
#[derive(Debug)]
struct Piece {
    /// Where it is stored.
    stored: Range<usize>,
    /// Bytes to pass over once it is unpacked.
    skipped: usize,
    /// Bytes that are wanted.
    length: usize,
}

/// What a thread needs for unpacking, kept from batch to batch.
#[derive(Default)]
struct Worker {
    decompressor: Option<Decompressor>,
    bytes: Vec<u8>,
}

/// What turns bytes into as many of something, and says whether it could.
pub(super) type Put<'p, T> = &'p (dyn Fn(&[u8], &mut [T]) -> bool + Sync);

impl Body<'_> {
    /// Bytes when unpacked.
    pub(super) fn length(&self) -> usize {
        match self {
            Self::Plain(stored) => stored.length(),
            Self::Base64 { length, .. } => *length,
            Self::Blocks(blocks) => blocks.length(),
        }
    }

    /// Turns all numbers into something, behind what is in `made` already; false as soon as some could not be, and then without the rest.
    ///
    /// - `size`: bytes of a number, of which the length is a multiple
    /// - `blank`: stands for what is not made yet
    ///
    /// # Errors
    /// Damaged base64 or blocks, and blocks that are not as large as they say; files that cannot be read; interruption.
    pub(super) fn turn<T: Copy + Send>(
        self,
        file: &XmlFile<'_>,
        size: usize,
        made: &mut Vec<T>,
        blank: T,
        put: Put<'_, T>,
    ) -> Result<bool, Problem> {
        if let Self::Blocks(blocks) = &self
            && !blocks.size.is_multiple_of(size)
            && blocks.lengths.len() > 1
        {
            // Numbers lie across the ends of blocks.
            let mut bytes = Vec::new();
            self.turn(file, 1, &mut bytes, 0, &|from: &[u8], to: &mut [u8]| {
                to.copy_from_slice(from);
                true
            })?;
            return Body::Plain(Stored::Memory(bytes.into())).turn(file, size, made, blank, put);
        }
        if !matches!(self, Self::Blocks(_)) {
            made.try_reserve_exact(self.length() / size).map_err(|_| no_memory(self.length()))?;
        }
        let mut pieces = self.pieces();
        let (mut batch, mut room) = (Vec::new(), Vec::new());
        let (mut workers, mut before): (Vec<Worker>, usize) = (Vec::new(), 0);
        let threads = if self.length() < ALONE { 1 } else { rayon::current_num_threads() };
        let most = (BATCH * threads).min(LARGEST_BATCH);
        loop {
            let mut length = 0_usize;
            batch.clear();
            while length < most && batch.len() < PIECES {
                let Some(piece) = pieces.next() else { break };
                length = length.saturating_add(piece.length);
                batch.push(piece);
            }
            let (Some(first), Some(last)) = (batch.first(), batch.last()) else { break };
            let stored = first.stored.start..last.stored.end;
            let bytes = self.stored(stored.clone(), &mut room)?;
            file.advance(stored.len())?;
            self.check(&batch, bytes, before)?;

            let from = made.len();
            let count = length / size;
            made.try_reserve(count).map_err(|_| no_memory(length))?;
            made.resize(from + count, blank);
            let used = if length < ALONE { 1 } else { threads };
            workers.resize_with(used.max(workers.len()), Worker::default);
            let share = batch.len().div_ceil(used);
            let mut places = &mut made[from..];
            let mut jobs = Vec::with_capacity(used);
            for (number, (pieces, worker)) in batch.chunks(share).zip(&mut workers).enumerate() {
                let count = pieces.iter().map(|piece| piece.length / size).sum();
                let own = places.split_off_mut(..count).unwrap_or_default();
                jobs.push((before + number * share, pieces, own, worker));
            }
            let work = |(number, pieces, own, worker): (usize, &[Piece], &mut [T], &mut Worker)| {
                self.unpack(number, pieces, stored.start, bytes, worker, size, own, put)
            };
            let all = if used == 1 {
                jobs.into_iter().map(work).try_fold(true, |all, one| one.map(|one| all && one))
            } else {
                // Of several errors the first one is told, whichever thread came first.
                let done: Vec<Result<bool, String>> = jobs.into_par_iter().map(work).collect();
                done.into_iter().try_fold(true, |all, one| one.map(|one| all && one))
            };
            if !all? {
                return Ok(false);
            }
            before += batch.len();
        }
        Ok(true)
    }

    /// Some bytes as they are stored.
    fn stored<'s>(&'s self, range: Range<usize>, room: &'s mut Vec<u8>) -> Result<&'s [u8], IoError> {
        match self {
            Self::Plain(stored) | Self::Blocks(Blocks { stored, .. }) => stored.get(range, room),
            Self::Base64 { characters, .. } => Ok(characters.get(range).unwrap_or_default()),
        }
    }

    fn pieces(&self) -> Box<dyn Iterator<Item = Piece> + '_> {
        match self {
            Self::Plain(stored) => {
                let end = stored.length();
                Box::new((0..end).step_by(PIECE).map(move |start| {
                    let stored = start..end.min(start + PIECE);
                    Piece { skipped: 0, length: stored.len(), stored }
                }))
            }
            Self::Base64 { characters, before, length } => Box::new(base64_pieces(characters.len(), *before, *length)),
            Self::Blocks(blocks) => {
                let mut at = 0;
                Box::new(blocks.lengths.iter().enumerate().map(move |(number, &length)| {
                    let start = at;
                    at += length;
                    Piece { stored: start..at, skipped: 0, length: blocks.size_of(number) }
                }))
            }
        }
    }

    /// Whether compressed blocks can hold what they are to hold.
    fn check(&self, batch: &[Piece], bytes: &[u8], before: usize) -> Result<(), String> {
        let (Self::Blocks(blocks), Some(start)) = (self, batch.first().map(|piece| piece.stored.start)) else {
            return Ok(());
        };
        for (number, piece) in batch.iter().enumerate() {
            let block = within(bytes, piece, start);
            blocks.compressor.check(block, piece.length).map_err(|problem| blocks.named(before + number, &problem))?;
        }
        Ok(())
    }

    /// Unpacks pieces and turns them into numbers.
    ///
    /// - `number`: that of the first of them
    /// - `bytes`: what is stored from byte `start` on
    #[expect(clippy::too_many_arguments, reason = "all of them are what one thread is given")]
    fn unpack<T>(
        &self,
        number: usize,
        pieces: &[Piece],
        start: usize,
        bytes: &[u8],
        worker: &mut Worker,
        size: usize,
        mut made: &mut [T],
        put: Put<'_, T>,
    ) -> Result<bool, String> {
        let mut all = true;
        for (index, piece) in pieces.iter().enumerate() {
            let stored = within(bytes, piece, start);
            worker.bytes.clear();
            let plain = match self {
                Self::Plain(_) => stored,
                Self::Base64 { .. } => {
                    decode(stored, piece.stored.start, &mut worker.bytes)?;
                    let wanted = piece.skipped..piece.skipped + piece.length;
                    worker.bytes.get(wanted).ok_or_else(|| {
                        format!("its base64 is damaged (padding before character {})", piece.stored.end)
                    })?
                }
                Self::Blocks(blocks) => {
                    let decompressor = worker.decompressor.get_or_insert_with(|| Decompressor::new(blocks.compressor));
                    decompressor
                        .decompress(stored, piece.length, &mut worker.bytes)
                        .map_err(|problem| blocks.named(number + index, &problem))?;
                    &worker.bytes
                }
            };
            let own = made.split_off_mut(..piece.length / size).unwrap_or_default();
            all &= put(plain, own);
        }
        Ok(all)
    }
}

impl Blocks<'_> {
    /// Bytes of all blocks when they are inflated.
    fn length(&self) -> usize {
        match self.lengths.len().checked_sub(1) {
            Some(last) => last.saturating_mul(self.size).saturating_add(self.last_size),
            None => 0,
        }
    }

    fn size_of(&self, number: usize) -> usize {
        if number + 1 == self.lengths.len() { self.last_size } else { self.size }
    }

    fn named(&self, number: usize, problem: &str) -> String {
        format!("compressed block {number} of {}: {problem}", self.lengths.len())
    }
}

/// A piece of what is stored from byte `start` on.
fn within<'b>(bytes: &'b [u8], piece: &Piece, start: usize) -> &'b [u8] {
    bytes.get(piece.stored.start - start..piece.stored.end - start).unwrap_or_default()
}

/// Pieces of base64 that begin with whole groups of characters, and but for the first one with whole numbers.
fn base64_pieces(there: usize, before: usize, length: usize) -> impl Iterator<Item = Piece> {
    let groups_fit = |end: usize| (before + end).is_multiple_of(3);
    let first = [0, 8, 16].map(|more| PIECE + more).into_iter().find(|&end| groups_fit(end)).unwrap_or(PIECE);
    let mut start = 0;
    std::iter::from_fn(move || {
        if start >= length {
            return None;
        }
        let end = if start == 0 { first } else { start + PIECE }.min(length);
        let skipped = if start == 0 { before } else { 0 };
        let from = if start == 0 { 0 } else { (before + start) / 3 * 4 };
        let piece = Piece { stored: from..characters(before + end).min(there), skipped, length: end - start };
        start = end;
        Some(piece)
    })
}

fn no_memory(bytes: usize) -> Problem {
    Problem::Words(format!("its {bytes} bytes are more memory than the system gives"))
}
