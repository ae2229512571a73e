//! The tetrahedra with the arrays of the mesh that they were cut from.

use super::{AddedPoint, Decomposition};
use crate::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells};

impl Decomposition {
    /// The tetrahedra as a dataset of their own, with all arrays of the `dataset` that was cut.
    ///
    /// Points are the dataset's, bit for bit and in their order, used or not, followed by the added ones. A point array has at these the weighted
    /// means of their parents, rounded to the nearest where it is of integers; a cell array has at every tetrahedron the tuple of the
    /// cell that it was cut from. Types, names and order of arrays stay; an array whose length is not the mesh's is left out.
    ///
    /// Tetrahedra are in the order of [`TetMesh::tetrahedra`](crate::TetMesh::tetrahedra), each of positive volume.
    pub fn to_dataset(&self, dataset: &Dataset) -> Dataset {
        let mesh = &self.mesh;
        let mut points = dataset.points.clone();
        let added = mesh.positions().iter().skip(points.len());
        points.extend(added.map(|&position| mesh.frame().to_world(position)));
        let count = mesh.tetrahedra().len();
        let cells = UnstructuredCells {
            kinds: vec![CellKind::Tetrahedron; count],
            offsets: (0..=count).map(|cell| 4 * cell).collect(),
            connectivity: mesh.tetrahedra().iter().flatten().map(|vertex| vertex.0).collect(),
            polyhedra: Vec::new(),
        };
        let of_points = |array: &DataArray| self.point_array(array, dataset.points.len());
        let of_cells = |array: &DataArray| gathered(array, mesh.source_cells());
        Dataset {
            points,
            cells: Cells::Unstructured(cells),
            point_arrays: dataset.point_arrays.iter().filter_map(of_points).collect(),
            cell_arrays: dataset.cell_arrays.iter().filter_map(of_cells).collect(),
        }
    }

    fn point_array(&self, array: &DataArray, points: usize) -> Option<DataArray> {
        if array.tuple_count() != points {
            return None;
        }
        let components = array.components;
        // The parents' numbers alone are looked at: most meshes have few added points or none.
        macro_rules! extended {
            ($($kind:ident $round:expr),*) => {
                match &array.values {
                    $(ArrayValues::$kind(numbers) => {
                        let mut all = numbers.clone();
                        for point in &self.added_points {
                            for component in 0..components {
                                let mean = weighted(point, |parent| numbers.get(parent * components + component).map(|&x| x as f64));
                                all.push($round(mean) as _);
                            }
                        }
                        ArrayValues::$kind(all)
                    })*
                }
            };
        }
        let values = extended!(I8 f64::round, U8 f64::round, I16 f64::round, U16 f64::round, I32 f64::round, U32 f64::round,
            I64 f64::round, U64 f64::round, F32 std::convert::identity, F64 std::convert::identity);
        Some(DataArray { name: array.name.clone(), components, values })
    }
}

/// The weighted mean of the parents' numbers; NaN where one is missing.
fn weighted(point: &AddedPoint, number: impl Fn(usize) -> Option<f64>) -> f64 {
    point.parents.iter().map(|&(vertex, weight)| number(vertex.index()).map_or(f64::NAN, |x| x * weight)).sum()
}

/// The tuples of these cells; `None` where one of them has none.
fn gathered(array: &DataArray, cells: &[u32]) -> Option<DataArray> {
    let components = array.components;
    macro_rules! each {
        ($($kind:ident),*) => {
            match &array.values {
                $(ArrayValues::$kind(numbers) => {
                    let mut own = Vec::with_capacity(cells.len().saturating_mul(components));
                    for &cell in cells {
                        let start = cell as usize * components;
                        own.extend_from_slice(numbers.get(start..start + components)?);
                    }
                    ArrayValues::$kind(own)
                })*
            }
        };
    }
    let values = each!(I8, U8, I16, U16, I32, U32, I64, U64, F32, F64);
    Some(DataArray { name: array.name.clone(), components, values })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::decompose;

    fn array(name: &str, components: usize, values: ArrayValues) -> DataArray {
        DataArray { name: name.to_owned(), components, values }
    }

    /// A hexahedron as a polyhedron, whose centroid is added, an inverted tetrahedron, and one of no volume.
    fn dataset() -> Dataset {
        let corner = |n: u32| DVec3::new(f64::from(n & 1), f64::from(n >> 1 & 1), f64::from(n >> 2));
        let points: Vec<_> = (0..8).map(corner).chain([DVec3::new(0.1, 0.2, 5.3)]).collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let cells = UnstructuredCells {
            kinds: vec![CellKind::Polyhedron, CellKind::Tetrahedron, CellKind::Tetrahedron],
            offsets: vec![0, 8, 12, 16],
            connectivity: vec![0, 1, 2, 3, 4, 5, 6, 7, 4, 6, 5, 8, 0, 1, 2, 3],
            polyhedra: vec![faces.iter().map(|face| face.to_vec()).collect()],
        };
        Dataset {
            points,
            cells: Cells::Unstructured(cells),
            point_arrays: vec![
                array("x", 2, ArrayValues::F64((0..18).map(|n| f64::from(n) / 3.0).collect())),
                array("i", 1, ArrayValues::U8(vec![0, 1, 2, 3, 4, 5, 6, 9, 255])),
            ],
            cell_arrays: vec![array("c", 2, ArrayValues::I16(vec![-1, 10, -2, 20, -3, 30]))],
        }
    }

    #[test]
    fn arrays_follow_the_tetrahedra() {
        let dataset = dataset();
        let cut = decompose(&dataset).unwrap();
        assert_eq!((cut.mesh.tetrahedra().len(), cut.counts.no_volume, cut.counts.inverted), (13, 1, 1));
        let tetrahedra = cut.to_dataset(&dataset);
        assert_eq!(tetrahedra.points[..9], dataset.points);
        assert!((tetrahedra.points[9] - DVec3::splat(0.5)).length() < 1e-15);
        let ArrayValues::F64(x) = &tetrahedra.point_arrays[0].values else { panic!("another type") };
        assert!(x.len() == 20 && (x[18] - 7.0 / 3.0).abs() < 1e-15 && (x[19] - 8.0 / 3.0).abs() < 1e-15, "{x:?}");
        // 30 / 8, rounded.
        let ArrayValues::U8(i) = &tetrahedra.point_arrays[1].values else { panic!("another type") };
        assert_eq!(i[8..], [255, 4]);
        let ArrayValues::I16(c) = &tetrahedra.cell_arrays[0].values else { panic!("another type") };
        assert_eq!(c[..24], [-1, 10].repeat(12));
        assert_eq!(c[24..], [-2, 20]);
        // Cut again they are what they were.
        let again = decompose(&tetrahedra).unwrap();
        assert_eq!(again.mesh.tetrahedra(), cut.mesh.tetrahedra());
        assert_eq!((again.counts.no_volume, again.counts.inverted, again.added_points.len()), (0, 0, 0));
    }

    #[test]
    fn arrays_of_another_length_are_left_out() {
        let mut dataset = dataset();
        dataset.point_arrays[0].values = ArrayValues::F64(vec![0.0; 16]);
        dataset.cell_arrays[0].values = ArrayValues::I16(vec![7]);
        let tetrahedra = decompose(&dataset).unwrap().to_dataset(&dataset);
        assert_eq!((tetrahedra.point_arrays.len(), tetrahedra.cell_arrays.len()), (1, 0));
    }
}
