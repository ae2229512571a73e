//! What every way to integrate a ray's segment has to keep, whatever it approximates.

use proptest::prelude::*;

use crate::{
    Integration, OpticalModel, RgbaAssoc, RunningIntegrals, Segment, TransferFunction, average, exact, opacity_2d,
    partial, thick_vertex,
};

type Method = fn(&TransferFunction, OpticalModel, &Segment) -> RgbaAssoc;

fn cumulative(transfer: &TransferFunction, model: OpticalModel, segment: &Segment) -> RgbaAssoc {
    RunningIntegrals::new(transfer).integrate(model, segment)
}

fn uncorrected(transfer: &TransferFunction, model: OpticalModel, segment: &Segment) -> RgbaAssoc {
    RunningIntegrals::new(transfer).without_correction(model, segment)
}

const METHODS: [(Integration, Method); 7] = [
    (Integration::Vertex, thick_vertex),
    (Integration::Average, average),
    (Integration::Opacity2d, opacity_2d),
    (Integration::Partial, partial),
    (Integration::Cumulative, cumulative),
    (Integration::Cumulative, uncorrected),
    (Integration::Exact, exact),
];

/// All methods with all models that they are made for.
fn all() -> impl Iterator<Item = (Integration, Method, OpticalModel)> {
    METHODS.into_iter().flat_map(|(name, method)| {
        OpticalModel::ALL.into_iter().filter(move |&model| name.covers(model)).map(move |model| (name, method, model))
    })
}

fn segment(scalar_front: f64, scalar_back: f64, chord_length: f64) -> Segment {
    Segment { scalar_front, scalar_back, chord_length }
}

fn largest_difference(left: RgbaAssoc, right: RgbaAssoc) -> f64 {
    left.rgb.iter().zip(right.rgb).map(|(l, r)| (l - r).abs()).fold((left.opacity - right.opacity).abs(), f64::max)
}

/// What the light of a color of 1 is measured against.
fn unit(model: OpticalModel, length: f64) -> f64 {
    if model.color_is_per_length() { length.max(1.0) } else { 1.0 }
}

prop_compose! {
    /// Control points on a raster, with steps and empty stretches.
    fn any_transfer()(
        color in prop::collection::vec((0..16i32, 0.0..1.0f64), 1..9),
        extinction in prop::collection::vec((0..16i32, prop_oneof![Just(0.0), 0.0..40.0f64]), 1..9),
    ) -> TransferFunction {
        let mut color: Vec<_> = color.into_iter().map(|(s, r)| [f64::from(s) / 16.0, r, 1.0 - r, 0.7]).collect();
        color.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut extinction: Vec<_> = extinction.into_iter().map(|(s, rho)| [f64::from(s) / 16.0, rho]).collect();
        extinction.sort_by(|a, b| a[0].total_cmp(&b[0]));
        TransferFunction::new(&color, &extinction).unwrap()
    }
}

fn any_length() -> impl Strategy<Value = f64> {
    prop_oneof![0.0..3.0f64, (-9.0..4.0f64).prop_map(|exponent| 10f64.powf(exponent))]
}

/// Any finite number, the edges of the range as likely as the middle.
fn any_number() -> impl Strategy<Value = f64> {
    let edges = [0.0, -0.0, 1.0, f64::MAX, f64::MIN, f64::MIN_POSITIVE, f64::from_bits(1), -f64::from_bits(1), 1e-320];
    prop_oneof![
        prop::sample::select(edges.to_vec()),
        -2.0..2.0f64,
        prop::num::f64::POSITIVE | prop::num::f64::NEGATIVE | prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL,
    ]
}

fn any_magnitude() -> impl Strategy<Value = f64> {
    any_number().prop_map(f64::abs)
}

prop_compose! {
    /// As wild as a transfer function can be.
    fn wild_transfer()(
        color in prop::collection::vec((any_number(), prop::array::uniform3(any_magnitude())), 1..5),
        extinction in prop::collection::vec((any_number(), any_magnitude()), 1..5),
    ) -> TransferFunction {
        let mut color: Vec<_> = color.into_iter().map(|(s, [r, g, b])| [s, r, g, b]).collect();
        color.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut extinction: Vec<_> = extinction.into_iter().map(|(s, rho)| [s, rho]).collect();
        extinction.sort_by(|a, b| a[0].total_cmp(&b[0]));
        TransferFunction::new(&color, &extinction).unwrap()
    }
}

proptest! {
    #[test]
    fn constants_are_known_in_closed_form(
        color in prop::array::uniform3(0.0..2.0f64), exponent in -6.0..3.0f64, length in any_length(),
        front in -2.0..2.0f64, back in -2.0..2.0f64,
    ) {
        let [r, g, b] = color;
        let rho = 10f64.powf(exponent);
        let transfer = TransferFunction::new(&[[0.0, r, g, b]], &[[0.0, rho]]).unwrap();
        let tau = rho * length;
        let opacity = -(-tau).exp_m1();
        for (name, method, model) in all() {
            let light = method(&transfer, model, &segment(front, back, length));
            let (factor, alpha) = match model {
                OpticalModel::DensityEmitter => (opacity, opacity),
                OpticalModel::Emitter => (opacity / rho, opacity),
                OpticalModel::Absorption => (0.0, opacity),
                OpticalModel::Emission => (length, 0.0),
            };
            prop_assert!((light.opacity - alpha).abs() <= 1e-15 * alpha, "{name} {model}: {light:?}");
            for (got, color) in light.rgb.iter().zip(color) {
                prop_assert!((got - factor * color).abs() <= 4e-15 * factor * color, "{name} {model}: {light:?}");
            }
        }
    }

    #[test]
    fn opacity_stays_in_range_and_does_not_fall_with_the_length(
        transfer in any_transfer(), front in -0.2..1.2f64, back in -0.2..1.2f64,
        length in any_length(), factor in 1.0..9.0f64,
    ) {
        for (name, method, model) in all() {
            let near = method(&transfer, model, &segment(front, back, length));
            let far = method(&transfer, model, &segment(front, back, factor * length));
            prop_assert!((0.0..=1.0).contains(&near.opacity), "{name} {model}: {near:?}");
            prop_assert!(far.opacity >= near.opacity, "{name} {model}: {near:?} {far:?}");
            let most = if model.color_is_per_length() { length } else { near.opacity };
            for channel in near.rgb {
                prop_assert!(channel >= 0.0 && channel <= most * (1.0 + 1e-13), "{name} {model}: {near:?}");
            }
        }
    }

    #[test]
    fn opacity_is_the_same_from_behind(
        transfer in any_transfer(), front in -0.2..1.2f64, back in -0.2..1.2f64, length in any_length(),
    ) {
        for (name, method, model) in all() {
            let here = method(&transfer, model, &segment(front, back, length)).opacity;
            let behind = method(&transfer, model, &segment(back, front, length)).opacity;
            prop_assert!((here - behind).abs() <= 1e-14 * here, "{name} {model}: {here} {behind}");
        }
    }

    #[test]
    fn halves_compose_where_the_assumption_holds(
        ends in prop::array::uniform2(0.0..30.0f64), color in prop::array::uniform2(0.0..1.0f64),
        front in 0.0..1.0f64, back in 0.0..1.0f64, length in 0.0..2.0f64,
    ) {
        let middle = 0.5 * (front + back);
        let halves = |method: Method, transfer: &TransferFunction, model| {
            let near = method(transfer, model, &segment(front, middle, 0.5 * length));
            near.over(method(transfer, model, &segment(middle, back, 0.5 * length)))
        };
        let white = [[0.0, 0.3, 0.6, 1.0]];
        let linear = [[0.0, color[0], 0.0, 1.0], [1.0, color[1], 0.5, 0.0]];
        let rho = [[0.0, ends[0]], [1.0, ends[1]]];
        let whole = segment(front, back, length);
        for (name, method, model) in all() {
            // One color under a linear extinction for what glows as it absorbs, and the other way round.
            let transfer = match model {
                OpticalModel::Emitter => TransferFunction::new(&white, &rho[..1]),
                OpticalModel::Emission => TransferFunction::new(&linear, &rho),
                OpticalModel::DensityEmitter | OpticalModel::Absorption => TransferFunction::new(&white, &rho),
            };
            let transfer = transfer.unwrap();
            let difference = largest_difference(method(&transfer, model, &whole), halves(method, &transfer, model));
            prop_assert!(difference < 1e-13, "{name} {model}: {difference:e}");
        }
        // Both linear: the closed form, and the table within its own error, three times.
        let transfer = TransferFunction::new(&linear, &rho).unwrap();
        for model in [OpticalModel::DensityEmitter, OpticalModel::Absorption, OpticalModel::Emission] {
            let [of_exact, of_partial] = [exact as Method, partial].map(|method| {
                largest_difference(method(&transfer, model, &whole), halves(method, &transfer, model))
            });
            prop_assert!(of_exact < 1e-13, "{model}: {of_exact:e}");
            prop_assert!(of_partial < 4e-4, "{model}: {of_partial:e}");
        }
        // The integral over the scalar keeps the opacity of any transfer function.
        let model = OpticalModel::Absorption;
        let difference = cumulative(&transfer, model, &whole).opacity - halves(cumulative, &transfer, model).opacity;
        prop_assert!(difference.abs() <= 1e-14, "{difference:e}");
    }

    #[test]
    fn thin_segments_are_proportional_to_their_length(
        transfer in any_transfer(), front in 0.0..1.0f64, back in 0.0..1.0f64, exponent in -200.0..-12.0f64,
    ) {
        let length = 10f64.powf(exponent);
        for (name, method, model) in all() {
            let [once, twice] = [1.0, 2.0].map(|factor| method(&transfer, model, &segment(front, back, factor * length)));
            // Depths up to 8e-11: what the second order takes off.
            let close = |once: f64, twice: f64| (twice - 2.0 * once).abs() <= 1e-10 * twice;
            prop_assert!(close(once.opacity, twice.opacity), "{name} {model}: {once:?} {twice:?}");
            prop_assert!((0..3).all(|c| close(once.rgb[c], twice.rgb[c])), "{name} {model}: {once:?} {twice:?}");
        }
    }

    #[test]
    fn deep_segments_are_opaque(
        color in prop::array::uniform2(0.0..1.0f64), ends in prop::array::uniform2(0.1..30.0f64),
        front in 0.0..1.0f64, back in 0.0..1.0f64, exponent in 4.0..300.0f64,
    ) {
        let color = [[0.0, color[0], 0.5, 0.0], [1.0, color[1], 0.5, 1.0]];
        let transfer = TransferFunction::new(&color, &[[0.0, ends[0]], [1.0, ends[1]]]).unwrap();
        let here = segment(front, back, 10f64.powf(exponent));
        for (name, method, model) in all() {
            let light = method(&transfer, model, &here);
            prop_assert_eq!(light.opacity, if model.needs_extinction() { 1.0 } else { 0.0 });
            if model == OpticalModel::DensityEmitter {
                prop_assert!((light.rgb[1] - 0.5).abs() <= 1e-14, "{name}: {light:?}");
            }
        }
        // Nothing but the front is seen, by those that know where it is.
        let expected = transfer.color(front);
        for (method, most) in [(exact as Method, 1e-2), (partial, 1e-2)] {
            let light = method(&transfer, OpticalModel::DensityEmitter, &here);
            prop_assert!(light.rgb.iter().zip(expected).all(|(got, color)| (got - color).abs() <= most), "{light:?}");
        }
    }

    #[test]
    fn nearly_equal_scalars_give_the_value_there(transfer in any_transfer(), s in 0.0..1.0f64, length in 0.0..2.0f64) {
        prop_assume!(transfer.pieces_between(s - 1e-12, s + 1e-12).len() == 1);
        for (name, method, model) in all() {
            let here = method(&transfer, model, &segment(s, s, length));
            // Without any approximation: one extinction, one color.
            let known = exact(&transfer, model, &segment(s, s, length));
            let most = if name == Integration::Partial { 2e-4 } else { 1e-14 * unit(model, length) };
            prop_assert!(largest_difference(here, known) <= most, "{name} {model}: {here:?} {known:?}");
            for near in [s.next_up(), s.next_down(), s + 1e-14] {
                let near = method(&transfer, model, &segment(s, near, length));
                prop_assert!(largest_difference(here, near) < 1e-10, "{name} {model}: {here:?} {near:?}");
            }
        }
    }

    #[test]
    fn no_finite_input_gives_nan(
        transfer in wild_transfer(), front in any_number(), back in any_number(), length in any_magnitude(),
    ) {
        // The emitter with `partial` too: refused for its meaning, not for its numbers.
        for (name, method) in METHODS {
            for model in OpticalModel::ALL {
                let light = method(&transfer, model, &segment(front, back, length));
                prop_assert!((0.0..=1.0).contains(&light.opacity), "{name} {model}: {light:?}");
                // What is too bright for a float is infinite.
                prop_assert!(light.rgb.iter().all(|&channel| channel >= 0.0), "{name} {model}: {light:?}");
            }
        }
    }
}
