// What the colors at both ends of a segment count, where extinction and color are linear: in the density emitter model as they are, in
// the emitter model times the length. Takes the optical depths that the segment would have with the extinction of its front, and of its
// back, all along: not negative.
//
// Up to an optical depth of 1 by a series (formulas: `tetrascope_integrate::series`). Deeper segments are split into equal parts thin
// enough for it; of a very deep one only the stretch next to the eye that is seen, so that the number of parts is bounded.
#use integrate/exponential.wgsl

struct Weights {
    front: f32,
    back: f32,
    opacity: f32,
}

// Optical depth up to which a segment is followed.
const VISIBLE_DEPTH: f32 = 18.0;
// exp(-VISIBLE_DEPTH): what lies beyond sends so much of its light.
const BEYOND: f32 = 1.523e-8;
// With so many parts none exceeds an optical depth of 1.11, wherever the extinction is gathered; the series is good to 3e-8 there.
const MOST_PARTS: f32 = 32.0;
// So deep a segment is opaque, and a sum of two and their products with shares are finite.
const DEEPEST_END: f32 = 1e30;

fn is_thin(tau: vec2<f32>) -> bool {
    return tau.x + tau.y <= 2.0 * TAU_MAX;
}

// exp(-x) for x from 0 to about 1/2.
fn exp_half(x: f32) -> f32 {
    let t = x - 0.25;
    let high = (EXP_HALF[5] * t + EXP_HALF[4]) * t + EXP_HALF[3];
    return ((high * t + EXP_HALF[2]) * t + EXP_HALF[1]) * t + EXP_HALF[0];
}

// g_0, g_1 and P of the series.
fn series_sums(y: f32, z: f32) -> vec3<f32> {
    let g0 = ((SERIES_0[3] * y + SERIES_0[2]) * y + SERIES_0[1]) * y + SERIES_0[0];
    let g1 = ((SERIES_1[3] * y + SERIES_1[2]) * y + SERIES_1[1]) * y + SERIES_1[0];
    let g2 = (SERIES_2[2] * y + SERIES_2[1]) * y + SERIES_2[0];
    let g3 = (SERIES_3[2] * y + SERIES_3[1]) * y + SERIES_3[0];
    let g4 = SERIES_4[1] * y + SERIES_4[0];
    // Powers of z in pairs: half as long a chain as one after the other.
    let z_squared = z * z;
    let high = SERIES_6[0] * z_squared + (SERIES_5[0] * z + g4);
    return vec3<f32>(g0, g1, (high * z_squared + (g3 * z + g2)) * z + g1);
}

fn thin_density_emitter(tau: vec2<f32>) -> Weights {
    let x = 0.25 * (tau.x + tau.y);
    let z = 0.25 * (tau.y - tau.x);
    let y = x * x;
    let sums = series_sums(y, z);
    let half = exp_half(x);
    let mean = x * sums.x;
    let difference = y * sums.y - z * sums.z;
    return Weights(half * (mean + difference), half * (mean - difference), min(2.0 * half * mean, 1.0));
}

fn thin_emitter(tau: vec2<f32>) -> Weights {
    let x = 0.25 * (tau.x + tau.y);
    let z = 0.25 * (tau.y - tau.x);
    let sums = series_sums(x * x, z);
    let half = exp_half(x);
    let mean = z * sums.z + sums.x;
    let difference = x * sums.z;
    // 1 - exp(-2 x) = 2 exp(-x) sinh(x).
    let opacity = min(2.0 * half * x * sums.x, 1.0);
    return Weights(0.5 * half * (mean + difference), 0.5 * half * (mean - difference), opacity);
}

// The stretch of a deep segment that is followed, in parts.
struct Stretch {
    // Of the whole segment.
    depth: f32,
    // Length of the stretch as a share of the segment's.
    length: f32,
    is_cut: bool,
    parts: f32,
    // Extinction where the stretch begins, and its increase along it, times the stretch's length.
    first: f32,
    increase: f32,
}

// For segments that are not thin.
fn stretch_of(tau: vec2<f32>) -> Stretch {
    let ends = min(tau, vec2<f32>(DEEPEST_END));
    let depth = 0.5 * (ends.x + ends.y);
    // Where the optical depth is VISIBLE_DEPTH: by the form of the quadratic formula that does not cancel, everything divided by the
    // larger end so that no square overflows. The larger end is above 1.
    let larger = max(ends.x, ends.y);
    let front = ends.x / larger;
    let slope = (ends.y - ends.x) / larger;
    let visible = VISIBLE_DEPTH / larger;
    let divisor = front + sqrt(max(front * front + 2.0 * slope * visible, 0.0));
    // Of a segment that is not that deep it lies behind the back, or nowhere.
    let is_cut = depth > VISIBLE_DEPTH && 2.0 * visible < divisor;
    let length = select(1.0, 2.0 * visible / divisor, is_cut);
    let first = ends.x * length;
    let increase = (ends.y - ends.x) * length * length;
    // As many parts as the deepest of them, at the denser end, asks for.
    let dense = max(first, first + increase);
    let parts = 0.5 * (dense + sqrt(max(dense * dense - 2.0 * abs(increase), 0.0))) / TAU_MAX;
    return Stretch(depth, length, is_cut, clamp(ceil(parts), 2.0, MOST_PARTS), first, increase);
}

// Sums over the parts: (weights of both ends), and of the back's, times the transmittance before the part.
fn sums_of_parts(stretch: Stretch, is_emitter: bool) -> vec2<f32> {
    let share = 1.0 / stretch.parts;
    let first = stretch.first * share;
    let increase = stretch.increase * (share * share);
    var start = first;
    var sums = vec2<f32>(0.0);
    var number = 0.0;
    while (number < stretch.parts) {
        // In groups of four: dozens of equal parts would be rounded the same way one after the other.
        let group_end = min(number + 4.0, stretch.parts);
        var group_sums = vec2<f32>(0.0);
        while (number < group_end) {
            let end = max(first + increase * (number + 1.0), 0.0);
            let position = number * share;
            // From the depth, not from the part before: a product would add up the rounding of numbers next to 1.
            let seen = transmittance_of(max((0.5 * position * stretch.increase + stretch.first) * position, 0.0));
            let tau = vec2<f32>(start, end);
            var one: Weights;
            if (is_emitter) {
                one = thin_emitter(tau);
            } else {
                one = thin_density_emitter(tau);
            }
            let whole = one.front + one.back;
            group_sums += seen * vec2<f32>(whole, whole * position + one.back * share);
            start = end;
            number += 1.0;
        }
        sums += group_sums;
    }
    return sums;
}

fn density_emitter_weights(tau: vec2<f32>) -> Weights {
    if (is_thin(tau)) {
        return thin_density_emitter(tau);
    }
    let stretch = stretch_of(tau);
    let whole = opacity_transmittance(stretch.depth);
    // What is seen from beyond the stretch lies right behind it.
    let beyond = select(0.0, BEYOND, stretch.is_cut);
    let back = (sums_of_parts(stretch, false).y + beyond) * stretch.length;
    // No cancellation: transmittance falls, so the front has at least a third of the whole.
    return Weights(whole.x - back, back, whole.x);
}

// To be multiplied by the length.
fn emitter_weights(tau: vec2<f32>) -> Weights {
    if (is_thin(tau)) {
        return thin_emitter(tau);
    }
    let stretch = stretch_of(tau);
    let sums = sums_of_parts(stretch, true) * (stretch.length / stretch.parts);
    let back = sums.y * stretch.length;
    return Weights(sums.x - back, back, opacity_transmittance(stretch.depth).x);
}
