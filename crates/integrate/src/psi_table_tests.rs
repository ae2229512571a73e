//! The table's error by depth, what it does at the ends of its axes, and the method on top of it.

use proptest::prelude::*;

use super::*;
use crate::exact;

/// Upper bounds of the ranges of depths in the module's table of errors.
const RANGES: [f64; 5] = [1e-2, 1.0, 30.0, 1e4, 1e12];

/// Depths of the ends, by the logarithm of their mean and with all balances, those near the ends of the axis included.
fn ladder() -> impl Iterator<Item = (usize, f64, f64)> {
    (0..=800u32).flat_map(|i| {
        let tau = 10f64.powf(0.02 * f64::from(i) - 4.0);
        let range = RANGES.iter().position(|&most| tau <= most * (1.0 + 1e-12)).unwrap();
        (0..=300u32).map(move |j| {
            let part = match j {
                0..=100 => 0.01 * f64::from(j),
                101..=200 => 10f64.powf(-0.06 * f64::from(j - 100)),
                _ => 1.0 - 10f64.powf(-0.06 * f64::from(j - 200)),
            };
            (range, 2.0 * tau * part, 2.0 * tau * (1.0 - part))
        })
    })
}

/// Largest error of the front's weight over the opacity, for each range.
fn errors(front: impl Fn(f64, f64) -> f64) -> [f64; 5] {
    let mut worst = [0.0f64; 5];
    for (range, a, b) in ladder() {
        let opacity = -(-0.5 * (a + b)).exp_m1();
        worst[range] = worst[range].max((front(a, b) - weights_f64(a, b).front).abs() / opacity);
    }
    worst
}

/// The published table: psi over gamma of both ends, samples at `i / size`, 32 bits.
fn table_of_psi(size: usize) -> impl Fn(f64, f64) -> f64 {
    let depth = move |i: usize| i as f64 / (size - i) as f64;
    let entries: Vec<f32> =
        (0..size * size).map(|i| (1.0 - weights_f64(depth(i / size), depth(i % size)).front) as f32).collect();
    move |a: f64, b: f64| {
        let [(i, down), (j, right)] = [a, b].map(|tau| {
            let place = (tau / (1.0 + tau) * size as f64).min((size - 1) as f64);
            let index = (place as usize).min(size - 2);
            (index, place - index as f64)
        });
        let [above, below] = [i, i + 1].map(|row| {
            let [left, next] = [j, j + 1].map(|column| f64::from(entries[row * size + column]));
            left + (next - left) * right
        });
        above + (below - above) * down
    }
}

#[test]
fn the_share_is_better_than_psi_itself() {
    let ours = errors(|a, b| PsiTable::shared().weights(a, b).front);
    println!("share: {:?}", ours.map(|error| format!("{error:.1e}")));
    let promised = [1e-5, 3e-5, 7e-5, 1.3e-4, 6e-4];
    assert!(ours.iter().zip(promised).all(|(error, promised)| *error < promised), "{ours:?}");
    for size in [128, 512] {
        let table = table_of_psi(size);
        let theirs = errors(|a, b| 1.0 - table(a, b));
        println!("psi {size} x {size}: {:?}", theirs.map(|error| format!("{error:.1e}")));
        // A fifteenth of the bytes and less, and better where it matters: in thin cells and in opaque ones.
        assert!(theirs[0] > 50.0 * ours[0] && theirs[3] > 100.0 * ours[3], "{theirs:?}");
    }
    assert_eq!(size_of_val(PsiTable::shared().entries()), 16_770);
}

#[test]
fn the_ends_of_the_axes_are_known() {
    let table = PsiTable::shared();
    // Not nearly 1: empty cells send nothing.
    assert_eq!(table.psi(0.0, 0.0), 1.0);
    let Weights { front, back, transmittance } = table.weights(0.0, 0.0);
    assert_eq!((front, back, transmittance), (0.0, 0.0, 1.0));
    for (a, b) in [(f64::INFINITY, 0.0), (0.0, f64::INFINITY), (f64::INFINITY, f64::INFINITY), (f64::MAX, f64::MAX)] {
        assert!(table.psi(a, b) < 4e-5, "{a} {b}");
        let Weights { front, back, transmittance } = table.weights(a, b);
        assert!((front - 1.0).abs() < 4e-5 && back.abs() < 4e-5 && transmittance == 0.0, "{a} {b}");
    }
    for tiny in [f64::MIN_POSITIVE, f64::from_bits(1), 1e-320] {
        for (a, b) in [(tiny, 0.0), (0.0, tiny), (tiny, tiny)] {
            assert!((1.0 - table.psi(a, b)).abs() < 1e-300, "{a} {b}");
        }
    }
    assert!(table.psi(f64::NAN, 1.0).is_nan() && table.psi(1.0, f64::NAN).is_nan());
    // Psi falls as the root of the depth where the front is empty: the next-to-last sample of a table over gamma.
    for tau in [1e3, 1e5, 1e9, 1e15] {
        let known = (core::f64::consts::FRAC_PI_2 / tau).sqrt();
        assert!((table.psi(0.0, tau) - known).abs() < 1.3e-4, "{tau}");
    }
}

#[test]
fn thin_segments_are_exact() {
    for (a, b) in [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.7, 0.1)] {
        for scale in [1e-6, 1e-12, 1e-100, 1e-300] {
            let (a, b): (f64, f64) = (a * scale, b * scale);
            let weights = PsiTable::shared().weights(a, b);
            let (front, back) = ((2.0 * a + b) / 6.0, (a + 2.0 * b) / 6.0);
            let opacity = 0.5 * (a + b);
            // The table's first cell adds less than the depth itself.
            let most = (scale + 1e-14) * opacity;
            assert!((weights.front - front).abs() < most && (weights.back - back).abs() < most, "{a:e} {b:e}");
        }
    }
}

#[test]
fn ends_of_another_color_count_as_psi_says() {
    // Extinction 8 s and a color that equals s: the known weights for end depths 0 and 2.5.
    let transfer = TransferFunction::new(&[[0.0; 4], [1.0; 4]], &[[0.0, 0.0], [1.0, 8.0]]).unwrap();
    let segment = Segment { scalar_front: 0.0, scalar_back: 1.0, chord_length: 0.3125 };
    let light = partial(&transfer, OpticalModel::DensityEmitter, &segment);
    assert!((light.rgb[0] - 0.415_918_634_536_776_8).abs() < 5e-5, "{light:?}");
    assert!((light.opacity - (1.0 - 0.286_504_796_860_190_1)).abs() < 1e-15);
}

proptest! {
    #[test]
    fn weights_are_shares_of_the_opacity(
        exponents in prop::array::uniform2(-320.0..320.0f64), zero in 0..8u32,
    ) {
        let [a, b] = exponents.map(|exponent| 10f64.powf(exponent));
        let (a, b) = (if zero == 0 { 0.0 } else { a }, if zero == 1 { 0.0 } else { b });
        let table = PsiTable::shared();
        let Weights { front, back, transmittance } = table.weights(a, b);
        let opacity = -(-(0.5 * a + 0.5 * b)).exp_m1();
        prop_assert!(front >= 0.0 && back >= 0.0 && (0.0..=1.0).contains(&transmittance));
        prop_assert!((front + back - opacity).abs() <= 1e-15 * opacity);
        prop_assert!((0.0..=1.0).contains(&table.psi(a, b)));
        let most = if a + b < 2e4 { 1.3e-4 } else { 6e-4 };
        // Below the smallest normal number there are few digits to be relative to.
        let difference = (front - weights_f64(a, b).front).abs();
        prop_assert!(difference <= most * opacity + 1e-322, "{difference:e} of {opacity:e}");
    }

    #[test]
    fn partial_is_exact_where_the_transfer_function_is_linear(
        color in prop::array::uniform2(0.0..2.0f64), extinction in prop::array::uniform2(0.0..50.0f64),
        front in 0.0..1.0f64, back in 0.0..1.0f64, length in 0.0..3.0f64,
    ) {
        let color = [[0.0, color[0], 0.5, 0.0], [1.0, color[1], 0.5, 0.0]];
        let transfer = TransferFunction::new(&color, &[[0.0, extinction[0]], [1.0, extinction[1]]]).unwrap();
        let segment = Segment { scalar_front: front, scalar_back: back, chord_length: length };
        for model in [OpticalModel::DensityEmitter, OpticalModel::Absorption, OpticalModel::Emission] {
            let (known, got) = (exact(&transfer, model, &segment), partial(&transfer, model, &segment));
            prop_assert!((known.opacity - got.opacity).abs() <= 1e-14 * known.opacity);
            // The error of a weight is that of a color which differs by 1 between the ends.
            let most = 1.3e-4 * known.opacity * f64::abs(color[1][1] - color[0][1]) + 1e-13;
            prop_assert!((known.rgb[0] - got.rgb[0]).abs() <= most, "{model} {known:?} {got:?}");
            prop_assert!((known.rgb[1] - got.rgb[1]).abs() <= 1e-13);
        }
        // Psi is all that a constant color needs in the emitter model.
        let model = OpticalModel::Emitter;
        let (known, got) = (exact(&transfer, model, &segment), partial(&transfer, model, &segment));
        prop_assert!((known.rgb[1] - got.rgb[1]).abs() <= 0.5 * length * 1.3e-4 + 1e-13);
    }
}

#[test]
fn the_table_knows_its_error() {
    let table = PsiTable::shared();
    let [thin, deep] = [1.0, 1e4].map(|deepest| table.deviation(deepest, 20_000).unwrap());
    assert!(thin.largest < 2e-5 && thin.root_mean_square < thin.largest, "{thin:?}");
    assert!(deep.largest > thin.largest && deep.largest < 2e-4, "{deep:?}");
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(table.deviation(wrong, 10).is_err(), "{wrong}");
    }
}
