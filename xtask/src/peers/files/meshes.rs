//! Meshes with every kind of cell and every type of array.

use glam::DVec3;
use tetrascope::{ArrayValues, CellKind, Cells, DataArray, Dataset, StructuredBlock, UnstructuredCells};

/// Meshes with their names.
pub(super) fn all() -> Vec<(String, Dataset)> {
    let solids = [
        (CellKind::Tetrahedron, 4),
        (CellKind::Voxel, 8),
        (CellKind::Hexahedron, 8),
        (CellKind::Wedge, 6),
        (CellKind::Pyramid, 5),
        (CellKind::PentagonalPrism, 10),
        (CellKind::HexagonalPrism, 12),
        (CellKind::QuadraticTetrahedron, 10),
        (CellKind::QuadraticHexahedron, 20),
        (CellKind::QuadraticWedge, 15),
        (CellKind::QuadraticPyramid, 13),
        (CellKind::TriquadraticHexahedron, 27),
        (CellKind::QuadraticLinearWedge, 12),
        (CellKind::BiquadraticQuadraticWedge, 18),
        (CellKind::BiquadraticQuadraticHexahedron, 24),
    ];
    // Vertices, lines and faces of all kinds that VTK has, by number and points.
    let flat = [
        (CellKind::Flat, 1),
        (CellKind::Flat, 2),
        (CellKind::Flat, 3),
        (CellKind::Flat, 4),
        (CellKind::FlatOf(2), 5),
        (CellKind::FlatOf(4), 4),
        (CellKind::FlatOf(6), 6),
        (CellKind::FlatOf(7), 7),
        (CellKind::FlatOf(8), 4),
        (CellKind::FlatOf(21), 3),
        (CellKind::FlatOf(22), 6),
        (CellKind::FlatOf(23), 8),
        (CellKind::FlatOf(28), 9),
        (CellKind::FlatOf(34), 7),
        (CellKind::FlatOf(69), 10),
        // A Lagrange tetrahedron of the third order, which is not cut.
        (CellKind::Other(71), 20),
    ];
    let everything: Vec<_> = solids.into_iter().chain(flat).collect();
    vec![
        ("cells of all kinds".to_owned(), mesh(&everything, 0, false)),
        ("polyhedra beside tetrahedra".to_owned(), mesh(&[(CellKind::Tetrahedron, 4)], 3, true)),
        ("polyhedra alone".to_owned(), mesh(&[], 2, false)),
        ("points alone".to_owned(), mesh(&[], 0, true)),
        ("two grids, a hidden corner".to_owned(), grids()),
    ]
}

/// As many points as the largest cell has, on a helix, cells over the first of them, and polyhedra: octahedra.
fn mesh(kinds: &[(CellKind, u32)], polyhedra: usize, is_double: bool) -> Dataset {
    let count = 27;
    let points: Vec<DVec3> = (0..count)
        .map(|n| {
            let turn = f64::from(n) * 2.1;
            let point = DVec3::new(turn.cos(), turn.sin(), f64::from(n) / 8.0);
            // Single precision goes out as that.
            if is_double { point } else { point.as_vec3().as_dvec3() }
        })
        .collect();
    let mut cells = UnstructuredCells::default();
    let mut push = |kind: CellKind, row: Vec<u32>| {
        cells.kinds.push(kind);
        cells.connectivity.extend(row);
        cells.offsets.push(cells.connectivity.len());
    };
    for _ in 0..polyhedra {
        push(CellKind::Polyhedron, (0..6).collect());
    }
    for &(kind, points) in kinds {
        push(kind, (0..points).collect());
    }
    let octahedron = |turn: u32| {
        let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        faces.map(|face| face.map(|point| (point + turn) % 6).to_vec()).to_vec()
    };
    cells.polyhedra = (0_u32..).take(polyhedra).map(octahedron).collect();
    let cell_count = cells.kinds.len();
    Dataset {
        point_arrays: arrays(points.len()),
        cell_arrays: if cell_count > 0 { arrays(cell_count) } else { Vec::new() },
        points,
        cells: Cells::Unstructured(cells),
    }
}

/// Arrays of every type, of one to nine components, under names that XML has to escape.
fn arrays(tuples: usize) -> Vec<DataArray> {
    // The first numbers are the outermost ones of each type.
    macro_rules! integers {
        ($kind:ident, $type:ty, $components:expr) => {
            ArrayValues::$kind(
                (0..tuples * $components)
                    .map(|n| match n {
                        0 => <$type>::MIN,
                        1 => <$type>::MAX,
                        // Any numbers will do.
                        n => (n * 2_654_435_761) as $type,
                    })
                    .collect(),
            )
        };
    }
    let doubles = [f64::MIN_POSITIVE, -f64::MAX, 1e-310, -0.0, 0.1, 1.0 / 3.0];
    let f64s = (0..2 * tuples).map(|n| doubles[n % doubles.len()] * (1.0 - n as f64 * 1e-9)).collect();
    let f32s = (0..9 * tuples).map(|n| (n as f32 * 0.7).sin() * 1e30).collect();
    let named = [
        ("signed bytes", 1, integers!(I8, i8, 1)),
        ("bytes & more", 3, integers!(U8, u8, 3)),
        ("a < b", 1, integers!(I16, i16, 1)),
        ("\"quoted\"", 2, integers!(U16, u16, 2)),
        ("it's", 1, integers!(I32, i32, 1)),
        ("Größe ∂ρ/∂t", 1, integers!(U32, u32, 1)),
        (" spaces ", 1, integers!(I64, i64, 1)),
        ("]]>", 4, integers!(U64, u64, 4)),
        ("tensor", 9, ArrayValues::F32(f32s)),
        ("numbers", 2, ArrayValues::F64(f64s)),
    ];
    named.map(|(name, components, values)| DataArray { name: name.to_owned(), components, values }).into()
}

fn grids() -> Dataset {
    let block = |first_point: usize| {
        let hidden_points = if first_point == 0 { Vec::new() } else { (0..27).map(|n| n == 26).collect() };
        StructuredBlock { dims: [3; 3], first_point, hidden_points }
    };
    let point = |n: u32| DVec3::new(f64::from(n % 3), f64::from(n / 3 % 3), f64::from(n / 9) * 1.1);
    Dataset {
        points: (0..54).map(point).collect(),
        cells: Cells::Structured(vec![block(0), block(27)]),
        point_arrays: arrays(54),
        cell_arrays: arrays(16),
    }
}
