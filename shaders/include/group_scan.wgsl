// Sums over the threads of a group, and the workgroup memory that threads exchange words through.
//
// Who uses it names the size: EXCHANGE_WORDS, at least 2 * GROUP.

var<workgroup> exchange: array<u32, EXCHANGE_WORDS>;

// Where a word lies in workgroup memory. Eight consecutive words of each thread, and one word of each of consecutive threads, both
// lie in different banks so; within aligned runs of eight words.
fn word(place: u32) -> u32 {
    return place ^ ((place >> 5u) & 7u);
}

// The sum, or the largest number where it is larger. Of numbers that are not negative that is associative: sums of any shape agree.
fn saturating_sum(a: u32, b: u32) -> u32 {
    let sum = a + b;
    return select(sum, 0xffffffffu, sum < a);
}

// The sum of the values of all threads before, and that of all. Nobody else may be using `exchange`; all are done with it when it returns.
//
// Four neighbors a round: half of the rounds, and so of the barriers, that pairs take.
fn group_scan(thread: u32, value: u32) -> vec2<u32> {
    var sum = value;
    var from_place = 0u;
    exchange[thread] = sum;
    workgroupBarrier();
    for (var stride = 1u; stride < GROUP; stride *= 4u) {
        for (var k = 1u; k < 4u; k++) {
            if (thread >= k * stride) {
                sum = saturating_sum(sum, exchange[from_place + thread - k * stride]);
            }
        }
        from_place = GROUP - from_place;
        exchange[from_place + thread] = sum;
        workgroupBarrier();
    }
    let total = exchange[from_place + GROUP - 1u];
    var before = 0u;
    if (thread > 0u) {
        before = exchange[from_place + thread - 1u];
    }
    workgroupBarrier();
    return vec2<u32>(before, total);
}
