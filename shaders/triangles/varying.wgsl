// What the vertices of triangles hand on.
//
// All is linear on the screen: w is 1 at every vertex, so that interpolation in perspective is linear. Asking for linear interpolation instead
// is not what every API has, and the clipper of Mesa's software driver then takes the wrong share of edges that are nearly upright.

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    // Linear on the screen; what they are is up to the <triangle>.
    @location(0) attributes: vec4<f32>,
    // The place on the screen from the anchor's center, pixels.
    @location(1) place: vec2<f32>,
    // A pixel near the cell, and the cell's place in the block with IS_BOX.
    @location(2) @interpolate(flat) anchor: vec2<i32>,
    @location(3) @interpolate(flat) cell: u32,
    // Of the cell: what the <triangle> wants to know of it.
    @location(4) @interpolate(flat) numbers: vec4<f32>,
    @location(5) @interpolate(flat) bounds: vec4<f32>,
    @location(6) @interpolate(flat) counts: vec4<i32>,
}
