// The view: see `layout::Frame`, which has units and meanings.

struct Frame {
    right: vec4<i32>,
    down: vec4<i32>,
    forward: vec4<i32>,
    eye: vec4<f32>,
    columns: vec4<i32>,
    rows: vec4<i32>,
    rest: vec4<f32>,
    slope: vec4<f32>,
    size: vec2<u32>,
    origin: vec2<u32>,
    extent: vec2<u32>,
    tiles: vec2<u32>,
    is_perspective: u32,
    termination: f32,
    cells: u32,
    points: u32,
    tangent: vec4<u32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// Center of a pixel from the middle of the picture, in pixels: right and down.
fn pixel_center(pixel: vec2<i32>) -> vec2<f32> {
    return vec2<f32>(pixel) + 0.5 - 0.5 * vec2<f32>(frame.size);
}

// How much longer a pixel's ray is than straight ahead.
fn ray_stretch(center: vec2<f32>) -> f32 {
    let across = center * frame.slope.xy;
    return sqrt(1.0 + dot(across, across));
}

// Depth, from the base, that depths are counted from.
fn start_from_base() -> f32 {
    return frame.eye.z + frame.eye.w;
}
