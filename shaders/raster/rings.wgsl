// Tiles that cells in rings touch.

// For every tile 1 if a cell in a ring touches it, else 0.
@group(0) @binding(81) var<storage, read> ring_tiles: array<u32>;

fn has_ring(tile: u32) -> bool {
    return ring_tiles[tile] != 0u;
}
