//! Texts: links, commands, paths, and words about what is missing.

use std::collections::BTreeSet;

use super::{Finding, Tree};
use crate::ci::TEST_COMMAND;

/// Relative links in Markdown lead to a file or folder of the repository, and a `#part` to a heading.
pub(super) fn links(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, text) in tree.texts(".md") {
        for (number, target) in link_targets(text) {
            if target.contains("://") || target.starts_with("mailto:") {
                continue;
            }
            let (file, part) = target.split_once('#').map_or((target, None), |(file, part)| (file, Some(part)));
            let place = format!("{path}:{number}");
            let Some(resolved) = (if file.is_empty() { Some(path.to_owned()) } else { resolve(path, file) }) else {
                findings.push(Finding::new(
                    place,
                    format!("{target} leads out of the repository"),
                    "link to what is in it",
                ));
                continue;
            };
            if !tree.has(&resolved) {
                findings.push(Finding::new(
                    place,
                    format!("there is no {resolved}"),
                    "correct the link, or add the file to the repository",
                ));
            } else if let (Some(part), Some(linked)) = (part, tree.text(&resolved))
                && resolved.ends_with(".md")
                && !headings(linked).any(|heading| heading == part)
            {
                findings.push(Finding::new(
                    place,
                    format!("{resolved} has no heading for #{part}"),
                    "headings become parts in lower case, with dashes for spaces",
                ));
            }
        }
    }
    findings
}

/// Targets of `[text](target)` with their lines, outside of code.
fn link_targets(text: &str) -> Vec<(usize, &str)> {
    let mut targets = Vec::new();
    let mut in_code = false;
    for (index, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        }
        if in_code || line.starts_with("    ") {
            continue;
        }
        let mut rest = line;
        while let Some((_, after)) = rest.split_once("](") {
            let Some((target, behind)) = after.split_once(')') else { break };
            targets.push((index + 1, target.split(' ').next().unwrap_or(target)));
            rest = behind;
        }
    }
    targets
}

/// A path from the root; `None` if it leads out of it.
fn resolve(from: &str, link: &str) -> Option<String> {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in link.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

/// The names by which a file's headings are linked.
fn headings(text: &str) -> impl Iterator<Item = String> {
    text.lines().filter(|line| line.starts_with('#')).map(|line| {
        let words = line.trim_start_matches('#').trim().to_lowercase();
        let kept = words.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    })
}

const REFERENCES: &str = "docs/references.md";

/// Keys in brackets, `[Name 1990]`, stand in the list of references, and each of the list stands in some code or text.
pub(super) fn references(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let listed: BTreeSet<&str> = tree.text(REFERENCES).unwrap_or_default().lines().filter_map(listed_key).collect();
    let mut used = BTreeSet::new();
    let elsewhere = |path: &str| path != REFERENCES && !path.starts_with("xtask/src/tidy/");
    for (path, text) in tree.texts(".rs").chain(tree.texts(".md")).filter(|(path, _)| elsewhere(path)) {
        for (index, line) in text.lines().enumerate() {
            for key in &listed {
                if line.contains(&format!("[{key}]")) {
                    used.insert(*key);
                }
            }
            for key in keys_with_year(line).filter(|key| !listed.contains(key)) {
                findings.push(Finding::new(
                    format!("{path}:{}", index + 1),
                    format!("the source [{key}] is not listed"),
                    format!("add it to {REFERENCES}, under the first author and the year"),
                ));
            }
        }
    }
    for key in listed.difference(&used) {
        findings.push(Finding::new(
            REFERENCES,
            format!("nothing names [{key}]"),
            "remove it, or name it where it is used",
        ));
    }
    findings
}

/// The key of a row `| [Key] | ...`.
fn listed_key(line: &str) -> Option<&str> {
    line.strip_prefix("| [")?.split_once("] |").map(|(key, _)| key)
}

/// What looks like a key: a name in brackets that ends in a year.
fn keys_with_year(line: &str) -> impl Iterator<Item = &str> {
    line.split('[').skip(1).filter_map(|rest| rest.split_once(']')).map(|(key, _)| key).filter(|key| {
        key.starts_with(char::is_uppercase)
            && key
                .rsplit_once(' ')
                .is_some_and(|(_, year)| year.len() == 4 && year.parse::<u16>().is_ok_and(|y| y > 1800))
    })
}

/// The README's way to run the tests is the one that CI takes.
pub(super) fn test_command(tree: &Tree) -> Vec<Finding> {
    let there =
        tree.text("README.md").is_some_and(|text| text.lines().any(|line| line.trim().starts_with(TEST_COMMAND)));
    let finding = || {
        Finding::new(
            "README.md",
            format!("`{TEST_COMMAND}` is not in it"),
            "name it on a line of its own, as CI runs it",
        )
    };
    if there { Vec::new() } else { vec![finding()] }
}

/// Beginnings of paths that exist on one machine. In pieces, so that this file does not find itself.
const MACHINE: &[&str] = &[concat!("/wo", "rk/"), concat!("/ro", "ot/"), concat!("/tm", "p/"), concat!("/ho", "me/")];

/// No file holds an absolute path.
pub(super) fn machine_paths(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, text) in tree.texts("") {
        for (index, line) in text.lines().enumerate() {
            for machine in MACHINE {
                // Only where a path begins: the same letters after two dots and a slash are none.
                let starts = line.match_indices(machine).any(|(at, _)| {
                    !line[..at].ends_with(|c: char| c.is_alphanumeric() || matches!(c, '.' | '_' | '-' | '*' | '}'))
                });
                if starts {
                    findings.push(Finding::new(
                        format!("{path}:{}", index + 1),
                        format!("{machine} is a path of one machine"),
                        "use a relative path, `std::env::temp_dir` or an environment variable",
                    ));
                }
            }
        }
    }
    findings
}

/// The mark of a missing thing. In pieces, so that this file does not find itself.
const MARKS: &[&str] = &[concat!("TO", "DO"), concat!("FIX", "ME"), concat!("X", "XX")];

/// Words after the mark from which on it says something.
const FEWEST_WORDS: usize = 4;

/// What is marked as missing is named, in a few words at least.
pub(super) fn missing_things(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let endings = [".rs", ".md", ".toml", ".wgsl", ".yml", ".sh"];
    for (path, text) in endings.iter().flat_map(|ending| tree.texts(ending)) {
        for (index, line) in text.lines().enumerate() {
            for mark in MARKS {
                let Some((_, after)) = line.split_once(mark) else { continue };
                if after.split_whitespace().count() < FEWEST_WORDS {
                    findings.push(Finding::new(
                        format!("{path}:{}", index + 1),
                        format!("{mark} without a thing"),
                        "name the missing thing and how its absence would be noticed",
                    ));
                }
            }
        }
    }
    findings
}

/// Both licences that the manifest names are there.
pub(super) fn licences(tree: &Tree) -> Vec<Finding> {
    let expected = [("LICENSE-MIT", "MIT License"), ("LICENSE-APACHE", "Apache License")];
    expected
        .into_iter()
        .filter(|(path, title)| !tree.text(path).is_some_and(|text| text.contains(title)))
        .map(|(path, title)| Finding::new(path, format!("no {title} in it"), "put the licence's text there"))
        .collect()
}

/// The script that CI starts is there, can be started, and stops at the first failure.
pub(super) fn ci_script(tree: &Tree) -> Vec<Finding> {
    let path = ".ci/run";
    let Some(text) = tree.text(path) else {
        return vec![Finding::new(path, "missing", "write it: CI starts it from the root")];
    };
    let mut findings = Vec::new();
    if !tree.is_executable(path) {
        findings.push(Finding::new(path, "not executable", "run `chmod +x .ci/run`"));
    }
    if !text.starts_with("#!") || !text.contains("set -euo pipefail") {
        findings.push(Finding::new(
            path,
            "does not stop at the first failure",
            "open with `#!/usr/bin/env bash` and `set -euo pipefail`",
        ));
    }
    findings
}
