// Corners of a cell, as the stage `project` left them.

#use include/points.wgsl

// The cell's vertices without the bits that say something else.
fn bare(vertices: vec4<u32>) -> vec4<u32> {
    return vec4<u32>(vertices.xy, vertices.z & ~RING_BIT, vertices.w & ~NEGATIVE_BIT);
}
