// Where points lie on the screen.

#use include/frame.wgsl

// A place on the screen in pixels from the center of the pixel that the frame's columns and rows count from: right, down. For a point in
// front of the eye, given as one of the lattice and what lies between that and it. The same for every cell that has the point.
fn screen_place(point: vec4<i32>, beside: vec3<f32>) -> vec2<f32> {
    let base = vec2<i32>(frame.columns.x, frame.rows.x);
    // The base pixel's ray lies there in the plane through the base, and moves on by so much per depth.
    let ray = vec2<i32>(frame.columns.y, frame.rows.y);
    let slope = pixel_center(base) * frame.slope.xy;
    let depth = f32(point.z) * LATTICE_STEP + beside.z;
    let from_ray = (vec2<f32>(point.xy - ray) - frame.rest.xz) * LATTICE_STEP + beside.xy - slope * depth;
    let pixel = (vec2<f32>(vec2<i32>(frame.columns.z, frame.rows.z)) + frame.rest.yw) * LATTICE_STEP + frame.slope.xy * depth;
    return from_ray / pixel;
}

// The position of a place for the rasterizer; w is 1, so that what is handed on is linear on the screen.
fn position_of(place: vec2<f32>) -> vec4<f32> {
    let base = vec2<i32>(frame.columns.x, frame.rows.x) - vec2<i32>(frame.origin);
    let from_corner = vec2<f32>(base) + 0.5 + place;
    let share = from_corner / vec2<f32>(frame.extent);
    return vec4<f32>(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, 0.5, 1.0);
}
