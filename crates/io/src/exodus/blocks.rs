//! The element blocks, which become the cells.

use std::collections::BTreeMap;

use tetrascope_mesh::UnstructuredCells;

use super::DAMAGED;
use super::elements::Element;
use super::faces::FaceTable;
use super::netcdf::Netcdf;
use super::numbered::numbered;
use crate::IoError;
use crate::vtk::cells::CellBuilder;
use crate::vtk::scalars::to_indices;

/// VTK's number for a cell that is nothing but its points.
const POINTS: i64 = 2;
const POLYGON: i64 = 7;

/// Where a block's cells are.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Its number in the names of variables, from 1.
    pub(super) number: u64,
    /// What the user calls it: its ID.
    pub(super) id: i64,
    /// Its cells among all.
    pub(super) cells: std::ops::Range<usize>,
}

/// The cells of all blocks in the order of their numbers.
///
/// # Errors
/// [`IoError::Invalid`] where a block names nodes that are not there.
pub(super) fn read_blocks(
    file: &Netcdf<'_>,
    points: usize,
    warnings: &mut Vec<String>,
) -> Result<(UnstructuredCells, Vec<Block>), IoError> {
    let mut builder = CellBuilder::new(file.source);
    let mut faces = None;
    let mut oddities = Oddities::default();
    let mut blocks = Vec::new();
    let ids = ids(file)?;
    let mut first = 0;
    for number in
        numbered(file, "connect").into_iter().chain(polyhedral(file)).collect::<std::collections::BTreeSet<_>>()
    {
        let id = usize::try_from(number - 1).ok().and_then(|index| ids.get(index).copied());
        let id = id.unwrap_or(i64::try_from(number).unwrap_or(i64::MAX));
        builder.begin_piece(&format!("element block {id}"), 0, points)?;
        let count = if file.shape(&format!("facconn{number}")).is_some() && is_polyhedral(file, number) {
            if faces.is_none() {
                faces = Some(FaceTable::read(file)?);
            }
            match &mut faces {
                Some(table) => table.push_block(file, number, &mut builder)?,
                None => 0,
            }
        } else {
            push_block(file, number, id, &mut builder, &mut oddities)?
        };
        blocks.push(Block { number, id, cells: first..first + count });
        first += count;
    }
    oddities.report(warnings);
    Ok((builder.finish(warnings), blocks))
}

/// The IDs of the blocks, by their numbers.
fn ids(file: &Netcdf<'_>) -> Result<Vec<i64>, IoError> {
    match file.shape("eb_prop1") {
        Some(shape) if shape.len() == 1 => Ok(to_indices(&file.numbers("eb_prop1", &[])?).unwrap_or_default()),
        _ => Ok(Vec::new()),
    }
}

/// The blocks whose elements are listed by their faces.
fn polyhedral(file: &Netcdf<'_>) -> Vec<u64> {
    let counted = numbered(file, "ebepecnt").into_iter();
    counted.filter(|&number| is_polyhedral(file, number)).collect()
}

fn is_polyhedral(file: &Netcdf<'_>, number: u64) -> bool {
    let element_type = |variable: &str| file.attribute(&format!("{variable}{number}"), "elem_type");
    let name = element_type("facconn").or_else(|| element_type("connect")).unwrap_or_default();
    name.to_ascii_uppercase().starts_with("NFA")
}

/// What was met that has no cell of its own, by type and number of nodes: how many elements.
#[derive(Default)]
struct Oddities {
    unknown: BTreeMap<(String, usize), usize>,
    reduced: BTreeMap<(String, usize), usize>,
}

impl Oddities {
    fn report(self, warnings: &mut Vec<String>) {
        for ((name, nodes), count) in self.unknown {
            warnings.push(format!(
                "{count} elements are of the type `{name}` with {nodes} nodes, which is not known; they are not drawn"
            ));
        }
        for ((name, nodes), count) in self.reduced {
            warnings.push(format!(
                "{count} elements of the type `{name}` have {nodes} nodes; only those of a simpler cell are used"
            ));
        }
    }
}

/// Adds the elements of a block that names their nodes; how many they are.
fn push_block(
    file: &Netcdf<'_>,
    number: u64,
    id: i64,
    builder: &mut CellBuilder<'_>,
    oddities: &mut Oddities,
) -> Result<usize, IoError> {
    let variable = format!("connect{number}");
    let name = file.attribute(&variable, "elem_type").unwrap_or_default();
    let shape = file.shape(&variable).unwrap_or_default();
    let invalid = |problem: String| file.source.invalid(format!("element block {id}"), problem, DAMAGED);
    if name.to_ascii_uppercase().starts_with("NSI") {
        return push_polygons(file, number, builder);
    }
    let &[elements, nodes] = shape.as_slice() else {
        return Err(invalid(format!(
            "`{variable}` has {} dimensions, where elements and nodes are needed",
            shape.len()
        )));
    };
    let connectivity = to_indices(&file.numbers(&variable, &[])?);
    let mut connectivity = connectivity.ok_or_else(|| invalid(format!("`{variable}` holds no whole numbers")))?;
    // Nodes are counted from 1.
    connectivity.iter_mut().for_each(|node| *node = node.saturating_sub(1));
    let (Ok(count), Ok(nodes)) = (usize::try_from(elements), usize::try_from(nodes)) else {
        return Err(invalid("it has more elements than fit into memory".to_owned()));
    };
    if nodes == 0 {
        // Each element costs a byte at least elsewhere; of these any number would cost nothing.
        return if count == 0 { Ok(0) } else { Err(invalid(format!("its {count} elements have no nodes"))) };
    }
    let element = Element::of(&name, nodes);
    if count > 0 {
        match element {
            None => *oddities.unknown.entry((name, nodes)).or_default() += count,
            Some(element) if element.is_reduced => *oddities.reduced.entry((name, nodes)).or_default() += count,
            Some(_) => {}
        }
    }
    let mut cell = Vec::new();
    for own in connectivity.chunks_exact(nodes) {
        match element {
            Some(element) => {
                element.cell(own, &mut cell);
                builder.push(element.vtk_type, &cell)?;
            }
            None => builder.push(POINTS, own)?,
        }
    }
    Ok(count)
}

/// Adds polygons, whose numbers of nodes are listed apart: they have no volume, but they have values.
fn push_polygons(file: &Netcdf<'_>, number: u64, builder: &mut CellBuilder<'_>) -> Result<usize, IoError> {
    let nodes = to_indices(&file.numbers(&format!("connect{number}"), &[])?).unwrap_or_default();
    let counts = to_indices(&file.numbers(&format!("ebepecnt{number}"), &[])?).unwrap_or_default();
    let mut at = 0_usize;
    for &count in &counts {
        let own = usize::try_from(count).ok().and_then(|count| nodes.get(at..at.checked_add(count)?));
        let own = own.ok_or_else(|| builder.invalid(format!("it has {count} nodes, more than are listed")))?;
        at += own.len();
        let own: Vec<i64> = own.iter().map(|node| node.saturating_sub(1)).collect();
        builder.push(POLYGON, &own)?;
    }
    Ok(counts.len())
}
