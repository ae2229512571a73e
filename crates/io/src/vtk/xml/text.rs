//! Numbers as text inside an element, read on all threads.

use std::borrow::Cow;

use rayon::prelude::*;

use super::super::numbers::{BadWord, Scalar, turn_words};
use super::file::XmlFile;
use crate::IoError;

/// Bytes of text that one thread reads at a time.
const PIECE: usize = 1 << 18;

/// Turns all numbers into something, behind what is in `made` already; false as soon as one could not be, and then without the rest.
///
/// # Errors
/// [`IoError::Interrupted`]; inside, [`BadWord`] at the first word that is no number of this type.
pub(super) fn turn<S: Scalar, T: Copy + Send>(
    texts: &[Cow<'_, str>],
    file: &XmlFile<'_>,
    made: &mut Vec<T>,
    turn: impl Fn(S) -> Option<T> + Sync,
) -> Result<Result<bool, BadWord>, IoError> {
    let before = made.len();
    let mut rooms: Vec<Vec<T>> = Vec::new();
    for text in texts {
        let threads = if text.len() <= PIECE { 1 } else { rayon::current_num_threads() };
        let mut pieces = Pieces(text);
        loop {
            let batch: Vec<&str> = pieces.by_ref().take(threads).collect();
            if batch.is_empty() {
                break;
            }
            let so_far = made.len() - before;
            let bad = |bad: BadWord, from: usize| BadWord { index: from + bad.index, ..bad };
            if let [piece] = batch[..] {
                match turn_words(piece, made, &turn) {
                    Ok(true) => {}
                    Ok(false) => return Ok(Ok(false)),
                    Err(word) => return Ok(Err(bad(word, so_far))),
                }
            } else {
                rooms.resize_with(batch.len().max(rooms.len()), Vec::new);
                let work = |(piece, room): (&&str, &mut Vec<T>)| {
                    room.clear();
                    turn_words(piece, room, &turn)
                };
                let done: Vec<_> = batch.par_iter().zip(&mut rooms[..batch.len()]).map(work).collect();
                for (done, room) in done.into_iter().zip(&rooms) {
                    match done {
                        Ok(true) => made.extend_from_slice(room),
                        Ok(false) => return Ok(Ok(false)),
                        Err(word) => return Ok(Err(bad(word, made.len() - before))),
                    }
                }
            }
            file.advance(batch.iter().map(|piece| piece.len()).sum())?;
        }
    }
    Ok(Ok(true))
}

/// A text in pieces that end between words.
struct Pieces<'t>(&'t str);

impl<'t> Iterator for Pieces<'t> {
    type Item = &'t str;

    fn next(&mut self) -> Option<&'t str> {
        let rest = self.0;
        if rest.is_empty() {
            return None;
        }
        let from = PIECE.min(rest.len());
        let space = rest.as_bytes()[from..].iter().position(u8::is_ascii_whitespace);
        // White space of ASCII is no part of another character.
        let (piece, left) = rest.split_at(space.map_or(rest.len(), |space| from + space));
        self.0 = left;
        Some(piece)
    }
}

/// A text without white space, of which there usually is some before and after it alone.
pub(super) fn without_white_space<'t>(texts: &'t [Cow<'_, str>]) -> Cow<'t, str> {
    let mut words = texts.iter().flat_map(|text| text.split_ascii_whitespace());
    match (words.next(), words.next()) {
        (None, _) => Cow::Borrowed(""),
        (Some(word), None) => Cow::Borrowed(word),
        (Some(first), Some(second)) => Cow::Owned([first, second].into_iter().chain(words).collect()),
    }
}
