// Draws the cells of a draw block, back to front: instance i is the i-th cell from the back, 12 vertices its fan of up to four triangles or
// a box around it. Light is found at the vertices and interpolated: one invocation of `fragment` gives that of one cell at one pixel, color
// (linear, premultiplied) and opacity, for blending with what lies behind: ONE, ONE_MINUS_SRC_ALPHA.
//
// In: frame, points, drawn, totals, block, fans (made by triangles/fans.wgsl), and what the light of a cell takes.
//
// Rasterizers move vertices onto a lattice of 1/16 to 1/256 of a pixel. So that this moves no attribute, the place on the screen is
// interpolated too: where it differs from the pixel's center, attributes are carried over by their slopes.
//
// <effects>: the light of a cell that has no fan.

#use include/frame.wgsl
#use triangles/assembled.wgsl
#use triangles/list.wgsl
#use triangles/fan.wgsl
#use triangles/screen.wgsl
#use triangles/varying.wgsl
#use cell/set_up.wgsl
#use cell/sample.wgsl
#use cell/optics.wgsl
#use cell/outline.wgsl
#use triangles/thick.wgsl
#use <effects>

@group(0) @binding(40) var<storage, read> fans: array<vec4<u32>>;

const IS_BOX: u32 = 0x80000000u;
// Farther than that no rasterizer moves a vertex, pixels.
const MOST_MOVED: f32 = 0.0625;

@vertex
fn vertex(@builtin(vertex_index) number: u32, @builtin(instance_index) instance: u32) -> Varying {
    let place = cells_of_block() - 1u - instance;
    let vertices = vertices_of(place);
    let record = fans[place];
    var handed: Varying;
    if triangles_of(record.x) == SHAPE_BOX {
        handed.position = box_vertex(find_outline(vertices), number);
        handed.cell = place | IS_BOX;
        return handed;
    }
    let corners = corners_of(vertices);
    handed.cell = place;
    if triangles_of(record.x) == 0u {
        handed.position = vec4<f32>(0.0, 0.0, 0.5, 1.0);
        return handed;
    }
    let at = fan_vertex(corners, record, number);
    let on_screen = screen_place(at.point, at.beside);
    handed.position = position_of(on_screen);
    // The first corner's pixel is close, and one and the same for the whole cell.
    let anchor = round(screen_place(corners.points[0], vec3<f32>()));
    handed.anchor = vec2<i32>(anchor) + vec2<i32>(frame.columns.x, frame.rows.x);
    handed.place = on_screen - anchor;
    handed.attributes = light_at(corners, at);
    return handed;
}

// Two triangles over a box of pixels; the other vertices lie in one point.
fn box_vertex(outline: vec4<i32>, number: u32) -> vec4<f32> {
    let is_empty = outline.x > outline.z || outline.y > outline.w || number >= 6u;
    // Corners 0 1 2, 2 1 3 of the box.
    let corner = select(number, 5u - number, number >= 3u && number < 5u);
    let at = select(corner, 3u, number == 5u);
    let far = vec2<bool>((at & 1u) != 0u, (at & 2u) != 0u);
    let edge = select(vec2<f32>(outline.xy), vec2<f32>(outline.zw) + 1.0, far);
    let base = vec2<f32>(vec2<i32>(frame.columns.x, frame.rows.x)) + 0.5;
    return position_of(select(edge - base, vec2<f32>(), is_empty));
}

@fragment
fn fragment(handed: Varying) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(floor(handed.position.xy)) + vec2<i32>(frame.origin);
    // Slopes first: neighbors take part in them.
    let per_column = dpdx(handed.attributes);
    let per_row = dpdy(handed.attributes);
    let moved = vec2<f32>(pixel - handed.anchor) - handed.place;
    let back = clamp(moved, vec2<f32>(-MOST_MOVED), vec2<f32>(MOST_MOVED));
    let attributes = handed.attributes + back.x * per_column + back.y * per_row;
    if (handed.cell & IS_BOX) == 0u {
        return assembled(fan_light(attributes));
    }
    let vertices = vertices_of(handed.cell & ~IS_BOX);
    let cell = set_up(vertices);
    let found = sample(cell, pixel);
    if !found.covered {
        discard;
    }
    var joint = no_joint();
    var crossings = 0u;
    return assembled(shade(cell, vertices, optics_of(cell), found, &joint, &crossings));
}
