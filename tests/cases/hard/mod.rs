//! The hard cases of `docs/hard-cases.md`, case by case, drawn in every way.

mod classification;
mod eye;
mod mesh;
mod numbers;
mod optics;
mod order;
mod pixels;

use tetrascope_tests::hard::document::beginning;
use tetrascope_tests::hard::{HardCase, all, judge, named};
use tetrascope_tests::ways::Way;

/// Draws every scene of a case in every way, prints the largest of each figure, and fails with all that is wrong.
fn check(name: &str) {
    let case: HardCase = named(name).unwrap_or_else(|| panic!("no hard case is named {name}"));
    let ways = Way::here(&format!("hard case {name}"));
    let mut failures = Vec::new();
    for hard in (case.scenes)() {
        for found in judge(&hard, &ways) {
            let shown = |figure: Option<f64>| figure.map_or("-".to_owned(), |f| format!("{f:.1e}"));
            println!(
                "{name}, {}, {}: chord {}, crack {}, light {:.1e}{}",
                hard.place,
                found.way,
                shown(found.chord),
                shown(found.crack),
                found.light,
                found.refused.as_ref().map_or(String::new(), |words| format!(", refused: {words}"))
            );
            failures.extend(found.failures.iter().map(|f| format!("{}, {}: {f}", hard.place, found.way)));
        }
    }
    assert!(failures.is_empty(), "{name}: {failures:#?}");
}

/// The document has every case, word for word, and its picture; `cargo xtask hard-cases` writes both.
#[test]
fn hard_cases_are_in_the_document() {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let text = std::fs::read_to_string(docs.join("hard-cases.md")).unwrap();
    for case in all() {
        assert!(text.contains(&beginning(&case)), "docs/hard-cases.md has another text of {}", case.name);
        assert!(docs.join(format!("images/hard/{}.png", case.name)).is_file(), "{} has no picture", case.name);
    }
}
