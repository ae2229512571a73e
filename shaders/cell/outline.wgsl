// Where on the screen a cell can be seen.
#use include/frame.wgsl
#use cell/corners.wgsl

// What rounding may have taken, pixels: of a column of the largest picture, 2^14 from its middle, and of the integers in which rays are
// tried against corners. A pixel too many costs nothing.
const OUTLINE_MARGIN: f32 = 4e-3;
const OUTLINE_ROUNDING: f32 = 6e-7;
const NO_OUTLINE = vec4<i32>(0, 0, -1, -1);

// A point from the eye, local units.
fn from_eye(vertex: u32) -> vec3<f32> {
    return vec3<f32>(points[vertex].xyz) * LATTICE_STEP - frame.eye.xyz;
}

// The part of the picture that is drawn.
fn whole_part() -> vec4<i32> {
    return vec4<i32>(vec2<i32>(frame.origin), vec2<i32>(frame.origin + frame.extent) - 1);
}

// Whether no ray through a box of pixels can meet a cell, for a perspective view; right for cells behind the eye too.
fn misses(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, d: vec3<f32>, box: vec4<i32>) -> bool {
    // One pixel more on each side, which is far more than rounding takes from slopes.
    let low = (pixel_center(box.xy) - 1.0) * frame.slope.xy;
    let high = (pixel_center(box.zw) + 1.0) * frame.slope.xy;
    let is_below = (a.xy < low * a.z) & (b.xy < low * b.z) & (c.xy < low * c.z) & (d.xy < low * d.z);
    let is_above = (a.xy > high * a.z) & (b.xy > high * b.z) & (c.xy > high * c.z) & (d.xy > high * d.z);
    return any(is_below | is_above);
}

// The pixels of the part that is drawn whose centers the cell may cover: first column and row, last column and row; first beyond last for
// none. A cell that reaches the eye's plane has no finite outline; the part bounds it.
fn find_outline(vertices: vec4<u32>) -> vec4<i32> {
    let corner = bare(vertices);
    let a = from_eye(corner.x);
    let b = from_eye(corner.y);
    let c = from_eye(corner.z);
    let d = from_eye(corner.w);
    let nearest = min(min(a.z, b.z), min(c.z, d.z));
    let farthest = max(max(a.z, b.z), max(c.z, d.z));
    if farthest <= 0.0 {
        return NO_OUTLINE;
    }
    let part = whole_part();
    var unit = vec4<f32>(1.0);
    if frame.is_perspective != 0u {
        if nearest <= 0.0 {
            return select(part, NO_OUTLINE, misses(a, b, c, d, part));
        }
        unit = 1.0 / vec4<f32>(a.z, b.z, c.z, d.z);
    }
    let per_pixel = 1.0 / frame.slope.zw;
    let p = a.xy * unit.x * per_pixel;
    let q = b.xy * unit.y * per_pixel;
    let r = c.xy * unit.z * per_pixel;
    let s = d.xy * unit.w * per_pixel;
    let step = LATTICE_STEP * f32(4u << frame.tangent.w) * max(max(unit.x, unit.y), max(unit.z, unit.w));
    let middle = 0.5 * vec2<f32>(frame.size) - 0.5;
    let low = min(min(p, q), min(r, s));
    let high = max(max(p, q), max(r, s));
    let margin = OUTLINE_MARGIN + OUTLINE_ROUNDING * max(abs(low), abs(high)) + step * per_pixel;
    // Within what an integer holds; one pixel beyond the picture is as good as any.
    let beyond = vec2<f32>(frame.size) + 1.0;
    let first = vec2<i32>(ceil(clamp(low + middle - margin, vec2<f32>(-1.0), beyond)));
    let last = vec2<i32>(floor(clamp(high + middle + margin, vec2<f32>(-2.0), beyond)));
    let outline = vec4<i32>(max(first, part.xy), min(last, part.zw));
    return select(outline, NO_OUTLINE, any(outline.xy > outline.zw));
}

// Whether a cell with this outline may cover a pixel of a tile: column and row of the tile in the part that is drawn.
fn may_show(vertices: vec4<u32>, outline: vec4<i32>, tile: vec2<u32>) -> bool {
    let first = vec2<i32>(frame.origin + tile * TILE_SIDE);
    let box = vec4<i32>(first, first + i32(TILE_SIDE) - 1);
    if any(outline.xy > box.zw) || any(outline.zw < box.xy) {
        return false;
    }
    // Only cells at the eye's plane fill the whole part.
    if frame.is_perspective == 0u || any(outline != whole_part()) {
        return true;
    }
    let corner = bare(vertices);
    return !misses(from_eye(corner.x), from_eye(corner.y), from_eye(corner.z), from_eye(corner.w), box);
}
