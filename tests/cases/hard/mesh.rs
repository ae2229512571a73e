//! Hard cases of mesh.

use super::check;

#[test]
fn hard_coplanar_sheet() {
    check("coplanar-sheet");
}

#[test]
fn hard_cells_without_volume() {
    check("cells-without-volume");
}

#[test]
fn hard_hanging_nodes() {
    check("hanging-nodes");
}

#[test]
fn hard_overlapping_cells() {
    check("overlapping-cells");
}

#[test]
fn hard_duplicated_cells() {
    check("duplicated-cells");
}

#[test]
fn hard_cracks() {
    check("cracks");
}
