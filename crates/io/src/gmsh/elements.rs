//! The cells of a mesh, in all versions.

use tetrascope_mesh::{CellKind, UnstructuredCells};

use super::element_types::{ElementType, Loss, POLYGONS, POLYHEDRON, element_type};
use super::entities::{Entities, small};
use super::number_map::NumberMap;
use super::numbers::Numbers;
use super::sections::{Form, Version};
use crate::{IoError, Source};

/// Cells, and what the file says of each.
pub(super) struct Elements<'a> {
    source: &'a Source,
    nodes: &'a NumberMap,
    pub(super) cells: UnstructuredCells,
    /// The number of Gmsh's type, one a cell.
    pub(super) types: Vec<u8>,
    /// One a cell; 0 for none.
    pub(super) physical: Vec<i32>,
    /// The tag of the entity that each cell belongs to; 0 for none.
    pub(super) geometrical: Vec<i32>,
    /// Numbers of elements and the cells that they became.
    numbers: Vec<(i64, u32)>,
    /// Those of the first section, once there is a second.
    first: Option<NumberMap>,
    repeated: usize,
    without_base_center: usize,
    corners_only: usize,
}

/// What the file says of an element besides its nodes.
#[derive(Clone, Copy)]
struct Label {
    number: i64,
    physical: i32,
    geometrical: i32,
}

impl<'a> Elements<'a> {
    /// None yet.
    pub(super) fn new(source: &'a Source, nodes: &'a NumberMap) -> Self {
        Self {
            source,
            nodes,
            cells: UnstructuredCells::default(),
            types: Vec::new(),
            physical: Vec::new(),
            geometrical: Vec::new(),
            numbers: Vec::new(),
            first: None,
            repeated: 0,
            without_base_center: 0,
            corners_only: 0,
        }
    }

    /// Adds a section's: `$Elements` or `$ELM`. What the first section has already is not added again.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where the section is damaged or names a node that is not there, [`IoError::Unsupported`] for
    /// types that are not known.
    pub(super) fn read(&mut self, numbers: &mut Numbers<'_>, entities: &Entities) -> Result<(), IoError> {
        if !self.numbers.is_empty() && self.first.is_none() {
            self.first = Some(self.map());
        }
        match (numbers.section.version, numbers.section.form) {
            (Version::V1, _) => self.read_version_1(numbers),
            (Version::V2, Form::Text) => self.read_list(numbers),
            (Version::V2, Form::Binary { .. }) => self.read_runs(numbers),
            (Version::V40 | Version::V41, _) => self.read_blocks(numbers, entities),
        }
    }

    /// Cells by the numbers of their elements.
    pub(super) fn map(&self) -> NumberMap {
        NumberMap::new(self.numbers.iter().copied()).0
    }

    /// What was odd.
    pub(super) fn warn(&self, warnings: &mut Vec<String>) {
        if self.repeated > 0 {
            warnings.push(format!(
                "{} elements repeat the one before them, as Gmsh writes those of several physical groups; each is kept once, \
                 in its first group",
                self.repeated
            ));
        }
        if self.corners_only > 0 {
            warnings.push(format!(
                "{} elements of a higher order than two are drawn by their corners alone, as linear cells",
                self.corners_only
            ));
        }
        if self.without_base_center > 0 {
            warnings.push(format!(
                "the point amid the base of {} pyramids with 14 points is not used",
                self.without_base_center
            ));
        }
    }

    /// Each as: number, type, physical group, entity, number of nodes, nodes.
    fn read_version_1(&mut self, numbers: &mut Numbers<'_>) -> Result<(), IoError> {
        let count: u64 = numbers.word("the number of elements")?;
        let mut row = Vec::new();
        for _ in 0..count {
            let number = numbers.int(NUMBER)?;
            let type_number = numbers.int(TYPE)?;
            let physical = small(numbers.int("the physical group of an element")?);
            let geometrical = small(numbers.int("the entity of an element")?);
            let nodes: usize = numbers.word("the number of an element's nodes")?;
            let kind = self.known(type_number, nodes)?;
            if kind.nodes != nodes {
                let wanted = kind.nodes;
                return Err(
                    numbers.invalid(format!("element {number} has {nodes} nodes, its type {type_number} has {wanted}"))
                );
            }
            self.read_nodes(numbers, kind.nodes, &mut row)?;
            self.push(numbers, type_number, kind, Label { number, physical, geometrical }, &row)?;
        }
        Ok(())
    }

    /// Each as: number, type, number of tags, tags, nodes.
    fn read_list(&mut self, numbers: &mut Numbers<'_>) -> Result<(), IoError> {
        let count: u64 = numbers.word("the number of elements")?;
        let mut row = Vec::new();
        for _ in 0..count {
            let number = numbers.int(NUMBER)?;
            let type_number = numbers.int(TYPE)?;
            let tags: u64 = numbers.word("the number of an element's tags")?;
            let (physical, geometrical) = tags_of(numbers, tags)?;
            let listed =
                if POLYGONS.contains(&type_number) { numbers.word("a polygon's number of nodes")? } else { 0 };
            let kind = self.known(type_number, listed)?;
            self.read_nodes(numbers, kind.nodes, &mut row)?;
            self.push(numbers, type_number, kind, Label { number, physical, geometrical }, &row)?;
        }
        Ok(())
    }

    /// Runs of elements with one type: type, length, number of tags; then each as: number, tags, nodes.
    fn read_runs(&mut self, numbers: &mut Numbers<'_>) -> Result<(), IoError> {
        let mut left: u64 = numbers.word("the number of elements")?;
        numbers.end_line();
        let mut row = Vec::new();
        while left > 0 {
            let type_number = numbers.int(TYPE)?;
            let length = numbers.int("the length of a run of elements")?;
            let tags = numbers.int("the number of an element's tags")?;
            let kind = self.known(type_number, 0)?;
            let sizes = (u64::try_from(length), u64::try_from(tags));
            let (Ok(length @ 1..), Ok(tags), true) = (sizes.0, sizes.1, sizes.0.is_ok_and(|length| length <= left))
            else {
                return Err(numbers.invalid(format!("a run of {length} elements with {tags} tags, of {left} elements")));
            };
            left -= length;
            for _ in 0..length {
                let number = numbers.int(NUMBER)?;
                let (physical, geometrical) = tags_of(numbers, tags)?;
                self.read_nodes(numbers, kind.nodes, &mut row)?;
                self.push(numbers, type_number, kind, Label { number, physical, geometrical }, &row)?;
            }
        }
        Ok(())
    }

    /// Blocks of elements with one type and entity; each as: number, nodes.
    fn read_blocks(&mut self, numbers: &mut Numbers<'_>, entities: &Entities) -> Result<(), IoError> {
        let is_41 = numbers.section.version == Version::V41;
        let blocks = numbers.size("the number of blocks of elements")?;
        numbers.size("the number of elements")?;
        if is_41 {
            numbers.size("the smallest number of an element")?;
            numbers.size("the largest number of an element")?;
        }
        let mut row = Vec::new();
        for _ in 0..blocks {
            let first = numbers.int("the entity of a block of elements")?;
            let second = numbers.int("the entity of a block of elements")?;
            // 4.0 has the tag before the dimension.
            let (dimension, tag) = if is_41 { (first, second) } else { (second, first) };
            let type_number = numbers.int(TYPE)?;
            let count = numbers.size("the number of elements in a block")?;
            let kind = self.known(type_number, 0)?;
            let entity = entities.get(&(dimension, tag)).copied();
            let (physical, geometrical) = entity.map_or((0, small(tag)), |entity| (entity.physical, entity.tag));
            for _ in 0..count {
                let number = numbers.tag(NUMBER)?;
                self.read_nodes(numbers, kind.nodes, &mut row)?;
                self.push(numbers, type_number, kind, Label { number, physical, geometrical }, &row)?;
            }
        }
        Ok(())
    }

    /// The type of a number; `listed` is how many nodes the element itself says it has.
    fn known(&self, number: i64, listed: usize) -> Result<ElementType, IoError> {
        if POLYGONS.contains(&number) && listed > 0 {
            return Ok(ElementType { nodes: listed, kind: CellKind::FlatOf(7), order: None, loss: Loss::None });
        }
        element_type(number).ok_or_else(|| {
            let what = match number {
                POLYHEDRON => "an element that is a cut polyhedron (type 35)".to_owned(),
                _ => format!("an element of type {number}"),
            };
            self.source.unsupported(what, "save the mesh from Gmsh without such elements, or as a .vtk file")
        })
    }

    /// Indices of the points of one element, in Gmsh's order.
    fn read_nodes(&self, numbers: &mut Numbers<'_>, count: usize, row: &mut Vec<u32>) -> Result<(), IoError> {
        row.clear();
        for _ in 0..count {
            let node = numbers.tag("a node of an element")?;
            let index = self.nodes.get(node).ok_or_else(|| {
                numbers.invalid(format!(
                    "the element at place {} names node {node}, which is not there",
                    self.numbers.len()
                ))
            })?;
            row.push(index);
        }
        Ok(())
    }

    fn push(
        &mut self,
        numbers: &Numbers<'_>,
        type_number: i64,
        kind: ElementType,
        label: Label,
        row: &[u32],
    ) -> Result<(), IoError> {
        let type_byte = u8::try_from(type_number).unwrap_or(0);
        let start = self.cells.connectivity.len();
        match kind.order {
            None => self.cells.connectivity.extend_from_slice(row),
            Some(order) => {
                let turned = order.iter().filter_map(|&node| row.get(usize::from(node)).copied());
                self.cells.connectivity.extend(turned);
            }
        }
        let is_new = |cell: usize| {
            let cells = &self.cells;
            let ends = cells.offsets.get(cell).zip(cells.offsets.get(cell + 1));
            let other = ends.and_then(|(&from, &to)| cells.connectivity.get(from..to));
            self.types.get(cell) != Some(&type_byte) || other != cells.connectivity.get(start..)
        };
        if self.first.as_ref().and_then(|first| first.get(label.number)).is_some_and(|cell| !is_new(cell as usize)) {
            self.cells.connectivity.truncate(start);
            return Ok(());
        }
        if self.types.len().checked_sub(1).is_some_and(|last| !is_new(last)) {
            self.cells.connectivity.truncate(start);
            self.repeated += 1;
        } else {
            let cells = &mut self.cells;
            cells.kinds.push(kind.kind);
            cells.offsets.push(cells.connectivity.len());
            self.types.push(type_byte);
            self.physical.push(label.physical);
            self.geometrical.push(label.geometrical);
            self.without_base_center += usize::from(kind.loss == Loss::BaseCenter);
            self.corners_only += usize::from(kind.loss == Loss::AllButCorners);
        }
        let Ok(cell) = u32::try_from(self.types.len().saturating_sub(1)) else {
            return Err(numbers.invalid(format!("there are more than {} elements", u32::MAX)));
        };
        self.numbers.push((label.number, cell));
        Ok(())
    }
}

const NUMBER: &str = "the number of an element";
const TYPE: &str = "the type of an element";

/// The physical group and the entity, which are the first two tags.
fn tags_of(numbers: &mut Numbers<'_>, count: u64) -> Result<(i32, i32), IoError> {
    let mut first = [0; 2];
    for tag in 0..count {
        let value = numbers.int("a tag of an element")?;
        if let Some(slot) = usize::try_from(tag).ok().and_then(|tag| first.get_mut(tag)) {
            *slot = small(value);
        }
    }
    Ok((first[0], first[1]))
}
