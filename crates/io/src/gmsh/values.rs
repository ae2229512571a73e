//! The arrays of the chosen step, from its data sections.

use std::collections::HashMap;

use tetrascope_mesh::{ArrayValues, CellKind, UnstructuredCells};

use super::element_types::element_type;
use super::middles::middles;
use super::number_map::NumberMap;
use super::numbers::Numbers;
use super::views::{Owner, View};
use crate::{IoError, Source};

/// Numbers that the arrays may have for each byte of the file: a section of few values makes an array for all points.
const MOST_NUMBERS_PER_BYTE: usize = 16;

/// Numbers that the arrays may have whatever the length of the file.
const NUMBERS_FOR_ALL: usize = 1 << 20;

/// The mesh that the values belong to.
pub(super) struct Mesh<'a> {
    pub(super) cells: &'a UnstructuredCells,
    pub(super) types: &'a [u8],
    pub(super) nodes: &'a NumberMap,
    pub(super) elements: &'a NumberMap,
    pub(super) point_count: usize,
}

/// An array that is being put together; several sections may share in it, one for each part of a partitioned mesh.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) owner: Owner,
    pub(super) components: usize,
    values: Vec<f64>,
    /// How many values came together in each tuple.
    counts: Vec<u32>,
    /// Tuples whose node or element is not in the mesh.
    strangers: usize,
    /// Elements with another number of values than nodes.
    odd: usize,
}

/// Reads the values of some views.
///
/// # Errors
/// [`IoError::Invalid`] where a section is damaged or the arrays are beyond their limit.
pub(super) fn columns<'v>(
    source: &Source,
    mesh: &Mesh<'_>,
    views: impl Iterator<Item = &'v View<'v>>,
) -> Result<Vec<Column>, IoError> {
    let limit = source.bytes.len().saturating_mul(MOST_NUMBERS_PER_BYTE).max(NUMBERS_FOR_ALL);
    let mut left = limit;
    let mut columns: Vec<Column> = Vec::new();
    let mut places: HashMap<(Owner, &str), usize> = HashMap::new();
    for view in views {
        let mut numbers = Numbers::new(source, view.section, view.values_at);
        let place = *places.entry((view.owner, &view.name)).or_insert(columns.len());
        if place == columns.len() {
            let tuples = if view.owner == Owner::Elements { mesh.types.len() } else { mesh.point_count };
            let length = tuples.saturating_mul(view.components);
            left = left.checked_sub(length).ok_or_else(|| {
                numbers.invalid(format!(
                    "with `{}` the arrays have more than {limit} numbers, 16 for each byte",
                    view.name
                ))
            })?;
            columns.push(Column::new(view, tuples));
        }
        let Some(column) = columns.get_mut(place) else { continue };
        if column.components != view.components {
            return Err(numbers.invalid(format!(
                "`{}` has {} components here and {} before",
                view.name, view.components, column.components
            )));
        }
        column.read(&mut numbers, view, mesh)?;
    }
    Ok(columns)
}

impl Column {
    fn new(view: &View<'_>, tuples: usize) -> Self {
        Self {
            name: view.name.clone(),
            owner: view.owner,
            components: view.components,
            values: vec![f64::NAN; tuples * view.components],
            counts: vec![0; tuples],
            strangers: 0,
            odd: 0,
        }
    }

    /// The array's numbers; NaN where the file has none. `warnings` says what was odd.
    pub(super) fn finish(self, is_used: &[bool], cells: &UnstructuredCells, warnings: &mut Vec<String>) -> ArrayValues {
        let name = &self.name;
        let empty = |place: &usize| self.counts.get(*place) == Some(&0);
        let (missing, of) = match self.owner {
            Owner::Elements => {
                let drawn = |cell: &usize| cells.kinds.get(*cell).is_some_and(|kind| !kind.is_flat());
                ((0..self.counts.len()).filter(empty).filter(drawn).count(), "cells")
            }
            _ => {
                let used = |point: &usize| is_used.get(*point) == Some(&true);
                ((0..self.counts.len()).filter(empty).filter(used).count(), "points")
            }
        };
        if self.owner == Owner::ElementNodes {
            warnings
                .push(format!("`{name}` has a value for each point of each cell; at every point they were averaged"));
        }
        if self.odd > 0 {
            warnings.push(format!(
                "`{name}` has another number of values than points in {} cells; those of the corners were taken, and their means between them",
                self.odd
            ));
        }
        if self.strangers > 0 {
            let of = if self.owner == Owner::Nodes { "nodes" } else { "elements" };
            warnings.push(format!("`{name}` has values for {} {of} that are not in the mesh", self.strangers));
        }
        if missing > 0 {
            warnings.push(format!("`{name}` has no value at {missing} {of}, where it is NaN"));
        }
        ArrayValues::F64(self.values)
    }

    fn read(&mut self, numbers: &mut Numbers<'_>, view: &View<'_>, mesh: &Mesh<'_>) -> Result<(), IoError> {
        let mut tuple = Vec::new();
        for _ in 0..view.count {
            let number = numbers.int("the number of a node or element")?;
            if view.owner == Owner::ElementNodes {
                let count = numbers.int("the number of an element's values")?;
                let count = usize::try_from(count)
                    .map_err(|_| numbers.invalid(format!("element {number} has {count} values")))?;
                read_tuple(numbers, count.saturating_mul(view.components), &mut tuple)?;
                match mesh.elements.get(number) {
                    Some(cell) => self.spread(mesh, cell as usize, count, &tuple),
                    None => self.strangers += 1,
                }
                continue;
            }
            read_tuple(numbers, view.components, &mut tuple)?;
            let map = if view.owner == Owner::Nodes { mesh.nodes } else { mesh.elements };
            match map.get(number) {
                Some(place) => self.put(place as usize, &tuple),
                None => self.strangers += 1,
            }
        }
        Ok(())
    }

    /// Takes a tuple as it is; a later one of the same number replaces it.
    fn put(&mut self, place: usize, tuple: &[f64]) {
        let start = place.saturating_mul(self.components);
        if let (Some(slots), Some(count)) =
            (self.values.get_mut(start..start.saturating_add(tuple.len())), self.counts.get_mut(place))
        {
            slots.copy_from_slice(tuple);
            *count = 1;
        }
    }

    /// Gives the values of one element's nodes, in Gmsh's order, to the cell's points.
    fn spread(&mut self, mesh: &Mesh<'_>, cell: usize, count: usize, values: &[f64]) {
        let cells = mesh.cells;
        let row = cells.offsets.get(cell).zip(cells.offsets.get(cell + 1));
        let Some(row) = row.and_then(|(&start, &end)| cells.connectivity.get(start..end)) else { return };
        let known = mesh.types.get(cell).and_then(|&number| element_type(number.into()));
        let nodes = known.map_or(row.len(), |known| known.nodes);
        let order = known.and_then(|known| known.order);
        let components = self.components;
        let tuple_of = |slot: usize| {
            let node = order.map_or(Some(slot), |order| order.get(slot).map(|&node| usize::from(node)));
            let start = node.unwrap_or(usize::MAX).saturating_mul(components);
            values.get(start..start.saturating_add(components))
        };
        let kind = cells.kinds.get(cell).copied().unwrap_or(CellKind::Flat);
        let corners = corner_count(kind);
        if count == nodes {
            for (slot, &point) in row.iter().enumerate() {
                if let Some(tuple) = tuple_of(slot) {
                    self.average(point as usize, tuple);
                }
            }
            return;
        }
        self.odd += 1;
        if count < corners {
            return;
        }
        // A linear field on an element of a higher order: between the corners it is their mean.
        let between = middles(kind).iter().filter_map(|of| mean(of.iter().map(|&corner| tuple_of(corner.into()))));
        let own = (0..corners).filter_map(|corner| tuple_of(corner).map(<[f64]>::to_vec));
        let tuples: Vec<Vec<f64>> = own.chain(between).collect();
        for (&point, tuple) in row.iter().zip(&tuples) {
            self.average(point as usize, tuple);
        }
    }

    fn average(&mut self, point: usize, tuple: &[f64]) {
        let start = point.saturating_mul(self.components);
        let Some(count) = self.counts.get_mut(point) else { return };
        *count = count.saturating_add(1);
        // A running mean: a sum could overflow where the values are near the largest number.
        let share = 1.0 / f64::from(*count);
        for (slot, &value) in self.values.iter_mut().skip(start).zip(tuple) {
            *slot = if *count == 1 { value } else { *slot * (1.0 - share) + value * share };
        }
    }
}

/// Reads so many numbers; memory grows as they come.
fn read_tuple(numbers: &mut Numbers<'_>, length: usize, tuple: &mut Vec<f64>) -> Result<(), IoError> {
    tuple.clear();
    for _ in 0..length {
        tuple.push(numbers.real("a value")?);
    }
    Ok(())
}

/// The mean of some tuples, each component by itself; nothing where one is not there.
fn mean<'a>(tuples: impl Iterator<Item = Option<&'a [f64]>>) -> Option<Vec<f64>> {
    let tuples: Vec<&[f64]> = tuples.collect::<Option<_>>()?;
    let share = 1.0 / tuples.len() as f64;
    let components = tuples.first()?.len();
    let component = |place: usize| tuples.iter().filter_map(|tuple| tuple.get(place)).map(|value| value * share).sum();
    Some((0..components).map(component).collect())
}

/// Corners of a kind, which come first among its points; 0 where they need not.
fn corner_count(kind: CellKind) -> usize {
    match kind {
        CellKind::Tetrahedron | CellKind::QuadraticTetrahedron => 4,
        CellKind::Pyramid | CellKind::QuadraticPyramid => 5,
        CellKind::Wedge | CellKind::QuadraticWedge | CellKind::BiquadraticQuadraticWedge => 6,
        CellKind::Hexahedron | CellKind::QuadraticHexahedron | CellKind::TriquadraticHexahedron => 8,
        _ => 0,
    }
}
