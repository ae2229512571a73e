// Candidates are the cells of a part of the mesh, as they come.

// First cell of the part that `cells` and `ranges` hold, and how many.
@group(0) @binding(80) var<uniform> chunk: vec4<u32>;

// A candidate's number in the mesh, with RING_BIT; NOTHING for one that is not in the part.
fn candidate(index: u32) -> u32 {
    let is_here = index >= chunk.x && index - chunk.x < chunk.y;
    return select(NOTHING, index, is_here);
}
