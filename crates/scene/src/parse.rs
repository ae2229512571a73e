//! From the text of a scene file to its sections, and back.

use std::path::{Path, PathBuf};

use crate::file::{OpacityName, SceneFile};

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
        // Not one character more or less: the mark stays where it belongs.
        let text: String = self
            .text
            .chars()
            .map(|c| if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c })
            .collect();
        format!("\n{gutter} | {text}\n{} | {indent}^", " ".repeat(gutter.len()))
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
        let scene: Self = if is_json(path) {
            serde_json::from_str(text).map_err(|error| {
                // A value that ends too early is at line 0 for an empty text.
                let position = Some(Position::of_line(text, error.line().max(1), error.column().max(1)));
                let message = error.to_string();
                let place = format!(" at line {} column {}", error.line(), error.column());
                let message = reworded(message.strip_suffix(&place).unwrap_or(&message));
                SceneSyntaxError { path: path.to_owned(), position, key: None, message }
            })?
        } else {
            toml::from_str(text).map_err(|error: toml::de::Error| {
                let position = error.span().map(|span| Position::of_byte(text, span.start));
                let message = reworded(error.message());
                let key = key_of(&error).map(|key| printable(&key));
                SceneSyntaxError { path: path.to_owned(), position, key, message }
            })?
        };
        match scene.key_with_control_characters() {
            None => Ok(scene),
            Some(key) => Err(SceneSyntaxError {
                path: path.to_owned(),
                position: None,
                key: Some(key.to_owned()),
                message: "it has control characters, which no name here has; remove them".to_owned(),
            }),
        }
    }

    /// A key whose text would make a terminal do anything where it is shown: all of them appear in messages.
    fn key_with_control_characters(&self) -> Option<&'static str> {
        let path = |path: &Path| path.to_string_lossy().contains(char::is_control);
        let text = |text: &Option<String>| text.as_deref().is_some_and(|text| text.contains(char::is_control));
        let keys = [
            ("mesh.path", path(&self.mesh.path)),
            ("mesh.solution", self.mesh.solution.as_deref().is_some_and(path)),
            ("mesh.field", text(&self.mesh.field)),
            ("mesh.raw", text(&self.mesh.raw)),
            ("transfer.colormap", text(&self.transfer.colormap)),
            ("transfer.preset", self.transfer.preset.as_deref().is_some_and(path)),
            ("transfer.preset_name", text(&self.transfer.preset_name)),
            (
                "transfer.opacity",
                matches!(&self.transfer.opacity, Some(OpacityName::Name(name)) if name.contains(char::is_control)),
            ),
            ("surface.path", self.surface.iter().any(|surface| path(&surface.path))),
            ("quality.adapter", text(&self.quality.adapter)),
        ];
        keys.into_iter().find_map(|(key, is_odd)| is_odd.then_some(key))
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
    printable(message)
        .replace("unknown field ", "unknown key ")
        .replace("missing field ", "missing key ")
        .replace("duplicate field ", "repeated key ")
        .replace("unknown variant ", "unknown name ")
        .replace(", expected one of ", "; known here are ")
        .trim_end()
        .to_owned()
}

/// Longest part of a message, in characters: unknown keys and names are repeated in it, and may be as long as the file.
const LONGEST_MESSAGE: usize = 1000;

/// A text with parts of a file in it, as it may be shown: without control characters, and not endless.
fn printable(text: &str) -> String {
    let shown = text.chars().map(|c| if c.is_control() && c != '\n' { char::REPLACEMENT_CHARACTER } else { c });
    if text.chars().count() <= LONGEST_MESSAGE {
        return shown.collect();
    }
    shown.take(LONGEST_MESSAGE).chain(" ...".chars()).collect()
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
