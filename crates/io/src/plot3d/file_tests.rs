//! The real files of the shared data set.

use std::path::Path;

use tetrascope_mesh::{Cells, DataArray};

use crate::{IoError, Loaded, ReadOptions, read_mesh, shared::shared};

fn load(grid: &str, solution: &str) -> Option<Loaded> {
    let folder = shared("data/plot3d")?;
    Some(read_mesh(&folder.join(grid), &ReadOptions::with_solution(Some(&folder.join(solution)))).unwrap())
}

fn array<'a>(loaded: &'a Loaded, name: &str) -> &'a DataArray {
    loaded.dataset.point_arrays.iter().find(|array| array.name == name).unwrap()
}

fn range(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// The expected ranges were printed with five or six digits.
fn check_range(what: &str, values: impl IntoIterator<Item = f64>, expected: [f64; 2]) {
    let found = range(values);
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-5 * expected.abs(), "{what}: {found} for {expected}");
    }
}

const SINGLE: &str = "binary, big-endian, 32-bit, no record marks, single-grid";

/// Grid, solution, and what the format says of their layout. Counts and ranges are the crate's test of all shared files.
const FILES: &[(&str, &str, &str, &str)] = &[
    ("bluntfinxyz.bin", "bluntfinq.bin", SINGLE, "no iblank"),
    ("combxyz.bin", "combq.bin", SINGLE, "no iblank"),
    ("postxyz.bin", "postq.bin", SINGLE, "with iblank"),
    (
        "annulus_fortran_le_iblank.xyz",
        "annulus_fortran_le_iblank.q",
        "binary, little-endian, 32-bit, with record marks, single-grid",
        "with iblank",
    ),
    ("multi-bin.xyz", "multi-bin.q", "binary, little-endian, 64-bit, with record marks, multi-grid", "no iblank"),
    ("multi-bin-C.xyz", "multi-bin-C.q", "binary, little-endian, 64-bit, no record marks, multi-grid", "no iblank"),
    ("multi-ascii.xyz", "multi-ascii.q", "text, multi-grid", "no iblank"),
];

#[test]
fn layouts_are_found() {
    for (grid, solution, layout, iblank) in FILES {
        let Some(loaded) = load(grid, solution) else { return };
        assert!(loaded.format.starts_with(&format!("PLOT3D, {layout}, {iblank}, ")), "{}", loaded.format);
        assert_eq!(loaded.dataset.point_arrays[0].name, "Density");
    }
}

#[test]
fn blunt_fin_derived_header_and_padding() {
    let Some(loaded) = load("bluntfinxyz.bin", "bluntfinq.bin") else { return };
    check_range("pressure", array(&loaded, "Pressure").component(0), [0.25955, 10.0127]);
    check_range("speed", array(&loaded, "Velocity").magnitude(), [0.0, 3.12293]);
    check_range("temperature", array(&loaded, "Temperature").component(0), [0.598700, 2.07131]);
    assert!(loaded.format.contains("Mach 2.95") && loaded.format.contains("time 1.3911"), "{}", loaded.format);
    assert_eq!(loaded.warnings, ["484 zero bytes after the data of bluntfinq.bin were taken for padding"]);
}

#[test]
fn post_negative_iblank_is_visible() {
    let Some(loaded) = load("postxyz.bin", "postq.bin") else { return };
    let iblank = array(&loaded, "IBlank").component(0);
    assert_eq!(iblank.iter().filter(|&&v| v == -1.0).count(), 4332);
    assert_eq!(iblank.iter().filter(|&&v| v == 1.0).count(), 105_412);
    let Cells::Structured(blocks) = &loaded.dataset.cells else { panic!() };
    assert!(blocks[0].hidden_points.is_empty());
    check_range("pressure", array(&loaded, "Pressure").component(0), [-0.216618, 1.75833]);
    check_range("speed", array(&loaded, "Velocity").magnitude(), [0.0, 1.39144]);
    assert!(loaded.warnings.iter().any(|w| w.contains("negative")), "{:?}", loaded.warnings);
}

#[test]
fn annulus_hides_100_hexahedra_and_has_the_analytic_flow() {
    let Some(loaded) = load("annulus_fortran_le_iblank.xyz", "annulus_fortran_le_iblank.q") else { return };
    let Cells::Structured(blocks) = &loaded.dataset.cells else { panic!() };
    let [ni, nj, nk] = blocks[0].dims;
    let hidden = &blocks[0].hidden_points;
    assert_eq!(hidden.len(), 1287);
    let corner = |i, j, k| hidden[i + ni * (j + nj * k)];
    let mut count = 0;
    for (i, j, k) in (0..(ni - 1) * (nj - 1) * (nk - 1))
        .map(|cell| (cell % (ni - 1), cell / (ni - 1) % (nj - 1), cell / (ni - 1) / (nj - 1)))
    {
        count += usize::from((0..8).any(|c| corner(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))));
    }
    assert_eq!(count, 100);
    assert_eq!(blocks[0].cell_count(), 960);

    let density = array(&loaded, "Density").component(0);
    let velocity = array(&loaded, "Velocity").values.to_f64();
    let pressure = array(&loaded, "Pressure").component(0);
    for (index, p) in loaded.dataset.points.iter().enumerate() {
        // A few roundings to 32 bits in the file, and the difference that the pressure is made from.
        let near = |found: f64, expected: f64| assert!((found - expected).abs() < 2e-6, "{found} for {expected}");
        near(density[index], 1.0 + 0.5 * (2.0 * p.x).sin() * p.y.cos());
        near(velocity[3 * index], -p.y);
        near(velocity[3 * index + 1], p.x);
        near(velocity[3 * index + 2], 0.2);
        near(pressure[index], 1.0 / 1.4 + 0.1 * p.z);
    }
}

#[test]
fn text_and_both_binary_forms_hold_the_same() {
    let Some(marked) = load("multi-bin.xyz", "multi-bin.q") else { return };
    let Some(bare) = load("multi-bin-C.xyz", "multi-bin-C.q") else { return };
    let Some(text) = load("multi-ascii.xyz", "multi-ascii.q") else { return };
    assert_eq!(marked.dataset.points, bare.dataset.points);
    for (a, b) in marked.dataset.points.iter().zip(&text.dataset.points) {
        // Six decimals are in the text.
        assert!((*a - *b).abs().max_element() <= 0.6e-6, "{a} {b}");
    }
    for name in ["Density", "Momentum", "StagnationEnergy"] {
        let [marked, bare, text] = [&marked, &bare, &text].map(|loaded| array(loaded, name).values.to_f64());
        assert_eq!(marked, bare, "{name}");
        for (a, b) in marked.iter().zip(&text) {
            assert!((a - b).abs() <= 0.6e-6 + 1e-7 * a.abs(), "{name}: {a} {b}");
        }
    }
}

#[test]
fn files_named_the_other_way_round() {
    let Some(loaded) = load("bluntfinq.bin", "bluntfinxyz.bin") else { return };
    assert_eq!(loaded.dataset.points.len(), 40_960);
    assert_eq!(loaded.dataset.point_arrays[0].name, "Density");
    assert!(loaded.warnings[0].contains("other way round"), "{:?}", loaded.warnings);
}

#[test]
fn one_file_alone() {
    let Some(folder) = shared("data/plot3d") else { return };
    let grid = read_mesh(&folder.join("bluntfinxyz.bin"), &ReadOptions::default()).unwrap();
    assert!(grid.dataset.point_arrays.is_empty());
    assert!(grid.warnings.len() == 1 && grid.warnings[0].contains("solution"), "{:?}", grid.warnings);
    let grid = folder.join("bluntfinxyz.bin");
    let twice = read_mesh(&grid, &ReadOptions::with_solution(Some(&grid))).unwrap_err().to_string();
    assert!(twice.contains("no layout of a PLOT3D solution"), "{twice}");
    for solution in ["bluntfinq.bin", "multi-ascii.q", "annulus_fortran_le_iblank.q"] {
        let error = read_mesh(&folder.join(solution), &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains(solution) && error.contains("name its grid"), "{error}");
        let twice = read_mesh(&folder.join(solution), &ReadOptions::with_solution(Some(&folder.join(solution))))
            .unwrap_err()
            .to_string();
        assert_eq!(twice, error);
    }
}

fn refusal(grid: &Path, solution: Option<&Path>) -> Option<(String, String)> {
    let error = read_mesh(grid, &ReadOptions::with_solution(solution)).unwrap_err();
    let IoError::Invalid { path, problem, .. } = error else { panic!("{error}") };
    Some((path.file_name()?.to_string_lossy().into_owned(), problem))
}

#[test]
fn hostile_files_name_the_nearest_layout() {
    let Some(folder) = shared("data/hostile") else { return };
    let (_, huge) = refusal(&folder.join("huge_dims_plot3d.xyz"), None).unwrap();
    assert!(huge.contains("big-endian") && huge.contains("2147483647x2147483647x2147483647 needs"), "{huge}");
    let (_, negative) = refusal(&folder.join("negative_dims_plot3d.xyz"), None).unwrap();
    assert!(negative.contains("big-endian") && negative.contains("-4x5x6 are not all positive"), "{negative}");

    let (grid, solution) = (folder.join("q_dims_differ.xyz"), folder.join("q_dims_differ.q"));
    let (file, differ) = refusal(&grid, Some(&solution)).unwrap();
    assert_eq!(file, "q_dims_differ.q");
    assert!(differ.contains("3x5x4") && differ.contains("3x4x5") && differ.contains("q_dims_differ.xyz"), "{differ}");
    // Even named the other way round; the file of zeros is also a small grid.
    let (_, swapped) = refusal(&solution, Some(&grid)).unwrap();
    assert!(swapped.contains("3x5x4") && swapped.contains("3x4x5"), "{swapped}");
}
