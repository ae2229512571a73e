// Every pixel integrates along its ray: nearness and scalars at both ends are linear on the screen over each triangle.
//
// Attributes: nearness where the ray enters, how much less it is where it leaves, and both scalars over their depth as shares of the
// reference's. Neither lengths nor scalars are linear in a perspective view.

#use cell/cell.wgsl
#use integrate/light.wgsl
#use triangles/fan.wgsl
#use triangles/varying.wgsl
#use integrate/pieces.wgsl
#use <effects>

fn carry(corners: Corners, record: vec4<u32>, at: FanVertex, handed: ptr<function, Varying>) {
    let low = lowest(corners.scalars);
    let high = highest(corners.scalars);
    let farthest = nearness_at(highest(corners.beyond), highest(corners.depths));
    let nearest = nearness_at(lowest(corners.beyond), lowest(corners.depths));
    let met = find_pieces(corners.scalar, low, high);
    (*handed).attributes = vec4<f32>(at.nearness, at.difference, at.front, at.back);
    (*handed).numbers = vec4<f32>(corners.depth, bitcast<f32>(record.w), corners.depth_shown, 0.0);
    (*handed).bounds = vec4<f32>(farthest, nearest, low, high);
    (*handed).counts = vec4<i32>(corners.scalar, vec2<i32>(met), 0);
}

fn fan_light(handed: Varying, attributes: vec4<f32>, vertices: vec4<u32>, pixel: vec2<i32>) -> Light {
    let reference = handed.numbers.x;
    let bounds = handed.bounds;
    let is_perspective = frame.is_perspective != 0u;

    var cell: Cell;
    cell.pixel = pixel;
    cell.nearness = bounds.xy;
    cell.scalars = bounds.zw;
    cell.reference = handed.counts.x;
    cell.depth = handed.numbers.z;
    cell.length = select(1.0, reference, is_perspective);

    // Beside the outline, where rounding lets a pixel count as covered, nothing is between the ends.
    let difference = clamp(attributes.y, 0.0, handed.numbers.y);
    let enter = clamp(attributes.x, bounds.x, bounds.y);
    let leave = enter - difference;
    var found: Sample;
    found.covered = true;
    found.center = pixel_center(pixel);
    var scalars = attributes.zw;
    var length = difference;
    found.depth = cell.depth - vec2<f32>(enter, leave);
    if is_perspective {
        let depths = 1.0 / (1.0 + max(vec2<f32>(enter, leave), bounds.xx));
        scalars *= depths;
        length = reference * difference * depths.x * depths.y;
        found.depth = cell.depth - reference * vec2<f32>(enter, leave) * depths;
    }
    found.length = length * ray_stretch(found.center);
    found.front = clamp(scalars.x, bounds.z, bounds.w);
    found.back = clamp(scalars.y, bounds.z, bounds.w);

    let of_cell = Optics(cell.reference, bounds.z, bounds.w, u32(handed.counts.y), u32(handed.counts.z));
    var joint = no_joint();
    var crossings = 0u;
    return shade(cell, vertices, of_cell, found, &joint, &crossings);
}
