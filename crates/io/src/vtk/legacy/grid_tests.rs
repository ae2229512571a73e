//! Grids in legacy files: each kind, text and binary, and odd forms.

use glam::DVec3;
use tetrascope_mesh::{Cells, StructuredBlock};

use super::super::test_support::{bits, cells, read, sanity_check};
use crate::Loaded;

fn text(kind: &str, body: &str) -> String {
    format!("# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET {kind}\n{body}")
}

fn good(file: &[u8]) -> Loaded {
    let loaded = read("grid.vtk", file).unwrap_or_else(|e| panic!("{e}"));
    sanity_check(&loaded.dataset);
    loaded
}

fn block(loaded: &Loaded) -> &StructuredBlock {
    let Cells::Structured(blocks) = &loaded.dataset.cells else { panic!("not structured") };
    assert_eq!(blocks.len(), 1);
    &blocks[0]
}

fn count(n: usize) -> String {
    (0..n).map(|i| i.to_string()).collect::<Vec<_>>().join(" ")
}

/// A binary file of 3x2x2 points, also a seed of the fuzz tests.
pub(in crate::vtk) fn structured_points() -> Vec<u8> {
    let mut file = b"# vtk DataFile Version 1.0\nt\n\nBINARY\n\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nASPECT_RATIO 1.0 2 0.5\n\
        ORIGIN 10 0 -1\n\nPOINT_DATA 12\nSCALARS s unsigned_short\nLOOKUP_TABLE default\n"
        .to_vec();
    file.extend((0..12_u16).flat_map(|n| (n * 300).to_be_bytes()));
    file.extend(b"\nCELL_DATA 2\nSCALARS c float\nLOOKUP_TABLE default\n");
    file.extend([1.5_f32, -2.5].iter().flat_map(|x| x.to_be_bytes()));
    file
}

#[test]
fn structured_points_of_version_1() {
    let loaded = good(&structured_points());
    assert_eq!(block(&loaded).dims, [3, 2, 2]);
    assert_eq!(loaded.dataset.points[1], DVec3::new(11.0, 0.0, -1.0));
    assert_eq!(loaded.dataset.points[11], DVec3::new(12.0, 2.0, -0.5));
    assert_eq!(bits(&loaded.dataset.point_arrays[0].values)[11], 3300);
    assert_eq!(loaded.dataset.cell_arrays[0].component(0), [1.5, -2.5]);
    assert_eq!(loaded.format, "VTK legacy 1.0, binary, structured points, 3x2x2");
}

#[test]
fn extents_count_from_the_origin() {
    let body = format!("EXTENT -1 1 0 1 2 3\nSPACING 1 1 1\nPOINT_DATA 12\nSCALARS s float\n{}\n", count(12));
    let loaded = good(text("STRUCTURED_POINTS", &body).as_bytes());
    assert_eq!(loaded.dataset.points[0], DVec3::new(-1.0, 0.0, 2.0));
}

#[test]
fn rectilinear_and_structured_grids() {
    let body = format!(
        "DIMENSIONS 3 2 2\nX_COORDINATES 3 float\n0 1 4\nY_COORDINATES 2 double\n-1 1\nZ_COORDINATES 2 int\n5 7\n\
         CELL_DATA 2\nSCALARS c int\nLOOKUP_TABLE default\n7 8\nPOINT_DATA 12\nFIELD f 1\ns 1 12 float\n{}\n",
        count(12)
    );
    let loaded = good(text("rectilinear_grid", &body).as_bytes());
    assert_eq!(block(&loaded).dims, [3, 2, 2]);
    assert_eq!(loaded.dataset.points[5], DVec3::new(4.0, 1.0, 5.0));
    assert_eq!((loaded.dataset.cell_arrays.len(), loaded.dataset.point_arrays.len()), (1, 1));

    let xyz: Vec<String> = loaded.dataset.points.iter().map(|p| format!("{} {} {}", p.x, p.y, p.z)).collect();
    let body = format!(
        "DIMENSIONS 3 2 2\nBLANKING 12 int\n1 1 1 1 1 1 1 1 1 1 1 0\nPOINTS 12 float\n{}\nMETADATA\nINFORMATION 0\n\n",
        xyz.join("\n")
    );
    let structured = good(text("STRUCTURED_GRID", &body).as_bytes());
    assert_eq!(structured.dataset.points, loaded.dataset.points);
    assert!(block(&structured).hidden_points[11] && !block(&structured).hidden_points[10]);
}

#[test]
fn hidden_cells_and_copies() {
    let body = |marks: &str| {
        let marks = format!("CELL_DATA 4\nFIELD f 1\nvtkGhostType 1 4 unsigned_char\n{marks}\n");
        text("STRUCTURED_POINTS", &format!("DIMENSIONS 5 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n{marks}"))
    };
    let hidden = good(body("0 32 0 0").as_bytes());
    assert_eq!(cells(&hidden.dataset).kinds.len(), 3);
    let copies = good(body("1 0 0 0").as_bytes());
    assert_eq!(block(&copies).dims, [4, 2, 2]);
    assert_eq!(copies.dataset.points[0], DVec3::X);
    let points =
        "POINTS 5 float\n0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10 10\n";
    let marks = "CELL_DATA 2\nFIELD f 1\nvtkGhostType 1 2 unsigned_char\n1 0\n";
    let unstructured = good(text("UNSTRUCTURED_GRID", &format!("{points}{marks}")).as_bytes());
    assert_eq!(cells(&unstructured.dataset).connectivity, [1, 2, 3, 4]);
    assert_eq!(unstructured.warnings.len(), 1);
}

#[test]
fn grid_errors_name_place_and_value() {
    for (kind, body, words) in [
        ("STRUCTURED_POINTS", "ORIGIN 0 0 0\n", &["DIMENSIONS"][..]),
        ("STRUCTURED_POINTS", "DIMENSIONS 2 2\n", &["DIMENSIONS", "\"\""]),
        ("STRUCTURED_POINTS", "DIMENSIONS 2 -2 2\n", &["\"-2\"", "line 5"]),
        ("STRUCTURED_POINTS", "DIMENSIONS 99999 99999 2\n", &["99999 x 99999 x 2"]),
        ("STRUCTURED_POINTS", "DIMENSIONS 18446744073709551615 1 1\n", &["18446744073709551615"]),
        ("STRUCTURED_POINTS", "DIMENSIONS 1000 1000 1000\n", &["DIMENSIONS", "limit"]),
        ("STRUCTURED_POINTS", "DIMENSIONS 2 2 2\nSPACING 1 nan 1\n", &["\"nan\"", "SPACING"]),
        ("STRUCTURED_POINTS", "DIMENSIONS 2 2 2\nPOINTS 1 float\n0 0 0\n", &["POINTS"]),
        (
            "STRUCTURED_POINTS",
            "DIMENSIONS 2 2 2\nPOINT_DATA 7\nSCALARS s int\n1 2 3 4 5 6 7\n",
            &["`s`", "7 tuples", "8 were"],
        ),
        ("STRUCTURED_GRID", "DIMENSIONS 2 2 2\n", &["POINTS", "missing"]),
        ("STRUCTURED_GRID", "DIMENSIONS 2 2 2\nPOINTS 1 float\n0 0 0\n", &["POINTS", "3 numbers", "24"]),
        ("RECTILINEAR_GRID", "DIMENSIONS 2 2 2\nX_COORDINATES 2 int\n1 2\n", &["Y_COORDINATES", "missing"]),
        ("RECTILINEAR_GRID", "DIMENSIONS 2 2 2\nX_COORDINATES 3 int\n1 2 3\n", &["X_COORDINATES", "3 numbers"]),
        ("RECTILINEAR_GRID", "DIMENSIONS 2 2 2\nX_COORDINATES 3 string\n1 2 3\n", &["X_COORDINATES", "text"]),
        ("RECTILINEAR_GRID", "CELLS 1 1\n", &["CELLS"]),
        ("UNSTRUCTURED_GRID", "DIMENSIONS 2 2 2\n", &["DIMENSIONS"]),
    ] {
        let found = read("grid.vtk", text(kind, body).as_bytes()).err().unwrap_or_else(|| panic!("it loads: {body}"));
        let found = found.to_string();
        assert!(found.starts_with("grid.vtk: "), "{found}");
        for word in words {
            assert!(found.contains(word), "\"{word}\" is not in: {found}");
        }
    }
}
