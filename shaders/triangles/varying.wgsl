// What the vertices of fans hand on.
//
// All is linear on the screen: w is 1 at every vertex, so that interpolation in perspective is linear. Asking for linear interpolation instead
// is not what every API has, and the clipper of Mesa's software driver then takes the wrong share of edges that are nearly upright.

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    // Linear on the screen: color and opacity, see triangles/thick.wgsl.
    @location(0) attributes: vec4<f32>,
    // The place on the screen from the anchor's center, pixels.
    @location(1) place: vec2<f32>,
    // A pixel near the cell, and the cell's place in the block with IS_BOX.
    @location(2) @interpolate(flat) anchor: vec2<i32>,
    @location(3) @interpolate(flat) cell: u32,
}
