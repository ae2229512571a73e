//! The methods that are compared.

use tetrascope::integrate::{
    LengthAxis, MethodError, OpacityTable, RgbaAssoc, RunningIntegrals, Segment, Table2d, Table3d, TableDomain,
    TableSettings, average, exact, opacity_2d, partial, thick_vertex,
};
use tetrascope::{Integration, OpticalModel, TransferFunction};

/// Samples along both axes of tables of opacity.
const OPACITY_SIZES: [u32; 2] = [64, 256];
/// Samples along each axis of scalars, without an axis of lengths.
const SIZES_2D: [u32; 4] = [64, 128, 256, 512];
/// Samples along all three axes.
const SIZES_3D: [u32; 3] = [32, 64, 128];

/// A way to integrate segments of one transfer function.
pub(crate) struct Method<'a> {
    /// Its name in scene files, with what it lacks where it is a variant.
    pub(crate) name: &'static str,
    /// Of its table; empty where there is none.
    pub(crate) size: String,
    pub(crate) evaluate: Box<dyn Fn(&Segment) -> RgbaAssoc + Sync + 'a>,
}

impl<'a> Method<'a> {
    fn new(name: &'static str, size: String, evaluate: impl Fn(&Segment) -> RgbaAssoc + Sync + 'a) -> Self {
        Self { name, size, evaluate: Box::new(evaluate) }
    }
}

/// All methods that cover a model and whose names contain `only`, with tables made for the transfer function and the domain, from
/// coarse to exact.
pub(crate) fn methods<'a>(
    transfer: &'a TransferFunction,
    model: OpticalModel,
    domain: &TableDomain,
    only: &str,
) -> Result<Vec<Method<'a>>, MethodError> {
    let direct = |name, function: fn(&TransferFunction, OpticalModel, &Segment) -> RgbaAssoc| {
        Method::new(name, String::new(), move |segment| function(transfer, model, segment))
    };
    let mut methods =
        vec![direct("vertex", thick_vertex), direct("average", average), direct("opacity-2d", opacity_2d)];
    // With light per length the table's opacity is not all that is needed.
    if matches!(model, OpticalModel::DensityEmitter | OpticalModel::Absorption) {
        let [low, high] = domain.scalars;
        for size in OPACITY_SIZES {
            let table = OpacityTable::new(transfer.max_extinction(low, high), domain.max_length, [size; 2])?;
            methods.push(Method::new("opacity-2d", format!("{size}², opacity alone"), move |segment| {
                by_opacity(&table, transfer, model, segment)
            }));
        }
    }
    if Integration::Partial.covers(model) {
        methods.push(direct("partial", partial));
    }
    let (running, uncorrected) = (RunningIntegrals::new(transfer), RunningIntegrals::new(transfer));
    methods.push(Method::new("cumulative, uncorrected", String::new(), move |segment| {
        uncorrected.without_correction(model, segment)
    }));
    methods.push(Method::new("cumulative", String::new(), move |segment| running.integrate(model, segment)));
    // Large tables take their time, so that those nobody asked for are not built.
    let sizes_2d: &[u32] = if "table-2d".contains(only) { &SIZES_2D } else { &[] };
    let sizes_3d: &[u32] = if "table-3d".contains(only) { &SIZES_3D } else { &[] };
    for &size in sizes_2d {
        let settings = TableSettings { scalars: size, lengths: TableSettings::LEAST, length_axis: LengthAxis::Linear };
        let table = Table2d::build(transfer, model, domain, &settings, None, &|_, _| {})?;
        methods.push(Method::new("table-2d", format!("{size}²"), move |segment| table.look_up(segment)));
    }
    for (length_axis, spacing) in [(LengthAxis::Linear, "linear"), (LengthAxis::Logarithmic, "logarithmic")] {
        for &size in sizes_3d {
            let settings = TableSettings { scalars: size, lengths: size, length_axis };
            let table = Table3d::build(transfer, model, domain, &settings, None, &|_, _| {})?;
            methods.push(Method::new("table-3d", format!("{size}³ {spacing}"), move |segment| table.look_up(segment)));
        }
    }
    methods.push(direct("exact", exact));
    methods.retain(|method| method.name.contains(only));
    Ok(methods)
}

/// `opacity-2d` with the opacity out of a table, as [Stein 1994] has it.
fn by_opacity(table: &OpacityTable, transfer: &TransferFunction, model: OpticalModel, segment: &Segment) -> RgbaAssoc {
    let ends = [segment.scalar_front, segment.scalar_back];
    let [front, back] = ends.map(|scalar| transfer.extinction(scalar));
    let opacity = table.look_up(f64::midpoint(front, back), segment.chord_length);
    let [near, far] = ends.map(|scalar| transfer.color(scalar));
    let glows = model != OpticalModel::Absorption;
    let rgb = std::array::from_fn(|c| if glows { opacity * f64::midpoint(near[c], far[c]) } else { 0.0 });
    RgbaAssoc { rgb, opacity }
}
