// An outline for tests of the binning: the indices of the vertices, as a box of pixels.
//
// A cell whose volume is said to be negative shows in some of its tiles alone.

fn find_outline(vertices: vec4<u32>) -> vec4<i32> {
    return vec4<i32>(vec4<u32>(vertices.xyz, vertices.w & ~NEGATIVE_BIT)) - 100;
}

fn may_show(vertices: vec4<u32>, outline: vec4<i32>, tile: vec2<u32>) -> bool {
    return (vertices.w & NEGATIVE_BIT) == 0u || (tile.x * 7u + tile.y * 3u + u32(outline.x + 100)) % 5u < 2u;
}
