// Where a ray last left a cell with isosurfaces, and on which side of each it was there.

struct Joint {
    // From where depths count.
    depth: f32,
    // How far the depth may be off.
    slack: f32,
    // Number of surfaces not above the scalar there; with maps, its texel.
    rank: f32,
}

// No cell yet: at a depth that no ray has.
fn no_joint() -> Joint {
    return Joint(-1e30, 0.0, 0.0);
}
