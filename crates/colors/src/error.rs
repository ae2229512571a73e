//! What goes wrong with names and presets: what, where, and what to do.

/// Why there is no color map or opacity curve.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ColorError {
    /// Nothing has this name.
    #[error("no {what} is called \"{name}\"; {remedy}")]
    UnknownName {
        /// The kind of thing: a color map, an opacity curve, a preset of a file.
        what: String,
        /// The name as it was given, without control characters.
        name: String,
        /// The nearest names, or how to list all.
        remedy: String,
    },
    /// A file of presets, or points that were given, break the rules.
    #[error("{file}: {place}: {problem}; {remedy}")]
    Invalid {
        /// The file, or what stands for it.
        file: String,
        /// Where in it: a line and column, a preset's name and a point's number.
        place: String,
        /// What is wrong there, with the value found and its limits.
        problem: String,
        /// What the user can do.
        remedy: String,
    },
    /// The file may be fine but has nothing that can be used here.
    #[error("{file}: {what} is not supported; {remedy}")]
    Unsupported {
        /// The file.
        file: String,
        /// The feature, with the preset's name.
        what: String,
        /// What the user can do.
        remedy: String,
    },
}

/// Characters of a file's words that a message shows.
const SHOWN: usize = 200;

/// Words of a file for a message: no control characters, no great length.
pub(crate) fn shown(words: &str) -> String {
    let mut shown: String =
        words.chars().take(SHOWN).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect();
    if words.chars().nth(SHOWN).is_some() {
        shown.push('…');
    }
    shown
}
