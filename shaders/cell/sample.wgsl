// What the ray of a pixel has inside of a cell.
#use cell/cell.wgsl
#use cell/ray.wgsl

fn sample(cell: Cell, pixel: vec2<i32>) -> Sample {
    if cell.entry_count == 0u {
        return sample_corners(cell, pixel);
    }
    return sample_planes(cell, pixel);
}

fn nearness_of(plane: vec4<i32>, offset: vec2<f32>) -> f32 {
    let numbers = bitcast<vec3<f32>>(plane.xyz);
    return numbers.x + (numbers.y * offset.x + numbers.z * offset.y);
}

fn sample_planes(cell: Cell, pixel: vec2<i32>) -> Sample {
    let offset = vec2<f32>(pixel - cell.pixel);
    let q = nearness_of(cell.faces[1], offset);
    let r = nearness_of(cell.faces[2], offset);
    var enter = min(nearness_of(cell.faces[0], offset), cell.nearness.y);
    var leave = max(nearness_of(cell.faces[3], offset), cell.nearness.x);
    enter = select(enter, min(enter, q), cell.entry_count > 1u);
    leave = select(max(leave, q), leave, cell.entry_count > 1u);
    enter = select(enter, min(enter, r), cell.entry_count > 2u);
    leave = select(max(leave, r), leave, cell.entry_count > 2u);

    var sample: Sample;
    sample.covered = enter > leave;
    // Pixels outside get harmless numbers: no ray there comes near a zero denominator.
    enter = select(0.0, enter, sample.covered);
    leave = select(0.0, leave, sample.covered);
    sample.center = pixel_center(pixel);
    let across = dot(cell.scalar.xy, offset);
    var ends = across - cell.scalar.z * vec2<f32>(enter, leave);
    var length = enter - leave;
    var depth = vec2<f32>(enter, leave);
    if frame.is_perspective != 0u {
        // One division serves both ends.
        let inverse = 1.0 / ((1.0 + enter) * (1.0 + leave));
        let unit = inverse * vec2<f32>(1.0 + leave, 1.0 + enter);
        ends *= unit;
        length *= inverse * cell.length;
        // The reference's depth and what is to be added to it: from far away the sum would lose what tells cells apart.
        depth *= unit * cell.length;
    }
    ends = clamp(ends, vec2<f32>(cell.scalars.x), vec2<f32>(cell.scalars.y));
    sample.front = ends.x;
    sample.back = ends.y;
    sample.length = length * ray_stretch(sample.center);
    sample.depth = cell.depth - depth;
    return sample;
}

// On which side of the ray an edge passes: twice the area that both span on the screen, and its sign.
struct Side {
    size: f32,
    sign: i32,
}

// Exact. Where the ray meets the edge it is moved a little to the right and, by far less, down: so does every cell that has the edge, and
// exactly one of those about it has the ray.
fn side(p: vec2<i32>, q: vec2<i32>) -> Side {
    let area = wide_difference(wide_product(p.x, q.y), wide_product(p.y, q.x));
    let moved = select(sign(p.y - q.y), sign(q.x - p.x), p.y == q.y);
    let exact = wide_sign(area);
    return Side(abs(wide_to_float(area)), select(exact, moved, exact == 0));
}

// Depth and scalar where the ray enters and leaves.
struct Ends {
    enter: vec2<f32>,
    leave: vec2<f32>,
    // Faces that it meets: 0 or 2.
    count: u32,
}

// Depth and scalar of a ray that meets a face, from those of its corners.
fn try_face(ends: ptr<function, Ends>, pq: Side, qr: Side, pr: Side, p: vec2<f32>, q: vec2<f32>, r: vec2<f32>) {
    // A face without area on the screen has no three equal signs: one of equal signs has an area.
    if pq.sign != qr.sign || pq.sign != -pr.sign {
        return;
    }
    let sum = pq.size + qr.size + pr.size;
    if !(sum > 0.0) {
        return;
    }
    // From the corner that counts most: what the others count is then at most a half, and rounding of it with it.
    let weights = vec3<f32>(qr.size, pr.size, pq.size) / sum;
    let is_p = weights.x >= weights.y && weights.x >= weights.z;
    let is_q = !is_p && weights.y >= weights.z;
    let base = select(select(r, q, is_q), p, is_p);
    let at = base + ((p - base) * weights.x + (q - base) * weights.y + (r - base) * weights.z);
    if (*ends).count == 0u {
        (*ends).enter = at;
        (*ends).leave = at;
    } else if at.x < (*ends).enter.x {
        (*ends).enter = at;
    } else {
        (*ends).leave = at;
    }
    (*ends).count += 1u;
}

fn sample_corners(cell: Cell, pixel: vec2<i32>) -> Sample {
    let ray = ray_of(pixel);
    let a = beside_rounded(ray, cell.faces[0].xyz);
    let b = beside_rounded(ray, cell.faces[1].xyz);
    let c = beside_rounded(ray, cell.faces[2].xyz);
    let d = beside_rounded(ray, cell.faces[3].xyz);
    let ab = side(a, b);
    let ac = side(a, c);
    let ad = side(a, d);
    let bc = side(b, c);
    let bd = side(b, d);
    let cd = side(c, d);
    // Depth from the first corner, and scalar from its.
    let first = cell.faces[0].zw;
    let at_b = vec2<f32>(cell.faces[1].zw - first) * LATTICE_STEP;
    let at_c = vec2<f32>(cell.faces[2].zw - first) * LATTICE_STEP;
    let at_d = vec2<f32>(cell.faces[3].zw - first) * LATTICE_STEP;
    var ends = Ends(vec2<f32>(0.0), vec2<f32>(0.0), 0u);
    try_face(&ends, bc, cd, bd, at_b, at_c, at_d);
    try_face(&ends, ac, cd, ad, vec2<f32>(0.0), at_c, at_d);
    try_face(&ends, ab, bd, ad, vec2<f32>(0.0), at_b, at_d);
    try_face(&ends, ab, bc, ac, vec2<f32>(0.0), at_b, at_c);

    var sample: Sample;
    sample.center = pixel_center(pixel);
    var enter = ends.enter;
    // Nothing behind the eye is seen.
    let depth = f32(first.x) * LATTICE_STEP;
    let eye = frame.eye.z - depth;
    let whole = ends.leave.x - enter.x;
    sample.covered = ends.count == 2u && whole > 0.0 && ends.leave.x > eye;
    if sample.covered && enter.x < eye {
        enter = mix(enter, ends.leave, (eye - enter.x) / whole);
    }
    enter = select(vec2<f32>(0.0), enter, sample.covered);
    let leave = select(vec2<f32>(0.0), ends.leave, sample.covered);
    sample.front = clamp(enter.y, cell.scalars.x, cell.scalars.y);
    sample.back = clamp(leave.y, cell.scalars.x, cell.scalars.y);
    sample.length = (leave.x - enter.x) * ray_stretch(sample.center);
    sample.depth = depth - start_from_base() + vec2<f32>(enter.x, leave.x);
    return sample;
}
