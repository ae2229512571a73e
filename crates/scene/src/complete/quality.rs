//! Orders, tables and maps: numbers for those that are used, a warning for those that are not.

use tetrascope_integrate::{Integration, LengthAxis, TableSettings};
use tetrascope_order::OrderMethod;

use crate::IsosurfaceMethod;
use crate::file::{Choice, IsosurfaceMethodName, QualitySection, SceneFile};

/// Takes a key that has no effect away, and says so if it was there.
fn drop_key<T>(slot: &mut Option<T>, key: &str, why: &str, warnings: &mut Vec<String>) {
    if slot.take().is_some() {
        warnings.push(format!("quality.{key} has no effect: {why}"));
    }
}

pub(super) fn fill_order(section: &mut QualitySection, warnings: &mut Vec<String>) -> Option<OrderMethod> {
    match (section.order, section.slabs) {
        (Choice::Named(OrderMethod::Bucket { .. }), Some(slabs)) => Some(OrderMethod::Bucket { slabs }),
        (order, _) => {
            drop_key(&mut section.slabs, "slabs", &format!("the order is {order}, not bucket"), warnings);
            match order {
                Choice::Auto => None,
                Choice::Named(order) => Some(order),
            }
        }
    }
}

/// The table's sizes for this integration; `None` if it has no table.
///
/// A size that is given counts for the axis of lengths too, unless that has its own.
pub(super) fn fill_tables(
    section: &mut QualitySection,
    integration: Integration,
    warnings: &mut Vec<String>,
) -> Option<TableSettings> {
    let usual = TableSettings::of(integration);
    if usual.is_none() {
        let why = format!("the integration {integration} has no table");
        drop_key(&mut section.table_size, "table_size", &why, warnings);
    }
    if integration != Integration::Table3d {
        let why = format!("the integration {integration} has no table with lengths");
        drop_key(&mut section.table_lengths, "table_lengths", &why, warnings);
        drop_key(&mut section.length_axis, "length_axis", &why, warnings);
    }
    let usual = usual?;
    let asked = section.table_size;
    let scalars = *section.table_size.get_or_insert(usual.scalars);
    if integration != Integration::Table3d {
        return Some(TableSettings { scalars, ..usual });
    }
    let lengths = *section.table_lengths.get_or_insert(asked.unwrap_or(usual.lengths));
    let length_axis = LengthAxis::from(*section.length_axis.get_or_insert_default());
    Some(TableSettings { scalars, lengths, length_axis })
}

pub(super) fn fill_isosurface_method(file: &mut SceneFile, warnings: &mut Vec<String>) -> IsosurfaceMethod {
    let section = &mut file.quality;
    if file.isosurface.is_empty() {
        let why = "there is no isosurface";
        drop_key(&mut section.isosurfaces, "isosurfaces", why, warnings);
        drop_key(&mut section.map_size, "map_size", why, warnings);
        return IsosurfaceMethod::Exact;
    }
    let name = *section.isosurfaces.get_or_insert_default();
    if name == IsosurfaceMethodName::Exact {
        drop_key(&mut section.map_size, "map_size", "isosurfaces by \"exact\" have no map", warnings);
    }
    let size = match name {
        IsosurfaceMethodName::Exact => IsosurfaceMethod::MAP_SIZE,
        _ => *section.map_size.get_or_insert(IsosurfaceMethod::MAP_SIZE),
    };
    name.with_size(size)
}
