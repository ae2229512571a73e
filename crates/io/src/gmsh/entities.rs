//! The geometry that elements of version 4 belong to: its physical groups, and of what each part of a partition is a part.

use std::collections::HashMap;

use super::numbers::Numbers;
use super::sections::Version;
use crate::IoError;

/// One point, curve, surface or volume of the geometry.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Entity {
    /// Its first physical group; 0 for none. The sign, which says which way round, is left out.
    pub(super) physical: i32,
    /// The tag that a user knows: that of the whole, where this is a part.
    pub(super) tag: i32,
    /// Whether it lies in more groups than one.
    pub(super) has_more_groups: bool,
}

/// By dimension and tag.
pub(super) type Entities = HashMap<(i64, i64), Entity>;

/// Reads `$Entities` or `$PartitionedEntities`, which has its own tags; these hide those of the wholes.
///
/// # Errors
/// [`IoError::Invalid`] where the section is damaged.
pub(super) fn read(numbers: &mut Numbers<'_>, is_partitioned: bool, entities: &mut Entities) -> Result<(), IoError> {
    if is_partitioned {
        numbers.size("the number of partitions")?;
        for _ in 0..numbers.size("the number of ghost entities")? {
            numbers.int("the tag of a ghost entity")?;
            numbers.int("the partition of a ghost entity")?;
        }
    }
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = numbers.size("a number of entities")?;
    }
    for (dimension, count) in (0_i64..).zip(counts) {
        for _ in 0..count {
            read_one(numbers, dimension, is_partitioned, entities)?;
        }
    }
    Ok(())
}

fn read_one(
    numbers: &mut Numbers<'_>,
    dimension: i64,
    is_partitioned: bool,
    entities: &mut Entities,
) -> Result<(), IoError> {
    let tag = numbers.int("the tag of an entity")?;
    let mut shown = tag;
    if is_partitioned {
        let parent_dimension = numbers.int("the dimension of an entity's parent")?;
        let parent = numbers.int("the tag of an entity's parent")?;
        // A border between parts has a parent of a higher dimension.
        if parent_dimension == dimension {
            shown = parent;
        }
        for _ in 0..numbers.size("the number of an entity's partitions")? {
            numbers.int("a partition of an entity")?;
        }
    }
    // Points have their place, all others a box; in version 4.0 points have one as well.
    let bounds = if dimension == 0 && numbers.section.version == Version::V41 { 3 } else { 6 };
    for _ in 0..bounds {
        numbers.real("the bounding box of an entity")?;
    }
    let groups = numbers.size("the number of an entity's physical groups")?;
    let mut entity = Entity { physical: 0, tag: small(shown), has_more_groups: groups > 1 };
    for group in 0..groups {
        let number = numbers.int("a physical group of an entity")?;
        if group == 0 {
            entity.physical = small(number.saturating_abs());
        }
    }
    if dimension > 0 {
        for _ in 0..numbers.size("the number of an entity's borders")? {
            numbers.int("a border of an entity")?;
        }
    }
    entities.insert((dimension, tag), entity);
    Ok(())
}

/// A tag as the arrays of cells hold it; text may have longer ones, which no program writes.
pub(super) fn small(tag: i64) -> i32 {
    i32::try_from(tag).unwrap_or(0)
}
