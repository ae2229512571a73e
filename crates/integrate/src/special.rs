//! The scaled complementary error function and Dawson's integral, each with the difference to its asymptote.
//!
//! `erfcx(t) = exp(t²) erfc(t)` falls as `1 / (√π t)`, `F(t) = exp(-t²) ∫₀ᵗ exp(s²) ds` as `1 / (2 t)`. What is left of
//! one when the asymptote is divided out, `1 - √π t erfcx(t)` and `1 - 2 t F(t)`, is computed without cancellation.
//!
//! Relative error of both functions below 4e-15, measured in the tests. Arguments are not negative.

/// From here on the asymptotic series is good to the last bit: its smallest term is about `exp(-t²)`.
const ASYMPTOTIC_FROM: f64 = 7.0;
/// Terms of the asymptotic series; the first one left out is below 1e-17 at [`ASYMPTOTIC_FROM`].
const ASYMPTOTIC_TERMS: u32 = 24;
/// Below, Dawson's integral is a series of positive terms.
const DAWSON_SERIES_BELOW: f64 = 2.0;

const SQRT_PI: f64 = 1.772_453_850_905_516;

/// A function value and what is left of 1 when its asymptote is divided out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scaled {
    /// The function.
    pub(crate) value: f64,
    /// One minus the function over its asymptote.
    pub(crate) rest: f64,
}

/// `value = exp(t²) erfc(t)`, `rest = 1 - √π t erfcx(t)`.
///
/// Source: Abramowitz and Stegun 7.1.23 for the asymptotic series.
pub(crate) fn erfcx(t: f64) -> Scaled {
    if t < ASYMPTOTIC_FROM {
        let value = exp_of_square(t) * libm::erfc(t);
        Scaled { value, rest: 1.0 - SQRT_PI * t * value }
    } else {
        let rest = -asymptotic(t, -1.0);
        Scaled { value: (1.0 - rest) / (SQRT_PI * t), rest }
    }
}

/// `value = F(t)`, `rest = 1 - 2 t F(t)`, which is the derivative of `F`.
///
/// Sources: the positive series is that of `exp(-t²) ∫ exp(s²)` term by term; between the two series, [Rybicki 1989], a
/// trapezoidal sum that converges exponentially.
pub(crate) fn dawson(t: f64) -> Scaled {
    if t >= ASYMPTOTIC_FROM {
        let rest = -asymptotic(t, 1.0);
        return Scaled { value: (1.0 - rest) / (2.0 * t), rest };
    }
    let value = if t < DAWSON_SERIES_BELOW {
        let square = t * t;
        let (mut power, mut sum, mut n) = (t, t, 1.0);
        // A term is below the last bit once the power over the factorial is; at most 40 terms.
        while power > sum * 1e-18 && n < 64.0 {
            power *= square / n;
            sum += power / (2.0 * n + 1.0);
            n += 1.0;
        }
        sum / exp_of_square(t)
    } else {
        rybicki(t)
    };
    Scaled { value, rest: 1.0 - 2.0 * t * value }
}

/// `F(t) ≈ π^(-1/2) Σ exp(-(t - n h)²) / n` over odd `n`. The error is about `exp(-(π / 2h)²)`, 7e-18 for this step.
fn rybicki(t: f64) -> f64 {
    const STEP: f64 = 0.25;
    /// The last term is `exp(-(25/4 - 1/4)²)`, 2e-16 of the largest, with a divisor at least as large.
    const LAST_ODD: i32 = 25;
    let nearest_even = 2.0 * (0.5 * t / STEP).round();
    let offset = t - nearest_even * STEP;
    let mut sum = 0.0;
    // From both ends inwards, so that small terms come first.
    for odd in (1..=LAST_ODD).rev().step_by(2) {
        let odd = f64::from(odd);
        for n in [odd, -odd] {
            let distance = offset - n * STEP;
            sum += (-distance * distance).exp() / (nearest_even + n);
        }
    }
    sum / SQRT_PI
}

/// `Σ_{n ≥ 1} signⁿ (2n - 1)!! / (2 t²)ⁿ`, from the last term inwards.
fn asymptotic(t: f64, sign: f64) -> f64 {
    let factor = sign * 0.5 / (t * t);
    (1..=ASYMPTOTIC_TERMS).rev().fold(0.0, |inner, n| f64::from(2 * n - 1) * factor * (1.0 + inner))
}

/// `exp(t²)` with the rounding of the square made good: it alone would cost 25 units in the last place at 7.
fn exp_of_square(t: f64) -> f64 {
    // 24 bits, whose square is exact in 53.
    let high = f64::from(t as f32);
    let rest = (t - high) * (t + high);
    (high * high).exp() * (1.0 + rest * (1.0 + 0.5 * rest))
}

#[cfg(test)]
mod tests {
    #![expect(clippy::excessive_precision, reason = "known values keep the digits they were computed with")]

    use super::*;

    /// `t`, `erfcx(t)`, `1 - √π t erfcx(t)`, `F(t)`, `1 - 2 t F(t)`, computed with 60 digits.
    const KNOWN: [[f64; 5]; 16] = [
        [0.0, 1.0, 1.0, 0.0, 1.0],
        [1e-9, 0.9999999988716208339, 0.99999999822754615109, 1.0000000000000000616e-9, 0.999999999999999998],
        [0.125, 0.8732218450821508096, 0.80653182224866523189, 0.12370601848283973394, 0.96907349537929006652],
        [0.5, 0.61569034419292587487, 0.4543586392349529579, 0.42443638350202229593, 0.57556361649797770407],
        [1.0, 0.42758357615580700441, 0.24212784385868789396, 0.53807950691276841914, -0.076159013825536838273],
        [1.9375, 0.26223760655038143882, 0.099442142308966010441, 0.31460420687901873905, -0.21909130165619761381],
        [2.0, 0.25539567631050574387, 0.094645900037650841275, 0.30134038892379196603, -0.20536155569516786414],
        [2.5, 0.21080636406114358065, 0.065888620561089709414, 0.22308372216743548113, -0.11541861083717740563],
        [3.75, 0.14558972127503853905, 0.032308517026739524546, 0.1387052395935911983, -0.040289296951933987219],
        [5.0, 0.11070463773306862637, 0.018905692684612085562, 0.10213407442427683544, -0.021340744242768354386],
        [6.96875, 0.080150900921459725703, 0.0099930819634790208194, 0.072511676295182335889, -0.010631488364103806451],
        [7.0, 0.07980005432915293349, 0.0099066048127644133595, 0.072180974658236292028, -0.010533645215308088389],
        [9.0, 0.062307724037774684147, 0.0060619112927926562013, 0.055905046724350460704, -0.0062908410383082926671],
        [40.0, 0.014100335983377813625, 0.00031220748801512052029, 0.012503909917843973199, -0.00031279342751785594731],
        [1e6, 5.6418958354747419216e-7, 4.9999999999925e-13, 5.0000000000025e-7, -5.0000000000075e-13],
        [1e12, 5.6418958354775628695e-13, 5.0e-25, 5.0e-13, -5.0e-25],
    ];

    #[test]
    fn known_values() {
        let mut worst = [0.0f64; 4];
        for [t, erfcx_known, erfcx_rest, dawson_known, dawson_rest] in KNOWN {
            let (erfcx, dawson) = (erfcx(t), dawson(t));
            let relative = |got: f64, known: f64| if known == 0.0 { got.abs() } else { (got / known - 1.0).abs() };
            worst[0] = worst[0].max(relative(erfcx.value, erfcx_known));
            worst[1] = worst[1].max(relative(dawson.value, dawson_known));
            // Relative to the rest below the asymptotic range: one minus nearly one, 100 times the rounding.
            worst[2] = worst[2].max(relative(erfcx.rest, erfcx_rest));
            worst[3] = worst[3].max((dawson.rest - dawson_rest).abs() / dawson_rest.abs());
        }
        println!(
            "relative errors: erfcx {:.1e}, Dawson {:.1e}, rests {:.1e} {:.1e}",
            worst[0], worst[1], worst[2], worst[3]
        );
        assert!(worst[0] < 4e-15 && worst[1] < 4e-15, "{worst:?}");
        assert!(worst[2] < 2e-13 && worst[3] < 2e-13, "{worst:?}");
    }

    #[test]
    fn ranges_join_and_derivatives_hold() {
        for seam in [DAWSON_SERIES_BELOW, ASYMPTOTIC_FROM] {
            let (below, above) = (seam.next_down(), seam);
            assert!((erfcx(below).value / erfcx(above).value - 1.0).abs() < 4e-15);
            assert!((dawson(below).value / dawson(above).value - 1.0).abs() < 4e-15);
        }
        // y' = 2 t y - 2/√π and F' = 1 - 2 t F, by central differences.
        for i in 1..400 {
            let (t, h) = (f64::from(i) * 0.025, 1e-4);
            let slope = |f: fn(f64) -> Scaled| (f(t + h).value - f(t - h).value) / (2.0 * h);
            assert!((slope(erfcx) - (2.0 * t * erfcx(t).value - 2.0 / SQRT_PI)).abs() < 1e-7, "{t}");
            assert!((slope(dawson) - dawson(t).rest).abs() < 1e-7, "{t}");
        }
    }
}
