//! The triangle fan of a projected cell.

/// A vertex of a fan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FanVertex {
    /// The center, where the ray meets both ends of the thickest chord.
    Thick,
    /// A corner of the cell, on the silhouette, where the chord has no length.
    Corner(usize),
}

/// A triangle fan of at most six vertices: the thick vertex, then the silhouette's corners around it.
///
/// The thick vertex comes first in every class (as in [Marroquim 2006], figure 6); in classes 1, 3 and 4 it covers a corner
/// on the screen. Classes 1 and 2 close the ring by repeating its first corner. Each triangle lies between one front face
/// and one back face of the cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fan {
    vertices: [FanVertex; 6],
    count: usize,
}

impl Fan {
    /// The fan of a cell without silhouette.
    pub const EMPTY: Self = Self { vertices: [FanVertex::Thick; 6], count: 0 };

    pub(crate) const fn new(vertices: [FanVertex; 6], count: usize) -> Self {
        Self { vertices, count }
    }

    /// The vertices: 0 or 3 to 6.
    pub fn as_slice(&self) -> &[FanVertex] {
        &self.vertices[..self.count]
    }

    /// The triangles, counterclockwise on the screen: the thick vertex and two corners in succession.
    pub fn triangles(&self) -> impl Iterator<Item = [FanVertex; 3]> + '_ {
        self.as_slice().windows(2).skip(1).map(|pair| [FanVertex::Thick, pair[0], pair[1]])
    }
}
