//! Every check on made-up trees: a good one is left alone, and each way to spoil it is found.

use super::*;

const ROOT: &str = "[workspace]\nmembers = [\"crates/*\"]\n";
const MESH: &str = "[package]\nname = \"tetrascope-mesh\"\ndescription = \"Meshes of two lines.\"\nversion.workspace = true\n\
edition.workspace = true\nrust-version.workspace = true\nlicense.workspace = true\npublish.workspace = true\n\
[dependencies]\nglam.workspace = true\n[lints]\nworkspace = true\n";

fn good() -> Tree {
    Tree::of([
        ("Cargo.toml", ROOT),
        ("ARCHITECTURE.md", "# Architecture\n\n**`crates/mesh`** cuts.\n"),
        ("README.md", "# Title\n\n    cargo test --release --workspace   # all\n\n[mesh](crates/mesh/README.md#use-it)\n"),
        ("LICENSE-MIT", "MIT License\n"),
        ("LICENSE-APACHE", "Apache License\n"),
        (".ci/run", "#!/usr/bin/env bash\nset -euo pipefail\n"),
        ("crates/mesh/Cargo.toml", MESH),
        ("crates/mesh/README.md", "# tetrascope-mesh\n\nMeshes.\n\n## Use it\n"),
        (
            "crates/mesh/src/lib.rs",
            "//! Meshes of\n//! two lines.\n//!\n//! More: `println!(\"a comment\")`\n\nmod a;\n#[cfg(test)]\nmod shared;\n",
        ),
        ("crates/mesh/src/a.rs", "//! One of the files.\nfn f() {}\n\n#[cfg(test)]\nmod tests {\n    fn g() { println!(\"x\"); }\n}\n"),
        ("crates/mesh/src/shared.rs", "//! For tests.\nuse std::fs;\nfn h() { eprintln!(\"x\"); }\n"),
        ("docs/images/a.png", "picture"),
        ("docs/a.md", "![a picture](images/a.png)\n```\n[no](link)\n```\n[far](https://example.org/x)\n[here](#a-part)\n# A part\n"),
    ])
    .runnable(".ci/run")
}

/// All but the golden images, whose list is that of the real tree.
fn findings(tree: &Tree) -> Vec<String> {
    let checks = CHECKS.iter().filter(|(rule, _)| !rule.starts_with("golden"));
    checks.flat_map(|(_, check)| check(tree)).map(|finding| finding.to_string()).collect()
}

#[track_caller]
fn check_finds(tree: Tree, expected: &str) {
    let found = findings(&tree);
    assert_eq!(found.len(), 1, "one thing is wrong: {found:#?}");
    assert!(found[0].contains(expected), "{found:#?}");
}

#[test]
fn good_tree_is_left_alone() {
    assert_eq!(findings(&good()), [""; 0]);
}

#[test]
fn crates_unlisted_and_made_up() {
    check_finds(good().with("ARCHITECTURE.md", "# A\n"), "the crate crates/mesh has no paragraph");
    check_finds(
        good().with("ARCHITECTURE.md", "**`crates/mesh`** cuts.\n**`crates/gone`** was.\n"),
        "a paragraph on crates/gone",
    );
    check_finds(good().without("ARCHITECTURE.md"), "ARCHITECTURE.md: missing");
    check_finds(good().with("README.md", "    cargo test --release --workspace\n"), "crates/mesh is not linked");
}

#[test]
fn manifests_that_stand_alone() {
    for (from, to, expected) in [
        ("rust-version.workspace = true", "rust-version = \"1.80\"", "package.rust-version is its own"),
        ("[lints]\nworkspace = true", "", "lints are not inherited"),
        ("glam.workspace = true", "glam = \"0.1\"", "dependencies.glam has a version"),
        ("glam.workspace = true", "clap.workspace = true", "clap is for tetrascope-cli and xtask"),
        ("glam.workspace = true", "naga.workspace = true", "naga is for tetrascope-shaders"),
        ("glam.workspace = true", "tetrascope-order.workspace = true", "tetrascope-order is not below tetrascope-mesh"),
        ("glam.workspace = true", "tetrascope-view.workspace = true", "tetrascope-view is not below tetrascope-mesh"),
        ("Meshes of two lines.", "Other", "make them one"),
        ("[package]", "[package", "mend the syntax"),
    ] {
        check_finds(good().with("crates/mesh/Cargo.toml", &MESH.replace(from, to)), expected);
    }
}

#[test]
fn crate_that_must_not_know() {
    let order = MESH.replace("tetrascope-mesh", "tetrascope-order").replace("glam", "tetrascope-integrate");
    let tree = good()
        .with("crates/order/Cargo.toml", &order)
        .with("crates/order/src/lib.rs", "//! Meshes of two lines.\n")
        .with("crates/order/README.md", "# tetrascope-order\n\nOrders.\n")
        .with("README.md", "    cargo test --release --workspace\n[a](crates/mesh) [b](crates/order)\n")
        .with("ARCHITECTURE.md", "**`crates/mesh`** a\n**`crates/order`** b\n");
    check_finds(tree, "tetrascope-order must not know tetrascope-integrate; it knows no color");
}

#[test]
fn back_ends_that_know_each_other() {
    let gpu = MESH.replace("tetrascope-mesh", "tetrascope-gpu").replace("glam", "tetrascope-cpu");
    let tree = good()
        .with("crates/gpu/Cargo.toml", &gpu)
        .with("crates/gpu/src/lib.rs", "//! Meshes of two lines.\n")
        .with("crates/gpu/README.md", "# tetrascope-gpu\n\nPictures.\n")
        .with("README.md", "    cargo test --release --workspace\n[a](crates/mesh) [b](crates/gpu)\n")
        .with("ARCHITECTURE.md", "**`crates/mesh`** a\n**`crates/gpu`** b\n");
    check_finds(tree, "tetrascope-cpu is not below tetrascope-gpu");
}

#[test]
fn readmes() {
    check_finds(good().with("crates/mesh/README.md", "# mesh\n\nMeshes.\n## Use it\n"), "another title");
    check_finds(good().with("crates/mesh/README.md", "# tetrascope-mesh\n## Use it\n"), "no sentence");
    let found = findings(&good().without("crates/mesh/README.md"));
    assert!(found.iter().any(|f| f.starts_with("crates/mesh/README.md: missing")), "{found:?}");
}

#[test]
fn links_that_lead_nowhere() {
    check_finds(good().with("docs/b.md", "see [that](gone.md)\n"), "docs/b.md:1: there is no docs/gone.md");
    check_finds(good().with("docs/b.md", "\n[x](a.md) and [out](../../x)\n"), "docs/b.md:2: ../../x leads out");
    check_finds(good().with("docs/b.md", "[x](a.md#b-part)\n"), "no heading for #b-part");
    assert_eq!(findings(&good().with("docs/b.md", "[x](a.md#a-part) [y](../crates/mesh) [z](images)\n")), [""; 0]);
}

#[test]
fn references_unlisted_and_unused() {
    let listed = |rows: &str| good().with("docs/references.md", rows);
    let key = "| [Max 1995] | N. Max. |\n";
    check_finds(listed(key), "nothing names [Max 1995]");
    let citing = "//! A file after [Max 1995], figure 2.\n";
    assert_eq!(findings(&listed(key).with("crates/mesh/src/b.rs", citing)), [""; 0]);
    check_finds(
        good().with("crates/mesh/src/b.rs", citing),
        "crates/mesh/src/b.rs:1: the source [Max 1995] is not listed",
    );
    assert_eq!(
        findings(&good().with("crates/mesh/src/b.rs", "//! A list [0, 1] of [Some] numbers [A 12].\n")),
        [""; 0]
    );
}

#[test]
fn printing_and_opening_files() {
    let printing = "//! A file here.\nfn f() {\n    eprintln!(\"x\");\n}\n";
    check_finds(good().with("crates/mesh/src/b.rs", printing), "crates/mesh/src/b.rs:3: prints");
    assert_eq!(findings(&good().with("crates/mesh/examples/b.rs", printing)), [""; 0]);
    let opening = "//! A file here.\nuse std::fs;\n";
    check_finds(good().with("crates/mesh/src/b.rs", opening), "crates/mesh/src/b.rs:2: std::fs");
    assert_eq!(findings(&good().with("crates/mesh/tests/b.rs", opening)), [""; 0]);
}

#[test]
fn headers_and_lengths() {
    check_finds(good().with("crates/mesh/src/b.rs", "fn f() {}\n"), "does not say what it is");
    check_finds(good().with("shaders/a/b.wgsl", "fn f() {}\n"), "shaders/a/b.wgsl: does not say what it is");
    assert_eq!(findings(&good().with("shaders/a/b.wgsl", "// One cell a thread.\n")), [""; 0]);
    let long = "x\n".repeat(900);
    check_finds(good().with("crates/mesh/src/b.rs", &format!("//! A long file.\n{long}")), "901 lines");
    assert_eq!(findings(&good().with("crates/mesh/src/b.rs", &format!("//! A generated table.\n{long}"))), [""; 0]);
}

#[test]
fn paths_and_missing_things() {
    let path = format!("see \"{}\"\n", MACHINE_PATH);
    check_finds(good().with("docs/b.toml", &path), "docs/b.toml:1: ");
    assert_eq!(findings(&good().with("docs/b.toml", &format!("target{MACHINE_PATH}\n"))), [""; 0]);
    let mark = concat!("// TO", "DO");
    let code = |rest: &str| format!("//! A file here.\n{mark}{rest}\n");
    check_finds(good().with("crates/mesh/src/b.rs", &code(": later")), "without a thing");
    assert_eq!(
        findings(&good().with("crates/mesh/src/b.rs", &code(": quadratic wedges; cut cells show gaps"))),
        [""; 0]
    );
}

const MACHINE_PATH: &str = concat!("/tm", "p/x");

#[test]
fn what_lies_in_the_root() {
    check_finds(good().without("LICENSE-MIT"), "LICENSE-MIT: no MIT License");
    check_finds(good().without(".ci/run"), ".ci/run: missing");
    check_finds(good().with(".ci/run", "#!/bin/sh\n"), "does not stop");
    check_finds(Tree::of(good().texts("").collect::<Vec<_>>()), ".ci/run: not executable");
    let readme = good().text("README.md").unwrap().replace("--workspace", "");
    check_finds(good().with("README.md", &readme), "is not in it");
}

#[test]
fn figures_without_text_and_too_large() {
    check_finds(good().with("docs/images/b.png", "x"), "no text shows it");
    check_finds(good().with("docs/images/a.png", &"x".repeat(400_000)), "make it smaller");
}

#[test]
fn golden_images_without_test() {
    let tree = Tree::of([
        ("tests/golden/a.toml", "path = \"a.vtu\""),
        ("tests/golden/a.vtu", ""),
        ("tests/golden/a.exr", ""),
        ("tests/golden/a.txt", ""),
    ]);
    let found = |tree: &Tree| pictures::golden_of(tree, &["a"]).iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(found(&tree), [""; 0]);
    for (tree, expected) in [
        (tree.clone().with("tests/golden/b.exr", ""), "tests/golden/b.exr: no test draws it"),
        (tree.clone().with("tests/golden/b.vtu", ""), "tests/golden/b.vtu: no scene uses it"),
        (tree.clone().with("tests/golden/a.exr", &"x".repeat(50_000)), "more than 40960 bytes"),
        (tree.clone().without("tests/golden/a.exr"), "tests/golden/a.exr: missing"),
        (tree.without("tests/golden/a.txt"), "tests/golden/a.txt: missing"),
    ] {
        let found = found(&tree);
        assert!(found.len() == 1 && found[0].contains(expected), "{found:?}");
    }
}
