//! Crates: those that texts name, what they inherit, and how they are documented.

use std::collections::BTreeSet;

use super::{Finding, Tree};

/// Every crate has a paragraph in ARCHITECTURE.md that opens with its folder in bold, and every such paragraph a crate;
/// README.md names every crate in `crates/`.
pub(super) fn listed(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let present: BTreeSet<&str> = tree.manifests().into_iter().map(|(folder, _)| folder).collect();
    let Some(architecture) = tree.text("ARCHITECTURE.md") else {
        return vec![Finding::new("ARCHITECTURE.md", "missing", "write it: a paragraph per crate with its invariants")];
    };
    let listed: BTreeSet<&str> = architecture
        .lines()
        .filter_map(|line| line.strip_prefix("**`"))
        .filter_map(|rest| rest.split_once("`**"))
        .map(|(folder, _)| folder.trim_end_matches('/'))
        .collect();
    for folder in present.difference(&listed) {
        findings.push(Finding::new(
            "ARCHITECTURE.md",
            format!("the crate {folder} has no paragraph"),
            format!("add one that opens with **`{folder}`**"),
        ));
    }
    for folder in listed.difference(&present) {
        findings.push(Finding::new(
            "ARCHITECTURE.md",
            format!("has a paragraph on {folder}, which is no crate"),
            "remove it, or name the crate's folder as it is",
        ));
    }
    let readme = tree.text("README.md").unwrap_or_default();
    for folder in present.iter().filter(|f| f.starts_with("crates/")) {
        if !readme.contains(&format!("({folder}")) {
            findings.push(Finding::new(
                "README.md",
                format!("the crate {folder} is not linked"),
                "add it to the table of crates",
            ));
        }
    }
    findings
}

/// Version, edition, least Rust, licence, lints and dependencies are said once, in the root.
pub(super) fn inherited(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (folder, manifest) in tree.manifests() {
        let place = format!("{folder}/Cargo.toml");
        let manifest = match manifest {
            Ok(manifest) => manifest,
            Err(problem) => {
                findings.push(Finding::new(place, problem, "mend the syntax"));
                continue;
            }
        };
        for key in ["version", "edition", "rust-version", "license", "publish"] {
            if !is_inherited(manifest.get("package").and_then(|p| p.get(key))) {
                findings.push(Finding::new(
                    &place,
                    format!("package.{key} is its own"),
                    format!("write `{key}.workspace = true`"),
                ));
            }
        }
        if !is_inherited(manifest.get("lints")) {
            findings.push(Finding::new(
                &place,
                "the workspace's lints are not inherited",
                "add `[lints] workspace = true`",
            ));
        }
        for (kind, dependencies) in dependency_tables(&manifest) {
            for (name, dependency) in dependencies {
                if !is_inherited(Some(dependency)) {
                    findings.push(Finding::new(
                        &place,
                        format!("{kind}.{name} has a version or path of its own"),
                        format!("put it into [workspace.dependencies] and write `{name}.workspace = true`"),
                    ));
                }
            }
        }
        let name = package_name(&manifest).unwrap_or_default();
        let expected = folder.strip_prefix("crates/").map_or_else(
            || folder.to_owned(),
            |short| if short == "tetrascope" { short.to_owned() } else { format!("tetrascope-{short}") },
        );
        if folder.starts_with("crates/") && name != expected {
            findings.push(Finding::new(
                &place,
                format!("the package is called {name}"),
                format!("call it {expected}, as its folder is"),
            ));
        }
    }
    findings
}

fn is_inherited(value: Option<&toml::Value>) -> bool {
    value.and_then(|v| v.get("workspace")).and_then(toml::Value::as_bool) == Some(true)
}

pub(super) fn package_name(manifest: &toml::Table) -> Option<&str> {
    manifest.get("package")?.get("name")?.as_str()
}

/// The tables of dependencies that are not for one platform alone.
pub(super) fn dependency_tables(manifest: &toml::Table) -> Vec<(&'static str, &toml::Table)> {
    ["dependencies", "dev-dependencies", "build-dependencies"]
        .into_iter()
        .filter_map(|kind| Some((kind, manifest.get(kind)?.as_table()?)))
        .collect()
}

/// README.md with the package's name as title and a sentence below; a description that is the crate documentation's first
/// sentence.
pub(super) fn documented(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (folder, manifest) in tree.manifests() {
        let Ok(manifest) = manifest else { continue };
        let name = package_name(&manifest).unwrap_or_default();
        let place = format!("{folder}/README.md");
        // Tests and automation are explained in ARCHITECTURE.md.
        if folder.starts_with("crates/") {
            match tree.text(&place) {
                None => findings.push(Finding::new(
                    &place,
                    "missing",
                    "write it: a sentence, an example, what it promises, what it leaves to others, where to go next",
                )),
                Some(text) => {
                    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
                    if lines.next() != Some(format!("# {name}").as_str()) {
                        findings.push(Finding::new(
                            &place,
                            "another title than the package has",
                            format!("begin with `# {name}`"),
                        ));
                    }
                    if !lines.next().is_some_and(|line| line.starts_with(char::is_uppercase) || line.starts_with('`')) {
                        findings.push(Finding::new(
                            &place,
                            "no sentence below the title",
                            "say there in one sentence what the crate gives",
                        ));
                    }
                }
            }
        }
        let Some(root) = ["src/lib.rs", "src/main.rs"]
            .map(|file| format!("{folder}/{file}"))
            .into_iter()
            .find(|file| tree.text(file).is_some())
        else {
            findings.push(Finding::new(folder, "neither src/lib.rs nor src/main.rs", "a crate needs one"));
            continue;
        };
        let first = first_paragraph(tree.text(&root).unwrap_or_default());
        let description = manifest.get("package").and_then(|p| p.get("description")).and_then(toml::Value::as_str);
        if description != Some(first.as_str()) {
            findings.push(Finding::new(
                format!("{folder}/Cargo.toml"),
                format!("the description is {:?}, and {root} begins \"{first}\"", description.unwrap_or_default()),
                "make them one",
            ));
        }
    }
    findings
}

/// The first paragraph of a file's documentation, in one line.
fn first_paragraph(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//!")).map(str::trim);
    lines.take_while(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}
