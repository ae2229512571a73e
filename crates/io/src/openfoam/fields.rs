//! Fields in cells and at points, of which a file holds one.

use std::path::{Path, PathBuf};

use tetrascope_mesh::ArrayValues;

use super::{
    entries::Entries,
    file::FoamFile,
    lists::ListReader,
    words::{Bad, Token, show},
};
use crate::IoError;

/// Whose values a field holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Owner {
    Cell,
    Point,
}

/// What a class of files holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// A field with so many numbers a cell or point.
    Field { owner: Owner, components: usize },
    /// A field on faces, which has no place in a volume.
    OnFaces,
    /// Anything else.
    Other,
}

/// The values of one field.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) owner: Owner,
    pub(super) components: usize,
    pub(super) values: ArrayValues,
}

/// What was read of a field's file.
pub(super) enum Outcome {
    Field(Field),
    /// Why it is left out.
    LeftOut(String),
}

/// Numbers that a case may make of the bytes that it has: a uniform field names its value once for all cells.
const FILLED_PER_BYTE: usize = 16;
/// Numbers that a case may make whatever its length.
const FILLED_ALWAYS: usize = 1 << 20;

/// How many numbers were made of how many bytes.
#[derive(Debug, Default)]
pub(super) struct Budget {
    /// Bytes of all files read, unpacked.
    pub(super) bytes: usize,
    filled: usize,
}

impl Budget {
    /// Counts numbers that stand in no file.
    ///
    /// # Errors
    /// A sentence, where they are too many.
    pub(super) fn fill(&mut self, count: Option<usize>) -> Result<(), String> {
        let limit = FILLED_ALWAYS.max(self.bytes.saturating_mul(FILLED_PER_BYTE));
        self.filled = count.and_then(|count| self.filled.checked_add(count)).unwrap_or(usize::MAX);
        if self.filled <= limit {
            return Ok(());
        }
        Err(format!(
            "uniform fields come to more than {FILLED_PER_BYTE} numbers for each byte of the case's files, {limit} in all"
        ))
    }
}

impl Class {
    /// By the name in a file's header.
    pub(super) fn of(name: &str) -> Self {
        let name = name.strip_suffix("::Internal").unwrap_or(name);
        let (owner, kind) = match (name.strip_prefix("vol"), name.strip_prefix("point"), name.strip_prefix("surface")) {
            (Some(kind), _, _) => (Owner::Cell, kind),
            (_, Some(kind), _) => (Owner::Point, kind),
            (_, _, Some(kind)) if kind.ends_with("Field") => return Self::OnFaces,
            _ => return Self::Other,
        };
        let kind = kind.strip_suffix("Field").unwrap_or_default();
        let kind =
            kind.strip_suffix("DimensionedInternal").or_else(|| kind.strip_suffix("Dimensioned")).unwrap_or(kind);
        let components = match kind {
            "Scalar" | "SphericalTensor" => 1,
            "Vector" => 3,
            "SymmTensor" => 6,
            "Tensor" => 9,
            _ => return Self::Other,
        };
        Self::Field { owner, components }
    }
}

impl Field {
    /// Reads a field's file, for a mesh with so many cells or points.
    ///
    /// # Errors
    /// [`IoError`] where the file is damaged, or uniform fields are too many for the case's length.
    pub(super) fn read(
        file: &FoamFile,
        name: String,
        (owner, components): (Owner, usize),
        expected: usize,
        budget: &mut Budget,
    ) -> Result<Outcome, IoError> {
        budget.bytes = budget.bytes.saturating_add(file.source.bytes.len());
        let internal = Entries::read(file.words());
        let Some(mut words) = internal.find(b"internalField").or_else(|| internal.find(b"value")) else {
            if internal.included.is_empty() {
                let at = file.source.bytes.len();
                return Err(file.invalid(Bad { at, problem: "there is no internalField".to_owned() }));
            }
            return Ok(Outcome::LeftOut(format!(
                "it has no internalField of its own and includes {}",
                internal.included
            )));
        };
        let before = words;
        match words.next() {
            Some(Token::Word(b"uniform")) => {
                let mut tuple = Vec::new();
                if let Some(reason) =
                    internal.tuple(words, components, &mut tuple, 0).map_err(|bad| file.invalid(bad))?
                {
                    return Ok(Outcome::LeftOut(reason));
                }
                budget.fill(expected.checked_mul(components)).map_err(|problem| {
                    file.source.invalid(
                        format!("field {name}"),
                        problem,
                        "remove the fields that are not needed from the time folder",
                    )
                })?;
                let values = ArrayValues::F64(tuple.repeat(expected));
                Ok(Outcome::Field(Self { name, owner, components, values }.in_order()))
            }
            Some(Token::Word(b"nonuniform")) => {
                if let Some(b'A'..=b'Z' | b'a'..=b'z') = words.peek() {
                    // `List<scalar>`
                    words.next();
                }
                let mut lists = ListReader { words: &mut words, header: &file.header };
                let values = lists.tuples(components, expected).map_err(|bad| file.invalid(bad))?;
                let held = values.len() / components;
                if held != expected {
                    let of = if owner == Owner::Cell { "cells" } else { "points" };
                    return Ok(Outcome::LeftOut(format!("it has {held} values for {expected} {of}")));
                }
                Ok(Outcome::Field(Self { name, owner, components, values }.in_order()))
            }
            Some(Token::Word(word)) if word.starts_with(b"#") || word.starts_with(b"$") => {
                Ok(Outcome::LeftOut(format!("its values are `{}`, which only OpenFOAM works out", show(word))))
            }
            _ => {
                let mut words = before;
                Err(file.invalid(words.bad_next("`uniform` or `nonuniform`")))
            }
        }
    }

    /// OpenFOAM's symmetric tensors are xx xy xz yy yz zz; here and in VTK they are xx yy zz xy yz xz.
    fn in_order(mut self) -> Self {
        fn turn<T>(values: &mut [T]) {
            for tuple in values.as_chunks_mut::<6>().0 {
                // xx xy xz yy yz zz -> xx yy xz xy yz zz -> xx yy zz xy yz xz
                tuple.swap(1, 3);
                tuple.swap(2, 5);
            }
        }
        if self.components == 6 {
            match &mut self.values {
                ArrayValues::F32(values) => turn(values),
                ArrayValues::F64(values) => turn(values),
                _ => {}
            }
        }
        self
    }
}

/// The files of a folder that may hold fields, by name; of a file that is there twice the one that is not compressed.
pub(super) fn field_files(folder: &Path) -> Vec<(String, PathBuf)> {
    let names = super::case::names_in(folder);
    let named = |name: &String| {
        let path = folder.join(name);
        let plain = name.strip_suffix(".gz").unwrap_or(name);
        let is_twice = plain != name && folder.join(plain).is_file();
        // An editor's copies, and those that a user keeps of the first step.
        let is_copy = [".orig", ".bak", "~"].iter().any(|end| plain.ends_with(end));
        (path.is_file() && !is_twice && !is_copy).then(|| (plain.to_owned(), path))
    };
    names.iter().filter_map(named).collect()
}
