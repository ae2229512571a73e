//! What a reader hands over: points, cells of any kind, and named arrays, as they stood in the file.

use glam::DVec3;

/// A mesh as it was read, before it is cut into tetrahedra.
///
/// Point arrays have one tuple a point, cell arrays one a cell, in the order of [`Dataset::points`] and of the cells.
#[derive(Clone, Debug, Default)]
pub struct Dataset {
    /// World coordinates; may hold NaN, which [`decompose`](crate::decompose()) counts and leaves out.
    pub points: Vec<DVec3>,
    /// The cells over these points.
    pub cells: Cells,
    /// Arrays with one tuple a point.
    pub point_arrays: Vec<DataArray>,
    /// Arrays with one tuple a cell. For structured blocks: i fastest, block after block.
    pub cell_arrays: Vec<DataArray>,
}

/// The two ways in which files lay out cells.
#[derive(Clone, Debug)]
pub enum Cells {
    /// Cells that name their points.
    Unstructured(UnstructuredCells),
    /// Curvilinear blocks of hexahedra, whose points are laid out i fastest.
    Structured(Vec<StructuredBlock>),
}

impl Default for Cells {
    fn default() -> Self {
        Self::Unstructured(UnstructuredCells::default())
    }
}

/// Cells that name their points, in compressed rows.
///
/// Cell `c` has kind `kinds[c]` and the points `connectivity[offsets[c]..offsets[c + 1]]`, in VTK's order.
/// `offsets` has one entry more than `kinds`, starts at 0, never falls, and ends at `connectivity.len()`;
/// every entry of `connectivity` is below the number of points. Readers check this once and report the place.
#[derive(Clone, Debug)]
pub struct UnstructuredCells {
    /// One kind a cell.
    pub kinds: Vec<CellKind>,
    /// Where each cell's points begin.
    pub offsets: Vec<usize>,
    /// Point indices of all cells.
    pub connectivity: Vec<u32>,
    /// For polyhedra alone: `face_streams[k]` belongs to the k-th cell of kind [`CellKind::Polyhedron`] and holds its
    /// faces as point indices, each turned either way.
    pub polyhedra: Vec<Vec<Vec<u32>>>,
}

impl Default for UnstructuredCells {
    fn default() -> Self {
        Self { kinds: Vec::new(), offsets: vec![0], connectivity: Vec::new(), polyhedra: Vec::new() }
    }
}

/// One curvilinear grid: `dims` points along i, j, k, and a hexahedron between each eight neighbors.
#[derive(Clone, Debug)]
pub struct StructuredBlock {
    /// Number of points along i, j and k; each at least 1.
    pub dims: [usize; 3],
    /// Index in [`Dataset::points`] of this block's first point; the others follow, i fastest.
    pub first_point: usize,
    /// Points that are blanked (PLOT3D's iblank of 0): one flag a point, or empty where none is. A cell with a hidden
    /// corner is not drawn.
    pub hidden_points: Vec<bool>,
}

impl StructuredBlock {
    /// Number of points.
    pub fn point_count(&self) -> usize {
        self.dims.iter().product()
    }

    /// Number of hexahedra, hidden ones included.
    pub fn cell_count(&self) -> usize {
        self.dims.iter().map(|&n| n.saturating_sub(1)).product()
    }
}

/// The kinds of cell that can be told apart; the numbers of corners and the order of points are VTK's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[expect(missing_docs, reason = "the names are the definitions")]
pub enum CellKind {
    Tetrahedron,
    Voxel,
    Hexahedron,
    Wedge,
    Pyramid,
    PentagonalPrism,
    HexagonalPrism,
    Polyhedron,
    QuadraticTetrahedron,
    QuadraticHexahedron,
    QuadraticWedge,
    QuadraticPyramid,
    TriquadraticHexahedron,
    BiquadraticQuadraticWedge,
    BiquadraticQuadraticHexahedron,
    QuadraticLinearWedge,
    /// Points, lines and faces: they have no volume and are not drawn. One with one to four points is a point, a line, a triangle or a
    /// quadrilateral; with more it is a cell that the file hides, or of a kind that nobody knows.
    Flat,
    /// A point, line or face of which the number of points does not tell what it is; its number in VTK's list.
    FlatOf(u8),
    /// A kind that is not known or not cut into tetrahedra; its number in VTK's list.
    Other(u8),
}

impl CellKind {
    /// Whether cells of this kind have no volume.
    pub fn is_flat(self) -> bool {
        matches!(self, Self::Flat | Self::FlatOf(_))
    }
}

/// A named array with `components` numbers a tuple.
#[derive(Clone, Debug)]
pub struct DataArray {
    /// Its name, as the file has it.
    pub name: String,
    /// Numbers a tuple; at least 1.
    pub components: usize,
    /// All numbers, tuple after tuple; the length is a multiple of `components`.
    pub values: ArrayValues,
}

/// The numbers of an array, in the type that the file has.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names are the definitions")]
pub enum ArrayValues {
    I8(Vec<i8>),
    U8(Vec<u8>),
    I16(Vec<i16>),
    U16(Vec<u16>),
    I32(Vec<i32>),
    U32(Vec<u32>),
    I64(Vec<i64>),
    U64(Vec<u64>),
    F32(Vec<f32>),
    F64(Vec<f64>),
}

/// Runs one expression for whichever vector an [`ArrayValues`] holds.
macro_rules! each_type {
    ($values:expr, $v:ident => $body:expr) => {
        match $values {
            ArrayValues::I8($v) => $body,
            ArrayValues::U8($v) => $body,
            ArrayValues::I16($v) => $body,
            ArrayValues::U16($v) => $body,
            ArrayValues::I32($v) => $body,
            ArrayValues::U32($v) => $body,
            ArrayValues::I64($v) => $body,
            ArrayValues::U64($v) => $body,
            ArrayValues::F32($v) => $body,
            ArrayValues::F64($v) => $body,
        }
    };
}

impl ArrayValues {
    /// Number of numbers.
    pub fn len(&self) -> usize {
        each_type!(self, v => v.len())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All numbers as f64; integers beyond 2⁵³ are rounded.
    #[expect(clippy::unnecessary_cast, reason = "one expression for all types, of which f64 is one")]
    pub fn to_f64(&self) -> Vec<f64> {
        each_type!(self, v => v.iter().map(|&x| x as f64).collect())
    }

    /// The type's name as VTK spells it, `"Float32"` for instance.
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::I8(_) => "Int8",
            Self::U8(_) => "UInt8",
            Self::I16(_) => "Int16",
            Self::U16(_) => "UInt16",
            Self::I32(_) => "Int32",
            Self::U32(_) => "UInt32",
            Self::I64(_) => "Int64",
            Self::U64(_) => "UInt64",
            Self::F32(_) => "Float32",
            Self::F64(_) => "Float64",
        }
    }
}

impl DataArray {
    /// Number of tuples.
    pub fn tuple_count(&self) -> usize {
        self.values.len() / self.components.max(1)
    }

    /// One component of every tuple; empty when there is no such component.
    pub fn component(&self, component: usize) -> Vec<f64> {
        if component >= self.components {
            return Vec::new();
        }
        let all = self.values.to_f64();
        if self.components == 1 {
            all
        } else {
            all.chunks_exact(self.components).map(|tuple| tuple[component]).collect()
        }
    }

    /// The Euclidean length of every tuple; of a scalar its absolute value.
    pub fn magnitude(&self) -> Vec<f64> {
        // Scaled by the largest component, so that the squares neither overflow nor vanish.
        let length = |tuple: &[f64]| {
            let largest = tuple.iter().fold(0.0_f64, |m, x| if x.is_nan() { f64::NAN } else { m.max(x.abs()) });
            if largest == 0.0 || !largest.is_finite() {
                return if tuple.iter().any(|x| x.is_nan()) { f64::NAN } else { largest };
            }
            tuple.iter().map(|x| (x / largest).powi(2)).sum::<f64>().sqrt() * largest
        };
        self.values.to_f64().chunks_exact(self.components.max(1)).map(length).collect()
    }
}
