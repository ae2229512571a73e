// The fan of a cell: what `fans` writes, and what becomes of it at each of its vertices.
//
// A record is a vec4<u32>: the shape, two weights, and the difference of nearness along the thickest chord (f32). The chord's near end is
// the mean of the corners P whose opposite faces are turned away from the eye, its far end that of the others, N; the weights are those of
// all but the first of P and all but the first of N, ascending. There are never more than two.

#use triangles/corners.wgsl

// Shape, by bits:
// 0 to 6: the four signs as the classification by a table counts them, 0 to 80
// 8 to 17: the corners around the thick vertex, two bits each
// 18 to 20: triangles, or SHAPE_BOX
// 21 to 22: the corner in whose place the thick vertex lies; 23: whether there is one
// 24 to 27: P; 28 to 31: N
const SHAPE_RING: u32 = 8u;
const SHAPE_TRIANGLES: u32 = 18u;
const SHAPE_CORNER: u32 = 21u;
const SHAPE_HAS_CORNER: u32 = 23u;
const SHAPE_PLUS: u32 = 24u;
const SHAPE_MINUS: u32 = 28u;
// Instead of a number of triangles: the cell has no fan, and is found ray by ray within a box.
const SHAPE_BOX: u32 = 7u;

// What is linear on the screen over each triangle.
struct FanVertex {
    // Nearness where the ray enters, and how much less it is where the ray leaves.
    nearness: f32,
    difference: f32,
    // Scalars there, over the depth as a share of the reference's; orthographic: the scalars.
    front: f32,
    back: f32,
    // A point of it: a corner, and what lies between the corner and it.
    point: vec4<i32>,
    beside: vec3<f32>,
}

fn triangles_of(shape: u32) -> u32 {
    return (shape >> SHAPE_TRIANGLES) & 7u;
}

// A scalar over the depth as a share of the reference's.
fn over_depth(scalar: f32, nearness: f32) -> f32 {
    return select(scalar, scalar * (1.0 + nearness), frame.is_perspective != 0u);
}

fn corner_vertex(corners: Corners, corner: u32) -> FanVertex {
    var all = corners;
    let nearness = nearness_at(all.beyond[corner], all.depths[corner]);
    let scalar = over_depth(all.scalars[corner], nearness);
    return FanVertex(nearness, 0.0, scalar, scalar, all.points[corner], vec3<f32>());
}

// One end of the thickest chord.
struct ChordEnd {
    // The first of its corners, and what lies between that and it.
    first: u32,
    beside: vec3<f32>,
    beyond: f32,
    scalar: f32,
    // How many weights it has used.
    used: u32,
}

fn chord_end(corners: Corners, members: u32, weights: vec2<f32>) -> ChordEnd {
    var all = corners;
    var end = ChordEnd(countTrailingZeros(members), vec3<f32>(), 0.0, 0.0, 0u);
    end.beyond = all.beyond[end.first];
    end.scalar = all.scalars[end.first];
    let base = all.points[end.first];
    let scalar = end.scalar;
    for (var corner = end.first + 1u; corner < 4u; corner++) {
        if ((members >> corner) & 1u) != 0u {
            let weight = select(weights.y, weights.x, end.used == 0u);
            let edge = between(base, all.points[corner]);
            end.beside += weight * edge;
            end.beyond += weight * edge.z;
            end.scalar += weight * (all.scalars[corner] - scalar);
            end.used += 1u;
        }
    }
    return end;
}

fn thick_vertex(corners: Corners, record: vec4<u32>) -> FanVertex {
    var all = corners;
    let weights = bitcast<vec2<f32>>(record.yz);
    let near = chord_end(corners, (record.x >> SHAPE_PLUS) & 15u, weights);
    let far = chord_end(corners, record.x >> SHAPE_MINUS, select(weights, weights.yy, near.used == 1u));
    let difference = bitcast<f32>(record.w);
    let nearness = nearness_at(near.beyond, corners.depth + near.beyond);
    let front = over_depth(near.scalar, nearness);
    let back = over_depth(far.scalar, nearness - difference);
    var vertex = FanVertex(nearness, difference, front, back, all.points[near.first], near.beside);
    if ((record.x >> SHAPE_HAS_CORNER) & 1u) != 0u {
        // The corner itself, so that no crack opens to the cell beside.
        vertex.point = all.points[(record.x >> SHAPE_CORNER) & 3u];
        vertex.beside = vec3<f32>();
    }
    return vertex;
}

// A vertex of the list of triangles: three each, the thick vertex first. Beyond the last triangle: the thick vertex.
fn fan_vertex(corners: Corners, record: vec4<u32>, number: u32) -> FanVertex {
    let triangle = number / 3u;
    let within = number % 3u;
    if within == 0u || triangle >= triangles_of(record.x) {
        return thick_vertex(corners, record);
    }
    let place = triangle + within - 1u;
    return corner_vertex(corners, (record.x >> (SHAPE_RING + 2u * place)) & 3u);
}
