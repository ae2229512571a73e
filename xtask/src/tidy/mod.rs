//! `cargo xtask tidy`: whether what the texts promise is so.
//!
//! Every check takes the [`Tree`] of the repository's files and gives [`Finding`]s that say what is wrong, where, and
//! how to repair it. Checks know no file system, so that their tests make up trees.

mod crates;
mod layers;
mod pictures;
mod prose;
mod source;
mod tree;

use std::fmt;
use std::path::Path;

use crate::Failure;
use tree::Tree;

/// Something that is not as promised.
#[derive(Clone, Debug, PartialEq)]
struct Finding {
    /// File, with a line where there is one.
    place: String,
    problem: String,
    repair: String,
}

impl Finding {
    fn new(place: impl Into<String>, problem: impl Into<String>, repair: impl Into<String>) -> Self {
        Self { place: place.into(), problem: problem.into(), repair: repair.into() }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}; {}", self.place, self.problem, self.repair)
    }
}

/// A rule, and what looks whether it is kept.
type Check = (&'static str, fn(&Tree) -> Vec<Finding>);

const CHECKS: &[Check] = &[
    ("ARCHITECTURE.md and README.md name the crates that are there", crates::listed),
    ("crates inherit version, licence, lints and dependencies", crates::inherited),
    ("every crate has a README, and its description opens its documentation", crates::documented),
    ("dependencies point downward", layers::downward),
    ("only crates that may open files", layers::files),
    ("links lead somewhere", prose::links),
    ("sources have keys that are listed, and all listed are used", prose::references),
    ("README.md has the command that CI runs", prose::test_command),
    ("no path of one machine", prose::machine_paths),
    ("what is missing is named", prose::missing_things),
    ("licences lie in the root", prose::licences),
    (".ci/run can be run", prose::ci_script),
    ("files say what they are", source::headers),
    ("only programs and tests print", source::prints),
    ("no file grows beyond reading", source::lengths),
    ("golden images have scenes, tests and small size", pictures::golden),
    ("figures are shown somewhere and small", pictures::figures),
];

/// Runs all checks and prints what they find.
pub(crate) fn run(root: &Path) -> Result<(), Failure> {
    let tree = Tree::of_repository(root)?;
    let mut count = 0;
    for (rule, check) in CHECKS {
        let findings = check(&tree);
        if !findings.is_empty() {
            println!("{rule}:");
        }
        for finding in &findings {
            println!("  {finding}");
        }
        count += findings.len();
    }
    if count == 0 {
        println!("{} rules kept by {} files", CHECKS.len(), tree.paths().count());
        return Ok(());
    }
    Err(format!("{count} things to mend").into())
}

#[cfg(test)]
mod tests;
