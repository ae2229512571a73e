//! What is written is read back: random meshes of all kinds of cells and arrays, what cannot be kept, and every file that we have.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_mesh::{CellKind, Cells, StructuredBlock, UnstructuredCells};

use super::super::cell_types::{kind_of, number_of_flat, point_count_of};
use super::super::test_support::{assert_same, cells};
use super::*;
use crate::{ReadOptions, read_mesh};

const ENCODINGS: [VtuEncoding; 3] = [VtuEncoding::Raw, VtuEncoding::Zlib, VtuEncoding::Text];

fn options(encoding: VtuEncoding) -> VtuOptions {
    VtuOptions { encoding, time: None }
}

/// Writes, reads, and gives what both said.
fn there_and_back(dataset: &Dataset, options: &VtuOptions) -> (WrittenVtu, crate::Loaded) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.vtu");
    let written = write_vtu_with(&path, dataset, options).unwrap();
    assert_eq!(written.bytes, std::fs::metadata(&path).unwrap().len());
    (written, read_mesh(&path, &ReadOptions::default()).unwrap())
}

fn array(name: &str, components: usize, values: ArrayValues) -> DataArray {
    DataArray { name: name.to_owned(), components, values }
}

/// Numbers of a type from any 64 bits. As text NaN has no bits to keep.
fn values(number: usize, bits: &[u64], keeps_nan: bool) -> ArrayValues {
    macro_rules! integers {
        ($kind:ident, $type:ty) => {
            ArrayValues::$kind(bits.iter().map(|&x| x as $type).collect())
        };
    }
    match number {
        0 => integers!(I8, i8),
        1 => integers!(U8, u8),
        2 => integers!(I16, i16),
        3 => integers!(U16, u16),
        4 => integers!(I32, i32),
        5 => integers!(U32, u32),
        6 => integers!(I64, i64),
        7 => integers!(U64, u64),
        8 => {
            let number = |&x: &u64| Some(f32::from_bits(x as u32)).filter(|x| keeps_nan || !x.is_nan());
            ArrayValues::F32(bits.iter().map(|x| number(x).unwrap_or(f32::NAN)).collect())
        }
        _ => {
            let number = |&x: &u64| Some(f64::from_bits(x)).filter(|x| keeps_nan || !x.is_nan());
            ArrayValues::F64(bits.iter().map(|x| number(x).unwrap_or(f64::NAN)).collect())
        }
    }
}

/// A kind of cell, as many point indices as it has, and faces for a polyhedron.
fn cell(points: u32) -> impl Strategy<Value = (CellKind, Vec<u32>, Vec<Vec<u32>>)> {
    let row = move |range| prop::collection::vec(0..points, range);
    let of_type = (0_i64..=81, row(40..41), prop::collection::vec(row(0..6), 0..7), 0_usize..12);
    of_type.prop_map(|(number, mut row, faces, length)| {
        let kind = kind_of(number).unwrap();
        match point_count_of(kind) {
            Some(count) => row.truncate(count),
            None => row.truncate(length.max(1)),
        }
        match kind {
            CellKind::Polyhedron => (kind, row, faces),
            // As readers have them.
            CellKind::Flat => {
                let number = u8::try_from(number).unwrap();
                row.truncate(if number == 0 { 4 } else { 12 });
                let is_plain = number == 0 || number_of_flat(row.len()) == Some(number);
                (if is_plain { kind } else { CellKind::FlatOf(number) }, row, Vec::new())
            }
            _ => (kind, row, Vec::new()),
        }
    })
}

fn coordinates(is_single: bool) -> BoxedStrategy<f64> {
    if is_single {
        any::<f32>().prop_map(f64::from).boxed()
    } else {
        prop_oneof![any::<f64>(), any::<u64>().prop_map(f64::from_bits), (-1e6..1e6)].boxed()
    }
}

/// A mesh of at least one point and one cell, whose arrays are of every type.
fn dataset(keeps_nan: bool) -> impl Strategy<Value = Dataset> {
    let sized = (1_u32..30, any::<bool>()).prop_flat_map(|(points, is_single)| {
        let coordinates = prop::collection::vec(coordinates(is_single), 3 * points as usize);
        (coordinates, prop::collection::vec(cell(points), 1..20))
    });
    let names = prop::collection::btree_set("[ -~äß∂]{0,12}[a-z<>&'\"]", 20);
    let numbers = prop::collection::vec(any::<u64>(), 3 * 30 + 20);
    (sized, names, numbers, prop::collection::vec(1_usize..=3, 20)).prop_map(
        move |((coordinates, rows), names, numbers, components)| {
            let keep = |x: f64| if keeps_nan || !x.is_nan() { x } else { f64::NAN };
            let points: Vec<DVec3> =
                coordinates.chunks_exact(3).map(|p| DVec3::new(keep(p[0]), keep(p[1]), keep(p[2]))).collect();
            let mut cells = UnstructuredCells::default();
            for (kind, row, faces) in rows {
                cells.kinds.push(kind);
                cells.connectivity.extend(row);
                cells.offsets.push(cells.connectivity.len());
                if kind == CellKind::Polyhedron {
                    cells.polyhedra.push(faces);
                }
            }
            let count = cells.kinds.len();
            let arrays = |owner: usize, tuples: usize| -> Vec<DataArray> {
                let named = names.iter().zip(&components).skip(10 * owner).take(10).enumerate();
                named
                    .map(|(number, (name, &components))| {
                        let bits = &numbers[number..number + tuples * components];
                        array(name, components, values(number, bits, keeps_nan))
                    })
                    .collect()
            };
            Dataset {
                point_arrays: arrays(0, points.len()),
                cell_arrays: arrays(1, count),
                points,
                cells: Cells::Unstructured(cells),
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn random_meshes_are_read_back_to_the_bit(dataset in dataset(true), time in prop::option::of(-1e9..1e9)) {
        for encoding in [VtuEncoding::Raw, VtuEncoding::Zlib] {
            let (written, read) = there_and_back(&dataset, &VtuOptions { encoding, time });
            assert_same(&read.dataset, &dataset, "random");
            prop_assert_eq!(read.times, Vec::from_iter(time));
            prop_assert!(written.warnings.is_empty() && written.notes.is_empty());
        }
    }

    #[test]
    fn random_meshes_are_read_back_from_text(dataset in dataset(false)) {
        let (_, read) = there_and_back(&dataset, &options(VtuEncoding::Text));
        assert_same(&read.dataset, &dataset, "random, text");
    }
}

#[test]
fn meshes_of_nothing() {
    let points = vec![DVec3::ZERO, DVec3::X];
    for encoding in ENCODINGS {
        let (written, read) = there_and_back(&Dataset::default(), &options(encoding));
        assert_eq!((written.points, written.cells, read.dataset.points.len()), (0, 0, 0));
        let lone = Dataset { points: points.clone(), ..Dataset::default() };
        assert_eq!(there_and_back(&lone, &options(encoding)).1.dataset.points, points);
    }
}

#[test]
fn blocks_of_compression_may_be_full() {
    // One number less than a block, a block, one more; and more than two.
    for count in [131_071, 131_072, 131_073, 300_000] {
        let dataset = Dataset {
            points: vec![DVec3::ZERO; count],
            point_arrays: vec![array("a", 1, ArrayValues::U64((0..count as u64).collect()))],
            ..Dataset::default()
        };
        let (written, read) = there_and_back(&dataset, &options(VtuEncoding::Zlib));
        assert_same(&read.dataset, &dataset, "full blocks");
        assert!(written.bytes < 8 * count as u64);
    }
}

#[test]
fn grids_become_hexahedra_without_what_is_hidden() {
    let points: Vec<DVec3> =
        (0..18).map(|n| DVec3::new(f64::from(n % 3), f64::from(n / 3 % 3), f64::from(n / 9))).collect();
    let mut hidden_points = vec![false; 18];
    // The corner of the last of four cells alone.
    hidden_points[8] = true;
    let block = StructuredBlock { dims: [3, 3, 2], first_point: 0, hidden_points };
    let dataset = Dataset {
        points,
        cells: Cells::Structured(vec![block]),
        point_arrays: Vec::new(),
        cell_arrays: vec![array("c", 2, ArrayValues::I32((0..8).collect()))],
    };
    let (written, read) = there_and_back(&dataset, &VtuOptions::default());
    assert_eq!((written.points, written.cells), (18, 3));
    assert!(written.notes[0].contains("hexahedra"), "{:?}", written.notes);
    assert!(written.warnings.len() == 1 && written.warnings[0].contains("1 of 4 cells"), "{:?}", written.warnings);
    let rows = cells(&read.dataset);
    assert_eq!(rows.kinds, [CellKind::Hexahedron; 3]);
    assert_eq!(rows.connectivity[..8], [0, 1, 4, 3, 9, 10, 13, 12]);
    assert_eq!(read.dataset.cell_arrays[0].values.to_f64(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
}

#[test]
fn cells_of_no_kind_are_left_out_with_their_tuples() {
    let tetrahedron = [0, 1, 2, 3];
    let faces =
        |turn: u32| -> Vec<Vec<u32>> { (0..4).map(|n| vec![(n + turn) % 4, (n + 1) % 4, (n + 2) % 4]).collect() };
    let dataset = Dataset {
        points: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        cells: Cells::Unstructured(UnstructuredCells {
            kinds: vec![CellKind::Polyhedron, CellKind::Flat, CellKind::Polyhedron],
            offsets: vec![0, 4, 12, 16],
            connectivity: [&tetrahedron[..]; 4].concat(),
            polyhedra: vec![faces(0), faces(1)],
        }),
        point_arrays: vec![
            array("short", 1, ArrayValues::F32(vec![0.0; 3])),
            array("tab\there", 1, ArrayValues::U8(vec![7; 4])),
        ],
        cell_arrays: vec![array("c", 1, ArrayValues::F64(vec![0.5, 1.5, 2.5]))],
    };
    let (written, read) = there_and_back(&dataset, &VtuOptions::default());
    let rows = cells(&read.dataset);
    assert_eq!((rows.kinds.as_slice(), &rows.polyhedra), (&[CellKind::Polyhedron; 2][..], &vec![faces(0), faces(1)]));
    assert_eq!(read.dataset.cell_arrays[0].values.to_f64(), [0.5, 2.5]);
    assert_eq!(read.dataset.point_arrays.len(), 1);
    let said = written.warnings.join("\n");
    for part in ["1 of 3 cells", "`short` is left out: it has 3 numbers for 4 points", "written as `tab_here`"] {
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn numbers_that_vtk_does_not_read_as_text() {
    let dataset = Dataset {
        points: vec![DVec3::new(0.0, f64::NAN, 1.0)],
        point_arrays: vec![
            array("whole", 1, ArrayValues::F32(vec![1.0])),
            array("odd", 1, ArrayValues::F64(vec![f64::INFINITY])),
        ],
        ..Dataset::default()
    };
    let (written, read) = there_and_back(&dataset, &options(VtuEncoding::Text));
    assert!(read.dataset.points[0].y.is_nan() && read.dataset.point_arrays[1].values.to_f64() == [f64::INFINITY]);
    assert!(written.warnings[0].contains("the coordinates, `odd`; as text"), "{:?}", written.warnings);
    assert!(there_and_back(&dataset, &VtuOptions::default()).0.warnings.is_empty());
}

#[test]
fn cells_that_do_not_fit_together_are_refused() {
    let path = Path::new("never.vtu");
    let refused = |cells: UnstructuredCells| {
        let dataset = Dataset { points: vec![DVec3::ZERO; 4], cells: Cells::Unstructured(cells), ..Dataset::default() };
        let problem = write_vtu(path, &dataset).unwrap_err().to_string();
        assert!(problem.contains("never.vtu") && problem.contains("offsets"), "{problem}");
        assert!(!path.exists());
    };
    let kinds = vec![CellKind::Tetrahedron];
    refused(UnstructuredCells { kinds: kinds.clone(), ..UnstructuredCells::default() });
    refused(UnstructuredCells {
        kinds: kinds.clone(),
        offsets: vec![0, 4],
        connectivity: vec![0, 1, 2, 4],
        polyhedra: Vec::new(),
    });
    refused(UnstructuredCells {
        kinds: vec![CellKind::Polyhedron],
        offsets: vec![0, 0],
        ..UnstructuredCells::default()
    });
}

/// What a dataset is once it is written: cells that name their points, none of them hidden.
fn as_written(dataset: Dataset) -> Dataset {
    let mut said = WrittenVtu::default();
    let layout = Layout::of(&dataset, &mut said);
    let cells = Cells::Unstructured(layout.cells.clone().into_owned());
    let cell_arrays = match &layout.kept {
        None => dataset.cell_arrays.clone(),
        Some(kept) => {
            let kept = |of: &DataArray| array(&of.name, of.components, gathered(of, kept));
            dataset.cell_arrays.iter().map(kept).collect()
        }
    };
    Dataset { cells, cell_arrays, ..dataset }
}

/// All files below a folder, and the folder's own name where it is no mesh's.
fn files_below(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    let mut entries: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() { files_below(&path, found) } else { found.push(path) }
    }
}

#[test]
fn shared_files_are_read_back_as_they_are_written() {
    let Some(folder) = crate::shared::shared("data") else { return };
    let mut files = Vec::new();
    files_below(&folder, &mut files);
    let mut written = 0;
    for file in files {
        // Those that are damaged on purpose, descriptions, slices of volumes.
        let Ok(loaded) = read_mesh(&file, &ReadOptions::default()) else { continue };
        let name = file.display().to_string();
        let expected = as_written(loaded.dataset);
        for encoding in [VtuEncoding::Raw, VtuEncoding::Zlib] {
            // Large ones take their time.
            if encoding == VtuEncoding::Zlib && expected.points.len() > 50_000 {
                continue;
            }
            let (said, read) = there_and_back(&expected, &options(encoding));
            assert!(said.warnings.is_empty(), "{name}: {:?}", said.warnings);
            assert_same(&read.dataset, &expected, &name);
        }
        written += 1;
    }
    assert!(written > 80, "only {written} files are read");
}

#[test]
fn what_is_compressed_beyond_what_is_read_is_said() {
    let constant = |count: usize| Dataset {
        points: vec![DVec3::ZERO; count],
        point_arrays: vec![array("zero", 9, ArrayValues::U8(vec![0; 9 * count]))],
        ..Dataset::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.vtu");
    for (count, encoding, is_read) in
        [(50_000, VtuEncoding::Zlib, true), (200_000, VtuEncoding::Zlib, false), (200_000, VtuEncoding::Raw, true)]
    {
        let written = write_vtu_with(&path, &constant(count), &options(encoding)).unwrap();
        assert_eq!(written.warnings.is_empty(), is_read, "{count}: {:?}", written.warnings);
        assert_eq!(read_mesh(&path, &ReadOptions::default()).is_ok(), is_read, "{count}");
    }
}
