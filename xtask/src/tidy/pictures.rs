//! Pictures: golden images with their scenes and tests, and figures with a text that shows them.

use tetrascope_tests::golden::{BYTE_BUDGET, SCENES};

use super::{Finding, Tree};

const GOLDEN: &str = "tests/golden/";
const FIGURES: &str = "docs/images/";

/// Most bytes of a figure.
const FIGURE_BUDGET: usize = 300 * 1024;

/// Every file in `tests/golden` belongs to a scene of the list that the test draws, and every scene has its files.
pub(super) fn golden(tree: &Tree) -> Vec<Finding> {
    golden_of(tree, &SCENES.iter().map(|scene| scene.name).collect::<Vec<_>>())
}

/// The same for a list of names.
pub(super) fn golden_of(tree: &Tree, scenes: &[&str]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let texts: Vec<&str> =
        tree.texts(".toml").filter(|(path, _)| path.starts_with(GOLDEN)).map(|(_, text)| text).collect();
    for path in tree.paths().filter(|path| path.starts_with(GOLDEN)) {
        let file = &path[GOLDEN.len()..];
        let (stem, ending) = file.rsplit_once('.').unwrap_or((file, ""));
        match ending {
            "exr" | "txt" | "toml" if !scenes.contains(&stem) => findings.push(Finding::new(
                path,
                "no test draws it",
                "add the scene to `SCENES` in tetrascope-tests, or remove the file",
            )),
            "exr" | "txt" | "toml" => {}
            "vtu" if texts.iter().any(|text| text.contains(&format!("\"{file}\""))) => {}
            _ => findings.push(Finding::new(path, "no scene uses it", "remove it")),
        }
        if ending == "exr" && tree.size(path).is_some_and(|size| size as u64 > BYTE_BUDGET) {
            findings.push(Finding::new(path, format!("more than {BYTE_BUDGET} bytes"), "draw fewer pixels"));
        }
    }
    for scene in scenes {
        for ending in ["toml", "exr", "txt"] {
            let path = format!("{GOLDEN}{scene}.{ending}");
            if !tree.has(&path) {
                findings.push(Finding::new(
                    path,
                    "missing",
                    "write the scene; `cargo xtask golden regenerate` draws it",
                ));
            }
        }
    }
    findings
}

/// Figures are small, and a text shows them.
pub(super) fn figures(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for path in tree.paths().filter(|path| path.starts_with(FIGURES)) {
        let name = &path[FIGURES.len()..];
        if !tree.texts(".md").any(|(_, text)| text.contains(&format!("images/{name}"))) {
            findings.push(Finding::new(path, "no text shows it", "remove it, or show it where it explains something"));
        }
        if tree.size(path).is_some_and(|size| size > FIGURE_BUDGET) {
            findings.push(Finding::new(path, format!("more than {FIGURE_BUDGET} bytes"), "make it smaller"));
        }
    }
    findings
}
