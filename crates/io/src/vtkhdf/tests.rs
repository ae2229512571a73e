//! Small files made here as VTK 9.7's `vtkHDFWriter` lays them out, and what is damaged in them.

use hdf5_writer::{AttributeBuilder, DatasetBuilder, FILTER_DEFLATE, FilterDescription, Hdf5Builder, WriteOptions};
use proptest::prelude::*;
use tetrascope_mesh::{CellKind, Cells, Dataset, UnstructuredCells, decompose};

use super::VTKHDF;
use crate::{IoError, Loaded, MeshReader, ReadOptions, Source, StepChoice};

fn read(bytes: Vec<u8>, step: StepChoice) -> Result<Loaded, IoError> {
    let options = ReadOptions { step, ..ReadOptions::default() };
    VTKHDF.read(&Source { path: "made.vtkhdf".into(), bytes, options })
}

fn cells(dataset: &Dataset) -> &UnstructuredCells {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells,
        Cells::Structured(_) => panic!("structured cells"),
    }
}

/// A file under construction.
struct Made {
    file: Hdf5Builder,
    is_compressed: bool,
}

impl Made {
    fn new(kind: &str, is_compressed: bool) -> Self {
        let file = Hdf5Builder::new()
            .group_attribute("VTKHDF", AttributeBuilder::fixed_string("Type", kind))
            .group_attribute("VTKHDF", AttributeBuilder::vector("Version", &[2_i64, 3]).unwrap());
        Self { file, is_compressed }
    }

    fn attribute<T: hdf5_writer::H5WriteElement>(mut self, group: &str, name: &str, values: &[T]) -> Self {
        self.file = self.file.group_attribute(group, AttributeBuilder::vector(name, values).unwrap());
        self
    }

    fn text(mut self, group: &str, name: &str, text: &str) -> Self {
        self.file = self.file.group_attribute(group, AttributeBuilder::fixed_string(name, text));
        self
    }

    fn data<T: hdf5_writer::H5WriteElement>(mut self, name: &str, shape: &[u64], values: &[T]) -> Self {
        let mut dataset = DatasetBuilder::typed_data(format!("VTKHDF/{name}"), shape, values).unwrap();
        if self.is_compressed {
            let deflate = FilterDescription { id: FILTER_DEFLATE, name: None, client_data: vec![5] };
            // More than there is in one chunk, as VTK writes it.
            let chunk: Vec<u64> = shape.iter().map(|&length| length.max(1)).collect();
            dataset = dataset.max_shape(shape.to_vec()).chunked(chunk).filter(deflate);
        }
        self.file = self.file.dataset(dataset);
        self
    }

    fn list(self, name: &str, values: &[i64]) -> Self {
        let length = values.len() as u64;
        self.data(name, &[length], values)
    }

    fn bytes(self) -> Vec<u8> {
        self.file.into_plan().unwrap().encode(WriteOptions::default()).unwrap()
    }
}

/// A hexahedron and a tetrahedron, once for each shift along x.
fn points(shifts: &[f32]) -> Vec<f32> {
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [2, 0, 0]];
    let shifted = |&shift: &f32| corners.map(|[x, y, z]| [x as f32 + shift, y as f32, z as f32]);
    shifts.iter().flat_map(shifted).flatten().collect()
}

/// The datasets of a grid below a folder, with one part for each shift.
fn grid(made: Made, folder: &str, shifts: &[f32]) -> Made {
    let count = shifts.len() as u64;
    let each = |values: &[i64]| values.repeat(shifts.len());
    let name = |name: &str| format!("{folder}{name}");
    let s: Vec<f32> = (0..9 * count).map(|n| n as f32).collect();
    let v: Vec<f64> = (0..27 * count).map(|n| n as f64).collect();
    let c: Vec<i32> = (0..2 * count as i32).map(|n| 7 + n).collect();
    made.list(&name("NumberOfPoints"), &each(&[9]))
        .list(&name("NumberOfCells"), &each(&[2]))
        .list(&name("NumberOfConnectivityIds"), &each(&[12]))
        .data(&name("Points"), &[9 * count, 3], &points(shifts))
        .list(&name("Connectivity"), &each(&[0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 2, 5]))
        .list(&name("Offsets"), &each(&[0, 8, 12]))
        .data(&name("Types"), &[2 * count], &[12_u8, 10].repeat(shifts.len()))
        .data(&name("PointData/s"), &[9 * count], &s)
        .data(&name("PointData/v"), &[9 * count, 3], &v)
        .data(&name("CellData/c"), &[2 * count], &c)
}

fn two_parts(is_compressed: bool) -> Vec<u8> {
    grid(Made::new("UnstructuredGrid", is_compressed), "", &[0.0, 10.0]).bytes()
}

/// Three steps: the mesh of each is elsewhere, and so are its values.
fn three_steps() -> Vec<u8> {
    let made = grid(Made::new("UnstructuredGrid", false), "", &[0.0, 1.0, 5.0]);
    made.attribute("VTKHDF/Steps", "NSteps", &[3_i64])
        .data("Steps/Values", &[3], &[0.0_f32, 0.5, 2.0])
        .list("Steps/NumberOfParts", &[1, 1, 1])
        .list("Steps/PartOffsets", &[0, 1, 2])
        .list("Steps/PointOffsets", &[0, 9, 18])
        .list("Steps/CellOffsets", &[0, 2, 4])
        .list("Steps/ConnectivityIdOffsets", &[0, 12, 24])
        .list("Steps/PointDataOffsets/s", &[0, 9, 18])
        .list("Steps/CellDataOffsets/c", &[0, 2, 4])
        .bytes()
}

/// Three steps of values on one mesh.
fn steps_on_one_mesh() -> Vec<u8> {
    let all: Vec<f64> = (0..27).map(f64::from).collect();
    let made = grid(Made::new("UnstructuredGrid", false), "", &[0.0]);
    made.data("PointData/t", &[27], &all)
        .data("Steps/Values", &[3], &[0.0, 0.5, 2.0])
        .list("Steps/NumberOfParts", &[1, 1, 1])
        .list("Steps/PartOffsets", &[0, 0, 0])
        .list("Steps/PointOffsets", &[0, 0, 0])
        .list("Steps/CellOffsets", &[0, 0, 0])
        .list("Steps/ConnectivityIdOffsets", &[0, 0, 0])
        .list("Steps/PointDataOffsets/t", &[0, 9, 18])
        .bytes()
}

/// Two cubes and a tetrahedron, the cubes as polyhedra, as VTK 9.7.2 writes them; each twice, as two parts.
fn polyhedra() -> Vec<u8> {
    let cube = |x: i64| {
        let at = |i: i64, j: i64, k: i64| 6 * k + 3 * j + i + x;
        [
            [at(0, 0, 0), at(0, 1, 0), at(0, 1, 1), at(0, 0, 1)],
            [at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)],
            [at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)],
            [at(0, 1, 0), at(1, 1, 0), at(1, 1, 1), at(0, 1, 1)],
            [at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)],
            [at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)],
        ]
    };
    let faces = [cube(0), cube(1)].concat();
    let points: Vec<f64> = (0..12).flat_map(|n| [f64::from(n % 3), f64::from(n / 3 % 2), f64::from(n / 6)]).collect();
    let ids = [0, 1, 3, 4, 6, 7, 9, 10, 1, 2, 4, 5, 7, 8, 10, 11, 0, 1, 3, 6];
    let ends: Vec<i64> = (0..13).map(|face| 4 * face).collect();
    Made::new("UnstructuredGrid", false)
        .list("NumberOfPoints", &[12, 12])
        .list("NumberOfCells", &[3, 3])
        .list("NumberOfConnectivityIds", &[20, 20])
        .list("NumberOfFaces", &[12, 12])
        .list("NumberOfFaceConnectivityIds", &[48, 48])
        .list("NumberOfPolyhedronToFaceIds", &[12, 12])
        .data("Points", &[24, 3], &points.repeat(2))
        .list("Connectivity", &ids.repeat(2))
        .list("Offsets", &[0, 8, 16, 20].repeat(2))
        .data("Types", &[6], &[42_u8, 42, 10, 42, 42, 10])
        .list("FaceConnectivity", &faces.as_flattened().repeat(2))
        .list("FaceOffsets", &ends.repeat(2))
        .list("PolyhedronToFaces", &(0..12).collect::<Vec<i64>>().repeat(2))
        .list("PolyhedronOffsets", &[0, 6, 12, 12].repeat(2))
        .bytes()
}

fn image() -> Made {
    let s: Vec<f32> = (0..24_u8).map(f32::from).collect();
    let v: Vec<f32> = (0..72_u8).map(f32::from).collect();
    Made::new("ImageData", false)
        .attribute("VTKHDF", "WholeExtent", &[1_i64, 4, 0, 2, 0, 1])
        .attribute("VTKHDF", "Origin", &[1.0, 2.0, 3.0])
        .attribute("VTKHDF", "Spacing", &[0.5, 1.0, 2.0])
        .attribute("VTKHDF", "Direction", &[0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0])
        .data("PointData/s", &[2, 3, 4], &s)
        .data("PointData/v", &[2, 3, 4, 3], &v)
        .data("CellData/c", &[1, 2, 3], &[0.0_f64, 1.0, 2.0, 3.0, 4.0, 5.0])
}

#[test]
fn parts_are_joined() {
    for is_compressed in [false, true] {
        let loaded = read(two_parts(is_compressed), StepChoice::Last).unwrap_or_else(|error| panic!("{error}"));
        assert!(VTKHDF.recognizes(&two_parts(is_compressed)));
        assert_eq!(loaded.format, "VTKHDF 2.3, UnstructuredGrid");
        assert!(loaded.warnings.is_empty() && loaded.times.is_empty(), "{:?}", loaded.warnings);
        let dataset = &loaded.dataset;
        use CellKind::{Hexahedron, Tetrahedron};
        assert_eq!(cells(dataset).kinds, [Hexahedron, Tetrahedron, Hexahedron, Tetrahedron]);
        assert_eq!(cells(dataset).connectivity[20..], [10, 17, 11, 14]);
        assert_eq!(dataset.points[17].to_array(), [12.0, 0.0, 0.0]);
        let [s, v] = dataset.point_arrays.as_slice() else { panic!("{:?}", dataset.point_arrays) };
        assert_eq!((s.name.as_str(), s.values.type_name(), s.values.to_f64()[17]), ("s", "Float32", 17.0));
        assert_eq!((v.name.as_str(), v.components, v.values.to_f64()[53]), ("v", 3, 53.0));
        assert_eq!(dataset.cell_arrays[0].values.to_f64(), [7.0, 8.0, 9.0, 10.0]);
        assert_eq!(decompose(dataset).unwrap().counts.tetrahedra, 14);
    }
}

#[test]
fn steps_have_their_own_mesh_and_values() {
    for (time, shift, first) in [(0.0, 0.0, 0.0), (0.5, 1.0, 9.0), (2.0, 5.0, 18.0)] {
        let loaded = read(three_steps(), StepChoice::Time(time)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.times, [0.0, 0.5, 2.0]);
        let dataset = &loaded.dataset;
        assert_eq!((dataset.points.len(), dataset.points[0].x), (9, shift));
        assert_eq!(dataset.point_arrays[0].values.to_f64()[0], first);
        assert_eq!(dataset.point_arrays[1].values.to_f64()[0], 3.0 * first);
        assert_eq!(cells(dataset).connectivity[8..], [1, 8, 2, 5]);
    }
    for (step, first) in [(0, 0.0), (1, 9.0), (2, 18.0)] {
        let loaded = read(steps_on_one_mesh(), StepChoice::Number(step)).unwrap_or_else(|error| panic!("{error}"));
        let arrays = &loaded.dataset.point_arrays;
        let of = |name: &str| arrays.iter().find(|array| array.name == name).unwrap().values.to_f64()[0];
        assert_eq!((loaded.step, of("t"), of("s")), (step, first, 0.0));
    }
    assert!(read(three_steps(), StepChoice::Number(3)).unwrap_err().to_string().contains("the file has 3"));
}

#[test]
fn polyhedra_by_their_tables() {
    let loaded = read(polyhedra(), StepChoice::Last).unwrap_or_else(|error| panic!("{error}"));
    use CellKind::{Polyhedron, Tetrahedron};
    let cells = cells(&loaded.dataset);
    assert_eq!(cells.kinds, [Polyhedron, Polyhedron, Tetrahedron, Polyhedron, Polyhedron, Tetrahedron]);
    assert_eq!(cells.polyhedra[1][1], [2, 5, 11, 8]);
    assert_eq!(cells.polyhedra[3][1], [14, 17, 23, 20]);
    let cut = decompose(&loaded.dataset).unwrap();
    assert_eq!((cut.counts.tetrahedra, cut.counts.malformed), (2 * (2 * 12 + 1), 0));
}

#[test]
fn images_are_where_they_say() {
    let loaded = read(image().bytes(), StepChoice::Last).unwrap_or_else(|error| panic!("{error}"));
    let dataset = &loaded.dataset;
    let Cells::Structured(blocks) = &dataset.cells else { panic!("not structured") };
    assert_eq!(blocks[0].dims, [4, 3, 2]);
    // The x axis points along y, the y axis against x; the extent begins at 1.
    assert_eq!(dataset.points[0].to_array(), [1.0, 2.5, 3.0]);
    assert_eq!(dataset.points[1].to_array(), [1.0, 3.0, 3.0]);
    assert_eq!(dataset.points[4].to_array(), [0.0, 2.5, 3.0]);
    assert_eq!(dataset.points[12].to_array(), [1.0, 2.5, 5.0]);
    assert_eq!(dataset.point_arrays[1].components, 3);
    assert_eq!(dataset.point_arrays[0].values.to_f64()[23], 23.0);
    assert_eq!(dataset.cell_arrays[0].values.to_f64().len(), 6);
    assert_eq!(decompose(dataset).unwrap().counts.tetrahedra, 30);
}

#[test]
fn collections_are_joined_in_the_order_of_their_index() {
    let made = Made::new("PartitionedDataSetCollection", false);
    let made = grid(grid(made, "A/", &[10.0]), "B/", &[0.0]);
    let bytes = made
        .text("VTKHDF/A", "Type", "UnstructuredGrid")
        .text("VTKHDF/B", "Type", "UnstructuredGrid")
        .text("VTKHDF/C", "Type", "PolyData")
        .attribute("VTKHDF/A", "Index", &[1_i64])
        .attribute("VTKHDF/B", "Index", &[0_i64])
        .data("A/PointData/only", &[9], &[1.0; 9])
        .bytes();
    let loaded = read(bytes, StepChoice::Last).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((loaded.dataset.points[0].x, loaded.dataset.points[9].x), (0.0, 10.0));
    assert_eq!(loaded.dataset.point_arrays.len(), 2);
    assert!(
        loaded.warnings.iter().any(|text| text.contains("`C` is left out: it is a PolyData")),
        "{:?}",
        loaded.warnings
    );
    assert!(loaded.warnings.iter().any(|text| text.contains("`only` is left out")), "{:?}", loaded.warnings);
}

#[test]
fn ghost_cells_are_not_drawn() {
    let bytes =
        grid(Made::new("UnstructuredGrid", false), "", &[0.0]).data("CellData/vtkGhostType", &[2], &[0_u8, 1]).bytes();
    let loaded = read(bytes, StepChoice::Last).unwrap();
    assert_eq!(cells(&loaded.dataset).kinds, [CellKind::Hexahedron, CellKind::Flat]);
    assert!(loaded.warnings[0].contains("1 cells are hidden"), "{:?}", loaded.warnings);
}

#[test]
fn what_is_wrong_is_named() {
    let message = |made: Made| read(made.bytes(), StepChoice::Last).unwrap_err().to_string();
    let text = message(Made::new("PolyData", false));
    assert!(text.contains("made.vtkhdf: VTKHDF with a dataset of the type `PolyData` is not supported"), "{text}");
    let wrong = Made::new("UnstructuredGrid", false)
        .list("NumberOfPoints", &[1 << 60])
        .list("NumberOfCells", &[1])
        .list("NumberOfConnectivityIds", &[4])
        .data("Points", &[1, 3], &[0.0; 3]);
    let text = message(wrong);
    assert!(text.contains("`Points`") && text.contains("it has 1 rows"), "{text}");
    let extent = Made::new("ImageData", false).attribute("VTKHDF", "WholeExtent", &[0_i64, 4000, 0, 4000, 0, 200]);
    assert!(message(extent).contains("16 numbers a byte"));
}

fn check(bytes: Vec<u8>) {
    match read(bytes, StepChoice::Last) {
        Ok(loaded) => {
            // The mesh checks every promise of a layout, and says what it misses.
            if let Err(error) = decompose(&loaded.dataset) {
                assert!(!matches!(error, tetrascope_mesh::MeshError::Inconsistent { .. }), "{error}");
            }
            let tuples = loaded.dataset.points.len();
            assert!(loaded.dataset.point_arrays.iter().all(|array| array.values.len() == tuples * array.components));
        }
        Err(error) => assert!(error.to_string().starts_with("made.vtkhdf: "), "{error}"),
    }
}

fn seeds() -> [Vec<u8>; 4] {
    [two_parts(true), three_steps(), polyhedra(), image().bytes()]
}

#[test]
fn files_cut_anywhere() {
    for bytes in seeds() {
        check(bytes.clone());
        for length in (0..bytes.len()).step_by(7) {
            check(bytes[..length].to_vec());
        }
    }
}

#[test]
fn files_with_one_changed_byte() {
    for bytes in seeds() {
        for at in (0..bytes.len()).step_by(3) {
            let mut bytes = bytes.clone();
            bytes[at] = [0, 1, 0x7f, 0xff][at / 3 % 4];
            check(bytes);
        }
    }
}

proptest! {
    #[test]
    fn files_with_changed_bytes(
        seed in 0..4_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = seeds()[seed].clone();
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        check(bytes);
    }
}
