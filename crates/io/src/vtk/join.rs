//! Pieces and parts, one behind the other.

use std::collections::HashMap;

use tetrascope_mesh::{ArrayValues, Cells, DataArray, Dataset, StructuredBlock, UnstructuredCells};

use super::grids::hexahedra::push_hexahedra;
use super::scalars::append;

/// Arrays of one kind over all pieces of a file.
pub(super) struct Joined {
    owner: &'static str,
    /// The arrays that all pieces had so far.
    pub(super) arrays: Vec<DataArray>,
    any_piece: bool,
}

impl Joined {
    /// Without any array.
    ///
    /// - `owner`: "point" or "cell", for warnings
    pub(super) fn new(owner: &'static str) -> Self {
        Self { owner, arrays: Vec::new(), any_piece: false }
    }

    /// Puts a piece's arrays behind those of the pieces before; what is not in all of them goes.
    pub(super) fn add_piece(&mut self, arrays: Vec<DataArray>, warnings: &mut Vec<String>) {
        if !self.any_piece {
            self.any_piece = true;
            self.arrays = arrays;
            return;
        }
        let owner = self.owner;
        let mut own: Vec<_> = arrays.into_iter().map(Some).collect();
        let by_name: HashMap<String, usize> =
            own.iter().flatten().enumerate().map(|(index, array)| (array.name.clone(), index)).collect();
        self.arrays.retain_mut(|all| {
            let joined = by_name
                .get(&all.name)
                .and_then(|&index| own[index].take())
                .is_some_and(|array| array.components == all.components && append(&mut all.values, array.values));
            if !joined {
                warnings.push(format!(
                    "the {owner} array `{}` is left out: not all pieces have it with the same type and components",
                    all.name
                ));
            }
            joined
        });
        for array in own.into_iter().flatten() {
            warnings.push(format!("the {owner} array `{}` is left out: not all pieces have it", array.name));
        }
    }
}

/// Puts whole meshes one behind the other. An array that some of them lack is NaN there, and one whose type differs is of 64-bit floats.
///
/// Structured blocks stay what they are, unless there are unstructured cells beside them. The error says what does not fit.
pub(super) fn join(mut parts: Vec<Dataset>, warnings: &mut Vec<String>) -> Result<Dataset, String> {
    if parts.len() == 1 {
        return Ok(parts.pop().unwrap_or_default());
    }
    let total: usize = parts.iter().map(|part| part.points.len()).sum();
    if u32::try_from(total).is_err() {
        return Err(format!("together they have {total} points, where a mesh can have {}", u32::MAX));
    }
    let counts = |part: &Dataset| match &part.cells {
        Cells::Unstructured(cells) => cells.kinds.len(),
        Cells::Structured(blocks) => blocks.iter().map(StructuredBlock::cell_count).sum(),
    };
    let cell_counts: Vec<usize> = parts.iter().map(counts).collect();
    let point_counts: Vec<usize> = parts.iter().map(|part| part.points.len()).collect();
    let take = |arrays: fn(&mut Dataset) -> &mut Vec<DataArray>, parts: &mut Vec<Dataset>| -> Vec<Vec<DataArray>> {
        parts.iter_mut().map(|part| std::mem::take(arrays(part))).collect()
    };
    let of_points = take(|part| &mut part.point_arrays, &mut parts);
    let of_cells = take(|part| &mut part.cell_arrays, &mut parts);
    let point_arrays = join_arrays("point", of_points, &point_counts, warnings);
    let cell_arrays = join_arrays("cell", of_cells, &cell_counts, warnings);
    let cells = join_cells(&mut parts, warnings);
    let mut points = Vec::with_capacity(total);
    parts.into_iter().for_each(|part| points.extend(part.points));
    Ok(Dataset { points, cells, point_arrays, cell_arrays })
}

/// The arrays of one name, each with the number of its part.
struct Named {
    name: String,
    components: usize,
    arrays: Vec<(usize, DataArray)>,
}

fn join_arrays(
    owner: &str,
    parts: Vec<Vec<DataArray>>,
    counts: &[usize],
    warnings: &mut Vec<String>,
) -> Vec<DataArray> {
    // For each name, in the order in which they first appear, the array of every part that has it.
    let mut by_name: HashMap<String, usize> = HashMap::new();
    let mut named: Vec<Named> = Vec::new();
    for (part, arrays) in parts.into_iter().enumerate() {
        for array in arrays {
            let index = *by_name.entry(array.name.clone()).or_insert(named.len());
            if index == named.len() {
                named.push(Named { name: array.name.clone(), components: array.components, arrays: Vec::new() });
            }
            named[index].arrays.push((part, array));
        }
    }
    let filled = counts.iter().filter(|&&count| count > 0).count();
    let mut joined = Vec::with_capacity(named.len());
    for Named { name, components, mut arrays } in named {
        arrays.retain(|(part, _)| counts[*part] > 0);
        if arrays.iter().any(|(_, array)| array.components != components) {
            warnings.push(format!(
                "the {owner} array `{name}` is left out: the parts have it with different numbers of components"
            ));
            continue;
        }
        let Some(first) = arrays.first().map(|(_, array)| array.values.type_name()) else { continue };
        let is_everywhere = arrays.len() == filled;
        let values = if is_everywhere && arrays.iter().all(|(_, array)| array.values.type_name() == first) {
            let mut arrays = arrays.into_iter().map(|(_, array)| array.values);
            let mut all = arrays.next().unwrap_or(ArrayValues::F64(Vec::new()));
            for values in arrays {
                append(&mut all, values);
            }
            all
        } else {
            if !is_everywhere {
                warnings.push(format!(
                    "the {owner} array `{name}` is in {} of {filled} parts only; elsewhere it is NaN",
                    arrays.len()
                ));
            }
            let mut arrays = arrays.into_iter().peekable();
            let mut all = Vec::new();
            for (part, &count) in counts.iter().enumerate() {
                match arrays.next_if(|(of, _)| *of == part) {
                    Some((_, array)) => all.extend(array.values.to_f64()),
                    None => all.resize(all.len() + count * components, f64::NAN),
                }
            }
            ArrayValues::F64(all)
        };
        joined.push(DataArray { name, components, values });
    }
    joined
}

fn join_cells(parts: &mut [Dataset], warnings: &mut Vec<String>) -> Cells {
    let is_structured = |part: &Dataset| matches!(part.cells, Cells::Structured(_));
    let mut base = 0;
    if parts.iter().all(is_structured) {
        let mut all = Vec::new();
        for part in parts {
            if let Cells::Structured(blocks) = &mut part.cells {
                all.extend(
                    blocks.drain(..).map(|block| StructuredBlock { first_point: block.first_point + base, ..block }),
                );
            }
            base += part.points.len();
        }
        return Cells::Structured(all);
    }
    if parts.iter().any(is_structured) {
        warnings
            .push("grids stand beside unstructured cells; their cells are read as hexahedra of their own".to_owned());
    }
    let mut all = UnstructuredCells::default();
    for part in parts {
        match std::mem::take(&mut part.cells) {
            Cells::Structured(blocks) => {
                for block in blocks {
                    push_hexahedra(
                        &mut all,
                        &StructuredBlock { first_point: block.first_point + base, ..block },
                        |_| true,
                    );
                }
            }
            Cells::Unstructured(cells) => append_cells(&mut all, cells, base),
        }
        base += part.points.len();
    }
    Cells::Unstructured(all)
}

/// Puts cells behind others; their points follow `base` points.
fn append_cells(all: &mut UnstructuredCells, cells: UnstructuredCells, base: usize) {
    let start = all.connectivity.len();
    // The number of all points was found to fit.
    let shift = |point: u32| point.saturating_add(u32::try_from(base).unwrap_or(u32::MAX));
    all.connectivity.extend(cells.connectivity.into_iter().map(shift));
    all.offsets.extend(cells.offsets.into_iter().skip(1).map(|end| end + start));
    all.kinds.extend(cells.kinds);
    all.polyhedra.extend(
        cells.polyhedra.into_iter().map(|faces| {
            faces.into_iter().map(|face| face.into_iter().map(shift).collect()).collect::<Vec<Vec<u32>>>()
        }),
    );
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use tetrascope_mesh::CellKind;

    use super::*;

    fn array(name: &str, values: ArrayValues) -> DataArray {
        DataArray { name: name.to_owned(), components: 1, values }
    }

    fn tetrahedron(arrays: Vec<DataArray>) -> Dataset {
        let cells = UnstructuredCells {
            kinds: vec![CellKind::Tetrahedron],
            offsets: vec![0, 4],
            connectivity: vec![0, 1, 2, 3],
            polyhedra: Vec::new(),
        };
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        Dataset { points, cells: Cells::Unstructured(cells), point_arrays: arrays, cell_arrays: Vec::new() }
    }

    fn block() -> Dataset {
        let block = StructuredBlock { dims: [2; 3], first_point: 0, hidden_points: Vec::new() };
        Dataset {
            points: (0..8).map(|n| DVec3::splat(f64::from(n))).collect(),
            cells: Cells::Structured(vec![block]),
            ..Dataset::default()
        }
    }

    #[test]
    fn arrays_that_parts_lack_or_have_in_other_types() {
        let mut warnings = Vec::new();
        let a = vec![array("s", ArrayValues::F32(vec![1.0; 4])), array("t", ArrayValues::I32(vec![7; 4]))];
        let b = vec![array("s", ArrayValues::F64(vec![0.1; 4]))];
        let empty = Dataset::default();
        let all = join(vec![tetrahedron(a), empty, tetrahedron(b)], &mut warnings).unwrap();
        assert_eq!(all.points.len(), 8);
        let Cells::Unstructured(cells) = &all.cells else { panic!("structured") };
        assert_eq!(cells.connectivity, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(cells.offsets, [0, 4, 8]);
        assert_eq!(all.point_arrays[0].component(0)[3..5], [1.0, 0.1]);
        let t = all.point_arrays[1].component(0);
        assert!(t[3] == 7.0 && t[4].is_nan() && t.len() == 8);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(warnings[0].contains("`t` is in 1 of 2 parts"), "{warnings:?}");
    }

    #[test]
    fn blocks_beside_blocks_and_beside_cells() {
        let mut warnings = Vec::new();
        let blocks = join(vec![block(), block()], &mut warnings).unwrap();
        let Cells::Structured(all) = &blocks.cells else { panic!("not structured") };
        assert_eq!((all[0].first_point, all[1].first_point), (0, 8));
        assert!(warnings.is_empty());
        let mixed = join(vec![tetrahedron(Vec::new()), block()], &mut warnings).unwrap();
        let Cells::Unstructured(all) = &mixed.cells else { panic!("structured") };
        assert_eq!(all.kinds, [CellKind::Tetrahedron, CellKind::Hexahedron]);
        assert_eq!(all.connectivity[4..], [4, 5, 7, 6, 8, 9, 11, 10]);
        assert_eq!(warnings.len(), 1);
    }
}
