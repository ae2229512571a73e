//! Damaged files: whatever is cut off or changed, a dataset that keeps its promises comes out, or an error.

use netcdf_writer::{NcWriteFormat, NcWriteOptions};
use proptest::prelude::*;
use tetrascope_mesh::decompose;

use super::tests::{file, polyhedra, read, two_blocks};
use crate::StepChoice;

fn seeds() -> [Vec<u8>; 5] {
    let nc4 = NcWriteOptions { format: NcWriteFormat::Nc4Classic };
    [
        file(&two_blocks(false), NcWriteOptions::classic()),
        file(&two_blocks(true), NcWriteOptions::offset64()),
        file(&two_blocks(false), NcWriteOptions::cdf5()),
        polyhedra(),
        file(&two_blocks(false), nc4),
    ]
}

fn check(bytes: Vec<u8>) {
    match read(bytes, StepChoice::Last) {
        // The mesh checks every promise of a layout, and says what it misses.
        Ok(loaded) => {
            if let Err(error) = decompose(&loaded.dataset) {
                assert!(!matches!(error, tetrascope_mesh::MeshError::Inconsistent { .. }), "{error}");
            }
            let tuples = loaded.dataset.points.len();
            assert!(loaded.dataset.point_arrays.iter().all(|array| array.values.len() == tuples * array.components));
        }
        Err(error) => assert!(error.to_string().starts_with("made.exo: "), "{error}"),
    }
}

#[test]
fn files_cut_anywhere() {
    for bytes in seeds() {
        check(bytes.clone());
        for length in 0..bytes.len() {
            check(bytes[..length].to_vec());
        }
    }
}

/// Every byte of a header, one after the other, as the values that counts and offsets break at.
#[test]
fn headers_with_one_changed_byte() {
    for bytes in seeds() {
        for at in 0..bytes.len().min(3000) {
            for value in [0, 1, 0x7f, 0xff] {
                let mut bytes = bytes.clone();
                bytes[at] = value;
                check(bytes);
            }
        }
    }
}

proptest! {
    #[test]
    fn files_with_changed_bytes(
        seed in 0..5_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = seeds()[seed].clone();
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        check(bytes);
    }
}
