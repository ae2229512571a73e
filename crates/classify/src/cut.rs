//! What is left of a cell in front of a plane across the line of sight.

use glam::DVec3;

use crate::volumes::six_volume;

/// The name of a corner of a piece, the same in all cells that share it: ids of the ends of the edge it lies on, ascending;
/// a corner of the original cell has its own id twice. Use it as `ids` for [`crate::project`].
pub type PieceId = [u32; 2];

/// One of the cells that a cut leaves; positively oriented.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Its corners.
    pub positions: [DVec3; 4],
    /// The field there.
    pub scalars: [f64; 4],
    /// What the corners are called.
    pub ids: [PieceId; 4],
}

/// Up to three pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    pieces: [Option<Piece>; 3],
    count: usize,
}

/// A plane across the line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthPlane {
    /// Where depth is measured from; the eye.
    pub origin: DVec3,
    /// Along which it is measured; a unit vector.
    pub forward: DVec3,
    /// At which depth to cut.
    pub depth: f64,
}

impl Cut {
    /// The pieces; together they fill the part of the cell beyond the plane.
    pub fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.pieces[..self.count].iter().flatten()
    }

    /// How many pieces there are: 0 to 3.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether nothing lies beyond the plane.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn push(&mut self, piece: Piece) {
        if let Some(slot) = self.pieces.get_mut(self.count) {
            *slot = Some(piece);
            self.count += 1;
        }
    }
}

/// Cuts away what lies nearer than a plane: for cells around the eye or across the near plane.
///
/// A cell wholly beyond comes back unchanged, one wholly before it not at all. One corner before the plane leaves a prism,
/// three pieces; two leave a wedge, three pieces; three leave one piece. Pieces without positive volume are left out, which
/// a plane through corners or within rounding of them produces. The field at new corners is interpolated linearly, which
/// changes no image, since the field of the cell is linear.
///
/// Two cells of a face cut it into the same triangles with the same corners, bit for bit: a new corner is computed from the
/// lower to the higher id, and a quadrangle is divided from its corner of lowest id. `ids` must be distinct for that.
/// Positions and scalars are finite, positions positively oriented.
pub fn cut_at_depth(positions: &[DVec3; 4], scalars: &[f64; 4], ids: [u32; 4], plane: &DepthPlane) -> Cut {
    let mut cut = Cut { pieces: [None; 3], count: 0 };
    let cell = Cell {
        positions,
        scalars,
        ids,
        depths: positions.map(|p| (p - plane.origin).dot(plane.forward) - plane.depth),
    };
    if cell.depths.iter().all(|depth| *depth >= 0.0) {
        cut.push(Piece { positions: *positions, scalars: *scalars, ids: ids.map(|id| [id, id]) });
        return cut;
    }
    // Kept corners first, in ascending order of ids within kept and cut ones.
    let mut order = [0, 1, 2, 3];
    order.sort_unstable_by_key(|&corner| (cell.depths[corner] < 0.0, ids[corner]));
    let is_even = swaps_are_even(order);
    let [a, b, c, d] = order;
    let at = |corner| End::Corner(corner);
    let on = |kept, gone| End::Edge(kept, gone);
    // Each piece is a step of a staircase through the prism; its diagonals start at the lowest ids. The flag says whether
    // the piece is oriented like (a, b, c, d).
    let steps: &[([End; 4], bool)] = match order.iter().filter(|&&corner| cell.depths[corner] >= 0.0).count() {
        0 => &[],
        1 => &[([at(a), on(a, b), on(a, c), on(a, d)], true)],
        2 => &[
            ([at(a), on(a, c), on(a, d), on(b, d)], true),
            ([at(a), on(a, c), on(b, c), on(b, d)], false),
            ([at(a), at(b), on(b, c), on(b, d)], true),
        ],
        _ => &[
            ([at(a), at(b), at(c), on(c, d)], true),
            ([at(a), at(b), on(b, d), on(c, d)], false),
            ([at(a), on(a, d), on(b, d), on(c, d)], true),
        ],
    };
    for (ends, is_like_cell) in steps {
        let mut ends = *ends;
        if *is_like_cell != is_even {
            ends.swap(2, 3);
        }
        let corners = ends.map(|end| cell.corner(end));
        let piece = Piece {
            positions: corners.map(|corner| corner.0),
            scalars: corners.map(|corner| corner.1),
            ids: corners.map(|corner| corner.2),
        };
        if six_volume(&piece.positions, piece.ids) > 0.0 {
            cut.push(piece);
        }
    }
    cut
}

/// Where a piece has a corner.
#[derive(Clone, Copy)]
enum End {
    /// At a corner of the cell.
    Corner(usize),
    /// Where the plane meets the edge between a kept corner and one that is cut away.
    Edge(usize, usize),
}

/// A cell and how far its corners lie beyond the plane.
struct Cell<'a> {
    positions: &'a [DVec3; 4],
    scalars: &'a [f64; 4],
    ids: [u32; 4],
    depths: [f64; 4],
}

impl Cell<'_> {
    fn corner(&self, end: End) -> (DVec3, f64, PieceId) {
        match end {
            End::Corner(corner) => (self.positions[corner], self.scalars[corner], [self.ids[corner]; 2]),
            End::Edge(kept, gone) => {
                let (low, high) = if self.ids[kept] < self.ids[gone] { (kept, gone) } else { (gone, kept) };
                // The signs differ and the depth of the corner that is cut away is not 0, so that this is in 0..=1.
                let fraction = self.depths[low] / (self.depths[low] - self.depths[high]);
                (
                    self.positions[low].lerp(self.positions[high], fraction),
                    self.scalars[low] + fraction * (self.scalars[high] - self.scalars[low]),
                    [self.ids[low], self.ids[high]],
                )
            }
        }
    }
}

/// Whether a permutation of four corners takes an even number of swaps.
fn swaps_are_even(order: [usize; 4]) -> bool {
    let mut inversions = 0;
    for i in 1..4 {
        for j in 0..i {
            inversions += usize::from(order[j] > order[i]);
        }
    }
    inversions % 2 == 0
}
