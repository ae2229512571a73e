// One pass of a stable radix sort: entries by the RADIX_BITS bits of their keys from bit work.shift on.
//
// One group works on LIST_BLOCK entries, LIST_ITEMS consecutive ones a thread. `radix_count`: how often each block has each digit;
// between the two stages these become prefix sums, digit by digit and block by block within; `radix_scatter`: sorts the block in
// workgroup memory, so that what is written together lies together. `radix_copy`: the lists as they are, after an odd number of passes.
//
// Ranks within a block come from counters that each thread has for itself and sums over them, four bits at a time: no atomic decides a
// place, and the result has the same bits every time. (Those of the counts add up to the same in any order.)
//
// in: radix_keys_in, radix_order_in, count in totals[work.count_at], never more than work.most; between: radix_counts (256 a block);
// out: radix_keys_out, radix_order_out.

#use include/list.wgsl
#use include/work.wgsl
#use include/group_scan.wgsl

const EXCHANGE_WORDS: u32 = LIST_BLOCK;
const DIGITS: u32 = 1u << RADIX_BITS;

@group(0) @binding(18) var<storage, read> totals: array<u32>;
@group(0) @binding(25) var<storage, read> radix_keys_in: array<u32>;
@group(0) @binding(26) var<storage, read> radix_order_in: array<u32>;
@group(0) @binding(27) var<storage, read_write> radix_keys_out: array<u32>;
@group(0) @binding(28) var<storage, read_write> radix_order_out: array<u32>;
@group(0) @binding(30) var<storage, read_write> radix_counts: array<u32>;

var<workgroup> histogram: array<atomic<u32>, DIGITS>;
// Rows of one word a thread; a word has the counts of two digits, half the digits apart. Later: where the digits' runs go.
var<workgroup> counters: array<u32, LIST_BLOCK>;

fn entry_count() -> u32 {
    return min(totals[work.count_at], work.most);
}

@compute @workgroup_size(GROUP)
fn radix_count(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let group = group_number(group_id, groups);
    let count = entry_count();
    for (var k = 0u; k < LIST_ITEMS; k++) {
        let place = group * LIST_BLOCK + k * GROUP + thread;
        if (place < count) {
            atomicAdd(&histogram[(radix_keys_in[place] >> work.shift) & (DIGITS - 1u)], 1u);
        }
    }
    workgroupBarrier();
    let blocks = blocks_of(work.most);
    // A thread a digit.
    if (group < blocks) {
        radix_counts[thread * blocks + group] = atomicLoad(&histogram[thread]);
    }
}

// Eight numbers of one thread. Vectors, as arrays that are indexed may end up in slow memory.
struct Eight {
    a: vec4<u32>,
    b: vec4<u32>,
}

fn counter_of(digit: u32, thread: u32) -> u32 {
    return word((digit & 7u) * GROUP + thread);
}

// How many entries of this digit the thread had before.
fn count_one(digit: u32, thread: u32) -> u32 {
    let place = counter_of(digit, thread);
    let half = (digit >> 3u) * 16u;
    let before = counters[place];
    counters[place] = before + (1u << half);
    return (before >> half) & 0xffffu;
}

fn count_four(digits: vec4<u32>, thread: u32) -> vec4<u32> {
    let x = count_one(digits.x, thread);
    let y = count_one(digits.y, thread);
    let z = count_one(digits.z, thread);
    let w = count_one(digits.w, thread);
    return vec4<u32>(x, y, z, w);
}

// Where the thread's entries of this digit begin in the block.
fn start_of(digit: u32, thread: u32) -> u32 {
    return (counters[counter_of(digit, thread)] >> ((digit >> 3u) * 16u)) & 0xffffu;
}

fn starts_of(digits: vec4<u32>, thread: u32) -> vec4<u32> {
    return vec4<u32>(
        start_of(digits.x, thread),
        start_of(digits.y, thread),
        start_of(digits.z, thread),
        start_of(digits.w, thread),
    );
}

// Places of the thread's entries in the block when it is sorted by these digits, below 16, and stays as it is otherwise.
// All are done with `exchange` when it returns.
fn places_of(digits: Eight, thread: u32) -> Eight {
    for (var row = 0u; row < LIST_ITEMS; row++) {
        counters[word(row * GROUP + thread)] = 0u;
    }
    let own_a = count_four(digits.a, thread);
    let own_b = count_four(digits.b, thread);
    workgroupBarrier();
    // Sums over all counters as they lie: digit by digit, thread by thread.
    var sum = 0u;
    for (var k = 0u; k < LIST_ITEMS; k++) {
        sum += counters[word(thread * LIST_ITEMS + k)];
    }
    let found = group_scan(thread, sum);
    // Digits in the upper halves come after all of those in the lower ones.
    var running = found.x + (found.y << 16u);
    for (var k = 0u; k < LIST_ITEMS; k++) {
        let place = word(thread * LIST_ITEMS + k);
        let value = counters[place];
        counters[place] = running;
        running += value;
    }
    workgroupBarrier();
    return Eight(own_a + starts_of(digits.a, thread), own_b + starts_of(digits.b, thread));
}

fn put(places: Eight, values: Eight) {
    exchange[word(places.a.x)] = values.a.x;
    exchange[word(places.a.y)] = values.a.y;
    exchange[word(places.a.z)] = values.a.z;
    exchange[word(places.a.w)] = values.a.w;
    exchange[word(places.b.x)] = values.b.x;
    exchange[word(places.b.y)] = values.b.y;
    exchange[word(places.b.z)] = values.b.z;
    exchange[word(places.b.w)] = values.b.w;
}

// Eight words from a place on, `stride` apart.
fn eight_from(first: u32, stride: u32) -> Eight {
    return Eight(
        first + stride * vec4<u32>(0u, 1u, 2u, 3u),
        first + stride * vec4<u32>(4u, 5u, 6u, 7u),
    );
}

fn taken(places: Eight) -> Eight {
    return Eight(
        vec4<u32>(
            exchange[word(places.a.x)], exchange[word(places.a.y)], exchange[word(places.a.z)], exchange[word(places.a.w)]
        ),
        vec4<u32>(
            exchange[word(places.b.x)], exchange[word(places.b.y)], exchange[word(places.b.z)], exchange[word(places.b.w)]
        ),
    );
}

// A key; the highest beyond the end, so that what is not there comes last.
fn key_at(place: u32, count: u32) -> u32 {
    if (place < count) {
        return radix_keys_in[place];
    }
    return 0xffffffffu;
}

fn order_at(place: u32, count: u32) -> u32 {
    if (place < count) {
        return radix_order_in[place];
    }
    return 0u;
}

fn digits_of(keys: vec4<u32>) -> vec4<u32> {
    return (keys >> vec4<u32>(work.shift)) & vec4<u32>(DIGITS - 1u);
}

// Notes where a digit's run goes, if one begins at this place of the sorted block.
fn note_run(place: u32, digit: u32, group: u32, blocks: u32) {
    var is_first = place == 0u;
    if (!is_first) {
        is_first = ((exchange[word(place - 1u)] >> work.shift) & (DIGITS - 1u)) != digit;
    }
    if (is_first) {
        counters[digit] = radix_counts[digit * blocks + group] - place;
    }
}

fn write_key(place: u32, destination: u32, key: u32, valid: u32) {
    if (place < valid) {
        radix_keys_out[destination] = key;
    }
}

fn write_order(place: u32, destination: u32, entry: u32, valid: u32) {
    if (place < valid) {
        radix_order_out[destination] = entry;
    }
}

@compute @workgroup_size(GROUP)
fn radix_scatter(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let group = group_number(group_id, groups);
    let count = entry_count();
    let first = group * LIST_BLOCK;
    if (first >= count) {
        return;
    }
    let valid = count - first;
    let blocks = blocks_of(work.most);
    let from_place = eight_from(first + thread * LIST_ITEMS, 1u);
    let own = eight_from(thread * LIST_ITEMS, 1u);
    let a = from_place.a;
    let b = from_place.b;
    var keys = Eight(
        vec4<u32>(key_at(a.x, count), key_at(a.y, count), key_at(a.z, count), key_at(a.w, count)),
        vec4<u32>(key_at(b.x, count), key_at(b.y, count), key_at(b.z, count), key_at(b.w, count)),
    );
    var entries = Eight(
        vec4<u32>(order_at(a.x, count), order_at(a.y, count), order_at(a.z, count), order_at(a.w, count)),
        vec4<u32>(order_at(b.x, count), order_at(b.y, count), order_at(b.z, count), order_at(b.w, count)),
    );

    // By the lower four bits, and then by the upper ones.
    let lower = places_of(Eight(digits_of(keys.a) & vec4<u32>(15u), digits_of(keys.b) & vec4<u32>(15u)), thread);
    put(lower, keys);
    workgroupBarrier();
    keys = taken(own);
    workgroupBarrier();
    put(lower, entries);
    workgroupBarrier();
    entries = taken(own);
    workgroupBarrier();
    let upper = places_of(Eight(digits_of(keys.a) >> vec4<u32>(4u), digits_of(keys.b) >> vec4<u32>(4u)), thread);
    put(upper, keys);
    workgroupBarrier();

    // From here on neighboring threads have neighboring entries.
    let place = eight_from(thread, GROUP);
    keys = taken(place);
    let digit = Eight(digits_of(keys.a), digits_of(keys.b));
    note_run(place.a.x, digit.a.x, group, blocks);
    note_run(place.a.y, digit.a.y, group, blocks);
    note_run(place.a.z, digit.a.z, group, blocks);
    note_run(place.a.w, digit.a.w, group, blocks);
    note_run(place.b.x, digit.b.x, group, blocks);
    note_run(place.b.y, digit.b.y, group, blocks);
    note_run(place.b.z, digit.b.z, group, blocks);
    note_run(place.b.w, digit.b.w, group, blocks);
    workgroupBarrier();
    let to_a = place.a + vec4<u32>(counters[digit.a.x], counters[digit.a.y], counters[digit.a.z], counters[digit.a.w]);
    let to_b = place.b + vec4<u32>(counters[digit.b.x], counters[digit.b.y], counters[digit.b.z], counters[digit.b.w]);
    write_key(place.a.x, to_a.x, keys.a.x, valid);
    write_key(place.a.y, to_a.y, keys.a.y, valid);
    write_key(place.a.z, to_a.z, keys.a.z, valid);
    write_key(place.a.w, to_a.w, keys.a.w, valid);
    write_key(place.b.x, to_b.x, keys.b.x, valid);
    write_key(place.b.y, to_b.y, keys.b.y, valid);
    write_key(place.b.z, to_b.z, keys.b.z, valid);
    write_key(place.b.w, to_b.w, keys.b.w, valid);
    put(upper, entries);
    workgroupBarrier();
    entries = taken(place);
    write_order(place.a.x, to_a.x, entries.a.x, valid);
    write_order(place.a.y, to_a.y, entries.a.y, valid);
    write_order(place.a.z, to_a.z, entries.a.z, valid);
    write_order(place.a.w, to_a.w, entries.a.w, valid);
    write_order(place.b.x, to_b.x, entries.b.x, valid);
    write_order(place.b.y, to_b.y, entries.b.y, valid);
    write_order(place.b.z, to_b.z, entries.b.z, valid);
    write_order(place.b.w, to_b.w, entries.b.w, valid);
}

@compute @workgroup_size(GROUP)
fn radix_copy(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let first = group_number(group_id, groups) * LIST_BLOCK + thread;
    let count = entry_count();
    for (var k = 0u; k < LIST_ITEMS; k++) {
        let place = first + k * GROUP;
        if (place < count) {
            radix_keys_out[place] = radix_keys_in[place];
            radix_order_out[place] = radix_order_in[place];
        }
    }
}
