//! Every golden image, drawn by the f64 reference and by the fast renderer.

use tetrascope_tests::golden::{SCENES, check, evidence_folder, folder};

#[test]
fn golden_images() {
    let outcomes = check(&folder(), SCENES, &evidence_folder());
    assert_eq!(outcomes.len(), SCENES.len());
    for outcome in &outcomes {
        if let (Some(reference), Some(fast)) = (outcome.reference, outcome.fast) {
            println!("{}: reference {:.1e}, cpu {:.1e}", outcome.name, reference.largest, fast.largest);
        }
    }
    let failures: Vec<&String> = outcomes.iter().flat_map(|o| &o.failures).collect();
    assert!(failures.is_empty(), "{failures:#?}; pictures are in {}", evidence_folder().display());
}
