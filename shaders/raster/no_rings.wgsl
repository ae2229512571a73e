// No cells lie in rings.

fn has_ring(tile: u32) -> bool {
    return false;
}
