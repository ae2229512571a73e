//! How long the segments of rays are inside the cells of a mesh.

use crate::{CellId, TetMesh};

/// Lengths of the segments that rays have inside single cells; world length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChordLengths {
    /// The mean over all segments of rays that are spread evenly over all places and directions; positive.
    pub mean: f64,
    /// The longest that any ray can have: the longest edge of a cell.
    pub longest: f64,
}

/// The lengths of the segments that rays have inside the tetrahedra of a mesh.
///
/// `None` if no tetrahedron has a volume that f64 can hold, an empty mesh among them: then no ray has a segment.
///
/// The mean is `4 sum(V) / sum(S)` over the volumes `V` of the cells and the areas `S` of their surfaces, every face counted
/// for each cell that it bounds. This is Cauchy's mean chord: a cell is met by a share of evenly spread rays that is its mean shadow,
/// `S / 4`, and the lengths of these add up to `V`. One view sees another mean: with cells that are stretched in
/// one direction it differs by as much as they are stretched.
///
/// Exact but for rounding, relative to the mesh's extent: of a mesh of needles thinner than 1e-16 of it little is left.
/// Scale and place of the mesh do not matter. The sums run in the order of the cells.
pub fn chord_lengths(mesh: &TetMesh) -> Option<ChordLengths> {
    // In local coordinates, where the mesh has a size of about one, so that no power of its scale over- or underflows.
    let (mut volume6, mut surface2, mut longest_squared) = (0.0, 0.0, 0.0_f64);
    for cell in 0..mesh.tetrahedra().len() {
        let [a, b, c, d] = mesh.corners(CellId(cell as u32));
        let (ab, ac, ad, bc, bd, cd) = (b - a, c - a, d - a, c - b, d - b, d - c);
        // Positive by the mesh's promise; rounding of a sliver may say otherwise.
        volume6 += ab.dot(ac.cross(ad)).max(0.0);
        surface2 +=
            [ab.cross(ac), ab.cross(ad), ac.cross(ad), bc.cross(bd)].map(|normal| normal.length()).iter().sum::<f64>();
        longest_squared =
            [ab, ac, ad, bc, bd, cd].iter().fold(longest_squared, |most, edge| most.max(edge.length_squared()));
    }
    let scale = mesh.frame().scale;
    // 4 (volume6 / 6) / (surface2 / 2)
    let lengths =
        ChordLengths { mean: volume6 / surface2 * (4.0 / 3.0) * scale, longest: longest_squared.sqrt() * scale };
    (lengths.mean > 0.0 && lengths.longest.is_finite()).then_some(lengths)
}

#[cfg(test)]
mod tests;
