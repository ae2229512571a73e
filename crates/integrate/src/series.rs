//! Weights of thin segments by a series that neither divides nor cancels.
//!
//! Let `a`, `b` be the optical depths of the ends (see [`crate::weights`]), `x = (a + b) / 4`, `y = x²` and
//! `z = (b - a) / 4`, so that `|z| ≤ x`. About the middle of the segment, with `v` from -1 to 1, the transmittance is
//! `exp(-x) exp(-x v) exp((z / 2) (1 - v²))`. Expanding the last factor leaves integrals of `exp(-x v) (1 - v²)ᵏ`, which
//! are modified spherical Bessel functions:
//!
//! ```text
//! psi    = exp(-x) Σ_{k ≥ 0} zᵏ g_k(y)        g_k(y) = i_k(x) / xᵏ = Σ_{j ≥ 0} c[k][j] yʲ
//! c[k][j] = 1 / (2ʲ j! (2k + 2j + 1)!!)       P = Σ_{k ≥ 0} zᵏ g_{k+1}(y)
//!
//! density emitter:  front, back = exp(-x) (x g_0 ± (y g_1 - z P))     since 1 - psi and psi - zeta share sinh x
//! emitter:          front, back = exp(-x) ((g_0 + z P) / 2 ± (x / 2) P)
//! transmittance = exp(-x)²
//! ```
//!
//! Every sum has one large term and small corrections; for equal ends `z = 0` is nothing special. In the thin limit
//! the density emitter's weights become `(2a + b) / 6` and `(a + 2b) / 6`.
//!
//! # Error
//!
//! Up to an optical depth of 1, `x ≤ 1/2`: what is left out is below 1e-8 of the sum of the weights in 32 bits and below
//! 1e-17 in 64 bits, so rounding is all that counts. Measured: see [`crate::weights`].

use crate::weights::Weights;

/// Largest optical depth `(a + b) / 2` for which the coefficients of [`SERIES_F32`] suffice.
pub const TAU_MAX_F32: f32 = 1.0;
/// Largest optical depth `(a + b) / 2` for which the coefficients of [`SERIES_F64`] suffice.
pub const TAU_MAX_F64: f64 = 1.0;

/// How many coefficients of each row of [`SERIES_F32`] count at 32 bits; the others are zero.
pub const SERIES_F32_TERMS: [usize; 7] = [4, 4, 3, 3, 2, 1, 1];
/// How many coefficients of each row of [`SERIES_F64`] count at 64 bits; the others are zero.
pub const SERIES_F64_TERMS: [usize; 14] = [9, 8, 8, 7, 7, 6, 6, 5, 5, 4, 4, 3, 2, 1];

/// `SERIES_F32[k][j] = 1 / (2ʲ j! (2k + 2j + 1)!!)`, coefficient of `yʲ` in `g_k(y)`; zero from
/// [`SERIES_F32_TERMS`]`[k]` on. Generated, each correctly rounded.
pub const SERIES_F32: [[f32; 4]; 7] = {
    let mut table = [[0.0; 4]; 7];
    let mut k = 0;
    while k < table.len() {
        let mut j = 0;
        while j < SERIES_F32_TERMS[k] {
            table[k][j] = coefficient(k, j) as f32;
            j += 1;
        }
        k += 1;
    }
    table
};

/// The same coefficients for 64 bits.
pub const SERIES_F64: [[f64; 9]; 14] = {
    let mut table = [[0.0; 9]; 14];
    let mut k = 0;
    while k < table.len() {
        let mut j = 0;
        while j < SERIES_F64_TERMS[k] {
            table[k][j] = coefficient(k, j);
            j += 1;
        }
        k += 1;
    }
    table
};

/// Terms of the polynomials for [`EXP_HALF_F32`] and [`EXP_M1_F32`].
pub const EXP_TERMS: usize = 6;

/// Coefficients of `exp(-(1/4 + t))` for `|t| ≤ 1/4`, ascending powers of `t`: the transmittance `exp(-x)` of half of a
/// thin segment. Relative error below 2e-8, from the Taylor series shortened with Chebyshev polynomials.
pub const EXP_HALF_F32: [f32; EXP_TERMS] = {
    const TAYLOR: usize = 12;
    // exp(-1/4) by its own series.
    let mut center = 0.0;
    let mut n = TAYLOR + 4;
    while n > 0 {
        n -= 1;
        center = 1.0 - center * 0.25 / (n as f64 + 1.0);
    }
    let mut taylor = [0.0; TAYLOR];
    let mut factor = center;
    let mut k = 0;
    while k < TAYLOR {
        taylor[k] = factor;
        factor = -factor / (k as f64 + 1.0);
        k += 1;
    }
    shortened(taylor, 0.25)
};

/// Coefficients of `(exp(r) - 1) / r` for `|r| ≤ ln 2 / 2`, ascending powers of `r`. Relative error below 2e-8.
pub const EXP_M1_F32: [f32; EXP_TERMS] = {
    const TAYLOR: usize = 14;
    let mut taylor = [0.0; TAYLOR];
    let mut factor = 1.0;
    let mut k = 0;
    while k < TAYLOR {
        taylor[k] = factor;
        factor /= k as f64 + 2.0;
        k += 1;
    }
    shortened(taylor, 0.5 * core::f64::consts::LN_2)
};

/// `1 / (2ʲ j! (2k + 2j + 1)!!)`. Numerators and denominators stay below 2⁵³ for all entries that are used, or are
/// rounded once per factor beyond, where the entry is a correction.
const fn coefficient(k: usize, j: usize) -> f64 {
    let mut divisor = 1.0;
    let mut i = 1;
    while i <= j {
        divisor *= 2.0 * i as f64;
        i += 1;
    }
    let mut odd = 3;
    while odd <= 2 * k + 2 * j + 1 {
        divisor *= odd as f64;
        odd += 2;
    }
    1.0 / divisor
}

/// Shortens a power series to [`EXP_TERMS`] terms on `[-radius, radius]`, taking off a Chebyshev polynomial per power:
/// the error is that of the first term left out, `2ⁿ⁻¹` times smaller than by cutting.
const fn shortened<const N: usize>(mut series: [f64; N], radius: f64) -> [f32; EXP_TERMS] {
    let mut degree = N - 1;
    while degree >= EXP_TERMS {
        // Coefficients of the Chebyshev polynomial of this degree from the highest down:
        // t[d] = 2^(d-1), t[d-2i-2] = -t[d-2i] (d-2i)(d-2i-1) / (4 (i+1) (d-i-1)).
        let top = series[degree];
        let mut ratio = 1.0;
        let mut i = 0;
        while 2 * i <= degree {
            let power = degree - 2 * i;
            series[power] -= top * ratio;
            if power < 2 {
                break;
            }
            let (p, d, n) = (power as f64, degree as f64, i as f64);
            ratio *= -p * (p - 1.0) / (4.0 * (n + 1.0) * (d - n - 1.0)) * radius * radius;
            i += 1;
        }
        degree -= 1;
    }
    let mut short = [0.0; EXP_TERMS];
    let mut k = 0;
    while k < EXP_TERMS {
        short[k] = series[k] as f32;
        k += 1;
    }
    short
}

/// `g_0`, `g_1` and `P` of the module's formulas.
struct Sums<T> {
    g0: T,
    g1: T,
    p: T,
}

macro_rules! scalar_series {
    ($float:ty, $table:ident, $terms:ident, $sums:ident, $density_emitter:ident, $emitter:ident) => {
        fn $sums(y: $float, z: $float) -> Sums<$float> {
            let row = |k: usize| {
                let coefficients: &[$float] = &$table[k][..$terms[k]];
                coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * y + coefficient)
            };
            let g1 = row(1);
            let inner = (2..$table.len()).rev().fold(0.0, |sum, k| sum * z + row(k));
            Sums { g0: row(0), g1, p: g1 + z * inner }
        }

        /// The density emitter's weights for `(tau_front + tau_back) / 2` up to 1.
        pub(crate) fn $density_emitter(tau_front: $float, tau_back: $float) -> Weights<$float> {
            let (x, z) = (0.25 * (tau_front + tau_back), 0.25 * (tau_back - tau_front));
            let y = x * x;
            let Sums { g0, g1, p } = $sums(y, z);
            let (half, difference) = ((-x).exp(), y * g1 - z * p);
            Weights {
                front: half * (x * g0 + difference),
                back: half * (x * g0 - difference),
                transmittance: half * half,
            }
        }

        /// The emitter's weights for `(tau_front + tau_back) / 2` up to 1.
        pub(crate) fn $emitter(tau_front: $float, tau_back: $float) -> Weights<$float> {
            let (x, z) = (0.25 * (tau_front + tau_back), 0.25 * (tau_back - tau_front));
            let Sums { g0, p, .. } = $sums(x * x, z);
            let half = (-x).exp();
            let mean = g0 + z * p;
            Weights {
                front: 0.5 * half * (mean + x * p),
                back: 0.5 * half * (mean - x * p),
                transmittance: half * half,
            }
        }
    };
}

scalar_series!(f32, SERIES_F32, SERIES_F32_TERMS, sums_f32, density_emitter_f32, emitter_f32);
scalar_series!(f64, SERIES_F64, SERIES_F64_TERMS, sums_f64, density_emitter_f64, emitter_f64);

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(coefficients: &[f32], t: f64) -> f64 {
        coefficients.iter().rev().fold(0.0, |sum, &c| sum * t + f64::from(c))
    }

    #[test]
    fn shortened_exponentials_are_as_good_as_stated() {
        let mut worst = [0.0f64; 2];
        for i in -1000..=1000 {
            let t = f64::from(i) / 4000.0;
            worst[0] = worst[0].max((polynomial(&EXP_HALF_F32, t) / (-0.25 - t).exp() - 1.0).abs());
            let r = f64::from(i) / 1000.0 * 0.5 * core::f64::consts::LN_2;
            let known = if i == 0 { 1.0 } else { r.exp_m1() / r };
            worst[1] = worst[1].max((polynomial(&EXP_M1_F32, r) / known - 1.0).abs());
        }
        println!("exp(-1/4 - t): {:.1e}, expm1(r) / r: {:.1e}", worst[0], worst[1]);
        // Rounding of the leading coefficient alone is up to 3e-8.
        assert!(worst[0] < 6e-8 && worst[1] < 4e-8, "{worst:?}");
    }

    #[test]
    fn coefficients_are_those_of_the_spherical_bessel_functions() {
        // i_0 = sinh(x) / x, i_1 = (x cosh x - sinh x) / x².
        for x in [0.1f64, 0.3, 0.5] {
            let Sums { g0, g1, .. } = sums_f64(x * x, 0.0);
            assert!((g0 - x.sinh() / x).abs() < 1e-15);
            assert!((g1 - (x.cosh() - x.sinh() / x) / (x * x)).abs() < 1e-13);
        }
        assert_eq!(SERIES_F64[2][1], 1.0 / 210.0);
        assert_eq!(SERIES_F32[3][0], 1.0 / 105.0);
    }
}
