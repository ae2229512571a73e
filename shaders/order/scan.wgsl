// Prefix sums, in place: every entry becomes the sum of those before it. Sums that exceed 32 bits become the largest number.
//
// One group works on LIST_BLOCK entries. `scan_reduce`: sum of each block; those are summed up likewise, level by level; `scan_apply`:
// each block from the sum before it. `scan_top`: a list of one block. The same bits every time: no sum depends on who comes first.
//
// in: work.most entries; in and out: scan_values (entries), scan_sums (one a block).

#use include/list.wgsl
#use include/work.wgsl
#use include/group_scan.wgsl

const EXCHANGE_WORDS: u32 = 2u * GROUP;

@group(0) @binding(22) var<storage, read_write> scan_values: array<u32>;
@group(0) @binding(23) var<storage, read_write> scan_sums: array<u32>;

@compute @workgroup_size(GROUP)
fn scan_reduce(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let group = group_number(group_id, groups);
    var sum = 0u;
    // Any order of the entries: neighbors by neighboring threads.
    for (var k = 0u; k < LIST_ITEMS; k++) {
        let place = group * LIST_BLOCK + k * GROUP + thread;
        if (place < work.most) {
            sum = saturating_sum(sum, scan_values[place]);
        }
    }
    let total = group_scan(thread, sum).y;
    if (thread == 0u && group < blocks_of(work.most)) {
        scan_sums[group] = total;
    }
}

@compute @workgroup_size(GROUP)
fn scan_apply(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let group = group_number(group_id, groups);
    var before = 0u;
    if (group < blocks_of(work.most)) {
        before = scan_sums[group];
    }
    scan_block(group, thread, before);
}

@compute @workgroup_size(GROUP)
fn scan_top(@builtin(workgroup_id) group_id: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    scan_block(group_id.x, thread, 0u);
}

fn scan_block(group: u32, thread: u32, before: u32) {
    let first = group * LIST_BLOCK + thread * LIST_ITEMS;
    let end = min(first + LIST_ITEMS, work.most);
    var sum = 0u;
    for (var place = first; place < end; place++) {
        sum = saturating_sum(sum, scan_values[place]);
    }
    var running = saturating_sum(before, group_scan(thread, sum).x);
    for (var place = first; place < end; place++) {
        let value = scan_values[place];
        scan_values[place] = running;
        running = saturating_sum(running, value);
    }
}
