//! All ways to integrate a segment behind one name.

use crate::{
    Integration, MethodError, OpticalModel, RgbaAssoc, RunningIntegrals, Segment, Table2d, Table3d, TableDomain,
    TableSettings, TransferFunction, average, exact, opacity_2d, partial,
};

/// A way to integrate, with whatever it has to prepare for one transfer function and one optical model.
///
/// In 64 bits but for the tables' entries: the reference of each method, for renderers to be compared with and for
/// measurements.
#[derive(Clone, Debug)]
pub struct Integrator {
    transfer: TransferFunction,
    model: OpticalModel,
    method: Method,
}

#[derive(Clone, Debug)]
enum Method {
    Average,
    Opacity2d,
    Partial,
    Cumulative(RunningIntegrals),
    Table2d(Table2d),
    Table3d(Table3d),
    Exact,
}

impl Integrator {
    /// Prepares a method: tables are built here, and what else can be computed once.
    ///
    /// - `table`: the size of the table and what it has to cover; needed where [`Integration::needs_table`], else not
    ///   looked at
    /// - `progress`: as in [`Table3d::build`] and [`Table2d::build`]; not called by methods without a table
    ///
    /// # Errors
    ///
    /// [`MethodError::NeedsFan`] for [`Integration::Vertex`], [`MethodError::ModelNotCovered`],
    /// [`MethodError::NoTable`] where one is needed and its size is not given, and the errors of building it.
    pub fn new(
        integration: Integration,
        transfer: &TransferFunction,
        model: OpticalModel,
        table: Option<(&TableSettings, &TableDomain)>,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Self, MethodError> {
        integration.check(model)?;
        let table = || table.ok_or(MethodError::NoTable { integration });
        let method = match integration {
            Integration::Vertex => return Err(MethodError::NeedsFan),
            Integration::Average => Method::Average,
            Integration::Opacity2d => Method::Opacity2d,
            Integration::Partial => Method::Partial,
            Integration::Cumulative => Method::Cumulative(RunningIntegrals::new(transfer)),
            Integration::Table2d => {
                let (settings, domain) = table()?;
                Method::Table2d(Table2d::build(transfer, model, domain, settings, None, progress)?)
            }
            Integration::Table3d => {
                let (settings, domain) = table()?;
                Method::Table3d(Table3d::build(transfer, model, domain, settings, None, progress)?)
            }
            Integration::Exact => Method::Exact,
        };
        Ok(Self { transfer: transfer.clone(), model, method })
    }

    /// Number of entries of its table; 0 for methods without one.
    pub fn table_entries(&self) -> u64 {
        match &self.method {
            Method::Table2d(table) => table.entries().len() as u64,
            Method::Table3d(table) => table.entries().len() as u64,
            _ => 0,
        }
    }

    /// The light of a segment.
    pub fn integrate(&self, segment: &Segment) -> RgbaAssoc {
        let (transfer, model) = (&self.transfer, self.model);
        match &self.method {
            Method::Average => average(transfer, model, segment),
            Method::Opacity2d => opacity_2d(transfer, model, segment),
            Method::Partial => partial(transfer, model, segment),
            Method::Cumulative(integrals) => integrals.integrate(model, segment),
            Method::Table2d(table) => table.look_up(segment),
            Method::Table3d(table) => table.look_up(segment),
            Method::Exact => exact(transfer, model, segment),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;
    use crate::LengthAxis;

    const DOMAIN: TableDomain = TableDomain { scalars: [0.0, 1.0], mean_length: 0.1, max_length: 0.5 };
    const SETTINGS: TableSettings = TableSettings { scalars: 9, lengths: 6, length_axis: LengthAxis::Linear };

    fn transfer() -> TransferFunction {
        let color = [[0.0, 0.1, 0.2, 0.9], [0.4, 0.9, 0.9, 0.8], [1.0, 0.9, 0.2, 0.1]];
        TransferFunction::new(&color, &[[0.0, 0.0], [0.3, 8.0], [0.6, 1.0], [1.0, 3.0]]).unwrap()
    }

    #[test]
    fn every_method_along_a_ray_is_there() {
        let transfer = transfer();
        for integration in Integration::ALL {
            for model in OpticalModel::ALL {
                let calls = AtomicU64::new(0);
                let count = |_, _| {
                    calls.fetch_add(1, Ordering::Relaxed);
                };
                let made = Integrator::new(integration, &transfer, model, Some((&SETTINGS, &DOMAIN)), &count);
                if integration.needs_fan() {
                    assert_eq!(made.unwrap_err(), MethodError::NeedsFan);
                    continue;
                }
                if !integration.covers(model) {
                    assert!(matches!(made.unwrap_err(), MethodError::ModelNotCovered { .. }));
                    continue;
                }
                let made = made.unwrap();
                assert_eq!(calls.into_inner() > 0, integration.needs_table(), "{integration}");
                // A segment on samples of the tables, of the mean length: all methods but those that look at the mean
                // scalar or the ends alone know it.
                let segment = Segment { scalar_front: 0.25, scalar_back: 0.75, chord_length: 0.1 };
                let (known, got) = (exact(&transfer, model, &segment), made.integrate(&segment));
                let error = (known.opacity - got.opacity).abs();
                match integration {
                    Integration::Exact => assert_eq!(known, got),
                    Integration::Table2d | Integration::Table3d | Integration::Cumulative => {
                        assert!(error < 1e-7, "{integration} {model}: {error:e}");
                    }
                    _ if model.needs_extinction() => assert!((1e-3..0.5).contains(&error), "{integration}: {error:e}"),
                    _ => assert_eq!(error, 0.0),
                }
                // No depth, no light.
                let nothing = made.integrate(&Segment { chord_length: 0.0, ..segment });
                assert_eq!(nothing, RgbaAssoc::TRANSPARENT, "{integration} {model}");
            }
        }
    }

    #[test]
    fn methods_with_a_table_need_its_size() {
        for integration in Integration::ALL.into_iter().filter(|integration| integration.needs_table()) {
            let made = Integrator::new(integration, &transfer(), OpticalModel::Emitter, None, &|_, _| ());
            assert_eq!(made.unwrap_err(), MethodError::NoTable { integration });
            let wrong = TableSettings { scalars: 1, ..SETTINGS };
            let table = Some((&wrong, &DOMAIN));
            let made = Integrator::new(integration, &transfer(), OpticalModel::Emitter, table, &|_, _| ());
            assert!(matches!(made.unwrap_err(), MethodError::TableSize { .. }));
        }
        assert!(Integrator::new(Integration::Exact, &transfer(), OpticalModel::Emitter, None, &|_, _| ()).is_ok());
    }

    #[test]
    fn constant_fields_are_known_to_every_method() {
        let transfer = TransferFunction::new(&[[0.0, 0.2, 0.5, 0.8]], &[[0.0, 3.0]]).unwrap();
        for integration in Integration::ALL.into_iter().filter(|integration| !integration.needs_fan()) {
            for model in OpticalModel::ALL.into_iter().filter(|&model| integration.covers(model)) {
                let table = Some((&SETTINGS, &DOMAIN));
                let made = Integrator::new(integration, &transfer, model, table, &|_, _| ()).unwrap();
                let segment = Segment { scalar_front: 0.13, scalar_back: 0.88, chord_length: 0.1 };
                let (known, got) = (exact(&transfer, model, &segment), made.integrate(&segment));
                let light = known.rgb.iter().zip(got.rgb).map(|(known, got)| (known - got).abs());
                let error = light.fold((known.opacity - got.opacity).abs(), f64::max);
                // The psi table of `partial` is the least exact of all.
                assert!(error < 1e-5, "{integration} {model}: {error:e}");
            }
        }
    }
}
