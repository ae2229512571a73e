//! Opacity against the closed form, the light where it is exact, and what the correction is worth.

use proptest::prelude::*;

use super::*;
use crate::exact;

const BOTH: [OpticalModel; 2] = [OpticalModel::DensityEmitter, OpticalModel::Emitter];

fn segment(scalar_front: f64, scalar_back: f64, chord_length: f64) -> Segment {
    Segment { scalar_front, scalar_back, chord_length }
}

fn largest(light: [f64; 3], other: [f64; 3]) -> f64 {
    light.iter().zip(other).map(|(l, r)| (l - r).abs()).fold(0.0, f64::max)
}

/// Peaks, steps, gaps and kinks of color elsewhere.
fn rugged() -> TransferFunction {
    let color = [[0.0, 0.1, 0.9, 0.0], [0.25, 1.0, 0.2, 0.3], [0.25, 0.0, 0.0, 1.0], [0.77, 0.4, 0.4, 0.4]];
    let extinction = [[0.1, 0.0], [0.12, 9.0], [0.3, 1.0], [0.5, 0.0], [0.5, 30.0], [0.6, 0.0], [0.9, 0.0], [1.0, 3.0]];
    TransferFunction::new(&color, &extinction).unwrap()
}

#[test]
fn opacity_is_exact_at_all_scales() {
    let transfer = rugged();
    let integrals = RunningIntegrals::new(&transfer);
    let mut worst = 0.0f64;
    for (front, back) in [
        (0.0, 1.0),
        (1.0, 0.0),
        (0.5, 0.6),
        (0.5, 0.5),
        (0.5f64.next_down(), 0.5),
        (0.5f64.next_down(), 0.5f64.next_up()),
        (0.6f64.next_down(), 0.6),
        (0.3, 0.3 + 1e-13),
        (0.49, 0.49 + 1e-9),
        (0.95, 0.7),
        (-1e300, 1e300),
        (f64::MAX, f64::MIN),
        (-1e6, 0.11),
        (2.0, 1e18),
    ] {
        for exponent in -300..=12 {
            let here = segment(front, back, 10f64.powi(exponent));
            for model in OpticalModel::ALL {
                let (known, got) = (exact(&transfer, model, &here), integrals.integrate(model, &here));
                let error = (got.opacity - known.opacity).abs() / known.opacity.max(f64::MIN_POSITIVE);
                worst = worst.max(error);
                assert!(error < 1e-12, "{front:e} {back:e} {exponent}: {} for {}", got.opacity, known.opacity);
                let plain = integrals.without_correction(model, &here);
                assert_eq!(plain.opacity, got.opacity);
            }
        }
    }
    println!("largest relative error of the opacity {worst:.1e}");
}

#[test]
fn a_peak_far_from_the_start_keeps_its_digits() {
    // Sums from the start would hold 1e12 and subtract two of them for a peak of 1e-6.
    let extinction =
        [[0.0, 1e12], [1.0, 1e12], [1.0, 0.0], [2.0, 0.0], [2.5, 1e-6], [3.0, 0.0], [4.0, 0.0], [5.0, 7.0]];
    let transfer = TransferFunction::new(&[[0.0, 0.0, 1.0, 0.5], [9.0, 1.0, 0.0, 0.5]], &extinction).unwrap();
    let integrals = RunningIntegrals::new(&transfer);
    for (front, back) in [(1.5, 3.5), (3.5, 1.5), (1.0, 4.0), (2.25, 2.75)] {
        let here = segment(front, back, 2.0);
        let model = OpticalModel::DensityEmitter;
        let (known, got) = (exact(&transfer, model, &here), integrals.integrate(model, &here));
        assert!((got.opacity / known.opacity - 1.0).abs() < 1e-14, "{front} {back}");
        assert!(largest(got.rgb, known.rgb) < 1e-6 * known.opacity, "{front} {back}");
    }
}

#[test]
fn the_table_holds_one_entry_a_piece_and_level() {
    // 256 entries, and still one composition between the two ends.
    let extinction: Vec<_> = (0..256).map(|i| [f64::from(i), f64::from(i * 37 % 11)]).collect();
    let integrals = RunningIntegrals::new(&TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &extinction).unwrap());
    for (start, end) in [(0, 1), (0, 255), (3, 200), (127, 129), (126, 128)] {
        let joins = core::cell::Cell::new(0);
        let counted = |below: Means, above| {
            joins.set(joins.get() + 1);
            below.join(above)
        };
        assert!(integrals.inner.get(start, end, counted).is_some());
        assert!(joins.get() <= 1, "{start}..{end}: {} compositions", joins.get());
    }
}

/// As in the example `method_errors`, in small.
fn mean_errors(transfer: &TransferFunction, model: OpticalModel) -> [f64; 2] {
    let integrals = RunningIntegrals::new(transfer);
    let mut sums = [0.0; 2];
    for i in 0..4000 {
        let [front, back, third] =
            [0.819_172_513, 0.671_043_607, 0.549_700_478].map(|step: f64| (0.5 + f64::from(i) * step).fract());
        let here = segment(front, back, 1e-3 * 500f64.powf(third));
        let known = exact(transfer, model, &here).rgb;
        sums[0] += largest(integrals.integrate(model, &here).rgb, known);
        sums[1] += largest(integrals.without_correction(model, &here).rgb, known);
    }
    sums.map(|sum| sum / 4000.0)
}

#[test]
fn the_correction_pays() {
    let tent = |center: f64| [[center - 0.05, 0.0], [center, 50.0], [center + 0.05, 0.0]];
    let color = [[0.0, 0.1, 0.2, 0.9], [0.5, 0.9, 0.9, 0.8], [1.0, 0.9, 0.2, 0.1]];
    let noise = |i: u32| (f64::from(i * i) * 0.618_033_988_75).fract();
    let entries: Vec<_> = (0..256).map(|i| [f64::from(i) / 255.0, 10.0 * noise(i)]).collect();
    let mut families = vec![("rugged", rugged())];
    for (name, extinction) in [
        ("ramp", vec![[0.0, 0.0], [1.0, 10.0]]),
        ("tents", [tent(0.2), tent(0.5), tent(0.8)].concat()),
        ("entries", entries),
    ] {
        families.push((name, TransferFunction::new(&color, &extinction).unwrap()));
    }
    for (name, transfer) in families {
        for model in BOTH {
            let [corrected, plain] = mean_errors(&transfer, model);
            println!("{name}, {model}: mean error {corrected:.1e} corrected, {plain:.1e} not");
            assert!(corrected < 0.5 * plain, "{name}, {model}: {corrected:e}, not {plain:e}");
        }
    }
}

#[test]
fn the_error_is_of_third_order() {
    // Half the length: a quarter of the error of the means alone, an eighth with the moments. Of the light that is one
    // order less where only the mean color is known.
    let transfer = rugged();
    let integrals = RunningIntegrals::new(&transfer);
    for (front, back) in [(0.0, 1.0), (1.0, 0.0), (0.11, 0.55), (0.7, 0.2)] {
        for model in BOTH {
            let errors = [1.0, 0.5].map(|half: f64| {
                let here = segment(front, back, 2e-3 * half);
                let known = exact(&transfer, model, &here).rgb;
                [integrals.integrate(model, &here), integrals.without_correction(model, &here)]
                    .map(|light| largest(light.rgb, known))
            });
            let [corrected, plain] = [0, 1].map(|method| (errors[0][method] / errors[1][method]).log2());
            assert!((corrected - 3.0).abs() < 0.1, "{model} {front} {back}: order {corrected}");
            assert!((plain - 2.0).abs() < 0.1, "{model} {front} {back}: order {plain}");
        }
    }
}

prop_compose! {
    /// Control points on a raster, with steps and empty stretches, over extinctions of several decades.
    fn any_transfer()(
        color in prop::collection::vec((0..16i32, 0.0..1.0f64, 0.0..3.0f64), 1..9),
        extinction in prop::collection::vec((0..16i32, prop_oneof![Just(0.0), 0.0..40.0f64, 0.0..1e-3f64]), 1..24),
    ) -> TransferFunction {
        let mut color: Vec<_> = color.into_iter().map(|(s, r, g)| [f64::from(s) / 16.0, r, g, 0.7]).collect();
        color.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut extinction: Vec<_> = extinction.into_iter().map(|(s, rho)| [f64::from(s) / 16.0, rho]).collect();
        extinction.sort_by(|a, b| a[0].total_cmp(&b[0]));
        TransferFunction::new(&color, &extinction).unwrap()
    }
}

fn any_scalar() -> impl Strategy<Value = f64> {
    prop_oneof![-0.2..1.2f64, (0..16i32).prop_map(|s| f64::from(s) / 16.0), -1e3..1e3f64]
}

fn any_length() -> impl Strategy<Value = f64> {
    prop_oneof![0.0..3.0f64, (-12.0..6.0f64).prop_map(|exponent| 10f64.powf(exponent))]
}

proptest! {
    #[test]
    fn opacity_is_exact(transfer in any_transfer(), front in any_scalar(), back in any_scalar(), length in any_length()) {
        let here = segment(front, back, length);
        let known = exact(&transfer, OpticalModel::Absorption, &here).opacity;
        let got = RunningIntegrals::new(&transfer).integrate(OpticalModel::Absorption, &here).opacity;
        prop_assert!((got - known).abs() <= 1e-12 * known, "{got:e} for {known:e}");
    }

    #[test]
    fn light_stays_between_the_colors(
        transfer in any_transfer(), front in any_scalar(), back in any_scalar(), length in any_length(),
    ) {
        let integrals = RunningIntegrals::new(&transfer);
        let here = segment(front, back, length);
        let means = integrals.means(&here);
        let light = integrals.integrate(OpticalModel::DensityEmitter, &here);
        for channel in 0..3 {
            let [lowest, highest] = [means.lowest[channel], means.highest[channel]].map(|color| color * light.opacity);
            prop_assert!((lowest..=highest).contains(&light.rgb[channel]));
        }
        let glowing = integrals.integrate(OpticalModel::Emission, &here);
        let seen = integrals.integrate(OpticalModel::Emitter, &here);
        for (glow, light) in glowing.rgb.iter().zip(seen.rgb) {
            // What is seen through everything, and through nothing; the transmittance is rounded against 1.
            prop_assert!(light >= glow * (1.0 - seen.opacity - 1e-15) * (1.0 - 1e-14) && light <= glow * (1.0 + 1e-14));
        }
    }

    #[test]
    fn one_color_is_exact(
        transfer in any_transfer(), front in any_scalar(), back in any_scalar(), length in any_length(),
    ) {
        let here = segment(front, back, length);
        let light = RunningIntegrals::new(&transfer).integrate(OpticalModel::DensityEmitter, &here);
        prop_assert!((light.rgb[2] - 0.7 * light.opacity).abs() <= 1e-15 * light.opacity);
    }

    #[test]
    fn emission_is_exact(
        transfer in any_transfer(), front in any_scalar(), back in any_scalar(), length in any_length(),
    ) {
        let here = segment(front, back, length);
        let known = exact(&transfer, OpticalModel::Emission, &here);
        let got = RunningIntegrals::new(&transfer).integrate(OpticalModel::Emission, &here);
        prop_assert_eq!(got.opacity, 0.0);
        prop_assert!(largest(got.rgb, known.rgb) <= 1e-13 * 3.0 * length);
    }

    #[test]
    fn a_linear_color_under_one_extinction_is_exact(
        color in prop::array::uniform2(0.0..1.0f64), extinction in 0.0..50.0f64,
        front in 0.0..1.0f64, back in 0.0..1.0f64, length in any_length(),
    ) {
        // Idle control points, so that there is something to compose.
        let at = |s: f64| color[0] + (color[1] - color[0]) * s;
        let color: Vec<_> = [0.0, 0.2, 0.5, 0.7, 1.0].map(|s| [s, at(s), 0.0, 0.0]).to_vec();
        let transfer = TransferFunction::new(&color, &[[0.0, extinction]]).unwrap();
        let here = segment(front, back, length);
        for model in BOTH {
            let known = exact(&transfer, model, &here);
            let got = RunningIntegrals::new(&transfer).integrate(model, &here);
            let most = if model == OpticalModel::Emitter { length } else { known.opacity };
            prop_assert!(largest(got.rgb, known.rgb) <= 1e-13 * most, "{model} {got:?} {known:?}");
        }
    }

    #[test]
    fn without_depth_the_light_is_exact(transfer in any_transfer(), front in any_scalar(), back in any_scalar()) {
        let here = segment(front, back, 1e-9);
        let integrals = RunningIntegrals::new(&transfer);
        for model in BOTH {
            let known = exact(&transfer, model, &here);
            // The depth is at most 4e-8: the mean alone is off by half of that.
            let most = 1e-7 * if model == OpticalModel::Emitter { 3e-9 } else { 3.0 * known.opacity };
            for light in [integrals.integrate(model, &here), integrals.without_correction(model, &here)] {
                prop_assert!(largest(light.rgb, known.rgb) <= most, "{model} {light:?} {known:?}");
            }
        }
    }
}
