//! Pre-integration tables: entries against the exact integral, look-ups against closed forms, errors, and lanes.

#[path = "../examples/families/mod.rs"]
mod families;

use std::sync::Mutex;

use proptest::prelude::*;

use crate::table_axes::scalar_samples;
use crate::table_pairs::Pairs;
use crate::{
    Isosurface, Isosurfaces, LengthAxis, MethodError, OpticalModel, RgbaAssoc, Segment, SurfaceRole, SurfaceShading,
    Table2d, Table3d, TableDomain, TableSettings, TransferFunction, exact,
};

const COARSE: TableDomain = TableDomain { scalars: [0.0, 1.0], mean_length: 0.08, max_length: 0.5 };

pub(crate) fn settings(scalars: u32, lengths: u32, length_axis: LengthAxis) -> TableSettings {
    TableSettings { scalars, lengths, length_axis }
}

pub(crate) fn quiet(_: u64, _: u64) {}

pub(crate) fn table_3d(transfer: &TransferFunction, model: OpticalModel, settings: TableSettings) -> Table3d {
    Table3d::build(transfer, model, &COARSE, &settings, None, &quiet).unwrap()
}

pub(crate) fn table_2d(transfer: &TransferFunction, model: OpticalModel, scalars: u32) -> Table2d {
    let settings = settings(scalars, 2, LengthAxis::Linear);
    Table2d::build(transfer, model, &COARSE, &settings, None, &quiet).unwrap()
}

/// The transfer functions of the README's error tables.
fn transfer_functions() -> Vec<(&'static str, TransferFunction)> {
    families::extinctions()
        .map(|(name, extinction)| (name, TransferFunction::new(&families::COLOR, &extinction).unwrap()))
        .into()
}

/// Steps on samples and between them, a thin peak, and a stretch without extinction.
pub(crate) fn steps_and_peaks() -> TransferFunction {
    let color = [[0.0, 0.1, 0.9, 0.0], [0.25, 1.0, 0.2, 0.3], [0.25, 0.0, 0.0, 2.0], [0.75, 0.4, 0.4, 0.4]];
    let extinction = [
        [0.1, 0.0],
        [0.1, 9.0],
        [0.25, 1.0],
        [0.5, 0.0],
        [0.5, 30.0],
        [0.6, 0.0],
        [0.699, 0.0],
        [0.7, 900.0],
        [0.701, 0.0],
    ];
    TransferFunction::new(&color, &extinction).unwrap()
}

fn surface(value: f64, opacity: f64) -> Isosurface {
    Isosurface { value, color: [0.9, 0.5, 0.1], back_color: [0.2, 0.3, 0.8], opacity, shading: SurfaceShading::None }
}

pub(crate) fn difference(left: RgbaAssoc, right: RgbaAssoc) -> f64 {
    let light = left.rgb.iter().zip(right.rgb).map(|(l, r)| (l - r).abs()).fold(0.0, f64::max);
    light.max((left.opacity - right.opacity).abs())
}

/// A slice of `scalars` samples over 0 to 1: the light from the front sample to the back one.
fn slice(pairs: &Pairs<'_>, length: f64) -> Vec<Vec<RgbaAssoc>> {
    let size = pairs.scalars.len();
    let mut seen = vec![vec![None; size]; size];
    for apart in 0..size {
        pairs.for_each_apart(apart, length, |front, back, light| {
            assert!(seen[front][back].replace(light).is_none(), "{front} {back} comes twice");
        });
    }
    seen.into_iter().map(|row| row.into_iter().map(Option::unwrap).collect()).collect()
}

#[test]
fn slices_are_exact() {
    let domain = TableDomain { scalars: [0.0, 1.0], ..COARSE };
    let mut transfers = transfer_functions();
    transfers.push(("steps and peaks", steps_and_peaks()));
    let mut worst = 0.0f64;
    for (name, transfer) in &transfers {
        for model in OpticalModel::ALL {
            for count in [2, 3, 41] {
                let scalars = scalar_samples(&domain, count);
                let pairs = Pairs { transfer, model, scalars: &scalars, surfaces: None };
                for length in [0.0, 1e-3, 0.3, 5.0] {
                    let slice = slice(&pairs, length);
                    for (i, &scalar_front) in scalars.iter().enumerate() {
                        for (j, &scalar_back) in scalars.iter().enumerate() {
                            let known =
                                exact(transfer, model, &Segment { scalar_front, scalar_back, chord_length: length });
                            let error = difference(slice[i][j], known);
                            assert!(error < 1e-12, "{name} {model} {count} {length} {i} {j}: {error:e}");
                            worst = worst.max(error);
                        }
                    }
                }
            }
        }
    }
    println!("largest difference to the exact integral {worst:.1e}");
}

#[test]
fn surfaces_cut_the_entries() {
    let transfer = steps_and_peaks();
    // On samples, between them, two of one value, and outside of the samples.
    let values = [(0.25, 0.4), (0.25, 0.7), (0.33, 0.5), (0.5, 1.0), (0.81, 0.2), (-0.1, 0.9), (0.0, 0.3), (1.0, 0.6)];
    let surfaces = Isosurfaces::new(values.iter().map(|&(value, opacity)| surface(value, opacity)).collect()).unwrap();
    let scalars = scalar_samples(&COARSE, 9);
    for model in OpticalModel::ALL {
        for role in [SurfaceRole::Included, SurfaceRole::Stop] {
            let pairs = Pairs { transfer: &transfer, model, scalars: &scalars, surfaces: Some((&surfaces, role)) };
            let slice = slice(&pairs, 0.6);
            for (i, &front) in scalars.iter().enumerate() {
                for (j, &back) in scalars.iter().enumerate() {
                    // The crossings of the whole segment by rank, from front to back.
                    let (p, q) = (surfaces.rank(front), surfaces.rank(back));
                    let mut crossed = surfaces.as_slice()[p.min(q)..p.max(q)].to_vec();
                    if p > q {
                        crossed.reverse();
                    }
                    let part = |scalar_front: f64, scalar_back: f64| {
                        let share = if front == back { 1.0 } else { (scalar_back - scalar_front) / (back - front) };
                        exact(&transfer, model, &Segment { scalar_front, scalar_back, chord_length: 0.6 * share })
                    };
                    let (mut known, mut at) = (RgbaAssoc::TRANSPARENT, front);
                    let mut stopped = false;
                    for crossing in &crossed {
                        known = known.over(part(at, crossing.value));
                        at = crossing.value;
                        if role == SurfaceRole::Stop {
                            stopped = true;
                            break;
                        }
                        let color = if q > p { crossing.back_color } else { crossing.color };
                        let shown = RgbaAssoc { rgb: color.map(|c| c * crossing.opacity), opacity: crossing.opacity };
                        known = known.over(shown);
                    }
                    if !stopped {
                        known = known.over(part(at, back));
                    }
                    let error = difference(slice[i][j], known);
                    assert!(error < 1e-12, "{model} {role:?} {front} {back}: {error:e}");
                }
            }
            // From the lowest to the highest sample: an opaque surface hides all, a stop leaves what is in front.
            match role {
                SurfaceRole::Included => assert!((slice[0][8].opacity - 1.0).abs() < 1e-15),
                SurfaceRole::Stop => {
                    let known =
                        exact(&transfer, model, &Segment { scalar_front: 0.0, scalar_back: 0.25, chord_length: 0.15 });
                    assert!(difference(slice[0][8], known) < 1e-14, "{model}");
                    // The other way it stops at once: the highest sample lies on a surface, above it by rank.
                    assert_eq!(slice[8][0], RgbaAssoc::TRANSPARENT);
                }
            }
        }
    }
}

#[test]
fn entries_lie_where_the_documentation_says() {
    let transfer = steps_and_peaks();
    for length_axis in [LengthAxis::Linear, LengthAxis::Logarithmic] {
        let table = table_3d(&transfer, OpticalModel::Emitter, settings(5, 12, length_axis));
        assert_eq!(table.entries().len(), 5 * 5 * 12);
        for (index, entry) in table.entries().iter().enumerate() {
            let [i, j, k] = [index % 5, (index / 5) % 5, index / 25];
            let length = table.length_nodes().length(k as u32);
            let segment = Segment { scalar_front: i as f64 / 4.0, scalar_back: j as f64 / 4.0, chord_length: length };
            let known = exact(&transfer, OpticalModel::Emitter, &segment);
            let light = RgbaAssoc { rgb: [0, 1, 2].map(|c| f64::from(entry[c])), opacity: f64::from(entry[3]) };
            assert!(difference(light, known) < 1e-7, "{i} {j} {k}");
            // At a sample the look-up is the entry.
            assert!(difference(table.look_up(&segment), light) < 1e-14, "{i} {j} {k}");
        }
    }
    let table = table_2d(&transfer, OpticalModel::Emitter, 5);
    for (index, entry) in table.entries().iter().enumerate() {
        let [i, j] = [index % 5, index / 5];
        let segment = Segment { scalar_front: i as f64 / 4.0, scalar_back: j as f64 / 4.0, chord_length: 0.08 };
        let known = exact(&transfer, OpticalModel::Emitter, &segment);
        assert!((f64::from(entry[3]) * table.scale() - known.opacity).abs() < 1e-7);
        assert!(difference(table.look_up(&segment), known) < 1e-7, "{i} {j}");
    }
    let largest = table.entries().iter().map(|entry| entry[3]).fold(0.0, f32::max);
    assert_eq!(largest, 1.0, "scaled by the largest opacity");
}

#[test]
fn lengths_and_scalars_beyond_the_domain_are_at_its_ends() {
    let transfer = steps_and_peaks();
    let table = table_3d(&transfer, OpticalModel::DensityEmitter, settings(9, 7, LengthAxis::Logarithmic));
    let at = |scalar_front, scalar_back, chord_length| Segment { scalar_front, scalar_back, chord_length };
    assert_eq!(table.look_up(&at(-5.0, 9.0, 0.3)), table.look_up(&at(0.0, 1.0, 0.3)));
    assert_eq!(table.look_up(&at(0.2, 0.4, 9.0)), table.look_up(&at(0.2, 0.4, 0.5)));
    assert_eq!(table.look_up(&at(0.2, 0.4, 0.0)), RgbaAssoc::TRANSPARENT);
    assert!(table.look_up(&at(0.2, f64::NAN, 0.1)).opacity.is_nan());
    assert!(table.look_up(&at(0.2, 0.1, f64::NAN)).opacity.is_nan());
}

#[test]
fn a_field_of_one_value_has_a_table() {
    let transfer = steps_and_peaks();
    let domain = TableDomain { scalars: [0.3, 0.3], mean_length: 0.1, max_length: 0.4 };
    let segment = Segment { scalar_front: 0.3, scalar_back: 0.3, chord_length: 0.2 };
    for model in OpticalModel::ALL {
        let known = exact(&transfer, model, &segment);
        let settings = settings(4, 5, LengthAxis::Linear);
        // The length is a node.
        let table = Table3d::build(&transfer, model, &domain, &settings, None, &quiet).unwrap();
        assert!(difference(table.look_up(&segment), known) < 1e-7, "{model}");
        let table = Table2d::build(&transfer, model, &domain, &settings, None, &quiet).unwrap();
        let mean = Segment { chord_length: 0.1, ..segment };
        assert!(difference(table.look_up(&mean), exact(&transfer, model, &mean)) < 1e-7, "{model}");
    }
}

#[test]
fn what_cannot_be_tabulated_is_refused() {
    let transfer = steps_and_peaks();
    let build = |domain: TableDomain, settings: TableSettings| {
        let model = OpticalModel::Emission;
        let of_3d = Table3d::build(&transfer, model, &domain, &settings, None, &quiet).map(|_| ());
        let of_2d = Table2d::build(&transfer, model, &domain, &settings, None, &quiet).map(|_| ());
        // As text, in which not-a-numbers are equal.
        assert_eq!(format!("{of_3d:?}"), format!("{of_2d:?}"));
        of_3d
    };
    let small = settings(2, 2, LengthAxis::Logarithmic);
    assert_eq!(build(COARSE, small), Ok(()));
    for wrong in [settings(1, 2, LengthAxis::Linear), settings(2, 1025, LengthAxis::Linear)] {
        assert!(matches!(build(COARSE, wrong), Err(MethodError::TableSize { .. })));
    }
    let refused = |domain: TableDomain| match build(domain, small) {
        Err(MethodError::TableDomain { what, .. }) => what,
        other => panic!("{domain:?}: {other:?}"),
    };
    assert_eq!(refused(TableDomain { scalars: [f64::NAN, 1.0], ..COARSE }), "lowest scalar");
    assert_eq!(refused(TableDomain { scalars: [0.0, f64::INFINITY], ..COARSE }), "highest scalar");
    assert_eq!(refused(TableDomain { scalars: [1.0, 0.0], ..COARSE }), "range of scalars");
    assert_eq!(refused(TableDomain { scalars: [-f64::MAX, f64::MAX], ..COARSE }), "range of scalars");
    assert_eq!(refused(TableDomain { mean_length: 0.0, ..COARSE }), "mean length");
    assert_eq!(refused(TableDomain { max_length: 0.07, ..COARSE }), "longest chord");
    assert_eq!(refused(TableDomain { max_length: f64::NAN, ..COARSE }), "longest chord");
    let message = build(TableDomain { mean_length: -1.0, ..COARSE }, small).unwrap_err().to_string();
    assert_eq!(message, "a table over a mean length of -1 is not possible; give a positive finite length");
}

#[test]
fn threads_do_not_matter_and_progress_counts_to_the_end() {
    let transfer = steps_and_peaks();
    let surfaces = Isosurfaces::new(vec![surface(0.4, 0.5), surface(0.6, 1.0)]).unwrap();
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let calls = Mutex::new([Vec::new(), Vec::new()]);
        let note = |table: usize| {
            let calls = &calls;
            move |done, all| calls.lock().unwrap()[table].push((done, all))
        };
        let (model, settings) = (OpticalModel::DensityEmitter, settings(17, 9, LengthAxis::Logarithmic));
        let surfaces = Some((&surfaces, SurfaceRole::Included));
        let tables = pool.install(|| {
            let of_3d = Table3d::build(&transfer, model, &COARSE, &settings, surfaces, &note(0)).unwrap();
            (of_3d, Table2d::build(&transfer, model, &COARSE, &settings, surfaces, &note(1)).unwrap())
        });
        let mut calls = calls.into_inner().unwrap();
        calls.iter_mut().for_each(|calls| calls.sort_unstable());
        assert_eq!(calls[0], (1..=9).map(|done| (done, 9)).collect::<Vec<_>>());
        assert_eq!(calls[1], (1..=17).map(|done| (done, 17)).collect::<Vec<_>>());
        tables
    };
    let one = build(1);
    assert!(one == build(2) && one == build(7));
}

#[test]
fn the_error_falls_with_the_square_of_the_samples_where_the_transfer_function_is_smooth() {
    // Without a kink: one piece over all of the domain.
    let color = [[0.0, 0.1, 0.2, 0.9], [1.0, 0.9, 0.2, 0.1]];
    let transfer = &TransferFunction::new(&color, &[[0.0, 0.0], [1.0, 10.0]]).unwrap();
    let errors = [32, 64, 128].map(|n| {
        let table = table_3d(transfer, OpticalModel::DensityEmitter, settings(n, n, LengthAxis::Linear));
        let error = table.deviation(transfer, 20_000);
        println!("{n}: {:.2e} / {:.2e}", error.largest, error.mean);
        error
    });
    for pair in errors.windows(2) {
        // Half the distance, a quarter of the error; (63 / 31)² and (127 / 63)², with a margin for where samples fall.
        let (largest, mean) = (pair[0].largest / pair[1].largest, pair[0].mean / pair[1].mean);
        assert!((3.5..5.0).contains(&largest) && (3.7..4.5).contains(&mean), "{largest} {mean}");
    }
}

/// The figures of the documentation, which the example `table_errors` prints: largest and mean.
#[test]
fn figures_of_the_documentation_hold() {
    let model = OpticalModel::DensityEmitter;
    let of_3d = [(0.004, 1.3e-4), (0.43, 0.0018), (0.78, 0.0027), (0.70, 0.0011), (0.34, 0.0026)];
    let of_2d = [(0.33, 0.040), (0.40, 0.042), (0.76, 0.024), (0.64, 0.045), (0.37, 0.044)];
    for (index, (name, transfer)) in transfer_functions().iter().enumerate() {
        let table = table_3d(transfer, model, settings(64, 64, LengthAxis::Linear));
        let error = table.deviation(transfer, 40_000);
        let (largest, mean) = of_3d[index];
        println!("{name} 3d: {:.2e} / {:.2e} at {:?}", error.largest, error.mean, error.worst);
        assert!(error.largest < 1.1 * largest && error.mean < 1.1 * mean, "{name}: {error:?}");
        let table = table_2d(transfer, model, 256);
        let error = table.deviation(transfer, 40_000);
        let (largest, mean) = of_2d[index];
        println!("{name} 2d: {:.2e} / {:.2e}", error.largest, error.mean);
        assert!(error.largest < 1.1 * largest && error.mean < 1.1 * mean, "{name}: {error:?}");
    }
}

fn model() -> impl Strategy<Value = OpticalModel> {
    prop::sample::select(OpticalModel::ALL.to_vec())
}

prop_compose! {
    /// Control points on a coarse raster, steps among them.
    fn transfer()(
        color in prop::collection::vec((0..16u32, 0.0..1.0f64), 1..6),
        extinction in prop::collection::vec((0..16u32, prop_oneof![Just(0.0), 0.0..40.0f64]), 1..8),
    ) -> TransferFunction {
        let (mut color, mut extinction) = (color, extinction);
        color.sort_by_key(|point| point.0);
        extinction.sort_by_key(|point| point.0);
        let color: Vec<_> = color.into_iter().map(|(s, v)| [f64::from(s) / 16.0, v, 1.0 - v, 0.7]).collect();
        let extinction: Vec<_> = extinction.into_iter().map(|(s, v)| [f64::from(s) / 16.0, v]).collect();
        TransferFunction::new(&color, &extinction).unwrap()
    }
}

fn axis() -> impl Strategy<Value = LengthAxis> {
    prop::sample::select(vec![LengthAxis::Linear, LengthAxis::Logarithmic])
}

/// Half a unit in the last place of a number up to 1 in 32 bits, what an entry is rounded by.
const ROUNDING: f64 = 6e-8;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn opacity_is_in_range_and_grows_with_the_length(
        transfer in transfer(), model in model(), axis in axis(), front in -0.1..1.1f64, back in -0.1..1.1f64,
        lengths in prop::array::uniform2(0.0..0.7f64),
    ) {
        let table = table_3d(&transfer, model, settings(9, 13, axis));
        // Node above node.
        for (below, above) in table.entries().iter().zip(&table.entries()[81..]) {
            prop_assert!(0.0 <= below[3] && below[3] <= above[3] && above[3] <= 1.0);
        }
        let other = table_2d(&transfer, model, 9);
        let [shorter, longer] = if lengths[0] <= lengths[1] { lengths } else { [lengths[1], lengths[0]] };
        let at = |chord_length| Segment { scalar_front: front, scalar_back: back, chord_length };
        for [shorter, longer] in [
            [table.look_up(&at(shorter)), table.look_up(&at(longer))],
            [other.look_up(&at(shorter)), other.look_up(&at(longer))],
        ] {
            prop_assert!((0.0..=1.0).contains(&shorter.opacity) && longer.opacity <= 1.0);
            // Eight products of 64-bit weights round.
            prop_assert!(shorter.opacity <= longer.opacity + 1e-15, "{} {}", shorter.opacity, longer.opacity);
        }
    }

    #[test]
    fn swapped_ends_have_the_same_opacity(
        transfer in transfer(), model in model(), axis in axis(), front in 0.0..1.0f64, back in 0.0..1.0f64,
        length in 0.0..0.6f64,
    ) {
        let segment = Segment { scalar_front: front, scalar_back: back, chord_length: length };
        let swapped = Segment { scalar_front: back, scalar_back: front, chord_length: length };
        let table = table_3d(&transfer, model, settings(9, 5, axis));
        prop_assert!((table.look_up(&segment).opacity - table.look_up(&swapped).opacity).abs() <= 2.0 * ROUNDING);
        let table = table_2d(&transfer, model, 9);
        // Scaled up to the longest of these lengths, and down again by the scale.
        let factor = 0.6 / 0.08;
        let error = (table.look_up(&segment).opacity - table.look_up(&swapped).opacity).abs();
        prop_assert!(error <= 2.0 * factor * ROUNDING);
    }

    #[test]
    fn a_constant_transfer_function_is_known_within_the_error_of_interpolation(
        model in model(), axis in axis(), extinction in 0.0..60.0f64, front in -0.5..1.5f64, back in -0.5..1.5f64,
        length in 0.0..0.5f64,
    ) {
        let transfer = TransferFunction::new(&[[0.0, 0.9, 0.5, 0.1]], &[[0.0, extinction]]).unwrap();
        let segment = Segment { scalar_front: front, scalar_back: back, chord_length: length };
        let known = exact(&transfer, model, &segment);

        let table = table_3d(&transfer, model, settings(4, 33, axis));
        // The second derivative of the opacity is at most the square of the extinction, that of light with the color
        // per length at most the extinction times the color; the chord of a parabola is off by an eighth of it times
        // the square of the interval. On the logarithmic axis an interval may hold the end of an octave, where the
        // look-up is linear in pieces of two slopes: off by no more than the whole interval's first derivative, at most
        // the extinction (or 1 per color), times the difference in place.
        let (node, _) = crate::table_axes::cell(table.length_nodes().coordinate(length), 33);
        let [start, end] = [node as u32, node as u32 + 1].map(|node| table.length_nodes().length(node));
        let bend = (start + (table.length_nodes().coordinate(length) - node as f64) * (end - start) - length).abs();
        let curvature = if model == OpticalModel::Emission { 0.0 } else { extinction * extinction.max(1.0) };
        let bound = curvature * (end - start).powi(2) / 8.0 + extinction.max(1.0) * bend + 2.0 * ROUNDING;
        let error = difference(table.look_up(&segment), known);
        prop_assert!(error <= bound, "{error:e} {bound:e}");

        let table = table_2d(&transfer, model, 4);
        let at_mean = exact(&transfer, model, &Segment { chord_length: 0.08, ..segment });
        let factor = if at_mean.opacity > 0.0 { (length / 0.08).min(1.0 / at_mean.opacity) } else { length / 0.08 };
        let linear = RgbaAssoc { rgb: at_mean.rgb.map(|c| c * factor), opacity: at_mean.opacity * factor };
        let error = difference(table.look_up(&segment), linear);
        prop_assert!(error <= 4.0 * factor.max(1.0) * ROUNDING, "{error:e}");
        if model == OpticalModel::Emission {
            prop_assert!(difference(linear, known) <= 1e-14, "linear in the length");
        }
    }
}
