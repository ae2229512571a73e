//! Damaged files: whatever is cut off or changed, the readers give a dataset that keeps its promises, or an error.

use proptest::prelude::*;

use super::legacy::grid_tests::structured_points;
use super::legacy::tests::binary_file;
use super::test_support::{read, sanity_check};
use super::xml::grid_tests::{KINDS, in_two_pieces};
use super::xml::tests::{ascii_file, raw_zlib_file};

const LEGACY_TEXT: &str = "# vtk DataFile Version 5.1\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n\
    0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 3 21\nOFFSETS vtktypeint64\n0 17 21\nCONNECTIVITY vtktypeint64\n\
    4 3 0 1 2 3 0 1 3 3 1 2 3 3 0 2 3 1 2 3 4\nCELL_TYPES 2\n42 10\nPOINT_DATA 5\nFIELD f 1\na%20b 1 5 int\n1 2 3 4 5\n";

fn seeds() -> [(&'static str, Vec<u8>); 8] {
    [
        ("ascii.vtu", ascii_file().into_bytes()),
        ("raw.vtu", raw_zlib_file()),
        ("binary.vtk", binary_file()),
        ("text.vtk", LEGACY_TEXT.as_bytes().to_vec()),
        ("pieces.vti", in_two_pieces(KINDS[0]).into_bytes()),
        ("pieces.vtr", in_two_pieces(KINDS[1]).into_bytes()),
        ("pieces.vts", in_two_pieces(KINDS[2]).into_bytes()),
        ("points.vtk", structured_points()),
    ]
}

fn check(name: &str, bytes: &[u8]) {
    match read(name, bytes) {
        Ok(loaded) => sanity_check(&loaded.dataset),
        Err(error) => assert!(error.to_string().starts_with(name), "{error}"),
    }
}

#[test]
fn seeds_themselves_load() {
    for (name, bytes) in seeds() {
        sanity_check(&read(name, &bytes).unwrap_or_else(|e| panic!("{e}")).dataset);
    }
}

#[test]
fn files_cut_anywhere() {
    for (name, bytes) in seeds() {
        for length in 0..bytes.len() {
            check(name, &bytes[..length]);
        }
    }
}

proptest! {
    #[test]
    fn files_with_changed_bytes(
        seed in 0..8_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let (name, mut bytes) = seeds()[seed].clone();
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        check(name, &bytes);
    }

    #[test]
    fn files_with_other_digits(
        seed in 0..8_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..10_u8), 1..6),
    ) {
        let (name, mut bytes) = seeds()[seed].clone();
        let digits: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i].is_ascii_digit()).collect();
        for (at, value) in changes {
            bytes[digits[at.index(digits.len())]] = b'0' + value;
        }
        check(name, &bytes);
    }

    #[test]
    fn blocks_of_any_bytes_in_every_compressor(block in prop::collection::vec(any::<u8>(), 0..300), size in 0..5000_usize) {
        use super::xml::tests::decompress_with_all;
        decompress_with_all(&block, size);
    }
}
