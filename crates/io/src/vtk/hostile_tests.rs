//! Both readers on the shared files that are broken or odd.

use super::test_support::{cells, finite_range, read_file, sanity_check, shared};
use crate::{IoError, Loaded};

/// Files that must load, with their counts.
const VALID: &[(&str, usize, usize)] = &[
    ("all_nan_scalars.vtu", 125, 320),
    ("array_name_empty.vtu", 125, 320),
    ("array_names_odd.vtu", 125, 320),
    ("array_names_repeated.vtu", 125, 320),
    ("constant_scalar.vtu", 125, 320),
    ("crlf.vtk", 125, 320),
    ("duplicate_points.vtu", 1280, 320),
    ("empty_mesh.vtu", 0, 0),
    ("huge_and_tiny_scalars.vtu", 125, 320),
    ("inverted_tets.vtu", 125, 320),
    ("legacy_vtk_named.msh", 125, 320),
    ("nan_coordinates.vtu", 125, 320),
    ("nan_inf_scalars_ascii.vtu", 125, 320),
    ("nan_inf_scalars_binary.vtu", 125, 320),
    ("nanometres.vtu", 125, 320),
    ("no_3d_cells.vtu", 125, 3),
    ("no_arrays.vtu", 125, 320),
    ("nonconforming_faces.vtu", 6, 3),
    ("overlapping_tets.vtu", 8, 3),
    ("points_but_no_cells.vtu", 125, 0),
    ("repeated_vertex_cells.vtu", 125, 320),
    ("scale_1e20.vtu", 125, 320),
    ("sliver_aspect_1e7.vtu", 125, 320),
    ("tet_with_three_points.vtu", 125, 8),
    ("unknown_cell_type.vtu", 125, 320),
    ("utf8_bom.vtu", 125, 320),
    ("utm_offset_float32.vtu", 125, 320),
    ("utm_offset_float64.vtu", 125, 320),
    ("vtu_named.vtk", 125, 320),
    ("zero_volume_tets.vtu", 135, 43),
];

/// Files that must not load, with words that the message must have.
const BROKEN: &[(&str, &[&str])] = &[
    ("bad_base64.vtu", &["Points", "base64"]),
    ("connectivity_negative.vtu", &["cell 5", "-3"]),
    ("connectivity_out_of_range.vtu", &["cell 5", "999999", "125"]),
    ("corrupt_zlib.vtu", &["block 0", "zlib"]),
    ("garbage_numbers.vtu", &["Points", "value"]),
    ("huge_block_header.vtu", &["`s`", "4611686018427387904"]),
    ("huge_count.vtk", &["POINTS", "48000000000"]),
    ("huge_count.vtu", &["Points", "24 values", "4000000000000"]),
    ("huge_count_overflow.vtu", &["Points", "24 values", "18446744073709551615"]),
    ("huge_zlib_block_count.vtu", &["72057594037927935", "blocks"]),
    ("no_piece.vtu", &["Piece"]),
    ("offsets_not_monotone.vtu", &["cell 10", "offsets"]),
    ("offsets_past_end.vtu", &["cell 319", "offsets"]),
    ("png_named.vtu", &["XML"]),
    ("polydata_as_vtu.vtu", &["PolyData", "ParaView"]),
    ("scalar_wrong_length.vtu", &["`s`", "100", "125"]),
    ("truncated_appended_raw.vtu", &["declared", "left"]),
    ("truncated_appended_zlib.vtu", &["declared", "left"]),
    ("truncated_ascii.vtu", &["end"]),
    ("truncated_binary.vtk", &["CELLS", "left"]),
    ("xml_deep_nesting.vtu", &["Piece"]),
    ("xml_entity_bomb.vtu", &["&j;"]),
    ("zero_bytes.vtu", &["empty"]),
    ("zlib_bomb.vtu", &["`s`", "500"]),
];

fn hostile(name: &str) -> Option<Result<Loaded, IoError>> {
    shared().map(|folder| read_file(&folder.join("hostile"), name))
}

#[test]
fn hostile_but_valid_files_load() {
    for &(name, points, cell_count) in VALID {
        let Some(result) = hostile(name) else { return };
        let dataset = result.unwrap_or_else(|e| panic!("{e}")).dataset;
        sanity_check(&dataset);
        assert_eq!((dataset.points.len(), cells(&dataset).kinds.len()), (points, cell_count), "{name}");
    }
}

#[test]
fn hostile_broken_files_name_file_and_place() {
    for &(name, words) in BROKEN {
        let Some(result) = hostile(name) else { return };
        let text = result.err().unwrap_or_else(|| panic!("{name} loads")).to_string();
        assert!(text.contains(name), "{text}");
        for word in words {
            assert!(text.contains(word), "{name}: \"{word}\" is not in: {text}");
        }
    }
}

#[test]
fn hostile_folder_has_no_other_file_of_these_formats() {
    let Some(folder) = shared() else { return };
    for entry in std::fs::read_dir(folder.join("hostile")).unwrap() {
        let name = entry.unwrap().file_name().to_string_lossy().into_owned();
        if name.ends_with(".vtu") || name.ends_with(".vtk") {
            let known = VALID.iter().any(|v| v.0 == name) || BROKEN.iter().any(|b| b.0 == name);
            assert!(known, "{name} is in no test");
        }
    }
}

#[test]
fn hostile_names_are_kept_apart() {
    let Some(result) = hostile("array_names_repeated.vtu") else { return };
    let loaded = result.unwrap();
    let arrays = &loaded.dataset.point_arrays;
    assert_eq!((arrays[0].name.as_str(), arrays[1].name.as_str()), ("s", "s_2"));
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    let (first, second) = (arrays[0].values.to_f64(), arrays[1].values.to_f64());
    assert!(first.iter().zip(&second).all(|(a, b)| (2.0 * a - b).abs() < 1e-6));

    let loaded = hostile("array_name_empty.vtu").unwrap().unwrap();
    assert!(loaded.dataset.point_arrays.iter().any(|a| a.name == "unnamed1"));
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);

    let loaded = hostile("array_names_odd.vtu").unwrap().unwrap();
    let names: Vec<&str> = loaded.dataset.point_arrays.iter().map(|a| a.name.as_str()).collect();
    assert!(names[0].starts_with("a<b & ") && names[0].contains('/') && !names[0].is_ascii(), "{names:?}");
    assert!(names.iter().any(|name| name.len() == 300) && names.iter().any(|name| name.contains(' ')));
    assert!(loaded.warnings.is_empty());
}

#[test]
fn hostile_values_that_are_not_finite_come_through() {
    let Some(result) = hostile("nan_inf_scalars_ascii.vtu") else { return };
    let binary = hostile("nan_inf_scalars_binary.vtu").unwrap().unwrap().dataset;
    let text = result.unwrap().dataset;
    for dataset in [&text, &binary] {
        let values = dataset.point_arrays.iter().find(|a| a.name == "s").unwrap();
        let (low, high, not_finite) = finite_range(&values.values);
        assert_eq!((low, not_finite), (0.0, 5));
        assert!((high - 1.99749).abs() < 1e-5);
        let all = values.component(0);
        assert_eq!(all.iter().filter(|x| x.is_nan()).count(), 2);
        assert_eq!(all.iter().filter(|&&x| x == f64::NEG_INFINITY).count(), 1);
    }
    assert_eq!(finite_range(&text.cell_arrays[0].values).2, 7);
    let all_nan = hostile("all_nan_scalars.vtu").unwrap().unwrap().dataset;
    assert!(all_nan.point_arrays[0].component(0).iter().all(|x| x.is_nan()));
}

#[test]
fn hostile_cells_are_kept_and_reported() {
    let Some(result) = hostile("tet_with_three_points.vtu") else { return };
    let loaded = result.unwrap();
    let rows = cells(&loaded.dataset);
    assert_eq!(rows.offsets[4] - rows.offsets[3], 3);
    assert!(loaded.warnings[0].contains("cell 3"), "{:?}", loaded.warnings);
    let kinds = cells(&hostile("unknown_cell_type.vtu").unwrap().unwrap().dataset).kinds.clone();
    assert_eq!(kinds[7], tetrascope_mesh::CellKind::Other(250));
    assert_eq!(kinds[8], tetrascope_mesh::CellKind::Flat);
}
