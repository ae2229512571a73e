//! Source files: their first line, their length, and who prints.

use super::{Finding, Tree};

/// Most lines of a file that is not a table made by a program.
const MOST_LINES: usize = 900;

/// Every file opens by saying what it is: in Rust as documentation, in WGSL as a comment.
pub(super) fn headers(tree: &Tree) -> Vec<Finding> {
    let lacks = |mark: &'static str| {
        move |(path, text): (&str, &str)| {
            let good = text.lines().next().is_some_and(|line| line.starts_with(mark) && line.len() > 10);
            (!good).then(|| Finding::new(path, "does not say what it is", format!("open with a line `{mark}...`")))
        }
    };
    tree.texts(".rs").filter_map(lacks("//! ")).chain(tree.texts(".wgsl").filter_map(lacks("// "))).collect()
}

/// Files that can be read in one go; tables that a program made say so in their first line.
pub(super) fn lengths(tree: &Tree) -> Vec<Finding> {
    let long = |(path, text): (&str, &str)| {
        let lines = text.lines().count();
        let is_table = text.lines().next().is_some_and(|line| line.to_lowercase().contains("generated"));
        (lines > MOST_LINES && !is_table).then(|| {
            Finding::new(
                path,
                format!("{lines} lines, more than {MOST_LINES}"),
                "look for a seam and make it two files",
            )
        })
    };
    tree.texts(".rs").filter_map(long).collect()
}

/// Macros that print. In pieces, so that this file does not find itself.
const PRINTS: &[&str] = &[concat!("print", "!("), concat!("println", "!("), concat!("dbg", "!(")];

/// Only the command line, automation, examples and tests print.
pub(super) fn prints(tree: &Tree) -> Vec<Finding> {
    let tests = tree.test_files();
    let mut findings = Vec::new();
    for (path, text) in tree.texts(".rs") {
        if path.starts_with("crates/cli/") || path.starts_with("xtask/") || tests.contains(path) {
            continue;
        }
        for (number, line) in code_lines(text) {
            if PRINTS.iter().any(|word| line.contains(word)) {
                findings.push(Finding::new(
                    format!("{path}:{number}"),
                    "prints",
                    "return it, or report it to the sink that the caller gave",
                ));
            }
        }
    }
    findings
}

/// Lines with their numbers, without comments and without what follows a `#[cfg(test)]` module in the same file.
pub(super) fn code_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines: Vec<&str> = text.lines().collect();
    let opens_tests = |(index, line): (usize, &&str)| {
        line.trim() == "#[cfg(test)]" && lines.get(index + 1).is_some_and(|next| next.ends_with('{'))
    };
    let end = lines.iter().enumerate().position(opens_tests).unwrap_or(lines.len());
    lines
        .into_iter()
        .take(end)
        .enumerate()
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        .map(|(index, line)| (index + 1, line))
}
