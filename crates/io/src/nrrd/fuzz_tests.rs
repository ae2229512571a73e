//! Damaged files: whatever is cut off or changed, there is a volume that keeps its promises, or an error.

use proptest::prelude::*;

use super::tests::{file, packed, read_with, sanity_check};
use crate::StepChoice;

/// One of each kind, to be damaged.
fn seeds() -> Vec<Vec<u8>> {
    let data: Vec<u8> = (0..48).collect();
    let axes = "dimension: 4\nsizes: 2 2 3 2\nkinds: vector domain domain domain\nspace directions: none (1,0,0) (0,2,0.5) (0,0,3)\n";
    let hex: String = data.iter().map(|byte| format!("{byte:02x}")).collect();
    vec![
        file(&format!("{axes}type: short\nendian: big\nencoding: raw\nspace: LAS"), &data),
        file(&format!("{axes}type: short\nendian: big\nencoding: gzip\nbyte skip: -1"), &packed(&data, false)),
        file(&format!("{axes}type: uint16\nendian: little\nencoding: bzip2"), &packed(&data, true)),
        file(&format!("{axes}type: uint8\nencoding: hex\nline skip: 0"), hex.as_bytes()),
        file(
            "dimension: 4\nsizes: 2 1 2 3\ntype: float\nencoding: text\naxis mins: 1 2 3 4\nspacings: 1 1 1 2",
            b"1 2 3 4 5 6 7 8 9 1e1 11 nan",
        ),
        file("dimension: 3\nsizes: 1 1 2\ntype: float\nencoding: text\ndata file: x%02d.raw 1 3 1", b""),
        file("dimension: 3\nsizes: 1 1 2\ntype: float\nencoding: text\ndata file: LIST 3\na\nb", b""),
    ]
}

fn check(bytes: Vec<u8>) {
    match read_with(bytes, StepChoice::Last) {
        Ok(loaded) => sanity_check(&loaded.dataset),
        Err(error) => assert!(error.to_string().starts_with("v.nrrd: "), "{error}"),
    }
}

#[test]
fn files_cut_anywhere() {
    for seed in seeds() {
        for length in 0..=seed.len() {
            check(seed[..length].to_vec());
        }
    }
}

proptest! {
    #[test]
    fn files_with_changed_bytes(
        seed in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = seed.get(&seeds()).clone();
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        check(bytes);
    }

    #[test]
    fn files_with_other_digits(
        seed in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![b'0'..=b'9', Just(b'-'), Just(b' ')]), 1..6),
    ) {
        let mut bytes = seed.get(&seeds()).clone();
        let digits: Vec<usize> = (8..bytes.len()).filter(|&i| bytes[i].is_ascii_digit()).collect();
        for (at, value) in changes {
            bytes[digits[at.index(digits.len())]] = value;
        }
        check(bytes);
    }
}
