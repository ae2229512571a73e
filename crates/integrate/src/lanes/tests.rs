//! Eight lanes against the 64-bit forms, at every level at hand.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::weights::tests::{error, ladder, widened};
use crate::weights::{emitter_weights_f64, weights_f32, weights_f64};

fn levels() -> [(&'static str, Level); 2] {
    [("best", Level::new()), ("baseline", Level::baseline())]
}

/// Applies a function of two vectors to all pairs, eight at a time; the last vector is filled up with zeros.
macro_rules! in_lanes {
    ($level:expr, $function:ident, $pairs:expr) => {{
        let mut all = Vec::new();
        for chunk in $pairs.chunks(8) {
            let (mut a, mut b) = ([0.0f32; 8], [0.0f32; 8]);
            for (lane, pair) in chunk.iter().enumerate() {
                (a[lane], b[lane]) = *pair;
            }
            let weights = dispatch!($level, simd => {
                let weights = $function(simd, a.simd_into(simd), b.simd_into(simd));
                Weights::<[f32; 8]> {
                    front: weights.front.into(),
                    back: weights.back.into(),
                    transmittance: weights.transmittance.into(),
                }
            });
            for lane in 0..chunk.len() {
                let [front, back] = [weights.front[lane], weights.back[lane]];
                all.push(Weights { front, back, transmittance: weights.transmittance[lane] });
            }
        }
        all
    }};
}

/// The ladder in 32 bits, by depth, so that most vectors take one path, and shuffled, so that they take all.
fn pairs() -> Vec<(f32, f32)> {
    let ordered: Vec<_> = ladder().map(|(a, b)| (a as f32, b as f32)).collect();
    let shuffled: Vec<_> = (0..ordered.len()).map(|i| ordered[(i * 7919) % ordered.len()]).collect();
    // Between 1 and 8 the steps of the ladder are coarse for the number of parts.
    let fine = (0..4000u32).map(|i| {
        let (tau, skew) = (0.9 + 0.002 * f64::from(i), f64::from(i * 37 % 101) / 50.0 - 1.0);
        ((tau * (1.0 - skew)) as f32, (tau * (1.0 + skew)) as f32)
    });
    ordered.into_iter().chain(shuffled).chain(fine).collect()
}

#[test]
fn weights_are_good_to_3e_7_of_the_opacity() {
    let pairs = pairs();
    for (name, level) in levels() {
        let mut worst = [[0.0f64; 3]; 2];
        let density_emitter = in_lanes!(level, density_emitter_weights, pairs);
        let emitter = in_lanes!(level, emitter_weights, pairs);
        for (i, &(a, b)) in pairs.iter().enumerate() {
            let (a, b) = (f64::from(a), f64::from(b));
            let (known, known_emitter) = (weights_f64(a, b), emitter_weights_f64(a, b));
            let range = if a + b <= 2.0 {
                0
            } else if a + b <= 16.0 {
                1
            } else {
                2
            };
            for (model, got, known) in [(0, density_emitter[i], known), (1, emitter[i], known_emitter)] {
                assert!(got.front >= 0.0 && got.back >= 0.0 && got.transmittance >= 0.0, "{a} {b}: {got:?}");
                let error = error(widened(got), known.front, known.back, known.transmittance);
                worst[model][range] = worst[model][range].max(error);
            }
        }
        for (model, [thin, split, deep]) in [("density emitter", worst[0]), ("emitter", worst[1])] {
            println!("{name}, {model}: up to 1 {thin:.2e}, up to 8 {split:.2e}, deeper {deep:.2e}");
        }
        assert!(worst.iter().flatten().all(|&error| error < 3e-7), "{name}: {worst:?}");
    }
}

#[test]
fn thin_lanes_do_not_depend_on_their_neighbors() {
    // A thin lane beside ever deeper ones.
    for (_, level) in levels() {
        for deep in [0.0, 0.9, 1.1, 3.0, 7.9, 8.1, 100.0, 1e30, f32::INFINITY] {
            let mut pairs = [(0.3, 0.1); 8];
            pairs[5] = (deep, 0.5 * deep);
            let got = in_lanes!(level, density_emitter_weights, pairs);
            let alone = in_lanes!(level, density_emitter_weights, [(0.3, 0.1)]);
            assert_eq!((got[0], got[7]), (alone[0], alone[0]), "{deep}");
            let known = weights_f32(deep, 0.5 * deep);
            assert!((got[5].front - known.front).abs() < 4e-7, "{deep}: {got:?}");
        }
        let got = in_lanes!(level, emitter_weights, [(f32::INFINITY, 0.0), (0.0, 0.0)]);
        assert!(got[0].front <= f32::MIN_POSITIVE && got[0].back == 0.0 && got[0].transmittance == 0.0, "{got:?}");
        assert!((got[1].front - 0.5).abs() < 1e-7 && (got[1].transmittance - 1.0).abs() < 2e-7);
        // No depth: no color at all, not nearly none.
        let got = in_lanes!(level, density_emitter_weights, [(0.0, 0.0), (20.0, 20.0)]);
        assert_eq!((got[0].front, got[0].back), (0.0, 0.0));
    }
}

#[test]
fn exponentials_are_good_to_2_ulp_and_opacities_to_themselves() {
    let depths: Vec<f32> = (0..200_000u32)
        .map(|i| 10f64.powf(f64::from(i) / 200_000.0 * 18.0 - 12.0) as f32)
        .chain((0..8800u32).map(|i| i as f32 * 0.01))
        .collect();
    for (name, level) in levels() {
        let (mut worst_ulp, mut worst_opacity) = (0.0f64, 0.0f64);
        for chunk in depths.chunks_exact(8) {
            let (exponentials, opacities, transmittances) = dispatch!(level, simd => {
                let x = f32x8::from_slice(simd, chunk);
                let (opacity, transmittance) = opacity_transmittance(simd, x);
                (exp_negative(simd, x).to_array(), opacity.to_array(), transmittance.to_array())
            });
            for (lane, &x) in chunk.iter().enumerate() {
                let known = (-f64::from(x)).exp();
                for got in [exponentials[lane], transmittances[lane]] {
                    if known >= f64::from(f32::MIN_POSITIVE) {
                        let nearest = known as f32;
                        let ulp = f64::from(nearest.next_up() - nearest);
                        worst_ulp = worst_ulp.max((f64::from(got) - known).abs() / ulp);
                    } else {
                        assert!((0.0..=f32::MIN_POSITIVE).contains(&got), "{x}: {got}");
                    }
                }
                let known = -(-f64::from(x)).exp_m1();
                if known > 0.0 {
                    worst_opacity = worst_opacity.max((f64::from(opacities[lane]) / known - 1.0).abs());
                }
            }
        }
        println!("{name}: exponential {worst_ulp:.2} ulp, opacity {worst_opacity:.2e}");
        assert!(worst_ulp < 2.0 && worst_opacity < 3e-7, "{name}: {worst_ulp} {worst_opacity:e}");
        let (opacity, transmittance) = dispatch!(level, simd => {
            let (opacity, transmittance) = opacity_transmittance(simd, f32x8::splat(simd, f32::INFINITY));
            (opacity[0], transmittance[0])
        });
        assert_eq!((opacity, transmittance), (1.0, 0.0));
    }
}
