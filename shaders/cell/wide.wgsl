// Signed 64-bit integers in two words, low and high, for positions that every device must agree on. All of it is exact, and wraps
// as 64-bit integers do.

fn wide(a: i32) -> vec2<u32> {
    return vec2<u32>(bitcast<u32>(a), bitcast<u32>(a >> 31u));
}

// From halves of words, since no product of two words is at hand.
fn wide_product(a: i32, b: i32) -> vec2<u32> {
    let x = bitcast<u32>(a);
    let y = bitcast<u32>(b);
    let low = (x & 0xffffu) * (y & 0xffffu);
    let first = (x >> 16u) * (y & 0xffffu);
    let second = (x & 0xffffu) * (y >> 16u);
    let middle = (low >> 16u) + (first & 0xffffu) + (second & 0xffffu);
    let high = (x >> 16u) * (y >> 16u) + (first >> 16u) + (second >> 16u) + (middle >> 16u);
    // A negative factor stands for itself plus 2^32.
    return vec2<u32>(x * y, high - select(0u, y, a < 0) - select(0u, x, b < 0));
}

fn wide_sum(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + u32(low < a.x));
}

fn wide_difference(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(a.x - b.x, a.y - b.y - u32(a.x < b.x));
}

// Times 2^bits; 1 to 31 bits.
fn wide_shifted_up(a: vec2<u32>, bits: u32) -> vec2<u32> {
    return vec2<u32>(a.x << bits, (a.y << bits) | (a.x >> (32u - bits)));
}

// Divided by 2^bits, to the nearest, halves up; 0 to 62 bits. What does not fit a word gives the nearest that does.
fn wide_rounded(a: vec2<u32>, bits: u32) -> i32 {
    var low = a.x;
    var high = bitcast<i32>(a.y);
    if bits > 0u {
        let half = bits - 1u;
        let sum = wide_sum(a, select(vec2<u32>(0u, 1u << (half & 31u)), vec2<u32>(1u << (half & 31u), 0u), half < 32u));
        low = sum.x;
        high = bitcast<i32>(sum.y);
        if bits >= 32u {
            low = bitcast<u32>(high >> (bits - 32u));
            high = high >> 31u;
        } else {
            low = (low >> bits) | (sum.y << (32u - bits));
            high = high >> bits;
        }
    }
    let word = bitcast<i32>(low);
    return select(select(0x7fffffff, -0x7fffffff - 1, high < 0), word, high == (word >> 31u));
}

// -1, 0 or 1.
fn wide_sign(a: vec2<u32>) -> i32 {
    return select(i32((a.x | a.y) != 0u), -1, bitcast<i32>(a.y) < 0);
}

// The nearest f32 but for two roundings; zero for zero alone.
fn wide_to_float(a: vec2<u32>) -> f32 {
    let is_negative = bitcast<i32>(a.y) < 0;
    let size = select(a, wide_difference(vec2<u32>(0u), a), vec2<bool>(is_negative));
    let value = f32(size.y) * 4294967296.0 + f32(size.x);
    return select(value, -value, is_negative);
}

// 2^-bits, exact; 0 to 126 bits.
fn power_below_one(bits: u32) -> f32 {
    return bitcast<f32>((127u - bits) << 23u);
}
