// Tiles that cells in rings touch: `find_rings.wgsl` marked them where their items begin.

fn has_ring(tile: u32) -> bool {
    return (tile_starts[tile] & RING_BIT) != 0u;
}
