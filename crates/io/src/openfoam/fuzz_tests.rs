//! Damaged cases: whatever is cut off or changed in a file, the reader gives a dataset that keeps its promises, or an error.

use proptest::prelude::*;

use super::test_support::*;
use crate::vtk::sanity_check;

/// Files of a case with everything in it, and whose mesh they belong to.
fn files(style: Style) -> Vec<(String, Vec<u8>)> {
    let mesh = mixed();
    let mut files: Vec<(String, Vec<u8>)> = mesh_files(&mesh, &mesh.faces(), style)
        .into_iter()
        .map(|(name, bytes)| (format!("constant/polyMesh/{name}"), bytes))
        .collect();
    files.push(("1/p".to_owned(), style.field("volScalarField", "scalar", &[0.5, 1.0, 2.0, 4.0, 8.0], 1)));
    let displacement: Vec<f64> = (0..17 * 3).map(f64::from).collect();
    files.push(("1/D".to_owned(), style.field("pointVectorField", "vector", &displacement, 3)));
    let uniform = b"u 1;\ninternalField uniform ($u 2 3);\nboundaryField { a { type b; } }\n";
    files.push(("1/U".to_owned(), [style.header("volVectorField"), uniform.to_vec()].concat()));
    files
}

fn check(case: &TestCase) {
    match case.read() {
        Ok(loaded) => sanity_check(&loaded.dataset),
        Err(error) => assert!(error.to_string().contains(&case.root().to_string_lossy().into_owned()), "{error}"),
    }
}

fn case_of(files: &[(String, Vec<u8>)]) -> TestCase {
    let case = TestCase::new();
    for (name, bytes) in files {
        case.write(name, bytes);
    }
    case
}

#[test]
fn files_cut_anywhere() {
    for style in [Style::Text, BINARY] {
        let files = files(style);
        let case = case_of(&files);
        assert_eq!(case.read().unwrap().dataset.cell_arrays.len(), 2);
        for (name, bytes) in &files {
            for length in 0..bytes.len() {
                case.write(name, &bytes[..length]);
                check(&case);
            }
            case.write(name, bytes);
        }
    }
}

#[test]
fn compressed_files_cut_anywhere() {
    let files = files(Style::Text);
    let case = case_of(&files);
    let name = "constant/polyMesh/owner";
    case.compress(name);
    let packed = std::fs::read(case.path(&format!("{name}.gz"))).unwrap();
    for length in 0..packed.len() {
        case.write(&format!("{name}.gz"), &packed[..length]);
        let error = case.read().unwrap_err().to_string();
        assert!(error.contains("owner.gz"), "{error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn files_with_changed_bytes(
        binary in any::<bool>(),
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        in_content in any::<bool>(),
    ) {
        let mut files = files(if binary { BINARY } else { Style::Text });
        let (_, bytes) = &mut files[which.index(7)];
        let start = if in_content { 180.min(bytes.len() - 1) } else { 0 };
        for (at, value) in changes {
            let at = start + at.index(bytes.len() - start);
            bytes[at] = value;
        }
        check(&case_of(&files));
    }

    #[test]
    fn files_with_other_digits(
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..10_u8), 1..6),
    ) {
        let mut files = files(Style::Text);
        let (_, bytes) = &mut files[which.index(7)];
        let digits: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i].is_ascii_digit()).collect();
        for (at, value) in changes {
            bytes[digits[at.index(digits.len())]] = b'0' + value;
        }
        check(&case_of(&files));
    }
}
