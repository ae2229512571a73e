// Which cells a draw block has.
//
// totals: 0 the cells that are drawn in the frame. block: places of the order that are drawn now. drawn: their vertices, front to back.

#use include/points.wgsl
#use include/block.wgsl

@group(0) @binding(10) var<storage, read> drawn: array<vec4<u32>>;
@group(0) @binding(18) var<storage, read> totals: array<u32>;

// How many cells of the block are there: the last block has fewer.
fn cells_of_block() -> u32 {
    let cells = totals[0];
    return min(block.count, cells - min(cells, block.first));
}

// The vertices of a cell of the block; the last has NEGATIVE_BIT, and none says whether the cell lies in a ring.
fn vertices_of(place: u32) -> vec4<u32> {
    let vertices = drawn[place];
    return vec4<u32>(vertices.xy, vertices.z & ~RING_BIT, vertices.w);
}
