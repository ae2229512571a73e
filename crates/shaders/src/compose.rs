//! Joining files.

use std::fmt::Write;

use crate::program::ShaderError;
use crate::sources::SOURCES;

/// A slot and the file that fills it.
pub type Slot<'a> = (&'a str, &'a str);

/// The text of a file of the folder `shaders`.
fn source(path: &str) -> Option<&'static str> {
    SOURCES.iter().find(|(name, _)| *name == path).map(|(_, text)| *text)
}

/// A file after all that it uses, each once.
pub(crate) fn join(path: &str, slots: &[Slot<'_>]) -> Result<String, ShaderError> {
    let mut joined = String::new();
    let mut done = Vec::new();
    add(path, "the caller", slots, &mut done, &mut joined)?;
    Ok(joined)
}

fn add(
    path: &str,
    user: &str,
    slots: &[Slot<'_>],
    done: &mut Vec<String>,
    joined: &mut String,
) -> Result<(), ShaderError> {
    if done.iter().any(|name| name == path) {
        return Ok(());
    }
    done.push(path.to_owned());
    let text = source(path).ok_or_else(|| ShaderError::NoSuchFile { path: path.to_owned(), user: user.to_owned() })?;
    for line in text.lines() {
        let Some(used) = line.strip_prefix("#use ") else { continue };
        let used = match used.trim().strip_prefix('<').and_then(|slot| slot.strip_suffix('>')) {
            Some(slot) => {
                let filled = slots.iter().find(|(name, _)| *name == slot);
                filled
                    .map(|(_, file)| *file)
                    .ok_or_else(|| ShaderError::EmptySlot { slot: slot.to_owned(), path: path.to_owned() })?
            }
            None => used.trim(),
        };
        add(used, path, slots, done, joined)?;
    }
    let _ = writeln!(joined, "// {path}");
    for line in text.lines().filter(|line| !line.starts_with("#use ")) {
        joined.push_str(line);
        joined.push('\n');
    }
    Ok(())
}
