//! Sums over pieces against the 64-bit form, at every level at hand.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::{OpticalModel, RgbaAssoc, RunningIntegrals, Segment, TransferFunction};

fn transfers() -> [TransferFunction; 4] {
    let color = [[0.0, 0.1, 0.2, 0.9], [0.5, 0.9, 0.9, 0.8], [0.5, 0.1, 1.0, 0.8], [1.0, 0.9, 0.2, 0.8]];
    let noise = |i: u32| (f64::from(i * i) * 0.618_033_988_75).fract();
    let entries: Vec<_> = (0..64).map(|i| [f64::from(i) / 63.0, 10.0 * noise(i)]).collect();
    [
        vec![[0.0, 0.0], [1.0, 10.0]],
        vec![[0.2, 0.0], [0.25, 50.0], [0.3, 0.0], [0.6, 0.0], [0.6, 400.0], [0.7, 0.0]],
        vec![[0.4, 30.0], [0.4, 0.0]],
        entries,
    ]
    .map(|extinction| TransferFunction::new(&color, &extinction).unwrap())
}

/// Scalars of both ends and lengths, in 32 bits; flat segments and such without length are among them.
fn segments() -> Vec<[f32; 3]> {
    (0..4096u32)
        .map(|i| {
            let [front, back, third] = [0.819_172_513, 0.671_043_607, 0.549_700_478]
                .map(|step: f64| ((0.5 + f64::from(i) * step).fract() * 1.2 - 0.1) as f32);
            let back = if i % 7 == 0 { front } else { back };
            let length = if i % 11 == 0 { 0.0 } else { 10f32.powf(7.0 * third - 5.0) };
            [front, back, length]
        })
        .collect()
}

fn in_64_bits(&[front, back, length]: &[f32; 3]) -> Segment {
    let [scalar_front, scalar_back, chord_length] = [front, back, length].map(f64::from);
    Segment { scalar_front, scalar_back, chord_length }
}

/// Eight segments, cut at the control points as a renderer does it.
macro_rules! integrate {
    ($level:expr, $per_length:literal, $transfer:expr, $segments:expr) => {{
        let lanes: &[[f32; 3]] = $segments;
        let range = |lane: &[f32; 3]| [lane[0].min(lane[1]), lane[0].max(lane[1])].map(f64::from);
        let pieces: Vec<_> = $transfer
            .pieces()
            .iter()
            .map(|piece| {
                let (mut rho, mut color) = ([[0.0f32; 8]; 2], [[[0.0f32; 8]; 3]; 2]);
                let mut length = [0.0f32; 8];
                for (lane, segment) in lanes.iter().enumerate() {
                    let [lo, hi] = range(segment);
                    let (from, to) = (lo.max(piece.start), hi.min(piece.end));
                    let is_here =
                        if lo == hi { $transfer.piece_at(lo) == $transfer.piece_at(piece.start) } else { from < to };
                    let share = if lo == hi { 1.0 } else { (to - from) / (hi - lo) };
                    length[lane] = if is_here { segment[2] * share as f32 } else { 0.0 };
                    for (end, scalar) in [from, to].into_iter().enumerate() {
                        rho[end][lane] = piece.extinction_at(scalar) as f32;
                        for c in 0..3 {
                            color[end][c][lane] = piece.color_at(scalar)[c] as f32;
                        }
                    }
                }
                (rho, color, length)
            })
            .collect();
        let rises: [f32; 8] = core::array::from_fn(|lane| lanes[lane][1] - lanes[lane][0]);
        let (rgb, opacity) = dispatch!($level, simd => {
            let mut sums = Sums::<_, $per_length>::new(simd);
            for (rho, color, length) in &pieces {
                sums.add(simd, &Part {
                    extinction: rho.map(|lanes| lanes.simd_into(simd)),
                    color: color.map(|end| end.map(|lanes| lanes.simd_into(simd))),
                    length: (*length).simd_into(simd),
                });
            }
            let rises: f32x8<_> = rises.simd_into(simd);
            let (rgb, opacity) = sums.finish(simd, rises.simd_ge(0.0));
            (rgb.map(<[f32; 8]>::from), <[f32; 8]>::from(opacity))
        });
        (0..8).map(|lane| (rgb.map(|channel| channel[lane]), opacity[lane])).collect::<Vec<_>>()
    }};
}

fn check(got: &[([f32; 3], f32)], known: &[RgbaAssoc], most: impl Fn(usize) -> f64, worst: &mut [f64; 2]) {
    for (lane, ((rgb, opacity), known)) in got.iter().zip(known).enumerate() {
        let most = most(lane);
        for (got, known) in rgb.iter().zip(known.rgb) {
            assert!(got.is_finite() && *got >= 0.0);
            if most > 0.0 {
                worst[0] = worst[0].max((f64::from(*got) - known).abs() / most);
            } else {
                assert_eq!(*got, 0.0);
            }
        }
        worst[1] = worst[1].max((f64::from(*opacity) - known.opacity).abs());
    }
}

#[test]
fn sums_agree_with_the_means_in_64_bits() {
    let segments = segments();
    for (name, level) in [("best", Level::new()), ("baseline", Level::baseline())] {
        let (mut scattered, mut glowing) = ([0.0f64; 2], [0.0f64; 2]);
        for transfer in transfers() {
            let integrals = RunningIntegrals::new(&transfer);
            for lanes in segments.chunks_exact(8) {
                let known = |model| -> Vec<_> {
                    lanes.iter().map(|lane| integrals.integrate(model, &in_64_bits(lane))).collect()
                };
                let light = known(OpticalModel::DensityEmitter);
                let got = integrate!(level, false, transfer, lanes);
                check(&got, &light, |lane| light[lane].opacity, &mut scattered);
                let light = known(OpticalModel::Emitter);
                let got = integrate!(level, true, transfer, lanes);
                check(&got, &light, |lane| f64::from(lanes[lane][2]), &mut glowing);
            }
        }
        println!(
            "{name}: light {:.1e}, {:.1e} (emitter), opacity {:.1e}, {:.1e}",
            scattered[0], glowing[0], scattered[1], glowing[1]
        );
        assert!(scattered[0] < 4e-6 && glowing[0] < 4e-6, "{scattered:?} {glowing:?}");
        assert!(scattered[1] < 1e-6 && glowing[1] < 1e-6, "{scattered:?} {glowing:?}");
    }
}

/// Of parts deeper than squares can be, each counts by its depth, not all alike.
#[test]
fn deep_parts_count_by_their_depth() {
    let color = [[0.0, 0.1, 0.2, 0.9], [0.5, 0.9, 0.9, 0.8], [1.0, 0.2, 0.0, 0.1]];
    let transfer =
        TransferFunction::new(&color, &[[0.0, 1e9], [0.3, 4e9], [0.3, 2e10], [0.8, 1e8], [1.0, 3e9]]).unwrap();
    let integrals = RunningIntegrals::new(&transfer);
    let segments: Vec<[f32; 3]> =
        segments().iter().map(|&[front, back, length]| [front, back, length.max(1e-3)]).collect();
    for (_, level) in [("best", Level::new()), ("baseline", Level::baseline())] {
        let (mut scattered, mut glowing) = ([0.0f64; 2], [0.0f64; 2]);
        for lanes in segments.chunks_exact(8) {
            let known =
                |model| -> Vec<_> { lanes.iter().map(|lane| integrals.integrate(model, &in_64_bits(lane))).collect() };
            check(
                &integrate!(level, false, transfer, lanes),
                &known(OpticalModel::DensityEmitter),
                |_| 1.0,
                &mut scattered,
            );
            let light = known(OpticalModel::Emitter);
            let brightest = |lane: usize| light[lane].rgb.into_iter().fold(0.0, f64::max);
            check(&integrate!(level, true, transfer, lanes), &light, brightest, &mut glowing);
        }
        // An emitter's light is a difference here: what is dense shines through what is not.
        assert!(scattered[0] < 4e-6 && glowing[0] < 1e-3, "{scattered:?} {glowing:?}");
        assert!(scattered[1] == 0.0 && glowing[1] == 0.0, "{scattered:?} {glowing:?}");
    }
}

#[test]
fn extremes_stay_finite() {
    for (_, level) in [("best", Level::new()), ("baseline", Level::baseline())] {
        for extinction in [0.0, f32::MIN_POSITIVE, 1e-20, 1.0, 1e6, 1e20, f32::MAX] {
            for length in [0.0, f32::from_bits(1), 1e-20, 1.0, 1e20, f32::MAX] {
                let (dense, glow) = dispatch!(level, simd => {
                    let splat = |value: f32| f32x8::splat(simd, value);
                    let part = Part {
                        extinction: [splat(extinction), splat(0.5 * extinction)],
                        color: [[splat(0.0), splat(1.0), splat(1e18)], [splat(1.0), splat(1.0), splat(0.0)]],
                        length: splat(length),
                    };
                    let (mut dense, mut glow) = (Sums::<_, false>::new(simd), Sums::<_, true>::new(simd));
                    for _ in 0..100 {
                        dense.add(simd, &part);
                        // The light itself, color times length, is to fit too.
                        glow.add(simd, &Part { length: part.length.min(1e6), ..part });
                    }
                    let rises = splat(0.0).simd_gt(1.0);
                    let (dense, glow) = (dense.finish(simd, rises), glow.finish(simd, rises));
                    ((dense.0.map(|c| c[0]), dense.1[0]), (glow.0.map(|c| c[0]), glow.1[0]))
                });
                for (rgb, opacity) in [dense, glow] {
                    assert!(rgb.iter().all(|c| c.is_finite() && *c >= 0.0), "{extinction:e} {length:e}: {rgb:?}");
                    assert!((0.0..=1.0).contains(&opacity));
                }
                let opacity = dense.1;
                assert!(dense.0[0] <= opacity * (1.0 + 1e-6) + f32::MIN_POSITIVE + 2e-7);
                if length == 0.0 || extinction == 0.0 {
                    assert_eq!((dense.0, dense.1), ([0.0; 3], 0.0), "nothing is nothing");
                }
            }
        }
    }
}
