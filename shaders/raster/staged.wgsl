// Cells that a group has at hand: set up by some of its invocations, seen by all.

#use cell/cell.wgsl
#use cell/set_up.wgsl
#use cell/sample.wgsl
#use cell/optics.wgsl

// Cells at a time: together they take 11.5 KiB of the 16 that every device has.
const BATCH: u32 = 64u;

var<workgroup> staged: array<Cell, BATCH>;
var<workgroup> staged_optics: array<Optics, BATCH>;
var<workgroup> staged_vertices: array<vec4<u32>, BATCH>;

// Sets up the cell of a place in the block's list for the pixels of a tile, in a slot.
fn stage(slot: u32, place: u32, tile: u32) {
    let vertices = drawn[place];
    let corner = vec2<i32>(corner_of(tile));
    let cell = set_up_within(vertices, vec4<i32>(corner, corner + i32(TILE_SIDE) - 1));
    staged[slot] = cell;
    staged_optics[slot] = optics_of(cell);
    staged_vertices[slot] = vertices;
}

// A slot, and what its cell has in the pixel; if nothing, there is no further one.
struct Found {
    slot: u32,
    sample: Sample,
}

// The first of the slots from one on whose cell covers a pixel.
fn next_covered(first: u32, count: u32, position: vec2<i32>) -> Found {
    var found: Found;
    found.slot = first;
    found.sample.covered = false;
    while found.slot < count && !found.sample.covered {
        if !is_outside(staged[found.slot].outline, position) {
            found.sample = sample(staged[found.slot], position);
        }
        found.slot += select(1u, 0u, found.sample.covered);
    }
    return found;
}
