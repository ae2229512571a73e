// All tiles sort.

fn has_ring(tile: u32) -> bool {
    return true;
}
