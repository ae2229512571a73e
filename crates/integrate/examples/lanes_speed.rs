//! Prints how long each function for eight lanes takes, per vector of eight and with thin, medium and deep segments.
//!
//! `cargo run --release -p tetrascope-integrate --example lanes_speed`

#![expect(clippy::print_stdout, reason = "printing is the purpose")]

use std::hint::black_box;
use std::time::Instant;

use fearless_simd::{Level, Simd, dispatch, f32x8, prelude::*};
use tetrascope_integrate::lanes::{
    density_emitter_weights, emitter_weights, exp_negative, opacity_transmittance, partial_weights,
};

/// Fit the first-level cache, so that only arithmetic counts.
const VALUES: usize = 2048;
/// Short enough that some runs are not interrupted on a busy machine.
const ROUNDS: usize = 8;

fn main() {
    let best = Level::new();
    print_level(best);
    // What most machines have, where this one has more.
    if let (Some(_), Some(avx2)) = (best.as_avx512(), best.as_avx2()) {
        print_level(avx2.level());
    }
}

fn print_level(level: Level) {
    println!("{level:?}, nanoseconds per 8 lanes");
    for (name, largest) in [("tau < 1", 1.0f32), ("tau < 4", 4.0), ("tau < 20", 20.0)] {
        // End depths whose mean stays below the bound, spread by multiples of irrational numbers.
        let fraction = |i: usize, step: f32| (i as f32 * step).fract();
        let front: Vec<f32> = (0..VALUES).map(|i| largest * fraction(i, 0.618_034)).collect();
        let back: Vec<f32> = (0..VALUES).map(|i| largest * fraction(i, 0.414_213_6)).collect();
        println!("{name}");
        print_time("load, add and store", || dispatch!(level, simd => run(simd, &front, &back, |_, a, b| a + b)));
        print_time(
            "exp_negative",
            || dispatch!(level, simd => run(simd, &front, &back, #[inline(always)] |simd, a, _| exp_negative(simd, a))),
        );
        print_time("opacity_transmittance", || {
            dispatch!(level, simd => run(simd, &front, &back, #[inline(always)] |simd, a, _| {
                let (opacity, transmittance) = opacity_transmittance(simd, a);
                opacity + transmittance
            }))
        });
        print_time("density_emitter_weights", || {
            dispatch!(level, simd => run(simd, &front, &back, #[inline(always)] |simd, a, b| {
                let weights = density_emitter_weights(simd, a, b);
                weights.front.mul_sub(weights.transmittance, weights.back)
            }))
        });
        print_time("partial_weights", || {
            dispatch!(level, simd => run(simd, &front, &back, #[inline(always)] |simd, a, b| {
                let weights = partial_weights(simd, a, b);
                weights.front.mul_sub(weights.transmittance, weights.back)
            }))
        });
        print_time("emitter_weights", || {
            dispatch!(level, simd => run(simd, &front, &back, #[inline(always)] |simd, a, b| {
                let weights = emitter_weights(simd, a, b);
                weights.front.mul_sub(weights.transmittance, weights.back)
            }))
        });
    }
}

/// Best of several runs, which is the one that was disturbed least.
fn print_time(name: &str, mut work: impl FnMut() -> f32) {
    let best = (0..400)
        .map(|_| {
            let start = Instant::now();
            black_box(work());
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    println!("  {name:24} {:7.2}", best * 1e9 / (ROUNDS * VALUES / 8) as f64);
}

#[inline(always)]
fn run<S: Simd>(simd: S, front: &[f32], back: &[f32], function: impl Fn(S, f32x8<S>, f32x8<S>) -> f32x8<S>) -> f32 {
    let mut out = [0.0; VALUES];
    let mut sum = 0.0;
    for _ in 0..ROUNDS {
        for ((front, back), out) in
            black_box(front).chunks_exact(8).zip(back.chunks_exact(8)).zip(out.chunks_exact_mut(8))
        {
            function(simd, f32x8::from_slice(simd, front), f32x8::from_slice(simd, back)).store_slice(out);
        }
        sum += black_box(&out)[0];
    }
    sum
}
