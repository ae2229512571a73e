//! From the text of a scene file to its sections, and back.

use std::path::{Path, PathBuf};

use crate::file::SceneFile;

/// What is wrong with the text of a scene file, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{}{}{message}{}", path.display(), position.as_ref().map(Position::to_string).unwrap_or_default(),
    key.as_ref().map(|key| format!(", key {key}: ")).unwrap_or_else(|| ": ".to_owned()),
    position.as_ref().map(Position::excerpt).unwrap_or_default())]
pub struct SceneSyntaxError {
    /// The file.
    pub path: PathBuf,
    /// Where in it.
    pub position: Option<Position>,
    /// The key whose value is wrong, with its section: `quality.order`.
    pub key: Option<String>,
    /// What is wrong there.
    pub message: String,
}

/// A place in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Position {
    /// Counted from 1.
    pub line: usize,
    /// In characters, counted from 1.
    pub column: usize,
    /// The line itself.
    pub text: String,
}

impl std::fmt::Display for Position {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, ": line {}, column {}", self.line, self.column)
    }
}

impl Position {
    /// Longest part of a line that a message repeats, in characters; a minified file is one line.
    const LONGEST_EXCERPT: usize = 100;

    fn of_byte(text: &str, byte: usize) -> Self {
        let before = &text.as_bytes()[..byte.min(text.len())];
        let start = before.iter().rposition(|&b| b == b'\n').map_or(0, |newline| newline + 1);
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let column = String::from_utf8_lossy(&before[start..]).chars().count() + 1;
        Self { line, column, text: text[start..].lines().next().unwrap_or_default().to_owned() }
    }

    fn of_line(text: &str, line: usize, column: usize) -> Self {
        Self { line, column, text: text.lines().nth(line.saturating_sub(1)).unwrap_or_default().to_owned() }
    }

    /// The line with a mark under the place.
    fn excerpt(&self) -> String {
        if self.text.chars().count() > Self::LONGEST_EXCERPT || self.text.trim().is_empty() {
            return String::new();
        }
        let gutter = self.line.to_string();
        let indent: String =
            self.text.chars().take(self.column - 1).map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
        format!("\n{gutter} | {}\n{} | {indent}^", self.text, " ".repeat(gutter.len()))
    }
}

impl SceneFile {
    /// Understands a scene file's text: JSON if the path ends in `.json`, else TOML. The file itself is not opened.
    ///
    /// # Errors
    /// [`SceneSyntaxError`] with the place, for what is no TOML or JSON, an unknown key (the message lists those that are
    /// known there), a value of the wrong type or an unknown name.
    pub fn parse(text: &str, path: &Path) -> Result<Self, SceneSyntaxError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if is_json(path) {
            serde_json::from_str(text).map_err(|error| {
                // A value that ends too early is at line 0 for an empty text.
                let position = Some(Position::of_line(text, error.line().max(1), error.column().max(1)));
                let message = error.to_string();
                let place = format!(" at line {} column {}", error.line(), error.column());
                let message = reworded(message.strip_suffix(&place).unwrap_or(&message));
                SceneSyntaxError { path: path.to_owned(), position, key: None, message }
            })
        } else {
            toml::from_str(text).map_err(|error: toml::de::Error| {
                let position = error.span().map(|span| Position::of_byte(text, span.start));
                let message = reworded(error.message());
                SceneSyntaxError { path: path.to_owned(), position, key: key_of(&error), message }
            })
        }
    }

    /// The scene as TOML. Numbers are written with the fewest digits that give the same f64 back.
    ///
    /// # Errors
    /// A path that is not Unicode.
    pub fn to_toml(&self) -> Result<String, WriteSceneError> {
        toml::to_string(self)
            .map(|text| one_point_a_line(&text))
            .map_err(|e| WriteSceneError { problem: e.to_string() })
    }

    /// The scene as JSON, with the keys and values of [`SceneFile::to_toml`].
    ///
    /// # Errors
    /// A path that is not Unicode.
    pub fn to_json(&self) -> Result<String, WriteSceneError> {
        serde_json::to_string_pretty(self).map_err(|e| WriteSceneError { problem: e.to_string() })
    }
}

/// A scene that has no text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the scene cannot be written: {problem}")]
pub struct WriteSceneError {
    /// What the writer says.
    pub problem: String,
}

/// Whether a scene file of this name holds JSON.
pub(crate) fn is_json(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"))
}

/// The key in which a TOML error lies: the library tells it only in the message of an error that has lost its text.
fn key_of(error: &toml::de::Error) -> Option<String> {
    let mut bare = error.clone();
    bare.set_input(None);
    let message = bare.to_string();
    let (_, key) = message.trim_end().rsplit_once("\nin `")?;
    key.strip_suffix('`').map(str::to_owned)
}

/// The library's words for what this file calls keys and names.
fn reworded(message: &str) -> String {
    message
        .replace("unknown field ", "unknown key ")
        .replace("missing field ", "missing key ")
        .replace("duplicate field ", "repeated key ")
        .replace("unknown variant ", "unknown name ")
        .replace(", expected one of ", "; known here are ")
        .trim_end()
        .to_owned()
}

/// Breaks lists of lists, so that a transfer function has a line for every control point.
fn one_point_a_line(toml: &str) -> String {
    let mut out = String::with_capacity(toml.len() * 2);
    for line in toml.lines() {
        match line.split_once(" = [[") {
            Some((key, points)) if points.ends_with("]]") => {
                let points = points.trim_end_matches("]]").replace("], [", "],\n  [");
                out.push_str(&format!("{key} = [\n  [{points}],\n]\n"));
            }
            _ => {
                out.push_str(line);
                out.push('\n');
            }
        }
    }
    out
}
