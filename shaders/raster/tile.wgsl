// One tile of the picture and its pixels: one group a tile, one invocation a pixel.
//
// Thirty-two invocations in a row have eight by four pixels, so that what runs together on a device sees the same few cells.

#use include/frame.wgsl
#use include/list.wgsl
#use include/opacity.wgsl

@group(0) @binding(10) var<storage, read> drawn: array<vec4<u32>>;
@group(0) @binding(11) var<storage, read> tile_starts: array<u32>;
@group(0) @binding(12) var<storage, read> tile_items: array<u32>;
// Pixels row by row: red, green, blue, packed opacity, as bits; then for every tile: fragments, crossings, fragments that were sorted, most that one pixel
// held back, with TILE_OPEN and TILE_CUT.
@group(0) @binding(13) var<storage, read_write> picture: array<vec4<u32>>;

var<workgroup> fragments_of_tile: atomic<u32>;
var<workgroup> crossings_of_tile: atomic<u32>;
var<workgroup> sorted_of_tile: atomic<u32>;
// The most that a pixel held back, and the bits.
var<workgroup> most_of_tile: atomic<u32>;
var<workgroup> flags_of_tile: atomic<u32>;

// A pixel while it is drawn.
struct Pixel {
    rgb: vec3<f32>,
    // Packed, see include/opacity.wgsl.
    hides: f32,
}

// What was done in a pixel.
struct Done {
    fragments: u32,
    crossings: u32,
    sorted: u32,
    most: u32,
}

// The first pixel of a tile: absolute column and row.
fn corner_of(tile: u32) -> vec2<u32> {
    return frame.origin + vec2<u32>(tile % frame.tiles.x, tile / frame.tiles.x) * TILE_SIDE;
}

// A pixel of a tile: absolute column and row.
fn pixel_of(tile: u32, local: u32) -> vec2<i32> {
    let strip = local >> 5u;
    let within = vec2<u32>((local & 7u) + 8u * (strip & 1u), ((local >> 3u) & 3u) + 4u * (strip >> 1u));
    return vec2<i32>(corner_of(tile) + within);
}

fn is_in_picture(pixel: vec2<i32>) -> bool {
    return all(vec2<u32>(pixel) < frame.origin + frame.extent);
}

fn place_in_picture(pixel: vec2<i32>) -> u32 {
    let within = vec2<u32>(pixel) - frame.origin;
    return within.y * frame.extent.x + within.x;
}

fn load_pixel(pixel: vec2<i32>) -> Pixel {
    let stored = bitcast<vec4<f32>>(picture[place_in_picture(pixel)]);
    return Pixel(stored.rgb, stored.a);
}

fn store_pixel(pixel: vec2<i32>, value: Pixel) {
    picture[place_in_picture(pixel)] = bitcast<vec4<u32>>(vec4<f32>(value.rgb, value.hides));
}

fn is_outside(outline: vec4<i32>, pixel: vec2<i32>) -> bool {
    return any(pixel < outline.xy) || any(pixel > outline.zw);
}

// Puts light behind what a pixel has.
fn blend(pixel: ptr<function, Pixel>, light: Light) {
    (*pixel).rgb += through((*pixel).hides) * light.rgb;
    (*pixel).hides = with_opacity((*pixel).hides, light.opacity);
}

// Marks a tile as cut until `count_done` knows better, and gives its counts so far to the group's first invocation.
//
// Where a driver ends loops, some invocations leave a loop with barriers before others do, and a driver may then abandon those others where they are:
// what they would have drawn and said is lost.
fn begin_tile(tile: u32, local: u32) -> vec4<u32> {
    var before = vec4<u32>(0u);
    if local == 0u {
        let place = frame.extent.x * frame.extent.y + tile;
        before = picture[place];
        picture[place] = before | vec4<u32>(0u, 0u, 0u, TILE_CUT);
    }
    return before;
}

// Whether the driver has ended a loop of this invocation before its end, or would end the next: then this one does not turn twice.
//
// - above_zero: a number that is not 0, and not known when this is compiled
fn is_cut(above_zero: u32) -> bool {
    let needed = 1u + min(above_zero, 1u);
    var turns = 0u;
    while turns < needed {
        turns += 1u;
    }
    return turns < needed;
}

// Adds what was done to the tile's counts. All invocations of the group take part.
//
// - before: of `begin_tile`
// - is_open: whether the pixel is to be run again
// - is_cut: whether the driver ended a loop before its end
fn count_done(tile: u32, local: u32, before: vec4<u32>, done: Done, is_open: bool, is_cut: bool) {
    atomicAdd(&fragments_of_tile, done.fragments);
    atomicAdd(&crossings_of_tile, done.crossings);
    atomicAdd(&sorted_of_tile, done.sorted);
    atomicMax(&most_of_tile, done.most);
    atomicOr(&flags_of_tile, select(0u, TILE_OPEN, is_open) | select(0u, TILE_CUT, is_cut));
    workgroupBarrier();
    if local == 0u {
        let now = vec3<u32>(
            atomicLoad(&fragments_of_tile),
            atomicLoad(&crossings_of_tile),
            atomicLoad(&sorted_of_tile),
        );
        let most = max(before.w & ~(TILE_OPEN | TILE_CUT), atomicLoad(&most_of_tile));
        let place = frame.extent.x * frame.extent.y + tile;
        picture[place] = vec4<u32>(before.xyz + now, most | (before.w & TILE_CUT) | atomicLoad(&flags_of_tile));
    }
}
