//! Orders, tables and maps: numbers for those that are used, a warning for those that are not.

use tetrascope_integrate::{Integration, LengthAxis, TableSettings};
use tetrascope_order::{CycleRemedy, OrderMethod};

use crate::file::{Choice, IsosurfaceMethodName, LengthAxisName, QualitySection, SceneFile};
use crate::{Backend, GpuOptions, GpuPath, IsosurfaceMethod, SceneError, TargetBits};

/// Takes a key that has no effect away, and says so if it was there.
fn drop_key<T>(slot: &mut Option<T>, key: &str, why: &str, warnings: &mut Vec<String>) {
    if slot.take().is_some() {
        warnings.push(format!("quality.{key} has no effect: {why}"));
    }
}

pub(super) fn fill_order(section: &mut QualitySection, warnings: &mut Vec<String>) -> Option<OrderMethod> {
    let order = section.order;
    if !matches!(order, Choice::Named(OrderMethod::Bucket { .. })) {
        drop_key(&mut section.slabs, "slabs", &format!("the order is {order}, not bucket"), warnings);
    }
    if !matches!(order, Choice::Named(OrderMethod::KBuffer { .. })) {
        drop_key(&mut section.window, "window", &format!("the order is {order}, not k-buffer"), warnings);
    }
    let order = match order {
        Choice::Auto => return None,
        Choice::Named(order) => order,
    };
    Some(match (order, section.slabs, section.window) {
        (OrderMethod::Bucket { .. }, Some(slabs), _) => OrderMethod::Bucket { slabs },
        (OrderMethod::KBuffer { .. }, _, Some(window)) => OrderMethod::KBuffer { window },
        (order, _, _) => order,
    })
}

/// What is done about rings, and whether heights are kept, for an order that was decided.
pub(super) fn fill_cycles(section: &mut QualitySection, order: OrderMethod, warnings: &mut Vec<String>) -> CycleRemedy {
    drop_what_the_order_has_not(section, order, warnings);
    if !finds_rings(order) {
        return CycleRemedy::Report;
    }
    *section.cycles.get_or_insert(CycleRemedy::PerPixel)
}

/// Takes away what an order has no use for, with a warning where it was there.
pub(super) fn drop_what_the_order_has_not(
    section: &mut QualitySection,
    order: OrderMethod,
    warnings: &mut Vec<String>,
) {
    if !may_have_heights(order) {
        drop_key(&mut section.keep_heights, "keep_heights", &format!("the order {order} has no heights"), warnings);
    }
    if !finds_rings(order) {
        drop_key(&mut section.cycles, "cycles", &format!("the order {order} looks for no rings"), warnings);
    }
}

/// Whether an order says which cells hide one another in rings.
pub(super) fn finds_rings(order: OrderMethod) -> bool {
    matches!(order, OrderMethod::Mpvo | OrderMethod::BspXmpvo)
}

/// Whether heights are looked for with this order, or were with the `"auto"` that took it: a scene written then keeps saying that
/// they are to be kept.
fn may_have_heights(order: OrderMethod) -> bool {
    matches!(order, OrderMethod::Power | OrderMethod::Mpvo | OrderMethod::BspXmpvo | OrderMethod::PerPixel)
}

impl QualitySection {
    /// Gives another order, and forgets without a word what belonged to the one before and has no effect with this one.
    pub fn replace_order(&mut self, order: Choice<OrderMethod>) {
        if order == self.order {
            return;
        }
        self.order = order;
        (self.slabs, self.window) = (None, None);
        if let Choice::Named(order) = order {
            drop_what_the_order_has_not(self, order, &mut Vec::new());
        }
    }

    /// Gives another back end, and forgets without a word what was asked of a GPU if it is none.
    pub fn replace_backend(&mut self, backend: Choice<Backend>) {
        self.backend = backend;
        if matches!(backend, Choice::Named(Backend::Cpu | Backend::Reference)) {
            (self.gpu_path, self.target_bits, self.adapter) = (None, None, None);
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

/// Writes a table's sizes into the file, as far as the integration has such axes.
pub(super) fn name_tables(section: &mut QualitySection, integration: Integration, tables: Option<TableSettings>) {
    let with_lengths = tables.filter(|_| integration == Integration::Table3d);
    section.table_size = tables.map(|tables| tables.scalars);
    section.table_lengths = with_lengths.map(|tables| tables.lengths);
    section.length_axis = with_lengths.map(|tables| match tables.length_axis {
        LengthAxis::Linear => LengthAxisName::Linear,
        LengthAxis::Logarithmic => LengthAxisName::Logarithmic,
    });
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

/// What is asked of a GPU, where one may draw.
pub(super) fn fill_gpu(section: &mut QualitySection, warnings: &mut Vec<String>) -> Result<GpuOptions, SceneError> {
    if let Choice::Named(backend @ (Backend::Cpu | Backend::Reference)) = section.backend {
        let why = format!("the back end is {backend}, not gpu");
        drop_key(&mut section.gpu_path, "gpu_path", &why, warnings);
        drop_key(&mut section.target_bits, "target_bits", &why, warnings);
        drop_key(&mut section.adapter, "adapter", &why, warnings);
    }
    if section.gpu_path == Some(Choice::Named(GpuPath::Compute)) {
        drop_key(&mut section.target_bits, "target_bits", "the path compute blends in 32 bits, in no target", warnings);
    }
    let path = match section.gpu_path {
        Some(Choice::Named(path)) => Some(path),
        Some(Choice::Auto) | None => None,
    };
    let known =
        |bits| TargetBits::of(bits).ok_or_else(|| SceneError::value("quality.target_bits", bits, "give 16 or 32"));
    let target_bits = section.target_bits.map(known).transpose()?;
    Ok(GpuOptions { path, target_bits, adapter: section.adapter.clone() })
}
