// Transmittance and opacity of any optical depth, by our own polynomial: the exponential of the language may be off in the fifth digit.
// Optical depths are finite and not negative.

// exp(-x) = scale (1 + excess), where scale is a power of two, or 0 from 87.7 on, and the excess lies between -0.3 and 0.42.
struct Exponential {
    scale: f32,
    excess: f32,
}

fn exponential(x: f32) -> Exponential {
    // ln 2 in two parts. The first has 9 bits, so that its product with an exponent is exact.
    const LN_2_HIGH: f32 = 355.0 / 512.0;
    const LN_2_LOW: f32 = 0.693147180559945309417232 - 355.0 / 512.0;
    const LOG2_E: f32 = 1.442695040888963407359925;
    // Beyond, the power of two is the one whose bits are all zero, the number 0.
    let limited = min(x, 88.0);
    let exponent = round(limited * -LOG2_E);
    let scale = bitcast<f32>((i32(exponent) + 127) << 23u);
    let rest = (-limited - exponent * LN_2_HIGH) - exponent * LN_2_LOW;
    let high = (EXP_M1[5] * rest + EXP_M1[4]) * rest + EXP_M1[3];
    let sum = ((high * rest + EXP_M1[2]) * rest + EXP_M1[1]) * rest + EXP_M1[0];
    return Exponential(scale, sum * rest);
}

// exp(-x).
fn transmittance_of(x: f32) -> f32 {
    let e = exponential(x);
    return e.excess * e.scale + e.scale;
}

// 1 - exp(-x), good relative to itself however thin, and exp(-x).
fn opacity_transmittance(x: f32) -> vec2<f32> {
    let e = exponential(x);
    // Up to half a power of two the scale is 1, and the opacity is minus the excess with all its digits.
    return vec2<f32>((1.0 - e.scale) - e.excess * e.scale, e.excess * e.scale + e.scale);
}
