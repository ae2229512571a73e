//! Tiles of the picture, and which cells each may show.

use crate::geometry::PixelBox;

/// The picture cut into square tiles; those at the right and lower edge may be cut off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileGrid {
    /// Logarithm of the pixels a side: divisions by the side are shifts.
    side_log2: u32,
    /// Width and height of the picture.
    pub(crate) size: [u32; 2],
    /// Tiles a row.
    columns: u32,
    rows: u32,
}

/// The pixels of one tile: first column and row, and how many of each lie in the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tile {
    pub(crate) x: u32,
    pub(crate) y: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl TileGrid {
    /// Tiles of `side` pixels, a power of two.
    pub(crate) fn new(size: [u32; 2], side: u32) -> Self {
        debug_assert!(side.is_power_of_two());
        Self { side_log2: side.ilog2(), size, columns: size[0].div_ceil(side), rows: size[1].div_ceil(side) }
    }

    pub(crate) fn len(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    pub(crate) fn tile(&self, index: usize) -> Tile {
        self.tile_at(index as u32 % self.columns, index as u32 / self.columns)
    }

    fn tile_at(&self, column: u32, row: u32) -> Tile {
        let side = self.side();
        let (x, y) = (column * side, row * side);
        Tile { x, y, width: side.min(self.size[0] - x), height: side.min(self.size[1] - y) }
    }

    fn side(&self) -> u32 {
        1 << self.side_log2
    }

    /// Lists for every tile the items whose box touches it and that pass `may_show(item, tile)`, each list in the order of the items.
    pub(crate) fn bin(
        &self,
        boxes: impl Iterator<Item = PixelBox> + Clone,
        may_show: impl Fn(usize, Tile) -> bool,
    ) -> Bins {
        let mut starts = vec![0_u32; self.len() + 1];
        self.each_pair(boxes.clone(), &may_show, |tile, _| starts[tile + 1] += 1);
        for tile in 0..self.len() {
            starts[tile + 1] += starts[tile];
        }
        let mut next = starts.clone();
        let mut items = vec![0_u32; starts[self.len()] as usize];
        self.each_pair(boxes, &may_show, |tile, item| {
            items[next[tile] as usize] = item as u32;
            next[tile] += 1;
        });
        Bins { starts, items }
    }

    fn each_pair(
        &self,
        boxes: impl Iterator<Item = PixelBox>,
        may_show: &impl Fn(usize, Tile) -> bool,
        mut visit: impl FnMut(usize, usize),
    ) {
        for (item, [x0, x1, y0, y1]) in boxes.enumerate() {
            for row in y0 >> self.side_log2..=y1 >> self.side_log2 {
                for column in x0 >> self.side_log2..=x1 >> self.side_log2 {
                    if may_show(item, self.tile_at(column, row)) {
                        visit(row as usize * self.columns as usize + column as usize, item);
                    }
                }
            }
        }
    }
}

/// For every tile a list of items.
#[derive(Debug)]
pub(crate) struct Bins {
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Bins {
    pub(crate) fn of(&self, tile: usize) -> &[u32] {
        &self.items[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tile_lists_what_touches_it_in_order() {
        let grid = TileGrid::new([70, 40], 32);
        assert_eq!(grid.len(), 6);
        let last = grid.tile(5);
        assert_eq!((last.x, last.y, last.width, last.height), (64, 32, 6, 8));
        let boxes = [[0, 69, 0, 39], [31, 32, 0, 0], [64, 64, 39, 39]];
        let bins = grid.bin(boxes.into_iter(), |item, tile| item != 0 || tile.x != 0);
        let lists: Vec<&[u32]> = (0..6).map(|t| bins.of(t)).collect();
        assert_eq!(lists, [&[1][..], &[0, 1], &[0], &[], &[0], &[0, 2]]);
    }
}
