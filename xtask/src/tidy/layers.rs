//! Layers: which crate may know which, and who opens files.

use super::crates::{dependency_tables, package_name};
use super::{Finding, Tree};

/// A crate's height, and what it does not know although it lies below.
struct Layer {
    package: &'static str,
    height: u8,
    /// Crates below that it must not know.
    never: &'static [&'static str],
    /// What the crate is defined by not knowing.
    why: &'static str,
}

const fn layer(package: &'static str, height: u8, never: &'static [&'static str], why: &'static str) -> Layer {
    Layer { package, height, never, why }
}

/// From the ground up. Crates of one height know nothing of each other.
const LAYERS: &[Layer] = &[
    layer("tetrascope-mesh", 0, &[], "it knows no camera and no color"),
    layer("tetrascope-view", 0, &[], "it knows no mesh and no optics"),
    layer("tetrascope-integrate", 0, &[], "it stands alone"),
    layer("tetrascope-colors", 0, &[], "it knows no mesh and no field"),
    layer(
        "tetrascope-classify",
        1,
        &["tetrascope-mesh", "tetrascope-integrate"],
        "it sees one cell at a time, without color",
    ),
    layer("tetrascope-order", 1, &["tetrascope-integrate"], "it knows no color"),
    layer(
        "tetrascope-shaders",
        1,
        &["tetrascope-mesh", "tetrascope-view"],
        "it has programs and the layout of what they read, and no device",
    ),
    layer(
        "tetrascope-scene",
        2,
        &["tetrascope-classify", "tetrascope-shaders"],
        "it plans and computes nothing of a picture",
    ),
    layer(
        "tetrascope-io",
        3,
        &["tetrascope-integrate", "tetrascope-classify", "tetrascope-order", "tetrascope-scene"],
        "it reads and writes and does not know what for",
    ),
    layer("tetrascope-cpu", 3, &[], "a back end sees no other one and opens no file"),
    layer("tetrascope-gpu", 3, &[], "a back end sees no other one and opens no file"),
    layer(
        "tetrascope-estimate",
        4,
        &["tetrascope-gpu", "tetrascope-io", "tetrascope-shaders"],
        "it measures pictures with rays and draws none",
    ),
    layer("tetrascope", 5, &[], "it joins the others"),
    layer("tetrascope-study", 6, &[], "it goes through the facade"),
    layer("tetrascope-cli", 7, &[], "it goes through the facade"),
    layer("tetrascope-tests", 7, &[], "it crosses crates"),
    layer("xtask", 8, &[], "it is above everything"),
];

/// Crates from elsewhere that only some may use.
const RESERVED: &[(&str, &[&str], &str)] = &[
    ("clap", &["tetrascope-cli", "xtask"], "only programs have a command line"),
    ("indicatif", &["tetrascope-cli"], "only the command line prints"),
    ("wgpu", &["tetrascope-gpu"], "only one crate sees the driver"),
    ("naga", &["tetrascope-shaders"], "only one crate reads programs"),
    ("png", &["tetrascope-io"], "only io knows formats of pictures"),
    ("exr", &["tetrascope-io"], "only io knows formats of pictures"),
];

/// Dependencies point downward, those of tests as well.
pub(super) fn downward(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let layer_of = |name: &str| LAYERS.iter().find(|l| l.package == name);
    for (folder, manifest) in tree.manifests() {
        let Ok(manifest) = manifest else { continue };
        let place = format!("{folder}/Cargo.toml");
        let name = package_name(&manifest).unwrap_or_default();
        let Some(own) = layer_of(name) else {
            findings.push(Finding::new(place, format!("{name} has no layer"), "give it one in tidy's table LAYERS"));
            continue;
        };
        for (kind, dependencies) in dependency_tables(&manifest) {
            for dependency in dependencies.keys() {
                if let Some((_, allowed, why)) = RESERVED.iter().find(|(reserved, ..)| reserved == dependency)
                    && !allowed.contains(&name)
                {
                    findings.push(Finding::new(
                        &place,
                        format!("{kind}: {dependency} is for {}", allowed.join(" and ")),
                        format!("leave it to those: {why}"),
                    ));
                }
                let Some(below) = layer_of(dependency) else { continue };
                if below.height >= own.height {
                    findings.push(Finding::new(
                        &place,
                        format!("{kind}: {dependency} is not below {name}"),
                        "move what is needed down, or the test that needs it into tests/",
                    ));
                } else if own.never.contains(&dependency.as_str()) {
                    findings.push(Finding::new(
                        &place,
                        format!("{kind}: {name} must not know {dependency}"),
                        format!("{}: let the crate above pass what is needed", own.why),
                    ));
                }
            }
        }
    }
    findings
}

/// Folders whose code may open files.
const OPENS_FILES: &[&str] = &["crates/io/", "crates/cli/", "xtask/"];

/// What opens them. In pieces, so that this file does not find itself.
const OPENING: &[&str] =
    &[concat!("std::", "fs"), concat!("fs::", "read"), concat!("File::", "open"), concat!("File::", "create")];

/// Only io, the command line and automation open files; tests may.
pub(super) fn files(tree: &Tree) -> Vec<Finding> {
    let tests = tree.test_files();
    let mut findings = Vec::new();
    for (path, text) in tree.texts(".rs") {
        if tests.contains(path) || OPENS_FILES.iter().any(|folder| path.starts_with(folder)) {
            continue;
        }
        for (number, line) in super::source::code_lines(text) {
            if let Some(word) = OPENING.iter().find(|word| line.contains(**word)) {
                findings.push(Finding::new(
                    format!("{path}:{number}"),
                    format!("{word} in a crate that opens no file"),
                    "take a reader or bytes from the caller; tetrascope-io opens files",
                ));
            }
        }
    }
    findings
}
