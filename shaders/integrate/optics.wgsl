// Numbers of the integration: see `layout::OpticsUniform`, which has units and meanings.

struct OpticsUniform {
    piece_count: u32,
    psi_start: u32,
    table_scalars: u32,
    table_lengths: u32,
    table_start: i32,
    table_step: i32,
    table_rest: f32,
    table_per_scalar: f32,
    table_per_length: f32,
    table_is_logarithmic: u32,
    unused: vec2<u32>,
}

@group(0) @binding(6) var<uniform> optics: OpticsUniform;
