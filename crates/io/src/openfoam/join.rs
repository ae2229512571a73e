//! Several parts as one dataset: regions side by side, and what processors have of one mesh with the points that they share.

use std::collections::HashMap;

use tetrascope_mesh::{ArrayValues, Cells, DataArray, Dataset, UnstructuredCells};

use super::{
    fields::{Budget, Field, Owner},
    part::Part,
    shared_points::Merger,
};
use crate::{IoError, Source};

/// The array of cells that says which region each belongs to.
const REGION: &str = "openfoam:region";

/// The parts of a case, to be joined.
#[derive(Debug, Default)]
pub(super) struct Joined {
    parts: Vec<Part>,
}

/// A field of all parts; one entry a part, nothing where it does not have it.
struct Gathered {
    owner: Owner,
    name: String,
    components: usize,
    values: Vec<Option<ArrayValues>>,
}

impl Joined {
    /// Adds another part.
    pub(super) fn add(&mut self, part: Part) {
        self.parts.push(part);
    }

    /// Whether any file of a mesh is in binary.
    pub(super) fn is_binary(&self) -> bool {
        self.parts.iter().any(|part| part.binary)
    }

    /// All parts as one dataset.
    ///
    /// - `by_region`: whether an array tells the regions apart
    ///
    /// # Errors
    /// [`IoError`] where the points are too many, or fields that some parts do not have are too many to be filled.
    pub(super) fn finish(
        mut self,
        source: &Source,
        by_region: bool,
        budget: &mut Budget,
        warnings: &mut Vec<String>,
    ) -> Result<Dataset, IoError> {
        let total: usize = self.parts.iter().map(|part| part.points.len()).sum();
        if u32::try_from(total).is_err() {
            return Err(source.unsupported(format!("a mesh of more than {} points", u32::MAX), "write a coarser one"));
        }
        let point_counts: Vec<usize> = self.parts.iter().map(|part| part.points.len()).collect();
        let cell_counts: Vec<usize> = self.parts.iter().map(|part| part.cells.kinds.len()).collect();
        let merger = Merger::new(&self.parts, warnings);

        let mut arrays = [Vec::new(), Vec::new()];
        for gathered in self.gather(warnings) {
            let counts = if gathered.owner == Owner::Cell { &cell_counts } else { &point_counts };
            let owner = gathered.owner;
            let array = gathered.join(source, counts, budget, warnings)?;
            match owner {
                Owner::Cell => arrays[0].push(array),
                Owner::Point => {
                    arrays[1].push(DataArray { values: merger.kept_tuples(array.values, array.components), ..array })
                }
            }
        }
        let [mut cell_arrays, point_arrays] = arrays;
        if by_region {
            let regions = self.parts.iter().flat_map(|part| std::iter::repeat_n(part.region, part.cells.kinds.len()));
            let values = ArrayValues::I32(regions.collect());
            cell_arrays.push(DataArray { name: REGION.to_owned(), components: 1, values });
        }

        let mut points = Vec::new();
        let mut cells = UnstructuredCells::default();
        for part in std::mem::take(&mut self.parts) {
            append_cells(&mut cells, part.cells, points.len(), &merger);
            points.extend(part.points);
        }
        Ok(Dataset { points: merger.kept_points(points), cells: Cells::Unstructured(cells), point_arrays, cell_arrays })
    }

    /// The fields of all parts by owner and name, in the order in which they are met.
    fn gather(&mut self, warnings: &mut Vec<String>) -> Vec<Gathered> {
        let part_count = self.parts.len();
        let mut places = HashMap::new();
        let mut all: Vec<Gathered> = Vec::new();
        for (number, part) in self.parts.iter_mut().enumerate() {
            for Field { name, owner, components, values } in std::mem::take(&mut part.fields) {
                let place = *places.entry((owner, name.clone())).or_insert(all.len());
                if place == all.len() {
                    all.push(Gathered { owner, name, components, values: Vec::new() });
                }
                let Some(gathered) = all.get_mut(place) else { continue };
                if gathered.components == components {
                    // Only entries up to this part, so that fields that few parts have cost little.
                    gathered.values.resize(number, None);
                    gathered.values.push(Some(values));
                } else {
                    warnings.push(format!(
                        "field {} has {components} components in part {number} and {} before; it is left out there",
                        gathered.name, gathered.components
                    ));
                }
            }
        }
        for gathered in &mut all {
            gathered.values.resize(part_count, None);
        }
        all
    }
}

impl Gathered {
    /// One array of all parts; NaN where a part does not have the field.
    fn join(
        self,
        source: &Source,
        counts: &[usize],
        budget: &mut Budget,
        warnings: &mut Vec<String>,
    ) -> Result<DataArray, IoError> {
        let (name, components) = (self.name, self.components);
        let lacking = self.values.iter().filter(|values| values.is_none()).count();
        if lacking > 0 {
            let filled = self.values.iter().zip(counts).filter(|(values, _)| values.is_none()).map(|(_, &count)| count);
            budget.fill(filled.sum::<usize>().checked_mul(components)).map_err(|problem| {
                source.invalid(format!("field {name}"), problem, "read one region, or remove fields")
            })?;
            warnings
                .push(format!("field {name} is not there in {lacking} of {} parts; it is NaN in these", counts.len()));
        }
        let all_short = self.values.iter().flatten().all(|values| matches!(values, ArrayValues::F32(_)));
        let mut parts = self.values.into_iter();
        let values = match (parts.next(), parts.len()) {
            // Most cases have one part, whose array is moved.
            (Some(Some(only)), 0) => only,
            (first, _) => {
                let all = first.into_iter().chain(parts).zip(counts);
                if all_short {
                    let part = |(values, &count): (Option<ArrayValues>, &usize)| match values {
                        Some(ArrayValues::F32(values)) => values,
                        _ => vec![f32::NAN; count * components],
                    };
                    ArrayValues::F32(all.flat_map(part).collect())
                } else {
                    let part = |(values, &count): (Option<ArrayValues>, &usize)| {
                        values.map_or_else(|| vec![f64::NAN; count * components], |values| values.to_f64())
                    };
                    ArrayValues::F64(all.flat_map(part).collect())
                }
            }
        };
        Ok(DataArray { name, components, values })
    }
}

/// Puts the cells of a part behind those before, with its points behind theirs and those that are shared under their one number.
fn append_cells(cells: &mut UnstructuredCells, part: UnstructuredCells, first_point: usize, merger: &Merger) {
    if cells.kinds.is_empty() && merger.is_identity() {
        *cells = part;
        return;
    }
    let point = |point: &u32| merger.number_of(first_point + *point as usize);
    let first = cells.connectivity.len();
    cells.kinds.extend(part.kinds);
    cells.offsets.extend(part.offsets.iter().skip(1).map(|offset| first + offset));
    cells.connectivity.extend(part.connectivity.iter().map(point));
    let faces = |faces: &Vec<Vec<u32>>| faces.iter().map(|face| face.iter().map(point).collect()).collect();
    cells.polyhedra.extend(part.polyhedra.iter().map(faces));
}
