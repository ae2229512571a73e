//! Small cases written here in every way that OpenFOAM writes them.

use std::{
    collections::{BTreeMap, HashMap},
    io::Write,
    path::{Path, PathBuf},
};

use glam::DVec3;
use tetrascope_mesh::{CellKind, Cells, Dataset, UnstructuredCells, decompose};

use crate::{IoError, Loaded, ReadOptions, StepChoice, bytes::ByteOrder, read_mesh};

/// How a file is written.
#[derive(Clone, Copy, Debug)]
pub(super) enum Style {
    Text,
    Binary { label: usize, scalar: usize, order: ByteOrder, arch: bool },
}

pub(super) const BINARY: Style = Style::Binary { label: 4, scalar: 8, order: ByteOrder::Little, arch: true };

/// A mesh as a user thinks of it: cells with their faces, normals outward.
#[derive(Clone, Debug, Default)]
pub(super) struct TestMesh {
    pub(super) points: Vec<[f64; 3]>,
    pub(super) cells: Vec<Vec<Vec<u32>>>,
}

/// A mesh as OpenFOAM has it.
#[derive(Clone, Debug, Default)]
pub(super) struct TestFaces {
    pub(super) faces: Vec<Vec<u32>>,
    pub(super) owners: Vec<i64>,
    pub(super) neighbors: Vec<i64>,
}

/// A folder with a case in it, removed when dropped.
pub(super) struct TestCase {
    folder: tempfile::TempDir,
}

/// A hexahedron with a pyramid on top, a wedge beside it, a tetrahedron at the wedge, and below it a cube of which one edge has a point
/// in its middle. Volumes 1, 1/3, 1/2, 1/6, 1.
pub(super) fn mixed() -> TestMesh {
    let [hex, pyramid] = [[0, 1, 2, 3, 4, 5, 6, 7].as_slice(), &[4, 5, 6, 7, 8]];
    let [wedge, tetrahedron] = [[1, 9, 5, 2, 10, 6].as_slice(), &[1, 9, 5, 11]];
    let faces = |corners: &[u32], model: &[&[usize]]| -> Vec<Vec<u32>> {
        model.iter().map(|face| face.iter().map(|&i| corners[i]).collect()).collect()
    };
    TestMesh {
        points: vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [1.0, 1.0, 1.0],
            [0.0, 1.0, 1.0],
            [0.5, 0.5, 2.0],
            [2.0, 0.0, 0.0],
            [2.0, 1.0, 0.0],
            [1.25, -1.0, 0.25],
            [0.0, 0.0, -1.0],
            [1.0, 0.0, -1.0],
            [1.0, 1.0, -1.0],
            [0.0, 1.0, -1.0],
            [0.5, 0.0, -1.0],
        ],
        cells: vec![
            faces(hex, &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]]),
            faces(pyramid, &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]]),
            faces(wedge, &[&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]]),
            faces(tetrahedron, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]]),
            [
                &[0, 1, 2, 3][..],
                &[12, 15, 14, 13, 16],
                &[0, 12, 16, 13, 1],
                &[1, 13, 14, 2],
                &[2, 14, 15, 3],
                &[3, 15, 12, 0],
            ]
            .map(<[u32]>::to_vec)
            .to_vec(),
        ],
    }
}

pub(super) const MIXED_KINDS: [CellKind; 5] =
    [CellKind::Hexahedron, CellKind::Pyramid, CellKind::Wedge, CellKind::Tetrahedron, CellKind::Polyhedron];
pub(super) const MIXED_VOLUME: f64 = 3.0;

impl TestMesh {
    /// Faces between two cells first, as OpenFOAM has them; the first cell that has a face owns it.
    pub(super) fn faces(&self) -> TestFaces {
        let key = |face: &[u32]| {
            let mut key = face.to_vec();
            key.sort_unstable();
            key
        };
        let mut all: Vec<(Vec<u32>, i64, Option<i64>)> = Vec::new();
        let mut places = HashMap::new();
        for (cell, faces) in self.cells.iter().enumerate() {
            for face in faces {
                let place = *places.entry(key(face)).or_insert(all.len());
                match all.get_mut(place) {
                    Some((_, _, neighbor)) => *neighbor = Some(cell as i64),
                    None => all.push((face.clone(), cell as i64, None)),
                }
            }
        }
        all.sort_by_key(|(_, _, neighbor)| neighbor.is_none());
        TestFaces {
            faces: all.iter().map(|(face, ..)| face.clone()).collect(),
            owners: all.iter().map(|(_, owner, _)| *owner).collect(),
            neighbors: all.iter().filter_map(|(_, _, neighbor)| *neighbor).collect(),
        }
    }
}

impl Style {
    pub(super) fn header(self, class: &str) -> Vec<u8> {
        let (format, arch) = match self {
            Self::Text => ("ascii", String::new()),
            Self::Binary { arch: false, .. } => ("binary", String::new()),
            Self::Binary { label, scalar, order, .. } => {
                let order = if order == ByteOrder::Big { "MSB" } else { "LSB" };
                ("binary", format!("    arch        \"{order};label={};scalar={}\";\n", label * 8, scalar * 8))
            }
        };
        format!("/*--- C++ ---*\\\n  a banner\n\\*---*/\nFoamFile\n{{\n    version     2.0;\n    format      {format};\n{arch}    class       {class};\n}}\n// * * //\n\n").into_bytes()
    }

    fn label_bytes(self, values: &[i64]) -> Vec<u8> {
        let Self::Binary { label, order, .. } = self else { return Vec::new() };
        let one = |&value: &i64| {
            let mut bytes = value.to_le_bytes()[..label].to_vec();
            if order == ByteOrder::Big {
                bytes.reverse();
            }
            bytes
        };
        values.iter().flat_map(one).collect()
    }

    fn scalar_bytes(self, values: &[f64]) -> Vec<u8> {
        let Self::Binary { scalar, order, .. } = self else { return Vec::new() };
        let one = |&value: &f64| {
            let mut bytes =
                if scalar == 4 { (value as f32).to_le_bytes().to_vec() } else { value.to_le_bytes().to_vec() };
            if order == ByteOrder::Big {
                bytes.reverse();
            }
            bytes
        };
        values.iter().flat_map(one).collect()
    }

    pub(super) fn labels(self, values: &[i64]) -> Vec<u8> {
        match self {
            Self::Text => {
                let words: Vec<String> = values.iter().map(i64::to_string).collect();
                format!("{}\n(\n{}\n)\n", values.len(), words.join("\n")).into_bytes()
            }
            Self::Binary { .. } => wrapped(values.len(), &self.label_bytes(values)),
        }
    }

    /// Tuples as a list: `2((0 0 0) (1 0 0))`.
    pub(super) fn tuples(self, values: &[f64], components: usize) -> Vec<u8> {
        let count = values.len() / components;
        match self {
            Self::Text => {
                let tuple = |tuple: &[f64]| {
                    let words: Vec<String> = tuple.iter().map(f64::to_string).collect();
                    if components == 1 { words.join(" ") } else { format!("({})", words.join(" ")) }
                };
                let lines: Vec<String> = values.chunks(components).map(tuple).collect();
                format!("{count}\n(\n{}\n)\n", lines.join("\n")).into_bytes()
            }
            Self::Binary { .. } => wrapped(count, &self.scalar_bytes(values)),
        }
    }

    pub(super) fn faces(self, faces: &[Vec<u32>]) -> Vec<u8> {
        match self {
            Self::Text => {
                let face = |face: &Vec<u32>| {
                    let words: Vec<String> = face.iter().map(u32::to_string).collect();
                    format!("{}({})", face.len(), words.join(" "))
                };
                let lines: Vec<String> = faces.iter().map(face).collect();
                let mut file = self.header("faceList");
                file.extend(format!("{}\n(\n{}\n)\n", faces.len(), lines.join("\n")).into_bytes());
                file
            }
            Self::Binary { .. } => {
                let mut starts = vec![0];
                let mut labels = Vec::new();
                for face in faces {
                    labels.extend(face.iter().map(|&point| i64::from(point)));
                    starts.push(labels.len() as i64);
                }
                [self.header("faceCompactList"), self.labels(&starts), self.labels(&labels)].concat()
            }
        }
    }

    /// A whole file of a field in cells or at points.
    pub(super) fn field(self, class: &str, list: &str, values: &[f64], components: usize) -> Vec<u8> {
        let start = format!("dimensions      [0 1 -1 0 0 0 0];\n\ninternalField   nonuniform List<{list}> \n");
        let end = b";\n\nboundaryField\n{\n    walls { type zeroGradient; }\n}\n";
        [self.header(class), start.into_bytes(), self.tuples(values, components), end.to_vec()].concat()
    }
}

fn wrapped(count: usize, bytes: &[u8]) -> Vec<u8> {
    [format!("\n{count}\n(").as_bytes(), bytes, b")\n"].concat()
}

/// What one processor has of a mesh.
pub(super) struct TestPart {
    pub(super) mesh: TestMesh,
    pub(super) faces: TestFaces,
    pub(super) boundary: String,
    /// The cells of the whole mesh that it has.
    pub(super) cells: Vec<usize>,
}

impl TestMesh {
    /// Cuts the mesh as `decomposePar` does: faces between processors come last, by neighbor, in the same order and turned over.
    pub(super) fn decompose(&self, processor_of: impl Fn(usize) -> usize, count: usize) -> Vec<TestPart> {
        let whole = self.faces();
        (0..count)
            .map(|own| {
                let cells: Vec<usize> = (0..self.cells.len()).filter(|&cell| processor_of(cell) == own).collect();
                let local: HashMap<i64, i64> = cells.iter().enumerate().map(|(i, &cell)| (cell as i64, i as i64)).collect();
                let mut inside = Vec::new();
                let mut outside = Vec::new();
                let mut shared: BTreeMap<usize, Vec<(Vec<u32>, i64)>> = BTreeMap::new();
                for (i, face) in whole.faces.iter().enumerate() {
                    let mut turned = face.clone();
                    turned[1..].reverse();
                    let neighbor = whole.neighbors.get(i);
                    match (local.get(&whole.owners[i]), neighbor.and_then(|cell| local.get(cell)), neighbor) {
                        (Some(&a), Some(&b), _) => inside.push((face.clone(), a, b)),
                        (Some(&a), None, None) => outside.push((face.clone(), a)),
                        (Some(&a), None, Some(&b)) => {
                            shared.entry(processor_of(b as usize)).or_default().push((face.clone(), a));
                        }
                        (None, Some(&b), _) => {
                            shared.entry(processor_of(whole.owners[i] as usize)).or_default().push((turned, b));
                        }
                        (None, None, _) => {}
                    }
                }
                let mut first = inside.len() + outside.len();
                let mut boundary = format!("{}\n(\nwalls {{ type wall; nFaces {}; startFace {}; }}\n", shared.len() + 1, outside.len(), inside.len());
                for (other, faces) in &shared {
                    boundary += &format!(
                        "procBoundary{own}to{other}\n{{\n type processor;\n inGroups 1(processor);\n nFaces {};\n startFace {first};\n \
                         matchTolerance 0.0001;\n transform unknown;\n myProcNo {own};\n neighbProcNo {other};\n}}\n",
                        faces.len()
                    );
                    first += faces.len();
                }
                boundary += ")\n";
                let neighbors = inside.iter().map(|(_, _, neighbor)| *neighbor).collect();
                let owned = inside.into_iter().map(|(face, owner, _)| (face, owner)).chain(outside).chain(shared.into_values().flatten());
                let (faces, owners): (Vec<Vec<u32>>, Vec<i64>) = owned.unzip();
                let mut points: Vec<usize> = faces.iter().flatten().map(|&point| point as usize).collect();
                points.sort_unstable();
                points.dedup();
                let number: HashMap<u32, u32> = points.iter().enumerate().map(|(i, &point)| (point as u32, i as u32)).collect();
                let faces = faces.iter().map(|face| face.iter().map(|point| number[point]).collect()).collect();
                let mesh = TestMesh { points: points.iter().map(|&point| self.points[point]).collect(), cells: Vec::new() };
                TestPart { mesh, faces: TestFaces { faces, owners, neighbors }, boundary, cells }
            })
            .collect()
    }
}

impl TestPart {
    /// Writes it as a processor's folder.
    pub(super) fn write(&self, case: &TestCase, processor: usize, style: Style) {
        let folder = format!("processor{processor}/constant/polyMesh");
        case.write_mesh(&folder, &self.mesh, &self.faces, style);
        case.write(
            &format!("{folder}/boundary"),
            &[Style::Text.header("polyBoundaryMesh"), self.boundary.clone().into_bytes()].concat(),
        );
    }
}

impl TestCase {
    /// An empty folder with a `case.foam` in it.
    pub(super) fn new() -> Self {
        let case = Self { folder: tempfile::tempdir().unwrap() };
        case.write("case.foam", b"");
        case.write("system/controlDict", &Style::Text.header("dictionary"));
        case
    }

    /// With a mesh in `constant/polyMesh`.
    pub(super) fn with_mesh(mesh: &TestMesh, style: Style) -> Self {
        let case = Self::new();
        case.write_mesh("constant/polyMesh", mesh, &mesh.faces(), style);
        case
    }

    pub(super) fn root(&self) -> &Path {
        self.folder.path()
    }

    pub(super) fn path(&self, below: &str) -> PathBuf {
        self.root().join(below)
    }

    pub(super) fn write(&self, below: &str, bytes: &[u8]) {
        let path = self.path(below);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    pub(super) fn write_mesh(&self, below: &str, mesh: &TestMesh, faces: &TestFaces, style: Style) {
        for (name, bytes) in mesh_files(mesh, faces, style) {
            self.write(&format!("{below}/{name}"), &bytes);
        }
    }

    /// Puts a file away compressed.
    pub(super) fn compress(&self, below: &str) {
        let bytes = std::fs::read(self.path(below)).unwrap();
        std::fs::remove_file(self.path(below)).unwrap();
        self.write(&format!("{below}.gz"), &gzip(&bytes));
    }

    pub(super) fn read(&self) -> Result<Loaded, IoError> {
        self.read_at("case.foam", StepChoice::Last)
    }

    pub(super) fn read_at(&self, below: &str, step: StepChoice) -> Result<Loaded, IoError> {
        read_mesh(&self.path(below), &ReadOptions { step, ..ReadOptions::default() })
    }
}

pub(super) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// The files of a folder `polyMesh`.
pub(super) fn mesh_files(mesh: &TestMesh, faces: &TestFaces, style: Style) -> [(&'static str, Vec<u8>); 4] {
    let labels = |values: &[i64]| [style.header("labelList"), style.labels(values)].concat();
    [
        ("points", [style.header("vectorField"), style.tuples(mesh.points.as_flattened(), 3)].concat()),
        ("faces", style.faces(&faces.faces)),
        ("owner", labels(&faces.owners)),
        ("neighbour", labels(&faces.neighbors)),
    ]
}

pub(super) fn cells(dataset: &Dataset) -> &UnstructuredCells {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells,
        Cells::Structured(_) => panic!("structured cells"),
    }
}

/// The volume of all tetrahedra, and how many were turned inside out.
pub(super) fn volume(dataset: &Dataset) -> (f64, usize) {
    let cut = decompose(dataset).unwrap();
    let frame = cut.mesh.frame();
    let point = |i: usize| -> DVec3 { frame.to_world(cut.mesh.positions()[i]) };
    let volume = |t: &[u32; 4]| {
        let [a, b, c, d] = t.map(|i| point(i as usize));
        (b - a).cross(c - a).dot(d - a) / 6.0
    };
    (cut.mesh.tetrahedra().iter().map(|t| volume(&t.map(|i| i.0))).sum(), cut.counts.inverted)
}
