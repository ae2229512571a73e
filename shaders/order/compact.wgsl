// Entries that are kept move up, in the order in which they come.
//
// One group works on LIST_BLOCK entries. `compact_count`: how many each block keeps; between the two stages these become prefix sums;
// `compact_write`: the entries.
//
// in: work.most entries of kept (NOTHING for none); between: compact_counts (one a block); out: order, totals[0] (how many).

#use include/list.wgsl
#use include/work.wgsl
#use include/group_scan.wgsl

const EXCHANGE_WORDS: u32 = 2u * GROUP;
const NOTHING: u32 = 0xffffffffu;

@group(0) @binding(9) var<storage, read_write> order: array<u32>;
@group(0) @binding(18) var<storage, read_write> totals: array<u32>;
@group(0) @binding(20) var<storage, read> kept: array<u32>;
@group(0) @binding(24) var<storage, read_write> compact_counts: array<u32>;

@compute @workgroup_size(GROUP)
fn compact_count(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let group = group_number(group_id, groups);
    var count = 0u;
    for (var k = 0u; k < LIST_ITEMS; k++) {
        let place = group * LIST_BLOCK + k * GROUP + thread;
        if (place < work.most) {
            count += select(1u, 0u, kept[place] == NOTHING);
        }
    }
    let total = group_scan(thread, count).y;
    if (thread == 0u && group < blocks_of(work.most)) {
        compact_counts[group] = total;
    }
}

@compute @workgroup_size(GROUP)
fn compact_write(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let group = group_number(group_id, groups);
    let blocks = blocks_of(work.most);
    let first = group * LIST_BLOCK + thread * LIST_ITEMS;
    let end = min(first + LIST_ITEMS, work.most);
    var count = 0u;
    for (var place = first; place < end; place++) {
        count += select(1u, 0u, kept[place] == NOTHING);
    }
    let found = group_scan(thread, count);
    var before = 0u;
    if (group < blocks) {
        before = compact_counts[group];
    }
    if (thread == 0u && group == blocks - 1u) {
        totals[0] = before + found.y;
    }
    var target_place = before + found.x;
    for (var place = first; place < end; place++) {
        let entry = kept[place];
        if (entry != NOTHING) {
            order[target_place] = entry;
            target_place++;
        }
    }
}
