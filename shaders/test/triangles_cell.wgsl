// Cells ray by ray without care for rounding, for tests of the triangles alone: `faces` are planes in camera axes about the eye, `speeds` hold
// the first corner and what the field is there, and its gradient.

#use include/frame.wgsl
#use cell/cell.wgsl
#use integrate/light.wgsl
#use integrate/pieces.wgsl
#use triangles/corners.wgsl

fn set_up(vertices: vec4<u32>) -> Cell {
    let corners = corners_of(vertices);
    let a = vec3<f32>(corners.points[0].xyz) * LATTICE_STEP - frame.eye.xyz;
    let ab = between(corners.points[0], corners.points[1]);
    let ac = between(corners.points[0], corners.points[2]);
    let ad = between(corners.points[0], corners.points[3]);
    let sign = select(1.0, -1.0, corners.is_negative);
    let volume = dot(cross(ab, ac), ad);
    let b_normal = cross(ad, ac);
    let c_normal = cross(ab, ad);
    let d_normal = cross(ac, ab);
    let a_normal = cross(ac - ab, ad - ab);
    var cell: Cell;
    cell.faces = array<vec4<f32>, 4>(
        vec4<f32>(a_normal, dot(a_normal, a + ab)) * sign,
        vec4<f32>(b_normal, dot(b_normal, a)) * sign,
        vec4<f32>(c_normal, dot(c_normal, a)) * sign,
        vec4<f32>(d_normal, dot(d_normal, a)) * sign,
    );
    let s = corners.scalars;
    let gradient = -(b_normal * (s.y - s.x) + c_normal * (s.z - s.x) + d_normal * (s.w - s.x)) / volume;
    cell.speeds[0] = vec4<f32>(a, s.x);
    cell.speeds[1] = vec4<f32>(gradient, 0.0);
    cell.scalars = vec2<f32>(lowest(s), highest(s));
    cell.reference = corners.scalar;
    return cell;
}

fn sample(cell: Cell, pixel: vec2<i32>) -> Sample {
    let center = pixel_center(pixel);
    let is_perspective = frame.is_perspective != 0u;
    let ray = vec3<f32>(center * frame.slope.xy, 1.0);
    let start = select(vec3<f32>(center * frame.slope.zw, 0.0), vec3<f32>(), is_perspective);
    var enter = 0.0;
    var leave = 1e9;
    var faces = cell.faces;
    for (var face = 0; face < 4; face++) {
        let speed = dot(faces[face].xyz, ray);
        let depth = (faces[face].w - dot(faces[face].xyz, start)) / speed;
        if speed < 0.0 {
            enter = max(enter, depth);
        } else {
            leave = min(leave, depth);
        }
    }
    var found: Sample;
    found.covered = enter < leave;
    let at = cell.speeds[0].w + vec2<f32>(
        dot(cell.speeds[1].xyz, start + ray * enter - cell.speeds[0].xyz),
        dot(cell.speeds[1].xyz, start + ray * leave - cell.speeds[0].xyz),
    );
    found.front = at.x;
    found.back = at.y;
    found.length = (leave - enter) * length(ray);
    found.center = center;
    return found;
}

fn optics_of(cell: Cell) -> Optics {
    let found = find_pieces(cell.reference, cell.scalars.x, cell.scalars.y);
    return Optics(cell.reference, cell.scalars.x, cell.scalars.y, found.x, found.y);
}

fn find_outline(vertices: vec4<u32>) -> vec4<i32> {
    let first = vec2<i32>(frame.origin);
    return vec4<i32>(first, first + vec2<i32>(frame.extent) - 1);
}
