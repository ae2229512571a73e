//! The files of a repository, in memory.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::Failure;

/// Files by their path from the root, with slashes between.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    files: BTreeMap<String, Vec<u8>>,
    executable: BTreeSet<String>,
}

impl Tree {
    /// What git tracks and what it would add.
    pub(super) fn of_repository(root: &Path) -> Result<Self, Failure> {
        let listed = Command::new("git")
            .current_dir(root)
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .output()
            .map_err(|e| format!("git does not run: {e}; tidy asks it which files belong to the repository"))?;
        if !listed.status.success() {
            return Err(format!("git ls-files: {}", String::from_utf8_lossy(&listed.stderr).trim()).into());
        }
        let mut tree = Self::default();
        for path in String::from_utf8(listed.stdout)?.split('\0').filter(|path| !path.is_empty()) {
            let file = root.join(path);
            // Removed in the working tree, but not yet in a commit.
            if !file.is_file() {
                continue;
            }
            tree.files.insert(path.to_owned(), fs::read(&file).map_err(|e| format!("{path}: {e}"))?);
            if is_executable(&file)? {
                tree.executable.insert(path.to_owned());
            }
        }
        Ok(tree)
    }

    /// A made-up tree.
    #[cfg(test)]
    pub(super) fn of<'a>(files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let files = files.into_iter().map(|(path, text)| (path.to_owned(), text.as_bytes().to_vec())).collect();
        Self { files, executable: BTreeSet::new() }
    }

    /// The same tree with one more file, or with another text in it.
    #[cfg(test)]
    pub(super) fn with(mut self, path: &str, text: &str) -> Self {
        self.files.insert(path.to_owned(), text.as_bytes().to_vec());
        self
    }

    /// The same tree without a file.
    #[cfg(test)]
    pub(super) fn without(mut self, path: &str) -> Self {
        self.files.remove(path);
        self
    }

    /// The same tree with a file that may be run.
    #[cfg(test)]
    pub(super) fn runnable(mut self, path: &str) -> Self {
        self.executable.insert(path.to_owned());
        self
    }

    pub(super) fn paths(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// A file's text; `None` if it is not there or no text.
    pub(super) fn text(&self, path: &str) -> Option<&str> {
        self.files.get(path).and_then(|bytes| str::from_utf8(bytes).ok())
    }

    /// All text files with that ending.
    pub(super) fn texts<'a>(&'a self, ending: &'a str) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.paths().filter(move |path| path.ends_with(ending)).filter_map(|path| Some((path, self.text(path)?)))
    }

    /// Bytes of a file.
    pub(super) fn size(&self, path: &str) -> Option<usize> {
        self.files.get(path).map(Vec::len)
    }

    /// Whether a file or a folder with files is there.
    pub(super) fn has(&self, path: &str) -> bool {
        let folder = format!("{path}/");
        path.is_empty() || self.files.contains_key(path) || self.paths().any(|p| p.starts_with(&folder))
    }

    pub(super) fn is_executable(&self, path: &str) -> bool {
        self.executable.contains(path)
    }

    /// The workspace's crates: their folders and manifests; those that do not parse are `Err` with the reason.
    pub(super) fn manifests(&self) -> Vec<(&str, Result<toml::Table, String>)> {
        self.texts("/Cargo.toml")
            .map(|(path, text)| {
                (path.trim_end_matches("/Cargo.toml"), text.parse().map_err(|e: toml::de::Error| e.to_string()))
            })
            .collect()
    }

    /// Rust files that are only compiled for tests: those in `tests` folders, examples, and modules that are declared so.
    pub(super) fn test_files(&self) -> BTreeSet<&str> {
        let mut modules = BTreeSet::new();
        for (path, text) in self.texts(".rs") {
            let mut lines = text.lines().map(str::trim).peekable();
            while let Some(line) = lines.next() {
                let Some(name) = lines.peek().and_then(|next| module_name(next)) else { continue };
                if line.starts_with("#[cfg(") && line.contains("test") {
                    modules.insert(format!("{}/{name}", module_folder(path)));
                }
            }
        }
        let is_test = |path: &&str| {
            let stem = path.trim_end_matches(".rs");
            path.contains("/tests/")
                || path.contains("/examples/")
                || path.contains("/benches/")
                || path.starts_with("tests/")
                || stem.ends_with("_tests")
                || modules.iter().any(|m| stem == m || stem.starts_with(&format!("{m}/")))
        };
        self.paths().filter(|path| path.ends_with(".rs")).filter(is_test).collect()
    }
}

/// `mod name;` with any visibility.
fn module_name(line: &str) -> Option<&str> {
    let (before, name) = line.strip_suffix(';')?.split_once("mod ")?;
    (before.is_empty() || before.starts_with("pub")).then_some(name)
}

/// The folder in which a file's modules lie.
fn module_folder(path: &str) -> &str {
    let stem = path.trim_end_matches(".rs");
    for end in ["/lib", "/main", "/mod"] {
        if let Some(folder) = stem.strip_suffix(end) {
            return folder;
        }
    }
    stem
}

#[cfg(unix)]
fn is_executable(file: &Path) -> Result<bool, Failure> {
    use std::os::unix::fs::PermissionsExt;
    Ok(fs::metadata(file)?.permissions().mode() & 0o111 != 0)
}

/// Where files have no such mark, git keeps it.
#[cfg(not(unix))]
fn is_executable(_: &Path) -> Result<bool, Failure> {
    Ok(true)
}
