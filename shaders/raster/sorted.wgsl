// Pixels that sort by themselves what their rays meet, with no memory but a few registers each.
//
// One group draws one tile, one invocation a pixel. A pixel holds back up to HELD segments, the nearest first, by the depth of their middles
// and, where those are equal, by their place in the list.
//
// - LAYERS: it looks for the HELD nearest behind those that it has, and goes on from there when the stage is run again, until no tile is open. Exact
//   without any order; time grows with the layers divided by HELD. What a pixel has to know in the next run stands behind the tiles in `picture`.
// - else, a window: it runs through them once, and gives up the nearest when one more comes than the window holds (a k-buffer).
//
// Where a driver ends long loops (SLICE above 0), a run looks at so many of the tile's cells and no more, and what it holds back stands in `picture` too.

#use integrate/light.wgsl
#use <volume>
#use <effects>
#use raster/tile.wgsl
#use raster/staged.wgsl
#use <rings>

// A place in the order of a pixel: nothing comes before the first.
struct Key {
    depth: f32,
    place: u32,
}

// Whether pixels have to know anything.
const HAS_STATE: bool = LAYERS || SLICE > 0u;

// What of the tile's list is looked at, and its end.
var<workgroup> range_of_tile: vec3<u32>;
var<workgroup> open_pixels: atomic<u32>;
var<workgroup> is_any_open: u32;

// What a pixel has to know in the next run, besides the segments that it holds back.
struct State {
    // The last segment that it blended when it was through the cells.
    depth: f32,
    place: u32,
    run: u32,
    // Cells of the tile that it has looked at since then: the same for all open pixels of a tile.
    looked_at: u32,
    joint: Joint,
    held_count: u32,
}

// How often it was through all cells. A picture that was cleared says FIRST_RUN.
const FIRST_RUN: u32 = 0u;
const NEXT_RUN: u32 = 1u;
const LAST_RUN: u32 = 2u;

var<private> held: array<Key, HELD>;
var<private> held_count: u32;
var<private> pixel: Pixel;
var<private> joint: Joint;
var<private> done: Done;

fn is_before(a: Key, b: Key) -> bool {
    return a.depth < b.depth || (a.depth == b.depth && a.place < b.place);
}

// Puts a segment to its place among those held; there is room.
fn hold(key: Key) {
    var slot = held_count;
    while slot > 0u && is_before(key, held[slot - 1u]) {
        held[slot] = held[slot - 1u];
        slot -= 1u;
    }
    held[slot] = key;
    held_count += 1u;
}

// Puts a segment to its place if it lies behind all of earlier runs and before some of those held, or if there is room.
fn hold_if_next(key: Key, last: Key, is_first_run: bool) {
    let is_behind = is_first_run || is_before(last, key);
    let is_full = held_count == HELD;
    if is_behind && (!is_full || is_before(key, held[HELD - 1u])) {
        held_count -= select(0u, 1u, is_full);
        hold(key);
    }
}

// Blends the segment of a cell, which is set up once more: that costs less than to keep what it was.
fn draw_segment(place: u32, position: vec2<i32>) {
    let vertices = drawn[place];
    let cell = set_up_within(vertices, vec4<i32>(position, position));
    let sample = sample(cell, position);
    if !sample.covered {
        return;
    }
    var carried = joint;
    var crossings = 0u;
    let light = shade(cell, vertices, optics_of(cell), sample, &carried, &crossings);
    joint = carried;
    var blended = pixel;
    blend(&blended, light);
    pixel = blended;
    done.crossings += crossings;
    done.fragments += 1u;
    done.sorted += 1u;
}

fn state_place(position: vec2<i32>) -> u32 {
    let tiles = frame.tiles.x * frame.tiles.y;
    return frame.extent.x * frame.extent.y + tiles + STATE * place_in_picture(position);
}

fn load_state(position: vec2<i32>) -> State {
    let at = state_place(position);
    let key = picture[at];
    let carried = picture[at + 1u];
    let joint = bitcast<vec3<f32>>(carried.xyz);
    return State(bitcast<f32>(key.x), key.y, key.z, key.w, Joint(joint.x, joint.y, joint.z), carried.w);
}

fn store_state(position: vec2<i32>, state: State) {
    let at = state_place(position);
    picture[at] = vec4<u32>(bitcast<u32>(state.depth), state.place, state.run, state.looked_at);
    let joint = bitcast<vec3<u32>>(vec3<f32>(state.joint.depth, state.joint.slack, state.joint.rank));
    picture[at + 1u] = vec4<u32>(joint, state.held_count);
}

// Takes up the segments that an earlier run held back.
fn load_held(position: vec2<i32>, count: u32) {
    let at = state_place(position) + 2u;
    held_count = min(count, HELD);
    for (var slot = 0u; slot < held_count; slot += 2u) {
        let pair = picture[at + slot / 2u];
        held[slot] = Key(bitcast<f32>(pair.x), pair.y);
        if slot + 1u < held_count {
            held[slot + 1u] = Key(bitcast<f32>(pair.z), pair.w);
        }
    }
}

fn store_held(position: vec2<i32>) {
    let at = state_place(position) + 2u;
    for (var slot = 0u; slot < held_count; slot += 2u) {
        let a = held[slot];
        var b = a;
        if slot + 1u < held_count {
            b = held[slot + 1u];
        }
        picture[at + slot / 2u] = vec4<u32>(bitcast<u32>(a.depth), a.place, bitcast<u32>(b.depth), b.place);
    }
}

fn is_pixel_open() -> bool {
    return through(pixel.hides) >= frame.termination;
}

// The nearest segment leaves the window.
fn give_up_nearest(position: vec2<i32>) {
    let nearest = held[0];
    held_count -= 1u;
    for (var slot = 0u; slot < held_count; slot++) {
        held[slot] = held[slot + 1u];
    }
    if is_pixel_open() {
        draw_segment(nearest.place, position);
    }
}

@compute @workgroup_size(TILE_PIXELS)
fn draw(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let tile = group_number(group, groups);
    let tiles = frame.tiles.x * frame.tiles.y;
    if local == 0u {
        range_of_tile = vec3<u32>(0u);
        if tile < tiles && has_ring(tile) {
            let all = vec2<u32>(tile_starts[tile], tile_starts[tile + 1u]) & vec2<u32>(~RING_BIT);
            range_of_tile = all.xyy;
            if SLICE > 0u {
                // A tile's first pixel is in the picture, and knows of the others.
                let first = min(all.x + load_state(pixel_of(tile, 0u)).looked_at, all.y);
                range_of_tile = vec3<u32>(first, first + min(all.y - first, SLICE), all.y);
            }
        }
    }
    let range = workgroupUniformLoad(&range_of_tile);
    if range.x == range.z {
        return;
    }
    let is_last_slice = range.y == range.z;
    let position = pixel_of(tile, local);
    let is_seen = is_in_picture(position);
    pixel = Pixel(vec3<f32>(0.0), 0.0);
    joint = no_joint();
    done = Done(0u, 0u, 0u, 0u);
    held_count = 0u;
    var state = State(0.0, 0u, FIRST_RUN, 0u, joint, 0u);
    var is_open = is_seen;
    if is_seen {
        pixel = load_pixel(position);
        is_open = is_pixel_open();
        if HAS_STATE {
            state = load_state(position);
            is_open = is_open && state.run != LAST_RUN;
            if state.run != FIRST_RUN || state.looked_at > 0u {
                joint = state.joint;
            }
        }
    }
    if is_open {
        atomicAdd(&open_pixels, 1u);
    }
    workgroupBarrier();
    if local == 0u {
        is_any_open = atomicLoad(&open_pixels);
    }
    if workgroupUniformLoad(&is_any_open) == 0u {
        return;
    }
    let before = begin_tile(tile, local);
    if SLICE > 0u && is_open {
        load_held(position, state.held_count);
    }
    let last = Key(state.depth, state.place);
    for (var first = range.x; first < range.y; first += BATCH) {
        let count = min(BATCH, range.y - first);
        workgroupBarrier();
        if local < count {
            stage(local, tile_items[first + local], tile);
        }
        workgroupBarrier();
        var slot = 0u;
        while slot < count && is_open {
            let found = next_covered(slot, count, position);
            slot = found.slot;
            if found.sample.covered {
                let depth = 0.5 * (found.sample.depth.x + found.sample.depth.y);
                let key = Key(depth, tile_items[first + slot]);
                if LAYERS {
                    hold_if_next(key, last, state.run == FIRST_RUN);
                } else {
                    // A window of HELD - 1, and one that is on its way.
                    hold(key);
                    if held_count == HELD {
                        give_up_nearest(position);
                        is_open = is_pixel_open();
                    }
                }
                slot += 1u;
                done.most = max(done.most, held_count);
            }
        }
    }
    if is_open && is_last_slice {
        for (var slot = 0u; slot < held_count && is_pixel_open(); slot++) {
            draw_segment(held[slot].place, position);
        }
        // Fewer than there was room for: these were the last.
        is_open = LAYERS && is_pixel_open() && held_count == HELD;
        if is_open {
            state.depth = held[HELD - 1u].depth;
            state.place = held[HELD - 1u].place;
            state.run = NEXT_RUN;
        }
        held_count = 0u;
    }
    if is_seen {
        store_pixel(position, pixel);
        if HAS_STATE {
            state.run = select(LAST_RUN, state.run, is_open);
            state.looked_at = select(state.looked_at + range.y - range.x, 0u, is_last_slice);
            state.joint = joint;
            state.held_count = held_count;
            store_state(position, state);
        }
        if SLICE > 0u && is_open && !is_last_slice {
            store_held(position);
        }
    }
    count_done(tile, local, before, done, is_open, is_cut(range.z));
}
