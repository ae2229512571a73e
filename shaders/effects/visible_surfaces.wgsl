// Whether isosurfaces may show in a cell.

#use effects/surface_set.wgsl

// - low, high: its scalars, lattice steps
fn surfaces_may_show(low: i32, high: i32) -> bool {
    return surfaces_near(low, high).y > 0u;
}
