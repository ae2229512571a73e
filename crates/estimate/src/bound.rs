//! What errors do not exceed, from what each cell can at most do.
//!
//! Along a ray a cell's light lies between that of its least and that of its greatest extinction and color, over the longest of its
//! edges; the light of every approximation lies there too, or at least between nothing and the greatest. The difference of the two bounds
//! the error of one segment. Errors of segments add up to that of a ray: in front of a segment light is only lost, and
//! what an error of opacity lets through or hides behind it is at most the brightest color. The sum over all cells that may cover a square of the picture
//! bounds that of every ray in the square.

use tetrascope_cpu::rays::RayTracer;
use tetrascope_integrate::{Integration, OpticalModel, TransferFunction};
use tetrascope_scene::{Interpolation, IsosurfaceMethod, Plan};
use tetrascope_view::View;

use crate::estimate::{BlendingOrder, Subject};

/// Squares along the larger side of the picture: with more of them the bound is tighter and takes longer.
const SQUARES: u32 = 96;

/// Part of a light by which a table of the transport integral may leave what its formula allows ([`Integration::Partial`]): above the
/// table's own error, for which see its tests.
const TABLE_SLACK: f64 = 2e-3;

/// What errors do not exceed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    /// Error of the integration; 0 if it has none, `None` where no bound is known.
    pub(crate) integration: Option<f64>,
    /// Error of the order, likewise.
    pub(crate) order: Option<f64>,
    /// Error of the interpolation, likewise.
    pub(crate) interpolation: Option<f64>,
    /// Error of isosurfaces that are looked up, likewise.
    pub(crate) surfaces: Option<f64>,
    /// The whole error of any picture of the scene.
    pub(crate) total: f64,
}

/// Bounds of a picture's errors.
pub(crate) fn bounds(subject: &Subject<'_>, tracer: &RayTracer<'_>) -> Bounds {
    let plan = subject.plan;
    let brightest = Brightest::of(subject);
    let has_maps = plan.isosurfaces.as_ref().is_some_and(|surfaces| surfaces.method != IsosurfaceMethod::Exact);
    let is_right_order = matches!(subject.order, BlendingOrder::Right);
    let interpolates = plan.interpolation != Interpolation::Exact;
    let total = brightest.of_picture();
    let none =
        Bounds { integration: Some(0.0), order: Some(0.0), interpolation: Some(0.0), surfaces: Some(0.0), total };
    if is_exact(plan) && is_right_order && !interpolates && !has_maps {
        return none;
    }
    let sums = largest_sums(subject, tracer, &brightest);
    // Segments that are longer than the ray's way through the mesh add up to more than the mesh could.
    let is_longer = interpolates && plan.model.color_is_per_length();
    let total = if is_longer { total.max((sums.emission + brightest.surface) * (1.0 + TABLE_SLACK)) } else { total };
    // A surface that lies where a segment is not is met in another place, or not at all.
    let moves_surfaces = interpolates && plan.isosurfaces.is_some();
    let of_segments = (!has_maps && !moves_surfaces).then(|| sums.error.min(total));
    Bounds {
        integration: if is_exact(plan) { Some(0.0) } else { of_segments },
        surfaces: if has_maps { None } else { Some(0.0) },
        order: if is_right_order { Some(0.0) } else { Some(brightest.of_order(&sums, plan).min(total)) },
        interpolation: if interpolates { of_segments } else { Some(0.0) },
        total,
    }
}

/// Whether nothing but rounding is between the integration and the exact one.
pub(crate) fn is_exact(plan: &Plan) -> bool {
    match plan.integration {
        Integration::Exact => true,
        // Its opacity is exact, and so is what has no opacity.
        Integration::Cumulative => matches!(plan.model, OpticalModel::Absorption | OpticalModel::Emission),
        _ => false,
    }
}

/// What values of a picture do not exceed.
struct Brightest {
    /// Largest and smallest color over the field's range, any channel, as the model has it.
    color: [f64; 2],
    /// Of isosurfaces, the light on them included.
    surface: f64,
    /// The most that the light on the volume multiplies its color by; 1 where it is not lit.
    on_volume: f64,
    /// World length of a ray inside the mesh.
    length: f64,
    model: OpticalModel,
}

impl Brightest {
    fn of(subject: &Subject<'_>) -> Self {
        let Subject { mesh, scalars, plan, .. } = *subject;
        let [low, high] = tetrascope_mesh::scalar_range(mesh.tetrahedra(), scalars);
        let values = Values::between(&plan.transfer, low, high);
        let lit = plan
            .lighting
            .map_or(1.0, |lighting| lighting.phong.ambient + lighting.phong.diffuse + lighting.phong.specular);
        let on_volume = if plan.lighting.is_some_and(|lighting| lighting.volume) { lit } else { 1.0 };
        let highlight = plan.lighting.map_or(0.0, |lighting| lighting.phong.specular);
        let surface = plan.isosurfaces.as_ref().map_or(0.0, |isosurfaces| {
            let colors = isosurfaces.surfaces.as_slice().iter().flat_map(|s| s.color.into_iter().chain(s.back_color));
            // Colors are multiplied by what is reflected, and the highlight is white.
            colors.fold(0.0, f64::max) * lit.max(1.0) + highlight
        });
        let [darkest, brightest] = if plan.model.needs_emission() {
            [
                values.color.iter().map(|c| c[0]).fold(f64::INFINITY, f64::min),
                values.color.iter().map(|c| c[1]).fold(0.0, f64::max),
            ]
        } else {
            [0.0; 2]
        };
        let diagonal = mesh.bounds_world().map_or(0.0, |(lowest, highest)| (highest - lowest).length());
        // Light that falls on the volume is somewhere less than all of it.
        let darkest = if plan.lighting.is_some_and(|lighting| lighting.volume) { 0.0 } else { darkest };
        Self { color: [darkest, brightest * on_volume], surface, on_volume, length: diagonal, model: plan.model }
    }

    /// The largest value of a channel of any picture, alpha included. Beside it goes what rounding may add.
    fn of_picture(&self) -> f64 {
        let volume = if self.model.color_is_per_length() { self.color[1] * self.length } else { self.color[1] };
        let behind = volume + self.surface;
        behind.max(1.0) * (1.0 + TABLE_SLACK)
    }

    /// What lies behind a segment is not brighter.
    fn behind(&self) -> f64 {
        let volume = if self.model.color_is_per_length() { self.color[1] * self.length } else { self.color[1] };
        // Light that is added up by length comes to what a surface shows.
        if self.model.color_is_per_length() { volume + self.surface } else { volume.max(self.surface) }
    }

    /// What another order may do: opacity is the same in any, and colors stay between the darkest and the brightest.
    fn of_order(&self, sums: &Sums, plan: &Plan) -> f64 {
        if plan.isosurfaces.is_some() {
            return self.of_picture();
        }
        let opacity = -(-sums.depth).exp_m1();
        let [darkest, brightest] = self.color;
        match self.model {
            OpticalModel::Absorption | OpticalModel::Emission => 0.0,
            OpticalModel::DensityEmitter if plan.integration.needs_table() => {
                brightest * sums.depth.min(1.0) * (1.0 + TABLE_SLACK)
            }
            OpticalModel::DensityEmitter => (brightest * (1.0 + TABLE_SLACK) - darkest) * opacity,
            OpticalModel::Emitter => sums.emission * sums.depth.min(1.0),
        }
    }
}

/// The largest sums over the cells of one square.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Of what a segment's error may do to a channel.
    error: f64,
    /// Of optical depths.
    depth: f64,
    /// Of light per length times length.
    emission: f64,
}

fn largest_sums(subject: &Subject<'_>, tracer: &RayTracer<'_>, brightest: &Brightest) -> Sums {
    let Subject { mesh, scalars, plan, .. } = *subject;
    let [width, height] = [plan.view.width, plan.view.height];
    let side = width.max(height).div_ceil(SQUARES).max(1);
    let (columns, rows) = (width.div_ceil(side), height.div_ceil(side));
    let mut squares = vec![Sums::default(); (columns * rows) as usize];
    let [low, high] = tetrascope_mesh::scalar_range(mesh.tetrahedra(), scalars);
    // A table knows scalars at its samples alone: a look-up may see as far as the next one.
    let reach = plan.table_settings().map_or(0.0, |table| (high - low) / f64::from(table.scalars - 1));
    let behind = brightest.behind();
    // Lengths that are interpolated are depths at the thick vertex, seen along the pixel's ray.
    let stretch = if plan.interpolation == Interpolation::Exact { 1.0 } else { longest_stretch(&plan.view) };
    for &(cell, [x0, x1, y0, y1]) in tracer.seen() {
        let corners = mesh.tetrahedra()[cell as usize];
        let values = corners.map(|v| scalars[v.index()]);
        let [from, to] = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], &s| [l.min(s), h.max(s)]);
        let positions = corners.map(|v| mesh.positions()[v.index()]);
        let longest = (0..4).flat_map(|i| (i + 1..4).map(move |j| (i, j)));
        let longest = longest.map(|(i, j)| positions[i].distance(positions[j])).fold(0.0, f64::max)
            * mesh.frame().scale
            * stretch;
        let reached = Values::between(&plan.transfer, (from - reach).max(low), (to + reach).min(high));
        let cuts = plan.isosurfaces.as_ref().map_or(0, |isosurfaces| isosurfaces.surfaces.between(from, to).len());
        let [color, opacity] = segment_error(plan, &reached, longest);
        // Light falls on the exact volume as on any other.
        let color = color * brightest.on_volume;
        let sums = Sums {
            // The pieces between surfaces are as many segments, each no longer than the whole.
            error: (opacity.max(color + opacity * behind)) * (1 + cuts) as f64,
            depth: if plan.model.needs_extinction() { reached.extinction[1] * longest } else { 0.0 },
            emission: reached.brightest() * brightest.on_volume * longest,
        };
        for row in y0 / side..=y1 / side {
            for column in x0 / side..=x1 / side {
                let square = &mut squares[(row * columns + column) as usize];
                square.error += sums.error;
                square.depth += sums.depth;
                square.emission += sums.emission;
            }
        }
    }
    squares.iter().fold(Sums::default(), |most, square| Sums {
        error: most.error.max(square.error),
        depth: most.depth.max(square.depth),
        emission: most.emission.max(square.emission),
    })
}

/// How much longer than its depth a ray to a corner of the picture is.
fn longest_stretch(view: &View) -> f64 {
    if view.is_perspective { (1.0 + view.half_width.powi(2) + view.half_height.powi(2)).sqrt() } else { 1.0 }
}

/// Least and greatest values of a transfer function over an interval.
#[derive(Clone, Copy, Debug)]
struct Values {
    extinction: [f64; 2],
    color: [[f64; 2]; 3],
}

impl Values {
    fn between(transfer: &TransferFunction, low: f64, high: f64) -> Self {
        let mut values = Self { extinction: [f64::INFINITY, 0.0], color: [[f64::INFINITY, 0.0]; 3] };
        let widen = |range: &mut [f64; 2], value: f64| *range = [range[0].min(value), range[1].max(value)];
        let pieces = transfer.pieces();
        let inner = transfer.pieces_between(low, high);
        // With a step at an end of the interval both of its sides count: the piece beyond has a point in common with it.
        for piece in &pieces[inner.start.saturating_sub(1)..(inner.end + 1).min(pieces.len())] {
            if piece.start > high || piece.end < low {
                continue;
            }
            for scalar in [low.max(piece.start), high.min(piece.end)] {
                widen(&mut values.extinction, piece.extinction_at(scalar));
                for (range, value) in values.color.iter_mut().zip(piece.color_at(scalar)) {
                    widen(range, value);
                }
            }
        }
        values
    }

    fn brightest(&self) -> f64 {
        self.color.iter().map(|range| range[1]).fold(0.0, f64::max)
    }
}

/// Bounds of a segment's error in color and in opacity, for chords up to `length`.
fn segment_error(plan: &Plan, values: &Values, length: f64) -> [f64; 2] {
    // Fans make the opacity and the color less than the cell's least; tables interpolate from shorter chords.
    let is_open_below =
        plan.integration.needs_fan() || plan.integration.needs_table() || plan.interpolation != Interpolation::Exact;
    let [least, most] = values.extinction;
    let least = if is_open_below { 0.0 } else { least };
    let has_right_opacity = plan.integration == Integration::Cumulative && !is_open_below;
    let of_channel = |[darkest, brightest]: [f64; 2]| {
        let darkest = if is_open_below { 0.0 } else { darkest };
        match plan.model {
            OpticalModel::Absorption => 0.0,
            // Light that is added up by length, whatever hides it.
            OpticalModel::Emission => (brightest - darkest) * length,
            OpticalModel::Emitter if has_right_opacity => brightest * length,
            OpticalModel::Emitter => brightest * length - darkest * mean_transmittance(most * length) * length,
            OpticalModel::DensityEmitter if plan.integration == Integration::Table2d => brightest * most * length,
            OpticalModel::DensityEmitter if has_right_opacity => (brightest - darkest) * opacity(most * length),
            OpticalModel::DensityEmitter => widest(length, [brightest * most, darkest * least], most - least, |l| {
                brightest * opacity(most * l) - darkest * opacity(least * l)
            }),
        }
    };
    let slack = if plan.integration == Integration::Partial { 1.0 + TABLE_SLACK } else { 1.0 };
    let color = values.color.into_iter().map(of_channel).fold(0.0, f64::max) * slack;
    let of_opacity = match plan.model {
        OpticalModel::Emission => 0.0,
        _ if has_right_opacity => 0.0,
        _ if plan.integration == Integration::Table2d => (most * length).min(1.0),
        _ => widest(length, [most, least], most - least, |l| opacity(most * l) - opacity(least * l)),
    };
    [color, of_opacity]
}

/// The largest difference of two saturating curves over lengths up to `length`: at its end, or where their slopes are equal.
///
/// - `slopes`: of both at length 0
/// - `difference`: of their rates
fn widest(length: f64, slopes: [f64; 2], difference: f64, gap: impl Fn(f64) -> f64) -> f64 {
    let meeting = (slopes[0] / slopes[1]).ln() / difference;
    let at_meeting = if meeting > 0.0 && meeting < length { gap(meeting) } else { 0.0 };
    gap(length).max(at_meeting).max(0.0)
}

fn opacity(depth: f64) -> f64 {
    -(-depth).exp_m1()
}

fn mean_transmittance(depth: f64) -> f64 {
    if depth > 0.0 { opacity(depth) / depth } else { 1.0 }
}
