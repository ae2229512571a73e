// Keys of the power order: the affine function of every cell at the eye, exact in whole numbers of 96 bits.
//
// One invocation makes one word of one entry's key: `power_keys_low` the lower, `power_keys_high` the higher 32 bits.
//
// in: power_cells (two entries a cell: gradient x, y, z and constant, 64 bits each, low word first), power_view (see
// `layout::PowerView`), order, totals[0], work.most; out: keys (ascending: front to back).

#use include/list.wgsl
#use include/work.wgsl

struct PowerView {
    axis: vec4<i32>,
    lowest: vec4<u32>,
    constant_shift: u32,
    has_constant: u32,
    drop: u32,
    unused: u32,
}

@group(0) @binding(9) var<storage, read> order: array<u32>;
@group(0) @binding(18) var<storage, read> totals: array<u32>;
@group(0) @binding(21) var<storage, read_write> keys: array<u32>;
@group(0) @binding(33) var<storage, read> power_cells: array<vec4<u32>>;
@group(0) @binding(34) var<uniform> power_view: PowerView;

// The product of two words: low and high.
fn product(a: u32, b: u32) -> vec2<u32> {
    let a0 = a & 0xffffu;
    let a1 = a >> 16u;
    let b0 = b & 0xffffu;
    let b1 = b >> 16u;
    let low = a0 * b0;
    // Below 2^32: (2^16 - 1)^2 + 2^16 - 1.
    let first = a1 * b0 + (low >> 16u);
    let second = a0 * b1 + (first & 0xffffu);
    return vec2<u32>((second << 16u) | (low & 0xffffu), a1 * b1 + (first >> 16u) + (second >> 16u));
}

// Sum of 96 bits.
fn sum(a: vec3<u32>, b: vec3<u32>) -> vec3<u32> {
    let x = a.x + b.x;
    let carry = select(0u, 1u, x < a.x);
    let y = a.y + b.y;
    let y_carried = y + carry;
    let next = select(0u, 1u, y < a.y) + select(0u, 1u, y_carried < y);
    return vec3<u32>(x, y_carried, a.z + b.z + next);
}

fn negated(a: vec3<u32>) -> vec3<u32> {
    return sum(~a, vec3<u32>(1u, 0u, 0u));
}

// All ones for a negative number.
fn sign_word(high: u32) -> u32 {
    return select(0u, 0xffffffffu, (high & 0x80000000u) != 0u);
}

// A number of 64 bits times one of 32, both with signs.
fn scaled(a: vec2<u32>, factor: i32) -> vec3<u32> {
    let size = select(bitcast<u32>(factor), 0u - bitcast<u32>(factor), factor < 0);
    let low = product(a.x, size);
    let high = product(a.y, size);
    // A negative number's high word stands for 2^32 less.
    let result = sum(vec3<u32>(low, 0u), vec3<u32>(0u, high.x, high.y - (size & sign_word(a.y))));
    if (factor < 0) {
        return negated(result);
    }
    return result;
}

// A constant of 64 bits with its sign, moved up by less than 32 bits.
fn moved_up(a: vec2<u32>, bits: u32) -> vec3<u32> {
    let high = sign_word(a.y);
    if (bits == 0u) {
        return vec3<u32>(a, high);
    }
    let rest = 32u - bits;
    return vec3<u32>(a.x << bits, (a.y << bits) | (a.x >> rest), (high << bits) | (a.y >> rest));
}

fn key_of(cell: u32) -> vec2<u32> {
    let a = power_cells[2u * cell];
    let b = power_cells[2u * cell + 1u];
    let axis = power_view.axis;
    var value = sum(sum(scaled(a.xy, axis.x), scaled(a.zw, axis.y)), scaled(b.xy, axis.z));
    if (power_view.has_constant != 0u) {
        value = sum(value, moved_up(b.zw, power_view.constant_shift));
    }
    value = sum(value, negated(power_view.lowest.xyz));
    if (power_view.drop >= 64u) {
        value = vec3<u32>(value.z, 0u, 0u);
    } else if (power_view.drop >= 32u) {
        value = vec3<u32>(value.y, value.z, 0u);
    }
    let bits = power_view.drop & 31u;
    if (bits == 0u) {
        return value.xy;
    }
    return (value.xy >> vec2<u32>(bits)) | (value.yz << vec2<u32>(32u - bits));
}

@compute @workgroup_size(GROUP)
fn power_keys_low(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let place = group_number(group_id, groups) * GROUP + thread;
    if (place < min(totals[0], work.most)) {
        keys[place] = key_of(order[place] & ~RING_BIT).x;
    }
}

@compute @workgroup_size(GROUP)
fn power_keys_high(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let place = group_number(group_id, groups) * GROUP + thread;
    if (place < min(totals[0], work.most)) {
        keys[place] = key_of(order[place] & ~RING_BIT).y;
    }
}
