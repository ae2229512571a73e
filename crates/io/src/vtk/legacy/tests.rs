//! Each odd form of a legacy file, written out here.

use tetrascope_mesh::{ArrayValues, CellKind, DataArray, Dataset};

use super::super::test_support::{assert_same, bits, cells, read, sanity_check};
use crate::{IoError, Loaded};

const POINTS: &str = "POINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1\n";

fn text(body: &str) -> Result<Loaded, IoError> {
    read("small.vtk", format!("# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n{body}").as_bytes())
}

fn good(body: &str) -> Loaded {
    let loaded = text(body).unwrap_or_else(|e| panic!("{e}"));
    sanity_check(&loaded.dataset);
    loaded
}

fn message(body: &str) -> String {
    text(body).err().unwrap_or_else(|| panic!("it loads: {body}")).to_string()
}

fn two_tets(rest: &str) -> String {
    format!("{POINTS}CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n{rest}")
}

fn array<'d>(dataset: &'d Dataset, name: &str) -> &'d DataArray {
    let mut all = dataset.point_arrays.iter().chain(&dataset.cell_arrays);
    all.find(|a| a.name == name).unwrap_or_else(|| panic!("no array {name}"))
}

#[test]
fn legacy_two_tets() {
    let loaded = good(&two_tets(""));
    let rows = cells(&loaded.dataset);
    assert_eq!(rows.kinds, [CellKind::Tetrahedron; 2]);
    assert_eq!(rows.connectivity, [0, 1, 2, 3, 1, 2, 3, 4]);
    assert_eq!(loaded.dataset.points[4].to_array(), [1.0, 1.0, 1.0]);
    assert_eq!(loaded.format, "VTK legacy 3.0, ASCII");
}

#[test]
fn legacy_cells_of_5_1_equal_the_old_form() {
    for kind in ["vtktypeint64", "vtktypeint32", "int"] {
        let body = format!(
            "{POINTS}CELLS 3 8\nOFFSETS {kind}\n0 4 8\nCONNECTIVITY {kind}\n0 1 2 3 1 2 3 4\nCELL_TYPES 2\n10 10\n"
        );
        assert_same(&good(&body).dataset, &good(&two_tets("")).dataset, kind);
    }
    assert!(good("POINTS 0 float\nCELLS 0 0\nCELL_TYPES 0\n").dataset.points.is_empty());
    assert!(
        cells(&good(&format!("{POINTS}CELLS 1 0\nOFFSETS int\n0\nCONNECTIVITY int\nCELL_TYPES 0\n")).dataset)
            .kinds
            .is_empty()
    );
}

#[test]
fn legacy_line_ends_case_and_blank_lines() {
    let body = format!(
        "# vtk DataFile Version 2.0\n\nascii\n\ndataset unstructured_grid\n\n{}",
        two_tets("\n\npoint_data 5\nscalars s double 1\nlookup_table default\n1 2 3 4 5\n")
    );
    let unix = read("a.vtk", body.as_bytes()).unwrap().dataset;
    let windows = read("a.vtk", body.replace('\n', "\r\n").as_bytes()).unwrap().dataset;
    assert_same(&unix, &windows, "line ends");
    assert_eq!(array(&unix, "s").component(0), [1.0, 2.0, 3.0, 4.0, 5.0]);
}

#[test]
fn legacy_attributes_of_every_kind() {
    let loaded = good(&two_tets(
        "POINT_DATA 5\nSCALARS s%20x float 2\nLOOKUP_TABLE mine\n1 2 3 4 5 6 7 8 9 10\n\
         SCALARS bare int\n1 2 3 4 5\n\
         LOOKUP_TABLE mine 2\n0 0 0 1 1 1 1 1\n\
         VECTORS v double\n1 0 0 2 0 0 3 0 0 4 0 0 5 0 0\n\
         METADATA\nCOMPONENT_NAMES\nx\n\n\
         NORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 1\n\
         TEXTURE_COORDINATES t 2 float\n0 0 0 1 1 0 1 1 0 0\n\
         COLOR_SCALARS c 3\n0 0.5 1 0 0 0 1 1 1 0 0 0 2 -1 0\n\
         GLOBAL_IDS g vtkIdType\n7 8 9 10 11\nPEDIGREE_IDS p long\n1 2 3 4 5\n\
         CELL_DATA 2\n\
         TENSORS t9 float\n1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9\n\
         TENSORS6 t6 float\n1 2 3 4 5 6 1 2 3 4 5 6\n\
         FIELD FieldData 4\n\
         NULL_ARRAY\n\
         f 1 2 unsigned_short\n3 65535\nMETADATA\nINFORMATION 0\n\n\
         words 1 2 string\none thing\nanother\n\
         b 1 2 bit\n1 0\n",
    ));
    let d = &loaded.dataset;
    let shape = |name: &str| (array(d, name).components, array(d, name).values.type_name());
    assert_eq!(array(d, "s x").component(1), [2.0, 4.0, 6.0, 8.0, 10.0]);
    assert_eq!(array(d, "bare").component(0), [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(array(d, "v").magnitude(), [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(shape("n"), (3, "Float32"));
    assert_eq!(shape("t"), (2, "Float32"));
    assert_eq!(bits(&array(d, "c").values), [0, 128, 255, 0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 0, 0]);
    assert_eq!(shape("g"), (1, "Int64"));
    assert_eq!(shape("p"), (1, "Int64"));
    assert_eq!(shape("t9"), (9, "Float32"));
    assert_eq!(shape("t6"), (6, "Float32"));
    assert_eq!(bits(&array(d, "f").values), [3, 65535]);
    assert_eq!(bits(&array(d, "b").values), [1, 0]);
    assert_eq!((d.point_arrays.len(), d.cell_arrays.len()), (8, 4));
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    assert!(loaded.warnings[0].contains("words"));
}

#[test]
fn legacy_sections_that_say_nothing() {
    // A table that is never given, an empty section with a wrong count, a field of the whole file.
    let body = format!(
        "FIELD all 1\ntime 1 1 double\n0.5\n{}",
        two_tets("CELL_DATA 160\nPOINT_DATA 5\nSCALARS s int\nLOOKUP_TABLE no\n1 2 3 4 5\n")
    );
    let loaded = good(&body);
    assert_eq!((loaded.dataset.point_arrays.len(), loaded.dataset.cell_arrays.len()), (1, 0));
}

#[test]
fn legacy_polyhedron_as_face_stream() {
    let stream = "4 3 0 1 2 3 0 1 3 3 1 2 3 3 0 2 3";
    let old = good(&format!("{POINTS}CELLS 2 23\n17 {stream}\n4 1 2 3 4\nCELL_TYPES 2\n42 10\n"));
    let rows = cells(&old.dataset);
    assert_eq!(rows.polyhedra, [vec![vec![0, 1, 2], vec![0, 1, 3], vec![1, 2, 3], vec![0, 2, 3]]]);
    assert_eq!(rows.offsets, [0, 4, 8]);
    let new = good(&format!(
        "{POINTS}CELLS 3 21\nOFFSETS int\n0 17 21\nCONNECTIVITY int\n{stream} 1 2 3 4\nCELL_TYPES 2\n42 10\n"
    ));
    assert_same(&old.dataset, &new.dataset, "5.1");
    let wrong = format!("{POINTS}CELLS 1 18\n17 {stream}\nCELL_TYPES 1\n42\n").replace("4 3 0 1 2", "4 3 0 1 9");
    assert!(message(&wrong).contains("point 9"));
    let short = format!("{POINTS}CELLS 1 18\n17 {stream}\nCELL_TYPES 1\n42\n").replace("17 4 3", "17 5 3");
    assert!(message(&short).contains("face"));
}

#[test]
fn legacy_cells_with_other_than_their_number_of_points() {
    let loaded = good(&format!("{POINTS}CELLS 2 9\n5 0 1 2 3 4\n2 0 1\nCELL_TYPES 2\n10 10\n"));
    assert_eq!(cells(&loaded.dataset).offsets, [0, 4, 6]);
    assert_eq!(loaded.warnings.len(), 2, "{:?}", loaded.warnings);
    assert!(loaded.warnings[0].contains("too few") && loaded.warnings[0].contains("cell 1"));
    assert!(loaded.warnings[1].contains("more points") && loaded.warnings[1].contains("cell 0"));
}

#[test]
fn legacy_errors_name_place_and_value() {
    for (body, words) in [
        (format!("{POINTS}CELLS 1 5\n4 0 1 2 5\nCELL_TYPES 1\n10\n"), &["cell 0", "point 5", "5 points"][..]),
        (format!("{POINTS}CELLS 1 5\n4 0 1 2 -1\nCELL_TYPES 1\n10\n"), &["cell 0", "-1"]),
        (format!("{POINTS}CELLS 2 5\n4 0 1 2 3\nCELL_TYPES 2\n10 10\n"), &["CELLS", "cell 1", "nothing is left"]),
        (format!("{POINTS}CELLS 1 5\n9 0 1 2 3\nCELL_TYPES 1\n10\n"), &["cell 0", "9"]),
        (format!("{POINTS}CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 2\n10 10\n"), &["CELL_TYPES", "2 types", "1 were"]),
        (format!("{POINTS}CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n300\n"), &["cell 0", "300"]),
        (
            format!("{POINTS}CELLS 3 8\nOFFSETS int\n0 8 4\nCONNECTIVITY int\n0 1 2 3 1 2 3 4\nCELL_TYPES 2\n10 10\n"),
            &["cell 1", "from 8 to 4"],
        ),
        (
            format!("{POINTS}CELLS 2 4\nOFFSETS int\n0 9\nCONNECTIVITY int\n0 1 2 3\nCELL_TYPES 1\n10\n"),
            &["cell 0", "to 9"],
        ),
        (format!("{POINTS}CELLS 2 4\nOFFSETS float\n0 4\nCONNECTIVITY int\n0 1 2 3\n"), &["OFFSETS", "Float32"]),
        (two_tets("POINT_DATA 4\nSCALARS s int\nLOOKUP_TABLE t\n1 2 3 4\n"), &["`s`", "4 tuples", "5 were"]),
        (two_tets("POINT_DATA 5\nFIELD f 1\na 1 3 int\n1 2 3\n"), &["`a`", "3 tuples", "5 were"]),
        (two_tets("POINT_DATA 5\nSCALARS s int\nLOOKUP_TABLE t\n1 2 x 4 5\n"), &["line 17", "value 2", "\"x\""]),
        (two_tets("POINT_DATA 5\nSCALARS s int\nLOOKUP_TABLE t\n1 2\n"), &["`s`", "2 of 5"]),
        (two_tets("POINT_DATA 5\nSCALARS s complex\n"), &["complex"]),
        (two_tets("NONSENSE 5\n"), &["NONSENSE"]),
        ("POINTS 99999999999999999999 float\n".to_owned(), &["number of points"]),
        ("POINTS 18446744073709551615 float\n".to_owned(), &["POINTS"]),
        ("CELLS 0 0\n".to_owned(), &["without a POINTS"]),
    ] {
        let found = message(&body);
        assert!(found.starts_with("small.vtk: "), "{found}");
        for word in words {
            assert!(found.contains(word), "\"{word}\" is not in: {found}");
        }
    }
}

#[test]
fn legacy_other_datasets_are_unsupported() {
    for kind in ["POLYDATA", "FIELD"] {
        let file = format!("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET {kind}\n");
        let error = read("x.vtk", file.as_bytes()).unwrap_err();
        assert!(matches!(error, IoError::Unsupported { .. }) && error.to_string().contains(kind), "{error}");
    }
}

/// A binary file of one tetrahedron with an array of every type; also the seed of the fuzz tests.
pub(in crate::vtk) fn binary_file() -> Vec<u8> {
    let mut file = b"# vtk DataFile Version 3.0\nbinary\nBINARY\nDATASET UNSTRUCTURED_GRID\n".to_vec();
    let mut block = |head: &str, data: &[u8]| {
        file.extend_from_slice(head.as_bytes());
        file.push(b'\n');
        file.extend_from_slice(data);
        file.push(b'\n');
    };
    let be16 = |v: &[i16]| v.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<u8>>();
    let be32 = |v: &[i32]| v.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<u8>>();
    let be64 = |v: &[i64]| v.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<u8>>();
    let f32s = |v: &[f32]| v.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<u8>>();
    block("POINTS 4 short", &be16(&[0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1]));
    block("METADATA\nINFORMATION 1\nNAME x LOCATION y\nDATA 1 2\n", b"");
    block("CELLS 1 5", &be32(&[4, 0, 1, 2, 3]));
    block("CELL_TYPES 1", &be32(&[10]));
    block("POINT_DATA 4\nSCALARS s float\nLOOKUP_TABLE default", &f32s(&[0.5, -1.5, f32::NAN, 4.0]));
    block("COLOR_SCALARS c 2", &[0, 255, 3, 4, 5, 6, 7, 8]);
    block("FIELD FieldData 5\nid 1 4 vtkIdType", &be32(&[1, 2, -3, 4]));
    block("long 1 4 long", &be64(&[1, 2, -3, 1 << 40]));
    block("bits 1 4 bit", &[0b1010_0000]);
    // Lengths of one, two, four and eight bytes.
    block("words 1 4 string", b"\xc2hi\x80\x02ho\x40\x00\x00\x01!\x00\x00\x00\x00\x00\x00\x00\x01?");
    block("u 1 4 unsigned_char", &[1, 2, 3, 10]);
    block("CELL_DATA 1\nVECTORS v float", &f32s(&[1.0, 2.0, 2.0]));
    file
}

#[test]
fn legacy_binary_types() {
    let loaded = read("b.vtk", &binary_file()).unwrap_or_else(|e| panic!("{e}"));
    let d = &loaded.dataset;
    sanity_check(d);
    assert_eq!(d.points[3].to_array(), [0.0, 0.0, -1.0]);
    assert_eq!(cells(d).connectivity, [0, 1, 2, 3]);
    let ArrayValues::F32(s) = &array(d, "s").values else { panic!("not Float32") };
    assert!(s[0] == 0.5 && s[1] == -1.5 && s[2].is_nan() && s[3] == 4.0);
    assert_eq!(bits(&array(d, "c").values), [0, 255, 3, 4, 5, 6, 7, 8]);
    assert_eq!(array(d, "id").component(0), [1.0, 2.0, -3.0, 4.0]);
    assert_eq!(array(d, "long").component(0)[3], (1_u64 << 40) as f64);
    assert_eq!(bits(&array(d, "bits").values), [1, 0, 1, 0]);
    assert_eq!(bits(&array(d, "u").values), [1, 2, 3, 10]);
    assert_eq!(array(d, "v").magnitude(), [3.0]);
    assert_eq!(loaded.format, "VTK legacy 3.0, binary");
    assert_eq!(loaded.warnings.len(), 1);
    // Padding at the end does no harm; a missing byte is found.
    let mut padded = binary_file();
    padded.extend([0; 100]);
    assert!(read("b.vtk", &padded).is_ok());
    let cut = read("b.vtk", &binary_file()[..binary_file().len() - 2]).unwrap_err().to_string();
    assert!(cut.contains("`v`") && cut.contains("12 bytes") && cut.contains("only 11"), "{cut}");
}
