//! The entries of a field's file, by which macros are replaced.

use super::words::{Bad, Token, Words, show};

/// How often a macro may name another one.
const DEEPEST_MACRO: usize = 16;

/// The entries of a file up to its field, for macros to name.
pub(super) struct Entries<'a> {
    /// Keyword, and where its value begins.
    entries: Vec<(&'a [u8], Words<'a>)>,
    /// What is included, as the file names it.
    pub(super) included: String,
}

impl<'a> Entries<'a> {
    /// Walks over a file's entries. It ends at `internalField`, as what follows may be long and is not needed, unless that comes
    /// first, so that a macro in it may be defined later; binary lists in what precedes would be misread, but no program writes them there.
    pub(super) fn read(mut words: Words<'a>) -> Self {
        let mut found = Self { entries: Vec::new(), included: String::new() };
        while let Some(token) = words.next() {
            match token {
                Token::Word(key) if key.starts_with(b"#") => {
                    let line = words.rest().split(|&b| b == b'\n').next().unwrap_or_default();
                    if key.starts_with(b"#include") && found.included.is_empty() {
                        found.included = String::from_utf8_lossy(line).trim().to_owned();
                    }
                    words.skip_line();
                }
                Token::Word(key) | Token::Quoted(key) => {
                    found.entries.push((key, words));
                    if key == b"internalField" {
                        break;
                    }
                    words.skip_entry();
                }
                Token::Mark(_) => {}
            }
        }
        found
    }

    pub(super) fn find(&self, key: &[u8]) -> Option<Words<'a>> {
        // Of entries of one name the last one holds.
        self.entries.iter().rev().find(|(name, _)| *name == key).map(|&(_, words)| words)
    }

    /// One tuple, in which macros stand for entries of the file; a reason where one of them is not there.
    pub(super) fn tuple(
        &self,
        mut words: Words<'a>,
        components: usize,
        values: &mut Vec<f64>,
        depth: usize,
    ) -> Result<Option<String>, Bad> {
        if words.peek() == Some(b'[') {
            // The unit that newer versions write there.
            while !matches!(words.next(), None | Some(Token::Mark(b']'))) {}
        }
        if let Some(name) = macro_name(words) {
            return self.expand(name, components, values, depth);
        }
        if components == 1 && words.peek() != Some(b'(') {
            values.push(words.number("a number")?);
            return Ok(None);
        }
        words.expect(b'(')?;
        for _ in 0..components {
            if let Some(name) = macro_name(words) {
                if let Some(reason) = self.expand(name, 1, values, depth)? {
                    return Ok(Some(reason));
                }
                words.next();
            } else {
                values.push(words.number("a number")?);
            }
        }
        words.expect(b')')?;
        Ok(None)
    }

    fn expand(
        &self,
        name: &[u8],
        components: usize,
        values: &mut Vec<f64>,
        depth: usize,
    ) -> Result<Option<String>, Bad> {
        let left_out = |why: String| Ok(Some(format!("its value is `{}`, {why}", show(name))));
        let plain = name.strip_prefix(b"$").unwrap_or(name);
        match self.find(plain) {
            Some(_) if depth >= DEEPEST_MACRO => left_out("which leads to itself".to_owned()),
            Some(words) => self.tuple(words, components, values, depth + 1),
            None if self.included.is_empty() => left_out("which the file does not define".to_owned()),
            None => {
                left_out(format!("which may come from the included {}; other files are not read for it", self.included))
            }
        }
    }
}

/// The macro that stands next, if one does.
fn macro_name(mut words: Words<'_>) -> Option<&[u8]> {
    match words.next() {
        Some(Token::Word(word)) if word.starts_with(b"$") || word.starts_with(b"#") => Some(word),
        _ => None,
    }
}
