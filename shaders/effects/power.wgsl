// Powers of numbers from 0 to 1, to a few units in the last place; those of the language are left to each driver.

const LEAST_NORMAL: f32 = 1.1754944e-38;

// -ln x for a normal number up to 1; 0 at 1.
//
// x = 2^k m with m from sqrt(1/2) to sqrt(2), and ln m = 2 artanh s with s = (m - 1) / (m + 1), whose series up to the ninth power leaves
// out 3e-9 of itself.
fn minus_log(x: f32) -> f32 {
    let sqrt_half = 0x3f3504f3u;
    let shifted = bitcast<u32>(x) + (0x3f800000u - sqrt_half);
    let exponent = f32(i32(shifted >> 23u) - 127);
    let mantissa = bitcast<f32>((shifted & 0x007fffffu) + sqrt_half);
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    let square = s * s;
    let series = ((square / 9.0 + 1.0 / 7.0) * square + 1.0 / 5.0) * square + 1.0 / 3.0;
    // The small part last: near 1 it is all there is.
    return -(exponent * 0.69314718 + (2.0 * s + 2.0 * s * (series * square)));
}

// exp(-x) for x from 0; 0 where the result has no normal number.
fn decay(x: f32) -> f32 {
    if x > 87.3 {
        return 0.0;
    }
    let exponent = round(-x * 1.442695);
    let scale = bitcast<f32>(u32(i32(exponent) + 127) << 23u);
    // ln 2 in two parts. The first has 9 bits, so that its product with an exponent is exact.
    let rest = (-x - exponent * 0.693359375) + exponent * 2.1219444e-4;
    var sum = EXP_M1[EXP_TERMS - 1u];
    for (var term = EXP_TERMS - 1u; term > 0u; term--) {
        sum = sum * rest + EXP_M1[term - 1u];
    }
    return scale + scale * (sum * rest);
}

// 0 to the power 0 is 1. Bases without a normal number count as 0.
//
// - base: 0 to 1
// - exponent: 0 or more
fn power(base: f32, exponent: f32) -> f32 {
    if exponent <= 0.0 {
        return 1.0;
    }
    if base < LEAST_NORMAL {
        return 0.0;
    }
    return decay(minus_log(base) * exponent);
}
