//! One way to draw the scene: which method at each of the places where there is a choice.

use std::fmt;

use tetrascope::{
    Backend, GpuPath, Integration, Interpolation, IsosurfaceMethod, LengthAxis, OrderMethod, Plan, TableSettings,
    TargetBits,
};

/// One way to draw the scene.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Its methods in a few words, no two settings of a study alike: `"table-2d 256, centroid, cpu"`.
    pub name: String,
    /// What is drawn: the scene's plan with these methods.
    pub plan: Plan,
    /// Who draws, and by which way.
    pub place: Place,
    /// In what it differs from the plan that the study began with.
    pub axis: Axis,
    /// Whether it is what the scene itself asks for.
    pub is_scene: bool,
}

/// What is not in a study, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// A setting, or what several have in common.
    pub name: String,
    /// Why it is not there.
    pub reason: String,
}

/// Who draws, and by which way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    /// The CPU.
    Cpu,
    /// A GPU by compute programs.
    GpuCompute,
    /// A GPU by triangles, blended into a target of so many bits a channel.
    GpuTriangles(TargetBits),
}

impl Place {
    /// Where a plan is drawn, as far as it says; the reference counts as the CPU.
    pub fn of(plan: &Plan) -> Self {
        match (plan.backend, plan.gpu.path) {
            (Backend::Cpu | Backend::Reference, _) => Self::Cpu,
            (Backend::Gpu, Some(GpuPath::Triangles)) => Self::triangles(plan),
            (Backend::Gpu, None) if plan.integration.needs_fan() => Self::triangles(plan),
            (Backend::Gpu, _) => Self::GpuCompute,
        }
    }

    fn triangles(plan: &Plan) -> Self {
        Self::GpuTriangles(plan.gpu.target_bits.unwrap_or(TargetBits::ThirtyTwo))
    }

    /// Has a plan drawn here.
    pub(crate) fn take(self, plan: &mut Plan) {
        (plan.backend, plan.gpu.path, plan.gpu.target_bits) = match self {
            Self::Cpu => (Backend::Cpu, None, None),
            Self::GpuCompute => (Backend::Gpu, Some(GpuPath::Compute), None),
            Self::GpuTriangles(bits) => (Backend::Gpu, Some(GpuPath::Triangles), Some(bits)),
        };
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cpu => f.pad("cpu"),
            Self::GpuCompute => f.pad("gpu compute"),
            Self::GpuTriangles(bits) => f.pad(&format!("gpu triangles {}", bits.bits())),
        }
    }
}

/// In what a setting differs from the plan that the study began with; who draws it is told apart by [`Place`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// In nothing.
    Start,
    /// In the integration or its table.
    Integration,
    /// In the order of cells.
    Order,
    /// In how segments are found at a pixel.
    Interpolation,
    /// In how isosurfaces are met.
    Isosurfaces,
    /// In more than one of them.
    Several,
}

impl Axis {
    /// All, in the order in which a legend has them.
    pub const ALL: [Self; 6] =
        [Self::Start, Self::Integration, Self::Order, Self::Interpolation, Self::Isosurfaces, Self::Several];

    /// A word for it, fit for a style sheet.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Integration => "integration",
            Self::Order => "order",
            Self::Interpolation => "interpolation",
            Self::Isosurfaces => "isosurfaces",
            Self::Several => "several",
        }
    }

    /// What a legend says.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Start => "where the study began",
            Self::Integration => "another integration or table",
            Self::Order => "another order",
            Self::Interpolation => "another interpolation",
            Self::Isosurfaces => "another way to isosurfaces",
            Self::Several => "several of these",
        }
    }

    pub(crate) fn between(start: &Methods, other: &Methods) -> Self {
        let differences = [
            ((start.integration, start.tables) != (other.integration, other.tables), Self::Integration),
            (start.order != other.order || start.cycles != other.cycles, Self::Order),
            (start.interpolation != other.interpolation, Self::Interpolation),
            (start.isosurfaces != other.isosurfaces, Self::Isosurfaces),
        ];
        let mut found = differences.iter().filter(|(differs, _)| *differs).map(|(_, axis)| *axis);
        match (found.next(), found.next()) {
            (None, _) => Self::Start,
            (Some(axis), None) => axis,
            (Some(_), Some(_)) => Self::Several,
        }
    }
}

/// The methods of a plan, to be compared: two plans of one scene with the same methods draw the same.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Methods {
    pub(crate) place: Place,
    integration: Integration,
    tables: Option<TableSettings>,
    order: OrderMethod,
    cycles: Option<tetrascope::CycleRemedy>,
    interpolation: Interpolation,
    isosurfaces: Option<IsosurfaceMethod>,
}

impl Methods {
    pub(crate) fn of(plan: &Plan) -> Self {
        let finds_rings = matches!(plan.order, OrderMethod::Mpvo | OrderMethod::BspXmpvo);
        let tables = plan.table_settings().map(|tables| {
            // A table of two dimensions has no lengths, whatever stands in their place.
            let usual = TableSettings { scalars: tables.scalars, lengths: 0, length_axis: LengthAxis::Linear };
            if plan.integration == Integration::Table3d { tables } else { usual }
        });
        Self {
            place: Place::of(plan),
            integration: plan.integration,
            tables,
            order: plan.order,
            cycles: finds_rings.then_some(plan.cycles),
            interpolation: plan.interpolation,
            isosurfaces: plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.method),
        }
    }

    /// In words; what is as usual, or as in `start` where nothing else is possible, is not said.
    pub(crate) fn name(&self, start: &Self) -> String {
        let order = if self.order == OrderMethod::None { "unordered".to_owned() } else { order_name(self.order) };
        let mut parts = vec![integration_name(self.integration, self.tables), order];
        match self.cycles {
            Some(cycles) if start.cycles.is_some_and(|usual| usual != cycles) => parts.push(format!("rings: {cycles}")),
            _ => {}
        }
        if self.interpolation != Interpolation::Exact {
            parts.push(self.interpolation.to_string());
        }
        if let Some(method) = self.isosurfaces
            && start.isosurfaces != Some(method)
        {
            parts.push(match method {
                IsosurfaceMethod::Exact => "isosurfaces exact".to_owned(),
                IsosurfaceMethod::Map { size, .. } => format!("{} {size}", method.name()),
            });
        }
        parts.push(self.place.to_string());
        parts.join(", ")
    }
}

/// `"table-3d 64 log"`: the integration, and of its table what differs between settings.
fn integration_name(integration: Integration, tables: Option<TableSettings>) -> String {
    let Some(tables) = tables else { return integration.to_string() };
    let mut name = format!("{integration} {}", tables.scalars);
    if integration == Integration::Table3d {
        if tables.lengths != tables.scalars {
            name.push_str(&format!("x{}", tables.lengths));
        }
        if tables.length_axis == LengthAxis::Logarithmic {
            name.push_str(" log");
        }
    }
    name
}

/// `"k-buffer 6"`: the order, and its number where it has one.
pub(crate) fn order_name(order: OrderMethod) -> String {
    match order {
        OrderMethod::KBuffer { window } => format!("{order} {window}"),
        OrderMethod::Bucket { slabs } => format!("{order} {slabs}"),
        _ => order.to_string(),
    }
}
