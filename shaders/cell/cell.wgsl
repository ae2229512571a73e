// A cell ready to be drawn, and what a ray has inside of it.
//
// What is linear on the screen is the nearness: 1/depth in a perspective view, minus the depth in an orthographic one. Here it is relative to
// that of a reference point in the cell (perspective: reference depth / depth - 1; orthographic: reference depth - depth), and pixels are counted
// from the reference's. Lengths in local units, scalars in units of 2^29 lattice steps relative to the scalar at the reference.

struct Cell {
    // Planes (entry_count 1 to 3): nearness of each face at the reference pixel, per column, per row; entry faces first.
    // Slabs (entry_count 0): how far the reference depth of a pixel's ray lies outside of each face, likewise.
    faces: array<vec4<f32>, 4>,
    // Slabs alone: how fast a ray gets out of each face per depth, at the reference pixel, per column, per row; last what counts as zero:
    // a ray that is slower runs along the face.
    speeds: array<vec4<f32>, 4>,
    // Scalar across at the reference depth per column and per row; fall along the ray k at the reference; unused.
    scalar: vec4<f32>,
    // Slabs alone: k per column and row.
    along: vec2<f32>,
    // Lowest and highest relative nearness of the corners; slabs: unused.
    nearness: vec2<f32>,
    // Lowest and highest scalar from the reference.
    scalars: vec2<f32>,
    // The reference pixel.
    pixel: vec2<i32>,
    // Pixels that it may cover: first column and row, last column and row, within the part of the picture that is drawn. First beyond last:
    // it covers none.
    outline: vec4<i32>,
    // The scalar at the reference, lattice steps.
    reference: i32,
    // Entry faces among `faces`; 0 for slabs.
    entry_count: u32,
    // Depth of the reference from where depths count.
    depth: f32,
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
