// A cell ready to be drawn, and what a ray has inside of it.
//
// What is linear on the screen is the nearness: 1/depth in a perspective view, minus the depth in an orthographic one. Here it is relative to
// that of a reference point in the cell (perspective: reference depth / depth - 1; orthographic: reference depth - depth), and pixels are counted
// from the reference's. Lengths in local units, scalars in units of 2^29 lattice steps relative to the scalar at the reference.
//
// Cells whose planes rounding would blur (faces seen edge-on, slivers, and whatever is near the eye) keep their corners instead, and each ray is
// tried against them in integers.

struct Cell {
    // By planes (entry_count 1 to 3): the bits of three floats, nearness of each face at the reference pixel, per column, per row; entry
    // faces first. By corners (entry_count 0): the corners as `points` has them, by ascending vertex.
    faces: array<vec4<i32>, 4>,
    // By planes: scalar across at the reference depth per column and per row, fall along the ray at the reference.
    scalar: vec3<f32>,
    // Depth of the reference from where depths count.
    depth: f32,
    // By planes: lowest and highest relative nearness of the corners.
    nearness: vec2<f32>,
    // Lowest and highest scalar from the reference.
    scalars: vec2<f32>,
    // Pixels that it may cover: first column and row, last column and row, within the part of the picture that is drawn. First beyond last:
    // it covers none.
    outline: vec4<i32>,
    // The reference pixel.
    pixel: vec2<i32>,
    // The scalar at the reference, lattice steps.
    reference: i32,
    // Entry faces among `faces`; 0 for a cell by corners.
    entry_count: u32,
    // Unit of length: the reference depth from the eye in a perspective view, else 1.
    length: f32,
}

// What a ray has inside of a cell.
struct Sample {
    // Scalars from the reference where the ray enters and leaves.
    front: f32,
    back: f32,
    // Length along the ray, local units.
    length: f32,
    // Depths of both ends, from where depths count.
    depth: vec2<f32>,
    // Center of the pixel from the middle of the picture, in pixels.
    center: vec2<f32>,
    // Whether the ray meets the cell at all.
    covered: bool,
}
