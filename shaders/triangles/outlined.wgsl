// A cell that is drawn as one convex polygon, and what its pixels want to know of it: made once a cell, read in every pixel.

#use cell/cell.wgsl
#use integrate/light.wgsl

struct Outlined {
    // As `Cell` has them.
    faces: array<vec4<i32>, 4>,
    scalar: vec3<f32>,
    depth: f32,
    nearness: vec2<f32>,
    scalars: vec2<f32>,
    outline: vec4<i32>,
    reference: i32,
    length: f32,
    // The pieces of the transfer function that it meets: the first; and four times their count, plus the count of entry faces.
    first_piece: u32,
    counts: u32,
    // Corners of the polygon in turn, pixels from the center of the pixel that the frame's columns and rows count from. A triangle has its
    // last corner twice.
    polygon: array<vec2<f32>, 4>,
}

fn cell_of(made: Outlined) -> Cell {
    var cell: Cell;
    cell.faces = made.faces;
    cell.scalar = made.scalar;
    cell.depth = made.depth;
    cell.nearness = made.nearness;
    cell.scalars = made.scalars;
    cell.outline = made.outline;
    // As set-up chose it.
    cell.pixel = (made.outline.xy + made.outline.zw) / 2;
    cell.reference = made.reference;
    cell.entry_count = made.counts & 3u;
    cell.length = made.length;
    return cell;
}

fn optics_from(made: Outlined) -> Optics {
    return Optics(made.reference, made.scalars.x, made.scalars.y, made.first_piece, made.counts >> 2u);
}

fn outlined_of(cell: Cell, of_cell: Optics, polygon: array<vec2<f32>, 4>) -> Outlined {
    var to: Outlined;
    to.faces = cell.faces;
    to.scalar = cell.scalar;
    to.depth = cell.depth;
    to.nearness = cell.nearness;
    to.scalars = cell.scalars;
    to.outline = cell.outline;
    to.reference = cell.reference;
    to.length = cell.length;
    to.first_piece = of_cell.first;
    to.counts = 4u * of_cell.count + cell.entry_count;
    to.polygon = polygon;
    return to;
}
