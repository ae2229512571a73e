// A table of light over the scalars at both ends; entries next to each other along the front scalar are next to each other in memory.
#use integrate/light.wgsl
#use integrate/optics.wgsl

@group(0) @binding(8) var<storage, read> table: array<vec4<f32>>;

// A position between the samples of an axis.
struct Place {
    // The sample at or below, such that there is one above.
    below: u32,
    // Share of the one above, 0 to 1.
    share: f32,
}

// Where a scalar lies on the table's axis; beyond it, at the nearer end.
fn scalar_place(reference: i32, scalar: f32) -> Place {
    // The sample before the reference, and the way from there, in integers: a float of the whole coordinate would lack the digits that
    // the share needs.
    let last = i32(optics.table_scalars) - 1;
    let steps = reference - optics.table_start;
    let sample = clamp(i32(f32(steps) * LATTICE_STEP * optics.table_per_scalar), 0, last);
    let rest = f32(steps - sample * optics.table_step) * LATTICE_STEP * optics.table_per_scalar;
    let way = (rest - f32(sample) * optics.table_rest) + scalar * optics.table_per_scalar;
    let whole = clamp(sample + i32(floor(way)), 0, last - 1);
    return Place(u32(whole), saturate(way - f32(whole - sample)));
}

// The light at a corner and its three neighbors along the two scalars, mixed.
fn mixed_scalars(first: u32, front: f32, back: f32) -> vec4<f32> {
    let next = first + optics.table_scalars;
    return mix(mix(table[first], table[first + 1u], front), mix(table[next], table[next + 1u], front), back);
}
