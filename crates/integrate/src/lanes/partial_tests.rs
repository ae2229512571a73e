//! The table in eight lanes against the table and against the closed form.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::weights::weights_f64;

fn weights(level: Level, front: [f32; 8], back: [f32; 8]) -> [Weights<f32>; 8] {
    let [front, back, transmittance] = dispatch!(level, simd => {
        let weights = partial_weights(simd, front.simd_into(simd), back.simd_into(simd));
        [weights.front, weights.back, weights.transmittance].map(<[f32; 8]>::from)
    });
    core::array::from_fn(|lane| Weights { front: front[lane], back: back[lane], transmittance: transmittance[lane] })
}

#[test]
fn lanes_agree_with_the_table() {
    for (name, level) in [("best", Level::new()), ("baseline", Level::baseline())] {
        let (mut from_table, mut from_known, mut from_opacity) = (0.0f64, 0.0f64, 0.0f64);
        for i in 0..8192u32 {
            let pair = |lane: u32| {
                let fraction = |step: f64| (f64::from(8 * i + lane) * step).fract();
                let tau = 10f64.powf(18.0 * fraction(0.754_877_666) - 12.0);
                let part = 1.02 * fraction(0.569_840_291) - 0.01;
                let part = part.clamp(0.0, 1.0);
                [2.0 * tau * part, 2.0 * tau * (1.0 - part)].map(|depth| depth as f32)
            };
            let pairs: [[f32; 2]; 8] = core::array::from_fn(|lane| pair(lane as u32));
            let got = weights(level, pairs.map(|pair| pair[0]), pairs.map(|pair| pair[1]));
            for (got, [a, b]) in got.iter().zip(pairs) {
                let (a, b) = (f64::from(a), f64::from(b));
                let (table, known) = (PsiTable::shared().weights(a, b), weights_f64(a, b));
                let opacity = -(-0.5 * (a + b)).exp_m1();
                let front = f64::from(got.front);
                assert!(got.front >= 0.0 && got.back >= 0.0);
                from_table = from_table.max((front - table.front).abs() / opacity);
                from_known = from_known.max((front - known.front).abs() / opacity);
                from_opacity = from_opacity.max((front + f64::from(got.back) - opacity).abs() / opacity);
                assert!((f64::from(got.transmittance) - known.transmittance).abs() < 3e-7);
            }
        }
        println!("{name}: {from_table:.1e} from the table, {from_known:.1e} from psi, {from_opacity:.1e} in the sum");
        // Coordinates along the axes are rounded to 1e-5 of an entry; entries differ by up to a few hundredths.
        assert!(from_table < 2e-6 && from_known < 6e-4 && from_opacity < 3e-7, "{name}");
    }
}

#[test]
fn nothing_and_infinity_are_in_the_table() {
    for level in [Level::new(), Level::baseline()] {
        let tiny = f32::from_bits(1);
        let front = [0.0, f32::INFINITY, 0.0, f32::INFINITY, f32::MAX, tiny, 0.0, 1.0];
        let back = [0.0, 0.0, f32::INFINITY, f32::INFINITY, f32::MAX, 0.0, tiny, 1.0];
        let got = weights(level, front, back);
        // Empty cells send nothing and hide nothing.
        assert_eq!(got[0], Weights { front: 0.0, back: 0.0, transmittance: 1.0 });
        for weights in &got[1..5] {
            assert!((weights.front - 1.0).abs() < 4e-5 && weights.back < 4e-5 && weights.transmittance == 0.0);
        }
        for weights in &got[5..7] {
            assert!(weights.front <= f32::MIN_POSITIVE && weights.back <= f32::MIN_POSITIVE);
        }
        // A NaN stays in its lane, and indexes nothing.
        let mut spoiled = front;
        spoiled[7] = f32::NAN;
        let beside = weights(level, spoiled, back);
        assert_eq!(got[..7], beside[..7]);
    }
}
