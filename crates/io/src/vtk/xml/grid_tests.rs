//! Grids in XML: each kind, pieces, marks and odd forms, written out here.

use glam::DVec3;
use tetrascope_mesh::{ArrayValues, Cells, Dataset, StructuredBlock};

use super::super::test_support::{bits, cells, read, sanity_check};
use crate::Loaded;

fn array(kind: &str, name: &str, components: usize, values: impl IntoIterator<Item = f64>) -> String {
    let text: Vec<String> = values.into_iter().map(|x| x.to_string()).collect();
    format!(
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">{}</DataArray>\n",
        text.join(" ")
    )
}

fn grid(kind: &str, attributes: &str, pieces: &str) -> String {
    format!(
        "<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\"><{kind} {attributes}>{pieces}</{kind}></VTKFile>"
    )
}

/// A number that tells a point, or a cell, of the whole grid from all others.
fn tell([i, j, k]: [i64; 3]) -> f64 {
    (i + 10 * j + 100 * k) as f64
}

fn places(extent: [i64; 6], cells: bool) -> Vec<[i64; 3]> {
    let less = i64::from(cells);
    let mut all = Vec::new();
    for k in extent[4]..=extent[5] - less {
        for j in extent[2]..=extent[3] - less {
            all.extend((extent[0]..=extent[1] - less).map(|i| [i, j, k]));
        }
    }
    all
}

/// A piece with a point array `p`, a cell array `c`, and what a kind of grid says of its points.
fn piece(kind: &str, extent: [i64; 6], more_points: &str, more_cells: &str) -> String {
    let point = |[i, j, k]: [i64; 3]| [i as f64, 2.0 * j as f64, k as f64 * k as f64];
    let along = |axis: usize| {
        let values = extent[2 * axis]..=extent[2 * axis + 1];
        array("Float32", "", 1, values.map(|n| point([n, n, n])[axis]))
    };
    let geometry = match kind {
        "StructuredGrid" => {
            let xyz = array("Float64", "Points", 3, places(extent, false).into_iter().flat_map(point));
            format!("<Points>{xyz}</Points>")
        }
        "RectilinearGrid" => format!("<Coordinates>{}{}{}</Coordinates>", along(0), along(1), along(2)),
        _ => String::new(),
    };
    let p = array("Float32", "p", 1, places(extent, false).into_iter().map(tell));
    let c = array("Int16", "c", 2, places(extent, true).into_iter().flat_map(|place| [tell(place), -1.0]));
    let extent = extent.map(|n| n.to_string()).join(" ");
    format!(
        "<Piece Extent=\"{extent}\"><PointData>{p}{more_points}</PointData><CellData>{more_cells}{c}</CellData>{geometry}</Piece>"
    )
}

fn good(file: &str) -> Loaded {
    let loaded = read("grid.vti", file.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    sanity_check(&loaded.dataset);
    loaded
}

fn message(file: &str) -> String {
    read("grid.vti", file.as_bytes()).err().unwrap_or_else(|| panic!("it loads: {file}")).to_string()
}

fn block(dataset: &Dataset) -> &StructuredBlock {
    let Cells::Structured(blocks) = &dataset.cells else { panic!("not structured") };
    assert_eq!(blocks.len(), 1);
    &blocks[0]
}

pub(in crate::vtk) const KINDS: [&str; 3] = ["ImageData", "RectilinearGrid", "StructuredGrid"];
const WHOLE: [i64; 6] = [-1, 3, 0, 2, 1, 3];

fn check_whole(loaded: &Loaded, what: &str) {
    let dataset = &loaded.dataset;
    assert_eq!(block(dataset).dims, [5, 3, 3], "{what}");
    assert!(block(dataset).hidden_points.is_empty(), "{what}");
    let of_points: Vec<f64> = places(WHOLE, false).into_iter().map(tell).collect();
    let of_cells: Vec<f64> = places(WHOLE, true).into_iter().map(tell).collect();
    assert_eq!(dataset.point_arrays[0].component(0), of_points, "{what}");
    let c = dataset.cell_arrays.iter().find(|array| array.name == "c").unwrap();
    assert_eq!(c.component(0), of_cells, "{what}");
    assert!(c.component(1).iter().all(|&x| x == -1.0), "{what}");
    let squares = !what.starts_with("ImageData");
    for (point, [i, j, k]) in dataset.points.iter().zip(places(WHOLE, false)) {
        let expected = if squares { [i, 2 * j, k * k] } else { [i, j, k] };
        assert_eq!(point.to_array(), expected.map(|n| n as f64), "{what}");
    }
}

/// A seed of the fuzz tests: pieces that overlap, with marks.
pub(in crate::vtk) fn in_two_pieces(kind: &str) -> String {
    let marks = |count| array("UInt8", "vtkGhostType", 1, (0..count).map(|n| f64::from(u8::from(n == 1))));
    let pieces = piece(kind, [0, 2, 0, 1, 0, 1], &marks(12), &marks(2)) + &piece(kind, [1, 3, 0, 1, 0, 1], "", "");
    grid(kind, "WholeExtent=\"0 3 0 1 0 1\" Origin=\"0 0 1\" Spacing=\"1 2 1\"", &pieces)
}

#[test]
fn grids_of_every_kind_whole_and_in_pieces() {
    let whole = "WholeExtent=\"-1 3 0 2 1 3\"";
    for kind in KINDS {
        let one = good(&grid(kind, whole, &piece(kind, WHOLE, "", "")));
        check_whole(&one, kind);
        assert!(one.warnings.is_empty(), "{:?}", one.warnings);
        // Two pieces side by side, and one that overlaps both by a layer, whose empty companion says nothing.
        let parts = [[-1, 1, 0, 2, 1, 3], [1, 3, 0, 1, 1, 3], [0, 3, 1, 2, 1, 3]];
        let empty = "<Piece Extent=\"0 -1 0 -1 0 -1\"/>";
        let pieces = parts.map(|part| piece(kind, part, "", "")).concat() + empty;
        let joined = good(&grid(kind, whole, &pieces));
        check_whole(&joined, &format!("{kind} in pieces"));
        assert!(joined.warnings.is_empty(), "{:?}", joined.warnings);
    }
}

#[test]
fn image_points_follow_origin_spacing_and_direction() {
    let turned = "Origin=\"10 20 30\" Spacing=\"2 3 4\" Direction=\"0 -1 0 1 0 0 0 0 1\"";
    let loaded = good(&grid("ImageData", turned, &piece("ImageData", [1, 2, 0, 1, 0, 1], "", "")));
    let points = &loaded.dataset.points;
    // Of the point (1, 0, 0): one step of 2 along the first column of the matrix.
    assert_eq!(points[0], DVec3::new(10.0, 22.0, 30.0));
    assert_eq!(points[1], DVec3::new(10.0, 24.0, 30.0));
    assert_eq!(points[2], DVec3::new(7.0, 22.0, 30.0));
    assert_eq!(points[4], DVec3::new(10.0, 22.0, 34.0));
    assert!(loaded.format.contains("image data 1.0, ASCII, 2x2x2"), "{}", loaded.format);
}

#[test]
fn copies_around_a_piece_are_cropped() {
    // The last layer along i is marked.
    let marks = places(WHOLE, true).into_iter().map(|[i, _, _]| f64::from(u8::from(i == 2)));
    for (name, kind) in [("vtkGhostType", "UInt8"), ("vtkGhostLevels", "UInt8")] {
        let ghosts = array(kind, name, 1, marks.clone());
        let loaded = good(&grid("ImageData", "", &piece("ImageData", WHOLE, "", &ghosts)));
        let dataset = &loaded.dataset;
        assert_eq!(block(dataset).dims, [4, 3, 3]);
        assert_eq!(dataset.cell_arrays.len(), 1);
        let kept: Vec<f64> = places([-1, 2, 0, 2, 1, 3], false).into_iter().map(tell).collect();
        assert_eq!(dataset.point_arrays[0].component(0), kept);
        assert_eq!(loaded.warnings.len(), 1);
        assert!(loaded.warnings[0].contains("4 of 16 cells are left out"), "{:?}", loaded.warnings);
    }
}

#[test]
fn cells_hidden_within_make_hexahedra() {
    let marks = places(WHOLE, true).into_iter().map(|place| if place == [1, 0, 1] { 32.0 } else { 2.0 });
    let loaded =
        good(&grid("ImageData", "", &piece("ImageData", WHOLE, "", &array("UInt8", "vtkGhostType", 1, marks))));
    let rows = cells(&loaded.dataset);
    assert_eq!((rows.kinds.len(), loaded.warnings.len()), (15, 2), "{:?}", loaded.warnings);
    assert_eq!(rows.connectivity[..8], [0, 1, 6, 5, 15, 16, 21, 20]);
    let ArrayValues::I16(c) = &loaded.dataset.cell_arrays[0].values else { panic!("not Int16") };
    assert!(!c.contains(&101) && c.len() == 30);
}

#[test]
fn hidden_points_stay_in_their_block() {
    let marks = places(WHOLE, false).into_iter().map(|place| if place == [0, 0, 1] { 2.0 } else { 1.0 });
    let marks = array("UInt8", "vtkGhostType", 1, marks);
    let loaded = good(&grid("RectilinearGrid", "", &piece("RectilinearGrid", WHOLE, &marks, "")));
    let hidden = &block(&loaded.dataset).hidden_points;
    assert_eq!(hidden.iter().filter(|&&hidden| hidden).count(), 1);
    assert!(hidden[1] && loaded.dataset.point_arrays.len() == 1);
}

#[test]
fn pieces_with_copies_fit_together() {
    // Each piece has a layer of the other's cells, marked, with another number in them.
    let of = |extent: [i64; 6], is_copy: fn(i64) -> bool, number: f64| {
        let marks = places(extent, true).into_iter().map(|[i, _, _]| f64::from(u8::from(is_copy(i))));
        let owner = places(extent, true).into_iter().map(|_| number);
        piece("ImageData", extent, "", &(array("UInt8", "vtkGhostType", 1, marks) + &array("Int8", "owner", 1, owner)))
    };
    let pieces = of([-1, 2, 0, 2, 1, 3], |i| i >= 1, 0.0) + &of([0, 3, 0, 2, 1, 3], |i| i < 1, 1.0);
    let loaded = good(&grid("ImageData", "", &pieces));
    check_whole(&loaded, "ImageData with copies");
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let owner = loaded.dataset.cell_arrays.iter().find(|array| array.name == "owner").unwrap();
    assert_eq!(owner.component(0), [0.0, 0.0, 1.0, 1.0].repeat(4));
}

#[test]
fn pieces_that_leave_gaps_and_pieces_far_apart() {
    let of = |extent| piece("ImageData", extent, "", "");
    let gap = of([0, 1, 0, 1, 0, 1]) + &of([2, 3, 0, 1, 0, 1]);
    let loaded = good(&grid("ImageData", "", &gap));
    let rows = cells(&loaded.dataset);
    assert_eq!(rows.kinds.len(), 2);
    assert!(loaded.warnings[0].contains("1 of 3 cells"), "{:?}", loaded.warnings);
    let far = of([0, 1, 0, 1, 0, 1]) + &of([90, 91, 90, 91, 90, 91]);
    let loaded = good(&grid("ImageData", "", &far));
    let Cells::Structured(blocks) = &loaded.dataset.cells else { panic!("not structured") };
    assert_eq!((blocks.len(), loaded.dataset.points.len()), (2, 16));
    assert_eq!(loaded.dataset.points[8], DVec3::splat(90.0));
    assert!(loaded.warnings[0].contains("do not tile"), "{:?}", loaded.warnings);
}

#[test]
fn arrays_that_not_all_pieces_have() {
    let extents = [[0, 1, 0, 1, 0, 1], [1, 2, 0, 1, 0, 1]];
    let q = array("Float32", "q", 1, [0.0; 8]);
    let pieces =
        piece("ImageData", extents[0], &q, "") + &piece("ImageData", extents[1], "", &array("Int8", "d", 1, [1.0]));
    let loaded = good(&grid("ImageData", "", &pieces));
    assert_eq!((loaded.dataset.point_arrays.len(), loaded.dataset.cell_arrays.len()), (1, 1));
    assert_eq!(loaded.warnings.len(), 2, "{:?}", loaded.warnings);
    assert!(loaded.warnings[0].contains("`q`") && loaded.warnings[1].contains("`d`"));
}

#[test]
fn flat_and_empty_grids() {
    let p = array("Float32", "p", 1, (0..6).map(f64::from));
    let c = array("Float32", "c", 1, (0..2).map(f64::from));
    let flat = format!("<Piece Extent=\"0 2 0 1 5 5\"><PointData>{p}</PointData><CellData>{c}</CellData></Piece>");
    let loaded = good(&grid("ImageData", "", &flat));
    assert_eq!((loaded.dataset.points.len(), loaded.dataset.cell_arrays.len()), (6, 0));
    assert!(loaded.warnings[0].contains("flat"), "{:?}", loaded.warnings);
    let empty = good(&grid("StructuredGrid", "", "<Piece Extent=\"0 -1 0 -1 0 -1\"/>"));
    assert!(empty.dataset.points.is_empty());
}

#[test]
fn times_in_the_file() {
    let time = "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.25</DataArray></FieldData>";
    let file = grid("ImageData", "", &(time.to_owned() + &piece("ImageData", WHOLE, "", "")));
    let loaded = good(&file);
    assert_eq!((loaded.times.as_slice(), loaded.step), ([0.25].as_slice(), 0));
    // Several steps, each with arrays of its own; what does not change is written once.
    let steps = [("0", 1.0), ("1", 2.0), ("7", 3.0)].map(|(steps, value)| {
        array("Float32", "p", 1, [value; 8]).replace("format", &format!("TimeStep=\"{steps}\" format"))
    });
    let piece = format!("<Piece><PointData>{}</PointData></Piece>", steps.concat());
    let file = grid("ImageData", "WholeExtent=\"0 1 0 1 0 1\" TimeValues=\"0 0.5 0.75\"", &piece);
    let loaded = good(&file);
    assert_eq!((loaded.times.len(), loaded.step), (3, 2));
    assert_eq!(loaded.dataset.point_arrays[0].component(0)[0], 2.0);
    // Each step a piece, all as the first step.
    let of = |value: f64| {
        let p = array("Float32", "p", 1, [value; 8]).replace("format", "TimeStep=\"0\" format");
        format!("<Piece Extent=\"0 1 0 1 0 1\"><PointData>{p}</PointData></Piece>")
    };
    let pieces = grid("ImageData", "TimeValues=\"0 1\"", &(of(5.0) + &of(6.0)));
    let loaded = good(&pieces);
    assert_eq!((loaded.step, loaded.dataset.points.len(), loaded.dataset.point_arrays[0].component(0)[0]), (1, 8, 6.0));
    let mut source = crate::Source { path: "t.vti".into(), bytes: file.into_bytes(), ..Default::default() };
    source.options.step = crate::StepChoice::Time(0.1);
    let first = crate::MeshReader::read(&super::super::VTI, &source).unwrap();
    assert_eq!((first.step, first.dataset.point_arrays[0].component(0)[0]), (0, 1.0));
    source.options.step = crate::StepChoice::Number(3);
    assert!(crate::MeshReader::read(&super::super::VTI, &source).is_err());
}

#[test]
fn grid_errors_name_place_and_value() {
    let one = |kind: &str| grid(kind, "Spacing=\"1 1 1\"", &piece(kind, [0, 1, 0, 1, 0, 1], "", ""));
    let image = one("ImageData");
    for (file, words) in [
        (image.replace("0 1 0 1 0 1", "0 1 0 1 0"), &["line 1", "`Extent`", "six whole numbers"][..]),
        (image.replace("0 1 0 1 0 1", "0 9000000 0 9000000 0 1"), &["`Extent`", "points"]),
        (image.replace("0 1 0 1 0 1", "0 1 0 1 0 2"), &["`p`", "8 values", "12 were"]),
        (image.replace("0 1 0 1 0 1", "0 999 0 999 0 999"), &["1000 x 1000 x 1000", "limit"]),
        (image.replace("Extent", "Content"), &["Extent", "WholeExtent"]),
        (image.replace("\"1 1 1\"", "\"1 nan 1\""), &["Spacing", "3 finite numbers"]),
        (image.replace("<Piece", "<Pierce").replace("Piece>", "Pierce>"), &["ImageData", "no Piece"]),
        (one("RectilinearGrid").replace("Coordinates>", "Coords>"), &["x coordinates", "missing"]),
        (one("RectilinearGrid").replace(">0 2<", ">0 2 4<"), &["y coordinates", "3 values"]),
        (one("StructuredGrid").replace("Points>", "Pints>"), &["8 points", "no Points"]),
        (one("StructuredGrid").replace("Float64", "String"), &["Points", "String"]),
    ] {
        let found = message(&file);
        assert!(found.starts_with("grid.vti: "), "{found}");
        for word in words {
            assert!(found.contains(word), "\"{word}\" is not in: {found}");
        }
    }
}

#[test]
fn kinds_are_told_by_the_root() {
    for kind in KINDS {
        assert_eq!(super::root_type(grid(kind, "", "").as_bytes()), Some(kind));
    }
    assert_eq!(super::root_type(b"<VTKFile header_type='a' type='b'>"), Some("b"));
    assert_eq!(super::root_type(b"<VTKFile><type=\"x\">"), Some(""));
    assert_eq!(super::root_type(b"VTKFile"), None);
}

#[test]
fn numbers_keep_their_type_when_pieces_are_joined() {
    let of = |extent, value| piece("ImageData", extent, &array("UInt16", "u", 1, [value; 8]), "");
    let pieces = of([0, 1, 0, 1, 0, 1], 7.0) + &of([1, 2, 0, 1, 0, 1], 65535.0);
    let loaded = good(&grid("ImageData", "", &pieces));
    assert_eq!(bits(&loaded.dataset.point_arrays[1].values), [7, 65535, 65535].repeat(4));
}
