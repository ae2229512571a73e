// On which side of isosurfaces a ray is where it enters and leaves a cell, as both cells of a face find it: from the face's own corners, in
// the order of their numbers, and from exact sides of the ray. So a surface that lies within what rounding does to the scalars at a face
// is met in exactly one of the two cells, though neither knows of the other.

#use cell/cell.wgsl
#use cell/sample.wgsl
#use effects/surface_set.wgsl

struct FaceRanks {
    enter: u32,
    leave: u32,
    // Whether the ray comes in through a face: not where the eye is inside.
    enters: bool,
    // Whether the ray meets the cell.
    meets: bool,
}

// - corners: by ascending vertex; near: the cell's surfaces, first and how many
fn face_ranks(corners: array<vec4<i32>, 4>, near: vec2<u32>, pixel: vec2<i32>) -> FaceRanks {
    var all = corners;
    let ray = ray_of(pixel);
    var places: array<vec2<i32>, 4>;
    for (var corner = 0u; corner < 4u; corner++) {
        places[corner] = beside_rounded(ray, all[corner].xyz);
    }
    var found = FaceRanks(0u, 0u, false, false);
    var depths = vec2<f32>();
    var count = 0u;
    // A loop, so that each face goes through the same instructions.
    for (var opposite = 0u; opposite < 4u; opposite++) {
        let p = select(0u, 1u, opposite == 0u);
        let q = select(1u, 2u, opposite <= 1u);
        let r = select(2u, 3u, opposite <= 2u);
        let pq = side(places[p], places[q]);
        let qr = side(places[q], places[r]);
        let pr = side(places[p], places[r]);
        let sum = pq.size + qr.size + pr.size;
        if pq.sign != qr.sign || pq.sign != -pr.sign || !(sum > 0.0) {
            continue;
        }
        let first = all[p];
        let to_q = vec2<f32>(all[q].zw - first.zw) * LATTICE_STEP;
        let to_r = vec2<f32>(all[r].zw - first.zw) * LATTICE_STEP;
        let at = (to_q * pr.size + to_r * pq.size) / sum;
        let range = max(max(to_q.y, to_r.y), 0.0) - min(min(to_q.y, to_r.y), 0.0);
        let tolerance = ON_SURFACE_OF_CELL * range + ON_SURFACE_OF_FIELD;
        var rank = 0u;
        for (var index = near.x; index < near.x + near.y; index++) {
            rank += u32(at.y >= f32(surfaces[index].value - first.w) * LATTICE_STEP - tolerance);
        }
        // From the first corner, as the others' are.
        let depth = f32(first.z - all[0].z) * LATTICE_STEP + at.x;
        if count == 0u || depth < depths.x {
            found.leave = select(found.leave, found.enter, count > 0u);
            depths.y = select(depth, depths.x, count > 0u);
            found.enter = rank;
            depths.x = depth;
        } else {
            found.leave = rank;
            depths.y = depth;
        }
        count += 1u;
    }
    let eye = frame.eye.z - f32(all[0].z) * LATTICE_STEP;
    found.meets = count == 2u;
    found.enters = depths.x > eye;
    return found;
}
