// Light of a segment, and what integration knows of the cell around it.

struct Light {
    // Linear light, what the segment hides of itself included.
    rgb: vec3<f32>,
    // And not the transmittance: next to 1 that has no digits for what a thin cell hides.
    opacity: f32,
}

// Scalars are relative to the cell's reference scalar, in units of 2^29 lattice steps.
struct Optics {
    // The reference scalar, lattice steps.
    reference: i32,
    // The cell's lowest and highest scalar.
    low: f32,
    high: f32,
    // The pieces of the transfer function that the cell meets: first and how many; 1 or more. Filled by find_pieces.
    first: u32,
    count: u32,
}
