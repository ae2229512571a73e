// What integration is to know of a cell.
#use cell/cell.wgsl
#use integrate/light.wgsl
#use <pieces>

fn optics_of(cell: Cell) -> Optics {
    let pieces = find_pieces(cell.reference, cell.scalars.x, cell.scalars.y);
    return Optics(cell.reference, cell.scalars.x, cell.scalars.y, pieces.x, pieces.y);
}
