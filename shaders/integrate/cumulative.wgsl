// Exact opacity, and light with a correction for what the segment hides of itself, from integrals over the pieces: see
// `tetrascope_integrate::lanes::cumulative`, which has the formulas. Density emitter and emitter. The slot <volume>.
#use integrate/pieces.wgsl
#use integrate/parts.wgsl
#use <model>

// Depth of a part from which on the whole segment is taken as shorter: it is opaque as often as one likes, and its light is a mean, which
// does not change, while squares stay finite.
const DEEPEST: f32 = 1e6;
// Depth of an end beyond which none is told from another: sums stay finite.
const LARGEST: f32 = 1e30;

// Over the pieces so far, in ascending order of the scalar whichever way the ray runs.
struct Integrals {
    // What lengths are multiplied by, see DEEPEST.
    scale: f32,
    depth: f32,
    light: vec3<f32>,
    skew: vec3<f32>,
    // The least and the largest color, where colors are multiplied by the extinction.
    lowest: vec3<f32>,
    highest: vec3<f32>,
}

// With the part of a segment in the next piece, whose scalars lie above all before; its length is above 0.
fn with_part(before: Integrals, low: Value, high: Value, part_length: f32) -> Integrals {
    // Half the depth that the part would have with the extinction of either end.
    let scaled = before.scale * part_length;
    let ends = min(0.5 * scaled * vec2<f32>(low.extinction, high.extinction), vec2<f32>(LARGEST));
    let shorter = select(1.0, DEEPEST / (ends.x + ends.y), ends.x + ends.y > DEEPEST);
    let length = scaled * shorter;
    let start = ends.x * shorter;
    let end = ends.y * shorter;
    let depth = start + end;
    let tilt = end - start;
    let change = high.color - low.color;
    let mean = 0.5 * (low.color + high.color);
    var next = before;
    next.scale *= shorter;
    next.depth *= shorter;
    next.light *= shorter;
    next.skew *= shorter * shorter;
    var light: vec3<f32>;
    var skew: vec3<f32>;
    if (MODEL_COLOR_IS_PER_LENGTH) {
        light = mean * length;
        // Where the extinction rises, less than half of the length lies behind half of the depth.
        skew = change * (length * depth * (1.0 / 12.0)) - light * (tilt * (1.0 / 6.0));
    } else {
        light = mean * depth + change * (tilt * (1.0 / 6.0));
        skew = change * ((5.0 * depth * depth - tilt * tilt) * (1.0 / 60.0));
        next.lowest = min(before.lowest, min(low.color, high.color));
        next.highest = max(before.highest, max(low.color, high.color));
    }
    next.skew += skew + 0.5 * (next.depth * light - depth * next.light);
    next.light += light;
    next.depth += depth;
    return next;
}

// ((1 - exp(-R)) / R - 1 + (1 - exp(-R)) / 2) / R^2 for R up to 1: coefficients -(-1)^k (k + 1) / (2 (k + 3)!), the first one left out
// is below 2e-7 of the sum.
fn tilt_series(r: f32) -> f32 {
    let high = ((r * (-1.0 / 8870400.0) + 1.0 / 907200.0) * r - 1.0 / 103680.0) * r + 1.0 / 13440.0;
    let middle = ((high * r - 1.0 / 2016.0) * r + 1.0 / 360.0) * r - 1.0 / 80.0;
    return (middle * r + 1.0 / 24.0) * r - 1.0 / 12.0;
}

fn light_of(sums: Integrals, rises: bool) -> Light {
    let depth = sums.depth;
    let whole = opacity_transmittance(depth);
    // Below, the quotient is one but for rounding.
    let has_depth = depth > 1e-7;
    let divisor = select(1.0, depth, has_depth);
    let mean = select(1.0, whole.x / divisor, has_depth);
    let closed = (0.5 * whole.x + mean - 1.0) / (divisor * divisor);
    let tilt = select(-12.0, 12.0, rises) * select(tilt_series(min(depth, 1.0)), closed, depth > 1.0);
    let light = sums.light * mean + sums.skew * tilt;
    var least: vec3<f32>;
    var most: vec3<f32>;
    if (MODEL_COLOR_IS_PER_LENGTH) {
        // The chord of the transmittance over the mean depth, from convexity.
        least = whole.y * sums.light;
        most = sums.light - 0.5 * whole.x * sums.light - mean * select(-sums.skew, sums.skew, rises);
    } else {
        least = sums.lowest * whole.x;
        most = sums.highest * whole.x;
    }
    return Light(max(min(light, most), least), whole.x);
}

fn volume(cell: Optics, front: f32, back: f32, length: f32) -> Light {
    let parts = parts_of(front, back);
    var sums = Integrals(1.0, 0.0, vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(3.0e38), vec3<f32>(0.0));
    for (var index = 0u; index < cell.count; index++) {
        let piece = local_piece(cell.first + index, cell.reference);
        let part = part_in(parts, piece, index, cell.count);
        // With one piece the share is 1 but for rounding.
        let part_length = length * select(part.share, 1.0, cell.count == 1u);
        if (part_length > 0.0) {
            sums = with_part(sums, value_by(piece, part.at_low), value_by(piece, part.at_high), part_length);
        }
    }
    return light_of(sums, front <= back);
}
