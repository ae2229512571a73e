//! The faces that two processors both have, by the list of patches in `boundary`.

use super::{
    file::FoamFile,
    words::{Bad, Token, Words},
};
use crate::IoError;

/// Faces of a part that another one has too, in the same order and turned over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ProcessorPatch {
    /// The processor that has them.
    pub(super) own: usize,
    /// The other one that has them.
    pub(super) other: usize,
    /// The first of them.
    pub(super) first_face: usize,
    /// How many there are.
    pub(super) face_count: usize,
}

/// The patches of type `processor`, in the order of the file.
pub(super) fn processor_patches(file: &FoamFile) -> Result<Vec<ProcessorPatch>, IoError> {
    file.expect_class(&["polyBoundaryMesh"])?;
    read(file.words()).map_err(|bad| file.invalid(bad))
}

fn read(mut words: Words<'_>) -> Result<Vec<ProcessorPatch>, Bad> {
    let mut found = Vec::new();
    if words.peek() != Some(b'(') {
        words.number::<usize>("the number of patches")?;
    }
    words.expect(b'(')?;
    while !words.take_mark(b')') {
        // The patch's name.
        let Some(Token::Word(_) | Token::Quoted(_)) = words.next() else { return Err(words.bad_next("a patch")) };
        words.expect(b'{')?;
        let mut kind: &[u8] = b"";
        let mut numbers = [None; 4];
        while !words.take_mark(b'}') {
            let Some(Token::Word(key)) = words.next() else { return Err(words.bad_next("an entry of a patch")) };
            match key {
                b"type" => {
                    if let Some(Token::Word(word)) = { words }.next() {
                        kind = word;
                    }
                }
                b"nFaces" | b"startFace" | b"myProcNo" | b"neighbProcNo" => {
                    let number = { words }.number::<usize>("a number")?;
                    let place = [&b"nFaces"[..], b"startFace", b"myProcNo", b"neighbProcNo"]
                        .iter()
                        .position(|name| *name == key);
                    if let Some(slot) = place.and_then(|place| numbers.get_mut(place)) {
                        *slot = Some(number);
                    }
                }
                _ => {}
            }
            words.skip_entry();
        }
        // Those of `processorCyclic` lie elsewhere than their other side.
        if let (b"processor", [Some(face_count), Some(first_face), Some(own), Some(other)]) = (kind, numbers) {
            found.push(ProcessorPatch { own, other, first_face, face_count });
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_of_processors() {
        let text = b"2 ( walls { type wall; inGroups 1(wall); nFaces 5; startFace 4; }
            procBoundary0to1 { type processor; inGroups List<word> 1(processor); nFaces 2; startFace 9; matchTolerance 0.0001;
            transform { a b; } transform unknown; myProcNo 0; neighbProcNo 1; } )";
        let patch = ProcessorPatch { own: 0, other: 1, first_face: 9, face_count: 2 };
        assert_eq!(read(Words::new(text, 0)), Ok(vec![patch]));
        assert_eq!(read(Words::new(b"0()", 0)), Ok(vec![]));
        for length in 0..text.len() - 1 {
            assert!(read(Words::new(&text[..length], 0)).is_err(), "{length}");
        }
    }
}
