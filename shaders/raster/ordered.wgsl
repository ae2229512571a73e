// Cells in order, front to back, into the pixels of a tile; color and opacity stay in registers until all are drawn.
//
// One group draws one tile. Each invocation goes on to the next cell that covers its pixel before any is shaded, so that invocations that run together shade
// together, each its own cell: cells are small, and few pixels have the same. A tile whose pixels are opaque ends early. Where a part of the cells lies in rings, the tiles that they touch are left to
// `raster/sorted.wgsl`.

#use integrate/light.wgsl
#use <volume>
#use <effects>
#use raster/tile.wgsl
#use raster/staged.wgsl
#use <rings>

var<workgroup> range_of_tile: vec2<u32>;
var<workgroup> open_pixels: atomic<u32>;
var<workgroup> is_any_open: u32;

@compute @workgroup_size(TILE_PIXELS)
fn draw(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let tile = group_number(group, groups);
    let tiles = frame.tiles.x * frame.tiles.y;
    if local == 0u {
        if tile < tiles && !has_ring(tile) {
            range_of_tile = vec2<u32>(tile_starts[tile], tile_starts[tile + 1u]) & vec2<u32>(~RING_BIT);
        } else {
            range_of_tile = vec2<u32>(0u, 0u);
        }
    }
    let range = workgroupUniformLoad(&range_of_tile);
    if range.x == range.y {
        return;
    }
    let position = pixel_of(tile, local);
    let is_seen = is_in_picture(position);
    var pixel = Pixel(vec3<f32>(0.0), 0.0);
    if is_seen {
        pixel = load_pixel(position);
    }
    var is_open = is_seen && through(pixel.hides) >= frame.termination;
    var joint = no_joint();
    var done = Done(0u, 0u, 0u, 0u);
    let before = begin_tile(tile, local);
    for (var first = range.x; first < range.y; first += BATCH) {
        let count = min(BATCH, range.y - first);
        if local < count {
            stage(local, tile_items[first + local], tile);
        }
        if local == 0u {
            atomicStore(&open_pixels, 0u);
        }
        workgroupBarrier();
        var slot = 0u;
        while slot < count && is_open {
            let found = next_covered(slot, count, position);
            slot = found.slot;
            if found.sample.covered {
                var crossings = 0u;
                let light =
                    shade(staged[slot], staged_vertices[slot], staged_optics[slot], found.sample, &joint, &crossings);
                blend(&pixel, light);
                done.crossings += crossings;
                done.fragments += 1u;
                is_open = through(pixel.hides) >= frame.termination;
                slot += 1u;
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
            break;
        }
    }
    if is_seen {
        store_pixel(position, pixel);
    }
    count_done(tile, local, before, done, false, is_cut(range.y));
}
