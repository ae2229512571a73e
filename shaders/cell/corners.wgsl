// Corners of a cell, as the stage `project` left them.

// Position from the base in lattice steps: right, down, forward; and scalar.
@group(0) @binding(2) var<storage, read> points: array<vec4<i32>>;

// The cell's vertices without the bits that say something else.
fn bare(vertices: vec4<u32>) -> vec4<u32> {
    return vec4<u32>(vertices.xy, vertices.z & ~RING_BIT, vertices.w & ~NEGATIVE_BIT);
}
