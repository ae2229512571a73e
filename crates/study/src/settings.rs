//! Which settings of a scene are worth a place in the study.
//!
//! Not the full product: every axis by itself from the plan that the study begins with, and the few products that somebody in a hurry would take.

use tetrascope::{Integration, Interpolation, IsosurfaceMethod, LengthAxis, Mixing, OrderMethod, Plan, TableSettings};

use crate::setting::{Axis, LeftOut, Methods, Place, Setting};

/// What the list of settings depends on, besides the plan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scope<'a> {
    /// Who can draw; the CPU first.
    pub(crate) places: &'a [Place],
    /// Whether few settings are wanted.
    pub(crate) is_quick: bool,
    /// Whether the order `power` is proven for this mesh without a search.
    pub(crate) has_heights: bool,
    /// What the scene itself asks for.
    pub(crate) own: Option<&'a Plan>,
}

/// All settings of a scene, and what is not among them.
pub(crate) fn settings(start: &Plan, scope: Scope<'_>) -> (Vec<Setting>, Vec<LeftOut>) {
    let mut list = List::new(start);
    for (index, place) in scope.places.iter().enumerate() {
        list.add(*place, |_| {});
        list.integrations(*place, scope.is_quick || index > 0);
        list.orders(*place, scope);
        if *place == Place::Cpu {
            list.interpolations();
        }
        list.isosurfaces(*place, scope.is_quick);
        list.in_a_hurry(*place);
    }
    if scope.places.len() > 1 && start.view.is_perspective {
        list.leave_out(
            "gpu, perspective and screen",
            "a GPU finds what a ray has inside a cell exactly, and in no other way",
        );
    }
    if let Some(own) = scope.own {
        list.own(own);
    }
    (list.settings, list.left_out)
}

struct List<'a> {
    start: &'a Plan,
    methods: Methods,
    settings: Vec<Setting>,
    seen: Vec<Methods>,
    left_out: Vec<LeftOut>,
}

impl<'a> List<'a> {
    fn new(start: &'a Plan) -> Self {
        Self { start, methods: Methods::of(start), settings: Vec::new(), seen: Vec::new(), left_out: Vec::new() }
    }

    fn leave_out(&mut self, name: impl Into<String>, reason: impl Into<String>) {
        self.left_out.push(LeftOut { name: name.into(), reason: reason.into() });
    }

    /// Adds the plan with a change, unless it is there already or its methods do not go together.
    fn add(&mut self, place: Place, change: impl FnOnce(&mut Plan)) {
        let mut plan = self.start.clone();
        place.take(&mut plan);
        change(&mut plan);
        self.take(plan, false);
    }

    fn take(&mut self, plan: Plan, is_scene: bool) {
        let methods = Methods::of(&plan);
        let name = methods.name(&self.methods);
        if self.seen.contains(&methods) {
            return;
        }
        let on_gpu = if methods.place == Place::Cpu { Ok(()) } else { plan.check_on_gpu() };
        if let Err(error) = plan.check().and(on_gpu) {
            self.seen.push(methods);
            return self.leave_out(name, error.to_string());
        }
        let (place, axis) = (methods.place, Axis::between(&self.methods, &methods));
        self.settings.push(Setting { name, plan, place, axis, is_scene });
        self.seen.push(methods);
    }

    fn integrations(&mut self, place: Place, is_short: bool) {
        for integration in Integration::ALL {
            let sizes = tables_of(integration, is_short);
            if sizes.is_empty() {
                self.add(place, |plan| (plan.integration, plan.tables) = (integration, None));
            }
            for tables in sizes {
                self.add(place, |plan| (plan.integration, plan.tables) = (integration, Some(tables)));
            }
        }
    }

    fn orders(&mut self, place: Place, scope: Scope<'_>) {
        if self.start.commutes() {
            if place == Place::Cpu {
                self.leave_out("other orders", "nothing depends on the order: every one gives this picture");
            }
            return;
        }
        if let Place::GpuTriangles(_) = place {
            // Who sorts is the CPU or the same programs: only what hardware blends is worth a look.
            return self.add(place, |plan| plan.order = OrderMethod::Centroid);
        }
        let mut orders = vec![
            OrderMethod::None,
            OrderMethod::Centroid,
            OrderMethod::Mpvo,
            OrderMethod::BspXmpvo,
            OrderMethod::KBuffer { window: OrderMethod::DEFAULT_WINDOW },
            OrderMethod::PerPixel,
        ];
        if scope.has_heights || !scope.is_quick {
            orders.push(OrderMethod::Power);
        } else if place == Place::Cpu {
            self.leave_out(
                "power",
                "no heights are known for this mesh, and looking for them takes long for a quick study",
            );
        }
        if !scope.is_quick {
            orders.extend([OrderMethod::Bucket { slabs: 20 }, OrderMethod::KBuffer { window: 2 }]);
            orders.push(OrderMethod::KBuffer { window: 20 });
        }
        for order in orders {
            self.add(place, |plan| plan.order = order);
        }
    }

    fn interpolations(&mut self) {
        if !self.start.view.is_perspective {
            return self
                .leave_out("perspective and screen", "without perspective all ways to interpolate are the same");
        }
        for interpolation in Interpolation::ALL {
            self.add(Place::Cpu, |plan| plan.interpolation = interpolation);
        }
    }

    fn isosurfaces(&mut self, place: Place, is_quick: bool) {
        if self.start.isosurfaces.is_none() {
            return;
        }
        let sizes = if is_quick { &[IsosurfaceMethod::MAP_SIZE][..] } else { &[64, IsosurfaceMethod::MAP_SIZE, 1024] };
        for mixing in [Mixing::Smooth, Mixing::Stopped] {
            for &size in sizes {
                self.add(place, |plan| {
                    if mixing == Mixing::Stopped && !plan.integration.needs_table() {
                        (plan.integration, plan.tables) = (Integration::Table3d, None);
                    }
                    let method = IsosurfaceMethod::Map { size, mixing };
                    plan.isosurfaces.iter_mut().for_each(|isosurfaces| isosurfaces.method = method);
                });
            }
        }
    }

    /// The products that cost least.
    fn in_a_hurry(&mut self, place: Place) {
        let orders =
            if self.start.commutes() { [self.start.order; 2] } else { [OrderMethod::Centroid, OrderMethod::None] };
        for integration in [
            Integration::Average,
            Integration::Vertex,
            Integration::Cumulative,
            Integration::Table2d,
            Integration::Table3d,
        ] {
            let change = |plan: &mut Plan| (plan.integration, plan.tables, plan.order) = (integration, None, orders[0]);
            self.add(place, change);
        }
        let cheapest =
            |plan: &mut Plan| (plan.integration, plan.tables, plan.order) = (Integration::Average, None, orders[1]);
        self.add(place, cheapest);
        if place == Place::Cpu && self.start.view.is_perspective {
            for integration in [Integration::Average, Integration::Table3d] {
                self.add(place, |plan| {
                    (plan.integration, plan.tables, plan.order) = (integration, None, orders[0]);
                    plan.interpolation = Interpolation::Screen;
                });
            }
        }
    }

    /// What the scene itself asks for: one of the settings, or one more.
    fn own(&mut self, own: &Plan) {
        let methods = Methods::of(own);
        match self.settings.iter_mut().find(|setting| Methods::of(&setting.plan) == methods) {
            Some(setting) => setting.is_scene = true,
            None => {
                let plan = Plan { view: self.start.view, ..own.clone() };
                self.take(plan, true);
            }
        }
    }
}

/// The tables of an integration that are worth a look; none if it looks nothing up.
fn tables_of(integration: Integration, is_short: bool) -> Vec<TableSettings> {
    let cube = |size, length_axis| TableSettings { scalars: size, lengths: size, length_axis };
    let (linear, logarithmic) = (LengthAxis::Linear, LengthAxis::Logarithmic);
    let sizes: &[(u32, LengthAxis)] = match (integration, is_short) {
        (Integration::Table2d, true) => &[(64, linear), (256, linear)],
        (Integration::Table2d, false) => &[(64, linear), (128, linear), (256, linear), (512, linear)],
        (Integration::Table3d, true) => &[(32, linear), (64, linear), (64, logarithmic)],
        (Integration::Table3d, false) => {
            &[(32, linear), (64, linear), (128, linear), (32, logarithmic), (64, logarithmic), (128, logarithmic)]
        }
        _ => &[],
    };
    sizes.iter().map(|&(size, axis)| cube(size, axis)).collect()
}
