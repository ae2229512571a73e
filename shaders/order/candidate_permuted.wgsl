// Candidates are all cells in an order that was made elsewhere, front to back.

// First cell of the part that `cells` and `ranges` hold, and how many.
@group(0) @binding(80) var<uniform> chunk: vec4<u32>;
@group(0) @binding(5) var<storage, read> permutation: array<u32>;

// A candidate's number in the mesh, with RING_BIT; NOTHING for one that is not in the part.
fn candidate(index: u32) -> u32 {
    let number = permutation[index];
    let cell = number & ~RING_BIT;
    let is_here = cell >= chunk.x && cell - chunk.x < chunk.y;
    return select(NOTHING, number, is_here);
}
