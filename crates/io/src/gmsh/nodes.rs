//! The points of a mesh, in all versions.

use glam::DVec3;

use super::number_map::NumberMap;
use super::numbers::Numbers;
use super::sections::Version;
use crate::{IoError, Source};

/// Points and the numbers that the file gives them, of all its sections.
#[derive(Default)]
pub(super) struct Nodes {
    pub(super) points: Vec<DVec3>,
    numbers: Vec<i64>,
    /// Those of the first section, once there is a second.
    first: Option<NumberMap>,
}

impl Nodes {
    /// Adds a section's: `$Nodes`, `$ParametricNodes` or `$NOD`. What the first section has already is not added again.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where the section is damaged.
    pub(super) fn read(&mut self, numbers: &mut Numbers<'_>) -> Result<(), IoError> {
        let before = self.numbers.len();
        if before > 0 && self.first.is_none() {
            self.first = Some(NumberMap::new(self.numbers.iter().copied().zip(0..)).0);
        }
        match numbers.section.version {
            Version::V1 | Version::V2 => self.read_list(numbers)?,
            Version::V40 | Version::V41 => self.read_blocks(numbers)?,
        }
        let Some(first) = &self.first else { return Ok(()) };
        let added = (self.numbers.split_off(before), self.points.split_off(before));
        for (number, point) in added.0.into_iter().zip(added.1) {
            let known = first.get(number).and_then(|index| self.points.get(index as usize));
            if known != Some(&point) {
                self.numbers.push(number);
                self.points.push(point);
            }
        }
        Ok(())
    }

    /// Indices of the points by their numbers; of points with one number the first. `warnings` says if there are such.
    ///
    /// # Errors
    /// [`IoError::Unsupported`] where a point's index would not fit into 32 bits.
    pub(super) fn map(&self, source: &Source, warnings: &mut Vec<String>) -> Result<NumberMap, IoError> {
        if u32::try_from(self.points.len()).is_err() {
            let what = format!("a mesh of more than {} points", u32::MAX);
            return Err(source.unsupported(what, "split the mesh or write a coarser one"));
        }
        let (map, repeated) = NumberMap::new(self.numbers.iter().copied().zip(0..));
        if repeated > 0 {
            warnings.push(format!(
                "{repeated} nodes have a number that an earlier node has; elements and data take the earlier one"
            ));
        }
        Ok(map)
    }

    fn read_list(&mut self, numbers: &mut Numbers<'_>) -> Result<(), IoError> {
        let count: u64 = numbers.word("the number of nodes")?;
        numbers.end_line();
        let is_parametric = numbers.section.name == b"ParametricNodes";
        for _ in 0..count {
            let number = numbers.int("the number of a node")?;
            let point = position(numbers)?;
            if is_parametric {
                let dimension = numbers.int("the dimension of a node's entity")?;
                numbers.int("the tag of a node's entity")?;
                // Points and volumes have no parameters.
                skip_parameters(numbers, if dimension == 3 { 0 } else { dimension })?;
            }
            self.push(number, point);
        }
        Ok(())
    }

    fn read_blocks(&mut self, numbers: &mut Numbers<'_>) -> Result<(), IoError> {
        let is_41 = numbers.section.version == Version::V41;
        let blocks = numbers.size("the number of blocks of nodes")?;
        numbers.size("the number of nodes")?;
        if is_41 {
            numbers.size("the smallest number of a node")?;
            numbers.size("the largest number of a node")?;
        }
        for _ in 0..blocks {
            let first = numbers.int("the entity of a block of nodes")?;
            let second = numbers.int("the entity of a block of nodes")?;
            // 4.0 has the tag before the dimension.
            let dimension = if is_41 { first } else { second };
            let is_parametric = numbers.int("whether a block of nodes is parametric")? != 0;
            let count = numbers.size("the number of nodes in a block")?;
            let parameters = if is_parametric { dimension } else { 0 };
            if is_41 {
                let before = self.numbers.len();
                for _ in 0..count {
                    let number = numbers.tag("the number of a node")?;
                    self.numbers.push(number);
                }
                for _ in before..self.numbers.len() {
                    let point = position(numbers)?;
                    skip_parameters(numbers, parameters)?;
                    self.points.push(point);
                }
            } else {
                for _ in 0..count {
                    let number = numbers.tag("the number of a node")?;
                    let point = position(numbers)?;
                    skip_parameters(numbers, parameters)?;
                    self.push(number, point);
                }
            }
        }
        Ok(())
    }

    fn push(&mut self, number: i64, point: DVec3) {
        self.numbers.push(number);
        self.points.push(point);
    }
}

fn position(numbers: &mut Numbers<'_>) -> Result<DVec3, IoError> {
    let what = "a coordinate of a node";
    Ok(DVec3::new(numbers.real(what)?, numbers.real(what)?, numbers.real(what)?))
}

/// Passes over the parameters of a node on a curve (1) or surface (2).
fn skip_parameters(numbers: &mut Numbers<'_>, count: i64) -> Result<(), IoError> {
    for _ in 0..count.clamp(0, 3) {
        numbers.real("a parameter of a node")?;
    }
    Ok(())
}
