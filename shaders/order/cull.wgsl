// Which cells are drawn: neither transparent by the transfer function nor out of view.
//
// One invocation looks at one candidate and writes its number, or NOTHING, to its place in `kept`. Counts what it leaves out in
// `totals` (2: transparent, 3: out of view).

#use include/frame.wgsl
#use include/list.wgsl
#use integrate/visible.wgsl
#use cell/outline.wgsl
#use <surface_visibility>
#use <candidate>

const NOTHING: u32 = 0xffffffffu;
const TRANSPARENT: u32 = 2u;
const OUTSIDE: u32 = 3u;

@group(0) @binding(3) var<storage, read> cells: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read> ranges: array<u32>;
@group(0) @binding(18) var<storage, read_write> totals: array<atomic<u32>>;
@group(0) @binding(20) var<storage, read_write> kept: array<u32>;

var<workgroup> transparent: atomic<u32>;
var<workgroup> outside: atomic<u32>;

fn may_show_scalars(low: i32, high: i32) -> bool {
    return is_visible(low, high) || surfaces_may_show(low, high);
}

// A bound of a range, lattice steps: 65536 of them over all that the lattice has.
fn bound(step: u32) -> i32 {
    return (i32(step) << 14u) - (1 << 29u);
}

fn judge(index: u32) -> u32 {
    let number = candidate(index);
    if number == NOTHING {
        return NOTHING;
    }
    let place = (number & ~RING_BIT) - chunk.x;
    // Rounded outward: what shows nothing here shows nothing, and is not looked up further.
    let range = ranges[place];
    if !may_show_scalars(bound(range & 0xffffu), bound(range >> 16u)) {
        atomicAdd(&transparent, 1u);
        return NOTHING;
    }
    let vertices = cells[place];
    let corners = vec4<u32>(vertices.xyz, vertices.w & ~NEGATIVE_BIT);
    let scalars = vec4<i32>(points[corners.x].w, points[corners.y].w, points[corners.z].w, points[corners.w].w);
    let low = min(min(scalars.x, scalars.y), min(scalars.z, scalars.w));
    let high = max(max(scalars.x, scalars.y), max(scalars.z, scalars.w));
    if !may_show_scalars(low, high) {
        atomicAdd(&transparent, 1u);
        return NOTHING;
    }
    let outline = find_outline(vertices);
    if outline.x > outline.z || outline.y > outline.w {
        atomicAdd(&outside, 1u);
        return NOTHING;
    }
    return number;
}

@compute @workgroup_size(GROUP)
fn cull(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = group_number(group, groups) * GROUP + local;
    if index < frame.cells {
        let number = judge(index);
        // Candidates of other parts of the mesh are left as they are.
        if candidate(index) != NOTHING {
            kept[index] = number;
        }
    }
    workgroupBarrier();
    if local == 0u {
        atomicAdd(&totals[TRANSPARENT], atomicLoad(&transparent));
        atomicAdd(&totals[OUTSIDE], atomicLoad(&outside));
    }
}
