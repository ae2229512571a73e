// Cells in order, front to back, into the pixels of a tile; color and transmittance stay in registers until all are drawn.
//
// One group draws one tile. A tile whose pixels are opaque ends early. Where a part of the cells lies in rings, the tiles that they touch are left to
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
            range_of_tile = vec2<u32>(tile_starts[tile], tile_starts[tile + 1u]);
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
    var is_open = is_seen && pixel.transmittance >= frame.termination;
    var joint = no_joint();
    var done = Done(0u, 0u, 0u, 0u);
    var visited = 0u;
    var is_early = false;
    for (var first = range.x; first < range.y; first += BATCH) {
        let count = min(BATCH, range.y - first);
        if local < count {
            stage(local, tile_items[first + local]);
        }
        if local == 0u {
            atomicStore(&open_pixels, 0u);
        }
        workgroupBarrier();
        for (var slot = 0u; slot < count; slot++) {
            visited += 1u;
            if !is_open || is_outside(staged[slot].outline, position) {
                continue;
            }
            let cell = staged[slot];
            let sample = sample(cell, position);
            if sample.covered {
                var crossings = 0u;
                let light = shade(cell, staged_vertices[slot], staged_optics[slot], sample, &joint, &crossings);
                done.crossings += crossings;
                blend(&pixel, light);
                done.fragments += 1u;
                is_open = pixel.transmittance >= frame.termination;
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
            is_early = true;
            break;
        }
    }
    if is_seen {
        store_pixel(position, pixel);
    }
    count_done(tile, local, done, false, !is_early && visited != range.y - range.x);
}
