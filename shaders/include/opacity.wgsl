// How much of what lies behind a pixel hides, in one number: below one half its opacity, else minus its transmittance.
//
// Whichever is the smaller has the more digits, so that thousands of thin layers add up to the right sum, and thousands more behind them still count.

const HALF_OPAQUE: f32 = 0.5;

// The transmittance is kept above 0, so that its sign is seen on every device.
fn packed_opacity(opacity: f32, transmittance: f32) -> f32 {
    return select(-max(transmittance, 1e-37), opacity, opacity < HALF_OPAQUE);
}

fn opacity_of(packed: f32) -> f32 {
    return select(packed, 1.0 + packed, packed < 0.0);
}

fn through(packed: f32) -> f32 {
    return select(1.0 - packed, -packed, packed < 0.0);
}

// With something of this opacity before or behind it.
fn with_opacity(packed: f32, opacity: f32) -> f32 {
    let hidden = through(packed) * opacity;
    return packed_opacity(opacity_of(packed) + hidden, through(packed) - hidden);
}
