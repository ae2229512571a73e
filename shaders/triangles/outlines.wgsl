// Sets up the cells of a draw block: one invocation makes the polygon of one cell, and the first writes the arguments of the draw.
//
// In: frame, points, drawn, totals, block, pieces. Out: outlined (a record a cell), arguments (vertices and instances of the draw).
//
// The polygon is the cell's silhouette, as it is classified, and a little more: rasterizers move corners onto a lattice of 1/16 to 1/256 of
// a pixel, which may leave out a pixel of the cell but must not. Which pixels are the cell's the ray in each of them decides. A cell that
// has no silhouette, or is so thin that what is added would be most of it, gets the box around its pixels.

#use include/list.wgsl
#use cell/set_up.wgsl
#use cell/optics.wgsl
#use cell/classify.wgsl
#use triangles/corners.wgsl
#use triangles/list.wgsl
#use triangles/outlined.wgsl
#use triangles/screen.wgsl

@group(0) @binding(41) var<storage, read_write> arguments: array<u32>;
@group(0) @binding(45) var<storage, read_write> outlined: array<Outlined>;

// How far the edges of the silhouette are moved outward, pixels: more than a rasterizer moves them inward, and rounding.
const ADDED: f32 = 0.125;
// So far a corner may lie beyond an edge by what rounding does to the classification, pixels.
const TOLERATED: f32 = 0.03125;

// The box around a cell's pixels; without any: a point.
fn box_around(outline: vec4<i32>) -> array<vec2<f32>, 4> {
    if any(outline.xy > outline.zw) {
        return array<vec2<f32>, 4>();
    }
    let base = vec2<f32>(vec2<i32>(frame.columns.x, frame.rows.x)) + 0.5;
    let low = vec2<f32>(outline.xy) - base;
    let high = vec2<f32>(outline.zw) + 1.0 - base;
    return array<vec2<f32>, 4>(low, vec2<f32>(high.x, low.y), high, vec2<f32>(low.x, high.y));
}

fn turned(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return a.x * b.y - a.y * b.x;
}

fn polygon_of(vertices: vec4<u32>, outline: vec4<i32>) -> array<vec2<f32>, 4> {
    let around = box_around(outline);
    let corners = corners_of(vertices);
    let nearest = lowest(corners.depths);
    let found = classify(vertices);
    let is_near = nearest <= select(0.0, NEAR_SHARE * highest(corners.depths), frame.is_perspective != 0u);
    if is_near || found.ring_count == 0u || any(outline.xy > outline.zw) {
        return around;
    }

    // The silhouette: the ring without its end where it closes; of the least ring the thick vertex is a corner too.
    let count = select(3u, 4u, found.ring_count == 5u);
    var points_of_cell = corners.points;
    var places: array<vec2<f32>, 4>;
    for (var corner = 0u; corner < 4u; corner++) {
        places[corner] = screen_place(points_of_cell[corner], vec3<f32>());
    }
    var polygon: array<vec2<f32>, 4>;
    var middle = vec2<f32>();
    for (var turn = 0u; turn < 4u; turn++) {
        let of_ring = ring_corner(found.ring, min(turn, count - 1u));
        polygon[turn] = places[select(of_ring, found.corner & 3u, turn >= 2u && found.ring_count == 2u)];
        middle += select(vec2<f32>(), polygon[turn], turn < count);
    }
    middle /= f32(count);

    // Twice the area, by the way around.
    let area = turned(polygon[1] - polygon[0], polygon[2] - polygon[0]) + turned(polygon[2] - polygon[0], polygon[3] - polygon[0]);
    let way = select(-1.0, 1.0, area > 0.0);
    // From the middle to the nearest edge; and whether all corners lie within.
    var inward = 1e30;
    var is_around = true;
    for (var turn = 0u; turn < count; turn++) {
        let start = polygon[turn];
        let edge = polygon[select(turn + 1u, 0u, turn + 1u == count)] - start;
        let edge_length = max(length(edge), 1e-30);
        inward = min(inward, way * turned(edge, middle - start) / edge_length);
        for (var corner = 0u; corner < 4u; corner++) {
            is_around = is_around && way * turned(edge, places[corner] - start) >= -TOLERATED * edge_length;
        }
    }
    if !(is_around && inward > 1e-3) {
        return around;
    }
    let stretch = 1.0 + ADDED / inward;
    let size = around[2] - around[0];
    if 0.5 * abs(area) * stretch * stretch >= size.x * size.y {
        return around;
    }
    for (var turn = 0u; turn < 4u; turn++) {
        polygon[turn] = middle + stretch * (polygon[turn] - middle);
    }
    return polygon;
}

@compute @workgroup_size(GROUP)
fn outlines_of_block(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let place = group_number(group, groups) * GROUP + thread;
    let cells = cells_of_block();
    if place == 0u {
        arguments[0] = 6u * cells;
        arguments[1] = 1u;
        arguments[2] = 0u;
        arguments[3] = 0u;
    }
    if place < cells {
        let vertices = vertices_of(place);
        let cell = set_up(vertices);
        outlined[place] = outlined_of(cell, optics_of(cell), polygon_of(vertices, cell.outline));
    }
}
