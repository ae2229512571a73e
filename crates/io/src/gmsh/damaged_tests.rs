//! Damaged files: whatever is cut off or changed, the reader gives a mesh that keeps its promises, or an error that says where.

use proptest::prelude::*;

use super::sections::Version;
use super::synthetic::{file, read, styles};
use super::tests::{cells, small};
use crate::{Loaded, ReadOptions};

fn seeds() -> Vec<Vec<u8>> {
    let (mesh, views) = small();
    styles().into_iter().map(|style| file(style, &mesh, &views)).collect()
}

fn sanity_check(loaded: &Loaded) {
    let rows = cells(loaded);
    assert_eq!((rows.offsets.len(), rows.offsets[0]), (rows.kinds.len() + 1, 0));
    assert!(rows.offsets.is_sorted() && *rows.offsets.last().unwrap() == rows.connectivity.len());
    let dataset = &loaded.dataset;
    assert!(rows.connectivity.iter().all(|&point| (point as usize) < dataset.points.len()));
    for (arrays, tuples) in [(&dataset.point_arrays, dataset.points.len()), (&dataset.cell_arrays, rows.kinds.len())] {
        for array in arrays {
            assert!(array.components >= 1 && !array.name.is_empty());
            assert_eq!(array.values.len(), tuples * array.components, "{}", array.name);
        }
    }
}

fn check(bytes: &[u8]) {
    match read("damaged.msh", bytes, &ReadOptions::default()) {
        Ok(loaded) => sanity_check(&loaded),
        Err(error) => {
            let text = error.to_string();
            assert!(text.starts_with("damaged.msh: ") && text.contains("; "), "{text}");
        }
    }
}

#[test]
fn files_cut_anywhere() {
    for bytes in seeds() {
        for length in 0..bytes.len() {
            check(&bytes[..length]);
        }
    }
}

#[test]
fn every_byte_changed() {
    for bytes in seeds() {
        for at in 0..bytes.len() {
            for value in [0, 0xff, b'9', b'-', b'\n', bytes[at] ^ 1] {
                let mut changed = bytes.clone();
                changed[at] = value;
                check(&changed);
            }
        }
    }
}

proptest! {
    #[test]
    fn several_bytes_changed(
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..6),
        dropped in 0..40_usize,
    ) {
        let mut bytes = which.get(&seeds()).clone();
        for (at, value, is_digit) in changes {
            let at = at.index(bytes.len());
            bytes[at] = if is_digit { b'0' + value % 10 } else { value };
        }
        let from = which.index(bytes.len());
        bytes.drain(from..(from + dropped).min(bytes.len()));
        check(&bytes);
    }
}

/// What must be in the message of a file that was changed in one place.
#[test]
fn errors_say_what_and_where() {
    let (mesh, views) = small();
    let style = styles().into_iter().find(|style| style.version == Version::V2 && style.binary.is_none()).unwrap();
    let text = String::from_utf8(file(style, &mesh, &views)).unwrap();
    let view = "$NodeData\n1\n\"height of it\"\n1\n0.5\n4\n1\n1\n7\n";
    for (from, to, words) in [
        ("2.2 0 8", "3.1 0 8", &["version 3.1", "Gmsh"][..]),
        ("2.2 0 8", "x 0 8", &["$MeshFormat", "version"]),
        ("2.2 0 8", "2.2 7 8", &["$MeshFormat", "binary"]),
        ("2.2 0 8", "2.2 1 8", &["order of bytes"]),
        ("$EndNodes", "", &["$Nodes", "before $EndNodes"]),
        ("$Nodes\n7", "$Nodes\n-7", &["$Nodes, line 1", "number of nodes", "-7"]),
        ("$Nodes\n7", "$Nodes\n8", &["section ends", "node"]),
        ("1000000 0.0", "1000000 zero", &["line 15", "\"zero\"", "coordinate"]),
        ("15 4 2 0 7 5 ", "15 4 2 0 7 6 ", &["$Elements, line", "node 6", "not there"]),
        ("15 4 2 0 7 5 ", "15 35 2 0 7 5 ", &["polyhedron"]),
        ("15 4 2 0 7 5 ", "15 77 2 0 7 5 ", &["type 77"]),
        ("$Elements\n3", "$Elements\n99999999999", &["section ends", "element"]),
        (view, "$NodeData\n1\n\"height of it\"\n1\n0.5\n4\n1\n0\n7\n", &["0 components", "1 to 9"]),
        (view, "$NodeData\n1\n\"height of it\"\n1\n0.5\n2\n1\n1\n7\n", &["2 integer tags"]),
        (view, "$NodeData\n1\n\"height of it\"\n1\n0.5\n4\n1\n3\n7\n", &["$NodeData", "value"]),
        (view, "$NodeData\n9999999999\n\"height of it\"\n1\n0.5\n", &["$NodeData", "texts"]),
        ("$Elements", "$Cells", &["$Cells", "$EndCells"]),
    ] {
        assert!(text.contains(from), "{from}");
        let error = read("b.msh", text.replacen(from, to, 1).as_bytes(), &ReadOptions::default()).err();
        let error = error.unwrap_or_else(|| panic!("{to} loads")).to_string();
        for word in words {
            assert!(error.contains(word), "{to}: \"{word}\" is not in: {error}");
        }
    }
    let no_mesh = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$NodeData\n0\n0\n3\n0\n1\n0\n$EndNodeData\n";
    let error = read("v.msh", no_mesh.as_bytes(), &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("no section $Nodes") && error.contains("merge"), "{error}");
}

/// Sections of a few bytes that each ask for an array of all points.
#[test]
fn arrays_have_a_limit() {
    let mut text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 20000 1 20000\n3 1 0 20000\n".to_owned();
    (1..=20_000).for_each(|number| text += &format!("{number}\n"));
    text += &"0 0 0\n".repeat(20_000);
    text += "$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";
    (0..4000).for_each(|name| text += &format!("$NodeData\n1\nv{name}\n0\n3\n0\n9\n0\n$EndNodeData\n"));
    let error = read("bomb.msh", text.as_bytes(), &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("16 for each byte") && error.contains("$NodeData"), "{error}");
}
