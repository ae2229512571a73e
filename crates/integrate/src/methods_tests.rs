//! The three ways to integrate: known answers, the closed form against quadrature, and the integral's invariants.

#![expect(clippy::excessive_precision, reason = "known values keep the digits they were computed with")]

use proptest::prelude::*;

use crate::{OpticalModel, RgbaAssoc, Segment, TransferFunction, average, exact, thick_vertex};

type Method = fn(&TransferFunction, OpticalModel, &Segment) -> RgbaAssoc;
const METHODS: [Method; 3] = [exact, average, thick_vertex];

fn segment(scalar_front: f64, scalar_back: f64, chord_length: f64) -> Segment {
    Segment { scalar_front, scalar_back, chord_length }
}

/// Largest difference of the opacities and of the light, the latter relative to `brightness`.
fn difference(left: RgbaAssoc, right: RgbaAssoc, brightness: f64) -> f64 {
    let light = left.rgb.iter().zip(right.rgb).map(|(l, r)| (l - r).abs()).fold(0.0, f64::max);
    (left.opacity - right.opacity).abs().max(light / brightness)
}

/// Most light that a segment can send: what differences are measured against.
fn brightness(transfer: &TransferFunction, model: OpticalModel, length: f64) -> f64 {
    let brightest = transfer.max_emission(f64::NEG_INFINITY, f64::INFINITY).max(1e-300);
    if model.color_is_per_length() { brightest * length.max(1e-300) } else { brightest }
}

#[test]
fn constant_fields_are_known_to_every_method() {
    let transfer = TransferFunction::new(&[[0.0, 0.2, 0.5, 1.5]], &[[0.0, 3.0]]).unwrap();
    for method in METHODS {
        for (front, back) in [(0.4, 0.4), (-1.0, 7.0), (1e300, -1e300)] {
            let here = segment(front, back, 0.25);
            let opacity = 1.0 - (-0.75f64).exp();
            let light = |model| method(&transfer, model, &here);
            let expected = RgbaAssoc { rgb: [0.2, 0.5, 1.5].map(|c| c * opacity), opacity };
            assert!(difference(light(OpticalModel::DensityEmitter), expected, 1.0) < 1e-15);
            let expected = RgbaAssoc { rgb: [0.2, 0.5, 1.5].map(|c| c * opacity / 3.0), opacity };
            assert!(difference(light(OpticalModel::Emitter), expected, 1.0) < 1e-15);
            let expected = RgbaAssoc { rgb: [0.0; 3], opacity };
            assert!(difference(light(OpticalModel::Absorption), expected, 1.0) < 1e-15);
            let expected = RgbaAssoc { rgb: [0.05, 0.125, 0.375], opacity: 0.0 };
            assert!(difference(light(OpticalModel::Emission), expected, 1.0) < 1e-15);
        }
    }
}

#[test]
fn no_length_gives_no_light() {
    let transfer = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &[[0.0, 0.0], [1.0, f64::MAX]]).unwrap();
    for method in METHODS {
        for model in OpticalModel::ALL {
            assert_eq!(method(&transfer, model, &segment(0.0, 1.0, 0.0)), RgbaAssoc::TRANSPARENT);
        }
    }
}

#[test]
fn a_linear_field_is_known_to_the_closed_form() {
    // Extinction 8 s, one color that equals s: the known weights for end depths 0 and 2.5 of the weights' table.
    let transfer = TransferFunction::new(&[[0.0; 4], [1.0; 4]], &[[0.0, 0.0], [1.0, 8.0]]).unwrap();
    let light = exact(&transfer, OpticalModel::DensityEmitter, &segment(0.0, 1.0, 0.3125));
    assert!((light.rgb[0] - 0.415_918_634_536_776_773).abs() < 1e-15);
    assert!((light.opacity - (1.0 - 0.286_504_796_860_190_1)).abs() < 1e-15);
    let light = exact(&transfer, OpticalModel::Emitter, &segment(1.0, 0.0, 0.3125));
    assert!((light.rgb[0] - 0.3125 * 0.285_398_081_255_923_96).abs() < 1e-15);
    // The mean of the ends gives the opacity of a linear extinction, the mean scalar does so too.
    for method in [average, thick_vertex] {
        let other = method(&transfer, OpticalModel::DensityEmitter, &segment(0.0, 1.0, 0.3125));
        assert!((other.opacity - (1.0 - 0.286_504_796_860_190_1)).abs() < 1e-15);
        assert!((other.rgb[0] - 0.5 * other.opacity).abs() < 1e-15);
    }
}

#[test]
fn steps_are_seen_from_the_side_of_the_segment() {
    let transfer =
        TransferFunction::new(&[[0.0, 1.0, 0.0, 0.0]], &[[0.0, 1.0], [1.0, 1.0], [1.0, 5.0], [2.0, 5.0]]).unwrap();
    let depth = |front, back| {
        let light = exact(&transfer, OpticalModel::Absorption, &segment(front, back, 1.0));
        -(-light.opacity).ln_1p()
    };
    let near = |left: f64, right: f64| assert!((left - right).abs() < 1e-14, "{left} {right}");
    near(depth(0.0, 1.0), 1.0);
    near(depth(1.0, 0.0), 1.0);
    near(depth(1.0, 2.0), 5.0);
    near(depth(1.0, 1.0), 5.0);
    near(depth(0.5, 1.5), 3.0);
    near(depth(1.0f64.next_down(), 1.0f64.next_down()), 1.0);
    // A segment one float wide across the step lies before it.
    near(depth(1.0f64.next_down(), 1.0), 1.0);
    near(depth(1.0f64.next_down(), 1.0f64.next_up()), 1.0 / 3.0 + 5.0 * 2.0 / 3.0);
}

#[test]
fn a_peak_thinner_than_the_segment_has_its_exact_depth() {
    // A tent of height 400 and half width 1/128: optical depth 400 / 128 per unit of scalar.
    for width in [1.0 / 128.0, 2f64.powi(-30)] {
        let peak = [[0.5 - width, 0.0], [0.5, 400.0], [0.5 + width, 0.0]];
        let transfer = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &peak).unwrap();
        for (front, back, length) in [(0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (0.25, 0.75, 3.0), (-100.0, 100.0, 7.0)] {
            let depth = 400.0 * width * length / f64::abs(back - front);
            let light = exact(&transfer, OpticalModel::DensityEmitter, &segment(front, back, length));
            let opacity = -(-depth).exp_m1();
            assert!((light.opacity / opacity - 1.0).abs() < 1e-13, "{front} {back}");
            assert!((light.rgb[1] / opacity - 1.0).abs() < 1e-13, "{front} {back}");
            let missed = average(&transfer, OpticalModel::DensityEmitter, &segment(front - 0.3, back, length));
            assert_eq!(missed.opacity, 0.0, "the mean scalar lies beside the peak");
        }
    }
}

#[test]
fn extremes_of_extinction_and_length_stay_in_range() {
    for exponent in -12..=12 {
        let rho = 10f64.powi(exponent);
        for [low, high] in [[0.0, rho], [rho, 0.0], [rho, rho], [1.0, rho]] {
            let color = [[0.0, 1.0, 0.0, 0.5], [1.0, 0.0, 1.0, 0.5]];
            let transfer = TransferFunction::new(&color, &[[0.0, low], [0.3, 0.5 * high], [1.0, high]]).unwrap();
            for length in [1e-12, 1e-6, 1.0, 1e6, 1e12] {
                for model in OpticalModel::ALL {
                    let light = exact(&transfer, model, &segment(-0.1, 1.3, length));
                    assert!((0.0..=1.0).contains(&light.opacity), "{rho} {length} {light:?}");
                    let most = brightness(&transfer, model, length) * (1.0 + 1e-14);
                    assert!(light.rgb.iter().all(|&c| (0.0..=most).contains(&c)), "{rho} {length} {light:?}");
                    if model == OpticalModel::DensityEmitter {
                        // The third channel is 1/2 everywhere.
                        assert!((light.rgb[2] - 0.5 * light.opacity).abs() <= 1e-14 * light.opacity);
                    }
                }
            }
        }
    }
}

/// The transport equation itself, marched in small steps with Simpson's rule for the source and the depth.
fn marched(transfer: &TransferFunction, model: OpticalModel, segment: &Segment, steps: u32) -> RgbaAssoc {
    let scalar = |u: f64| segment.scalar_front + (segment.scalar_back - segment.scalar_front) * u;
    let extinction = |u: f64| if model.needs_extinction() { transfer.extinction(scalar(u)) } else { 0.0 };
    let source = |u: f64| {
        let color = if model.needs_emission() { transfer.color(scalar(u)) } else { [0.0; 3] };
        color.map(|c| if model.color_is_per_length() { c } else { c * extinction(u) })
    };
    let width = 1.0 / f64::from(steps);
    let length = segment.chord_length * width;
    let (mut rgb, mut depth) = ([0.0; 3], 0.0f64);
    for step in 0..steps {
        // Inside the step, so that no end lies on the far side of a step of the transfer function.
        let at = |share: f64| (f64::from(step) + share.clamp(1e-9, 1.0 - 1e-9)) * width;
        let [start, quarter, middle, end] = [0.0, 0.25, 0.5, 1.0].map(at);
        let half = length / 12.0 * (extinction(start) + 4.0 * extinction(quarter) + extinction(middle));
        let whole = length / 6.0 * (extinction(start) + 4.0 * extinction(middle) + extinction(end));
        let seen = [depth, depth + half, depth + whole].map(|depth| (-depth).exp());
        for (channel, sum) in rgb.iter_mut().enumerate() {
            let values = [start, middle, end].map(|u| source(u)[channel]);
            *sum += length / 6.0 * (seen[0] * values[0] + 4.0 * seen[1] * values[1] + seen[2] * values[2]);
        }
        depth += whole;
    }
    RgbaAssoc { rgb, opacity: -(-depth).exp_m1() }
}

#[test]
fn exact_agrees_with_marching() {
    // Kinks and steps at multiples of 1/16, which are bounds of the marching steps too.
    let color = [[0.0, 0.1, 0.9, 0.0], [0.25, 1.0, 0.2, 0.3], [0.25, 0.0, 0.0, 2.0], [0.75, 0.4, 0.4, 0.4]];
    let extinction = [[0.0625, 0.0], [0.125, 9.0], [0.25, 1.0], [0.5, 0.0], [0.5, 30.0], [0.625, 0.0], [1.0, 3.0]];
    let transfer = TransferFunction::new(&color, &extinction).unwrap();
    let mut worst = 0.0f64;
    for (front, back, length) in
        [(0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (0.25, 0.75, 0.3), (1.0, 0.5, 4.0), (-1.0, 2.0, 5.0)]
    {
        for model in OpticalModel::ALL {
            let here = segment(front, back, length);
            let marched = marched(&transfer, model, &here, 48 * 1024);
            let error = difference(exact(&transfer, model, &here), marched, brightness(&transfer, model, length));
            assert!(error < 1e-12, "{model} {front} {back} {length}: {error:e}");
            worst = worst.max(error);
        }
    }
    println!("largest difference to marching {worst:.1e}");
}

/// Control points on a coarse raster, with steps and empty stretches.
fn points(largest: f64) -> impl Strategy<Value = Vec<[f64; 2]>> {
    let value = prop_oneof![Just(0.0), 0.0..largest];
    prop::collection::vec((0..16i32, value), 1..9).prop_map(|mut points| {
        points.sort_by_key(|point| point.0);
        points.into_iter().map(|(s, v)| [f64::from(s) / 16.0, v]).collect()
    })
}

prop_compose! {
    fn transfer()(red in points(1.0), extinction in points(40.0)) -> (Vec<[f64; 4]>, Vec<[f64; 2]>) {
        (red.iter().map(|&[s, v]| [s, v, 1.0 - v, 0.7]).collect(), extinction)
    }
}

fn any_model() -> impl Strategy<Value = OpticalModel> {
    prop::sample::select(OpticalModel::ALL.to_vec())
}

fn scalar() -> impl Strategy<Value = f64> {
    prop_oneof![-0.2..1.2f64, (0..16i32).prop_map(|s| f64::from(s) / 16.0)]
}

fn length() -> impl Strategy<Value = f64> {
    prop_oneof![0.0..3.0f64, (-9.0..4.0f64).prop_map(|exponent| 10f64.powf(exponent))]
}

proptest! {
    #[test]
    fn splitting_and_composing_changes_nothing(
        (color, extinction) in transfer(), model in any_model(),
        front in scalar(), back in scalar(), length in length(), cut in 0.0..1.0f64,
    ) {
        let transfer = TransferFunction::new(&color, &extinction).unwrap();
        // The cut's scalar first, its place after: the place of a rounded scalar is known, the scalar of a place is not.
        let middle = front + (back - front) * cut;
        let cut = if front == back { cut } else { (middle - front) / (back - front) };
        let rest = if front == back { 1.0 - cut } else { (back - middle) / (back - front) };
        let whole = exact(&transfer, model, &segment(front, back, length));
        let near = exact(&transfer, model, &segment(front, middle, length * cut));
        let far = exact(&transfer, model, &segment(middle, back, length * rest));
        // A cut within a float of a step may fall on its other side: a width of 1e-16 of that much extinction.
        let error = difference(near.over(far), whole, brightness(&transfer, model, length));
        prop_assert!(error < 1e-12 * (1.0 + 1e-3 * length), "{error:e}");
    }

    #[test]
    fn light_and_opacity_are_bounded(
        (color, extinction) in transfer(), front in scalar(), back in scalar(), length in length(),
    ) {
        let transfer = TransferFunction::new(&color, &extinction).unwrap();
        let light = exact(&transfer, OpticalModel::DensityEmitter, &segment(front, back, length));
        let (lo, hi) = (front.min(back), front.max(back));
        prop_assert!((0.0..=1.0).contains(&light.opacity));
        prop_assert!(light.opacity <= -(-length * transfer.max_extinction(lo, hi)).exp_m1() * (1.0 + 1e-14));
        let brightest = transfer.max_emission(lo, hi);
        for channel in light.rgb {
            prop_assert!(channel >= 0.0 && channel <= brightest * light.opacity * (1.0 + 1e-13));
        }
        // The third channel is constant.
        prop_assert!((light.rgb[2] - 0.7 * light.opacity).abs() <= 1e-13 * light.opacity);
    }

    #[test]
    fn opacity_is_the_same_from_behind_and_grows_with_length(
        (color, extinction) in transfer(), model in any_model(), front in scalar(), back in scalar(), length in length(),
    ) {
        let transfer = TransferFunction::new(&color, &extinction).unwrap();
        let opacity = |front, back, length| exact(&transfer, model, &segment(front, back, length)).opacity;
        let here = opacity(front, back, length);
        prop_assert!((opacity(back, front, length) - here).abs() <= 1e-14 * here);
        prop_assert!(opacity(front, back, 1.5 * length) >= here);
    }

    #[test]
    fn light_is_linear_in_the_color(
        (color, extinction) in transfer(), model in any_model(), front in scalar(), back in scalar(), length in length(),
        factor in 0.0..3.0f64, offset in 0.0..2.0f64,
    ) {
        let moved: Vec<_> = color.iter().map(|&[s, r, g, b]| [s, factor * r + offset, g, b]).collect();
        let here = segment(front, back, length);
        let before = exact(&TransferFunction::new(&color, &extinction).unwrap(), model, &here);
        let after = exact(&TransferFunction::new(&moved, &extinction).unwrap(), model, &here);
        // The light of a color of one, from the constant channel.
        let of_one = before.rgb[2] / 0.7;
        // A constant color has fewer pieces to add up.
        prop_assert!((after.opacity - before.opacity).abs() <= 1e-14 * before.opacity, "{after:?} {before:?}");
        let expected = factor * before.rgb[0] + offset * of_one;
        prop_assert!((after.rgb[0] - expected).abs() <= 1e-13 * (3.0 * of_one + 2.0 * of_one), "{} {}", after.rgb[0], expected);
    }

    #[test]
    fn scalars_may_be_mapped_with_the_transfer_function(
        (color, extinction) in transfer(), model in any_model(), front in scalar(), back in scalar(), length in length(),
    ) {
        let transfer = TransferFunction::new(&color, &extinction).unwrap();
        let here = exact(&transfer, model, &segment(front, back, length));
        let most = brightness(&transfer, model, length);
        // By exact factors, so that no scalar changes sides at a step.
        let moved = |s: f64| 4.0 * s;
        let color_moved: Vec<_> = color.iter().map(|&[s, r, g, b]| [moved(s), r, g, b]).collect();
        let extinction_moved: Vec<_> = extinction.iter().map(|&[s, rho]| [moved(s), rho]).collect();
        let there = TransferFunction::new(&color_moved, &extinction_moved).unwrap();
        let there = exact(&there, model, &segment(moved(front), moved(back), length));
        prop_assert!(difference(here, there, most) <= 1e-14);
        // Mirrored; a segment of one scalar that lies on a step would take the other side.
        if front != back {
            let color: Vec<_> = color.iter().rev().map(|&[s, r, g, b]| [-s, r, g, b]).collect();
            let extinction: Vec<_> = extinction.iter().rev().map(|&[s, rho]| [-s, rho]).collect();
            let there = TransferFunction::new(&color, &extinction).unwrap();
            let there = exact(&there, model, &segment(-front, -back, length));
            prop_assert!(difference(here, there, most) <= 1e-14);
        }
    }

    #[test]
    fn an_offset_of_the_scalars_costs_only_their_rounding(
        (color, extinction) in transfer(), front in 0..64i32, back in 0..64i32, length in 0.0..3.0f64,
    ) {
        // Multiples of 1/64 stay exact when moved by an integer.
        let (front, back) = (f64::from(front) / 64.0, f64::from(back) / 64.0);
        let offset = 12_345.0;
        let moved_color: Vec<_> = color.iter().map(|&[s, r, g, b]| [s + offset, r, g, b]).collect();
        let moved_extinction: Vec<_> = extinction.iter().map(|&[s, rho]| [s + offset, rho]).collect();
        let here = TransferFunction::new(&color, &extinction).unwrap();
        let there = TransferFunction::new(&moved_color, &moved_extinction).unwrap();
        let model = OpticalModel::DensityEmitter;
        let here = exact(&here, model, &segment(front, back, length));
        let there = exact(&there, model, &segment(front + offset, back + offset, length));
        prop_assert!(difference(here, there, 1.0) <= 1e-14);
    }

    #[test]
    fn extinction_scales_the_logarithm_of_the_transmittance(
        (color, extinction) in transfer(), front in scalar(), back in scalar(), length in 0.0..0.2f64, factor in 0.0..4.0f64,
    ) {
        let transfer = TransferFunction::new(&color, &extinction).unwrap();
        let scaled = transfer.with_lengths_scaled(factor + 1e-3, OpticalModel::Absorption);
        let depth = |transfer| {
            -(-exact(transfer, OpticalModel::Absorption, &segment(front, back, length)).opacity).ln_1p()
        };
        let (depth, scaled) = (depth(&transfer), depth(&scaled));
        // The logarithm loses what the opacity rounds near 1.
        let expected = depth * (factor + 1e-3);
        prop_assert!((scaled - expected).abs() <= 1e-15 * (expected.exp() + depth.exp() * 4.0) + 1e-13 * expected);
    }

    #[test]
    fn nearly_equal_scalars_give_nearly_the_value_there((color, extinction) in transfer(), s in 0.0..1.0f64, length in length()) {
        let transfer = TransferFunction::new(&color, &extinction).unwrap();
        for (front, back) in [(s, s.next_up()), (s.next_up(), s), (s, s + 1e-14)] {
            // Away from steps, where one float makes all the difference.
            prop_assume!(transfer.pieces_between(s - 1e-12, s + 1e-12).len() == 1);
            let here = exact(&transfer, OpticalModel::DensityEmitter, &segment(s, s, length));
            let near = exact(&transfer, OpticalModel::DensityEmitter, &segment(front, back, length));
            prop_assert!(difference(here, near, 1.0) < 1e-11);
        }
    }

    #[test]
    fn over_is_associative_and_keeps_transparency(values in prop::array::uniform12(0.0..1.0f64)) {
        let [front, middle, back] = core::array::from_fn(|i| {
            let [r, g, b, opacity] = core::array::from_fn(|j| values[4 * i + j]);
            RgbaAssoc { rgb: [r, g, b], opacity }
        });
        prop_assert!(difference(front.over(middle).over(back), front.over(middle.over(back)), 1.0) < 1e-15);
        prop_assert_eq!(front.over(RgbaAssoc::TRANSPARENT), front);
        prop_assert_eq!(RgbaAssoc::TRANSPARENT.over(front), front);
    }
}
