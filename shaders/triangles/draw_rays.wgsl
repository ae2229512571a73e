// Draws the cells of a draw block, back to front: six vertices a cell, two triangles over its silhouette or a box around it. One invocation of
// `fragment` gives the light of one cell along the ray of one pixel, color (linear, premultiplied) and opacity, for blending with what lies
// behind: ONE, ONE_MINUS_SRC_ALPHA.
//
// In: frame, points, drawn, totals, block, outlined (made by triangles/outlines.wgsl), and what the light of a cell takes.
//
// Where the ray enters and leaves is found from the planes of the faces, linear on the screen, at the pixel's center. Interpolated between
// vertices it would be off by what rasterizers do to vertices: at silhouettes and where two triangles meet, a share of the chord that
// grows as the cell gets smaller on the screen.
//
// <effects>: the light of a cell.

#use include/frame.wgsl
#use triangles/assembled.wgsl
#use triangles/list.wgsl
#use triangles/outlined.wgsl
#use triangles/screen.wgsl
#use cell/sample.wgsl
#use integrate/pieces.wgsl
#use <effects>

@group(0) @binding(45) var<storage, read> outlined: array<Outlined>;

struct Handed {
    @builtin(position) position: vec4<f32>,
    // The cell's place in the block.
    @location(0) @interpolate(flat) place: u32,
}

@vertex
fn vertex(@builtin(vertex_index) number: u32) -> Handed {
    let place = cells_of_block() - 1u - number / 6u;
    // Corners 0 1 2, 0 2 3 of the polygon.
    let turn = number % 6u;
    let corner = select(turn, select(turn - 2u, 0u, turn == 3u), turn >= 3u);
    return Handed(position_of(outlined[place].polygon[corner]), place);
}

@fragment
fn fragment(handed: Handed) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(floor(handed.position.xy)) + vec2<i32>(frame.origin);
    let made = outlined[handed.place];
    let cell = cell_of(made);
    let found = sample(cell, pixel);
    if !found.covered || any(pixel < cell.outline.xy) || any(pixel > cell.outline.zw) {
        discard;
    }
    var joint = no_joint();
    var crossings = 0u;
    return assembled(shade(cell, vertices_of(handed.place), optics_from(made), found, &joint, &crossings));
}
