//! Weights against 150-digit values, each other, and the properties of the integral.

#![expect(clippy::excessive_precision, reason = "known values keep the digits they were computed with")]

use proptest::prelude::*;

use super::*;

/// `a`, `b`, the density emitter's front and back weight, transmittance, the emitter's front and back weight.
const KNOWN: [[f64; 7]; 21] = [
    [0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.5],
    [
        1e-12,
        3e-12,
        8.33333333332816684e-13,
        1.16666666666518338e-12,
        0.999999999998,
        0.49999999999975,
        0.499999999999416667,
    ],
    [
        1e-06,
        0.0,
        3.33333266666676175e-7,
        1.66666608333344635e-7,
        0.999999500000125,
        0.499999875000020833,
        0.4999997916667125,
    ],
    [
        0.0,
        1e-06,
        1.66666641666669635e-7,
        3.33333233333351175e-7,
        0.999999500000125,
        0.4999999583333375,
        0.499999875000020833,
    ],
    [
        0.25,
        0.75,
        0.179578401013950873,
        0.213890939273415703,
        0.606530659712633424,
        0.443693717904340537,
        0.376727881081708589,
    ],
    [
        0.75,
        0.25,
        0.244914076712425184,
        0.148555263574941393,
        0.606530659712633424,
        0.409395718930945745,
        0.345690204356629072,
    ],
    [
        0.0,
        1.9999999,
        0.253175857713955553,
        0.378944682720629597,
        0.367879459565414851,
        0.430763856265737562,
        0.316060286020306885,
    ],
    [
        0.0,
        2.5,
        0.297576568603033127,
        0.415918634536776773,
        0.2865047968601901,
        0.417025350141042913,
        0.28539808125592396,
    ],
    [
        2.5,
        0.0,
        0.531990137728589556,
        0.181505065411220344,
        0.2865047968601901,
        0.28539808125592396,
        0.182611781015486484,
    ],
    [
        1.5,
        1.5,
        0.482086773432286553,
        0.294783066419283618,
        0.223130160148429829,
        0.321391182288191035,
        0.196522044279522412,
    ],
    [
        1.5,
        1.5000000000000002,
        0.482086773432286565,
        0.294783066419283631,
        0.223130160148429804,
        0.321391182288191031,
        0.196522044279522404,
    ],
    [
        3.0,
        3.000001,
        0.683262377485949365,
        0.266950579039714656,
        0.049787043474335979,
        0.227754110409696263,
        0.0889835121043543718,
    ],
    [
        3.000001,
        3.0,
        0.683262423742805586,
        0.266950532782858435,
        0.049787043474335979,
        0.227754080748525557,
        0.0889834955086688562,
    ],
    [
        1.0,
        20.0,
        0.758369051708603157,
        0.241603411842047096,
        0.0000275364493497471579,
        0.201718236961962453,
        0.03991271132943439,
    ],
    [
        20.0,
        1.0,
        0.947153721047581588,
        0.0528187425030686648,
        0.0000275364493497471579,
        0.0498487465578016758,
        0.00299753239461673615,
    ],
    [
        700.0,
        100.0,
        0.998569672834714378,
        0.00143032716528562164,
        1.9151695967140057e-174,
        0.00142827880578572973,
        2.04835949989191353e-6,
    ],
    [0.0, 1e6, 0.9987466858626845, 0.00125331413731550025, 0.0, 0.00125231413731550025, 1.0e-6],
    [1e6, 0.0, 0.999998999998999997, 1.00000100000300002e-6, 0.0, 1.0e-6, 1.00000300001500011e-12],
    [1e6, 1e6, 0.999999, 1.0e-6, 0.0, 9.99999e-7, 1.0e-12],
    [1e-3, 1e12, 0.999998746685863684, 1.25331413631550088e-6, 0.0, 1.25331313631550213e-6, 9.99999998746686864e-13],
    [1e12, 1e-3, 0.999999999999, 1.000000000001e-12, 0.0, 1.0e-12, 1.000000000003e-24],
];

/// Largest error of a weight relative to the sum of both, and of the transmittance relative to 1.
pub(crate) fn error(got: Weights<f64>, front: f64, back: f64, transmittance: f64) -> f64 {
    let sum = front + back;
    let weights = (got.front - front).abs().max((got.back - back).abs());
    let weights = if sum == 0.0 { weights } else { weights / sum };
    weights.max((got.transmittance - transmittance).abs())
}

pub(crate) fn widened(weights: Weights<f32>) -> Weights<f64> {
    Weights {
        front: f64::from(weights.front),
        back: f64::from(weights.back),
        transmittance: f64::from(weights.transmittance),
    }
}

#[test]
fn known_values_f64() {
    let mut worst = [0.0f64; 2];
    for [a, b, front, back, transmittance, emitter_front, emitter_back] in KNOWN {
        let errors = [
            error(weights_f64(a, b), front, back, transmittance),
            error(emitter_weights_f64(a, b), emitter_front, emitter_back, transmittance),
        ];
        assert!(errors[0] < 4e-15 && errors[1] < 4e-15, "{a} {b}: {errors:?}");
        worst = [worst[0].max(errors[0]), worst[1].max(errors[1])];
    }
    println!("density emitter {:.1e}, emitter {:.1e}", worst[0], worst[1]);
}

#[test]
fn infinite_depth_shows_the_front_alone() {
    let opaque = Weights { front: 1.0, back: 0.0, transmittance: 0.0 };
    let infinity = f64::INFINITY;
    for (a, b) in
        [(infinity, 0.0), (0.0, infinity), (infinity, infinity), (1.7e308, 1.7e308), (1e308, 0.0), (0.0, 1e308)]
    {
        let got = weights_f64(a, b);
        assert!((got.front - 1.0).abs() < 1e-15 && got.back < 1e-100 && got.transmittance == 0.0, "{a} {b}: {got:?}");
        let got = emitter_weights_f64(a, b);
        assert!(got.front >= 0.0 && got.front < 1e-100 && (0.0..1e-100).contains(&got.back), "{a} {b}: {got:?}");
    }
    assert_eq!(weights_f32(f32::INFINITY, 0.0), rounded(opaque));
    assert_eq!(weights_f32(0.0, f32::INFINITY), rounded(opaque));
    assert!(weights_f64(f64::NAN, 1.0).front.is_nan() && emitter_weights_f64(1.0, f64::NAN).back.is_nan());
}

/// Optical depths and ratios of the ends, evenly over their exponents, with equal and one-sided ends among them.
pub(crate) fn ladder() -> impl Iterator<Item = (f64, f64)> {
    let depths = (-120..=60).map(|exponent| 10f64.powf(f64::from(exponent) / 10.0));
    depths.flat_map(|tau| {
        let near = (-16..0).map(|exponent| 10f64.powi(exponent));
        let skews = near.clone().chain(near.map(|skew| 1.0 - skew)).chain([0.0, 0.3, 0.5, 0.77, 1.0]);
        skews.flat_map(move |skew| {
            let (small, large) = (tau * (1.0 - skew), tau * (1.0 + skew));
            [(small, large), (large, small)]
        })
    })
}

#[test]
fn weights_f32_are_good_to_3e_7_of_the_opacity() {
    let mut worst = [0.0f64; 2];
    for (a, b) in ladder() {
        let (a, b) = (a as f32, b as f32);
        let (known_a, known_b) = (f64::from(a), f64::from(b));
        let known = weights_f64(known_a, known_b);
        worst[0] = worst[0].max(error(widened(weights_f32(a, b)), known.front, known.back, known.transmittance));
        let known = emitter_weights_f64(known_a, known_b);
        let got = widened(emitter_weights_f32(a, b));
        worst[1] = worst[1].max(error(got, known.front, known.back, known.transmittance));
    }
    println!("density emitter {:.2e}, emitter {:.2e}", worst[0], worst[1]);
    assert!(worst[0] < 3e-7 && worst[1] < 3e-7, "{worst:?}");
}

/// Positions and weights of the Gauss-Legendre rule with `N` points on 0 to 1, by Newton's method.
fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    core::array::from_fn(|i| {
        let mut x = (core::f64::consts::PI * (i as f64 + 0.75) / (N as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..50 {
            let (mut before, mut value) = (1.0, x);
            for n in 2..=N {
                let n = n as f64;
                (before, value) = (value, ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n);
            }
            slope = N as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// The transport integral itself, by 64 points on many equal parts.
fn by_quadrature(a: f64, b: f64, parts: u32) -> [f64; 4] {
    let rule = gauss_legendre::<64>();
    let mut sums = [0.0; 4];
    for part in 0..parts {
        for (position, weight) in rule {
            let u = (f64::from(part) + position) / f64::from(parts);
            let (rate, weight) = (a + (b - a) * u, weight / f64::from(parts));
            let seen = (-(a * u + 0.5 * (b - a) * u * u)).exp() * weight;
            let terms = [seen * rate * (1.0 - u), seen * rate * u, seen * (1.0 - u), seen * u];
            sums = core::array::from_fn(|i| sums[i] + terms[i]);
        }
    }
    sums
}

#[test]
fn weights_f64_agree_with_quadrature() {
    let mut worst = 0.0f64;
    let ends = [0.0, 1e-12, 1e-5, 0.01, 0.3, 0.999, 1.0, 1.001, 2.0, 5.0, 17.0, 60.0, 250.0, 1500.0];
    for a in ends {
        for b in ends {
            let [front, back, emitter_front, emitter_back] = by_quadrature(a, b, 48);
            let transmittance = (-0.5 * (a + b)).exp();
            worst = worst.max(error(weights_f64(a, b), front, back, transmittance));
            worst = worst.max(error(emitter_weights_f64(a, b), emitter_front, emitter_back, transmittance));
            assert!(worst < 1e-13, "{a} {b}: {worst:e}");
        }
    }
    println!("largest difference to quadrature {worst:.1e}");
}

#[test]
fn series_and_closed_form_meet() {
    for skew in [0.0, 1e-15, 1e-9, 1e-3, 0.5, 1.0, -1e-15, -1e-9, -0.5, -1.0] {
        let (a, b) = (1.0 - skew, 1.0 + skew);
        let Moments { psi, psi1, transmittance } = moments(a, b);
        let series = series::density_emitter_f64(a, b);
        assert!(error(series, 1.0 - psi, psi - transmittance, transmittance) < 4e-15, "{skew}");
        let series = series::emitter_f64(a, b);
        assert!(error(series, psi - psi1, psi1, transmittance) < 2e-14, "{skew}: {series:?} {psi1}");
    }
}

fn depth() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), (-12.0..6.0f64).prop_map(|exponent| 10f64.powf(exponent)), 0.0..4.0f64]
}

proptest! {
    #[test]
    fn weights_are_bounded_and_sum_to_the_opacity(a in depth(), b in depth()) {
        let got = weights_f64(a, b);
        let opacity = -(-0.5 * (a + b)).exp_m1();
        prop_assert!(got.front >= 0.0 && got.back >= 0.0 && got.front <= 1.0 && got.back <= 1.0);
        prop_assert!((got.front + got.back - opacity).abs() <= 1e-15 + 4e-15 * opacity);
        prop_assert!((got.front + got.back - opacity).abs() <= 4e-15 * opacity);
        let got = emitter_weights_f64(a, b);
        prop_assert!(got.front >= got.back && got.back >= 0.0 && got.front <= 0.5 + 1e-15);
        // The density emitter's weights by the emitter's: the emission is the extinction times the color there.
        let constant_color = a * got.front + b * got.back;
        prop_assert!((constant_color - opacity).abs() <= 1e-13 * opacity, "{} {}", constant_color, opacity);
    }

    #[test]
    fn opacity_grows_with_either_end(a in depth(), b in depth(), more in depth()) {
        let sum = |weights: Weights<f64>| weights.front + weights.back;
        let least = sum(weights_f64(a, b)) * (1.0 - 8e-15);
        prop_assert!(sum(weights_f64(a + more, b)) >= least && sum(weights_f64(a, b + more)) >= least);
    }

    #[test]
    fn a_nearly_equal_end_changes_nearly_nothing(a in depth()) {
        let (equal, above) = (weights_f64(a, a), weights_f64(a, a.next_up()));
        prop_assert!(error(above, equal.front, equal.back, equal.transmittance) < 1e-14);
        let (equal, above) = (emitter_weights_f64(a, a), emitter_weights_f64(a, a.next_up()));
        prop_assert!(error(above, equal.front, equal.back, equal.transmittance) < 1e-14);
    }
}
