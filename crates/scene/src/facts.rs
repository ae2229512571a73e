//! What a scene's defaults are made from.

use glam::DVec3;
use tetrascope_mesh::TetMesh;

/// The numbers of mesh and field that defaults depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshFacts {
    /// The lowest corner of the box around all tetrahedra; world coordinates, finite.
    pub lowest: DVec3,
    /// The highest corner; in no component below the lowest.
    pub highest: DVec3,
    /// The lowest and the highest finite value of the field on the tetrahedra that are drawn.
    pub scalar_range: (f64, f64),
}

impl MeshFacts {
    /// Facts of a mesh whose field has this range; `None` for a mesh with no tetrahedron.
    ///
    /// The box holds every tetrahedron of `mesh`. Give the whole mesh, not only the part where a field is finite, so that
    /// the camera stays where it is when another field is shown.
    pub fn new(mesh: &TetMesh, scalar_range: (f64, f64)) -> Option<Self> {
        let (lowest, highest) = mesh.bounds_world()?;
        Some(Self { lowest, highest, scalar_range })
    }

    /// Facts of both: the box around the two boxes, and the range of the two ranges. Defaults made of it fit either.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        let ((low, high), (other_low, other_high)) = (self.scalar_range, other.scalar_range);
        Self {
            lowest: self.lowest.min(other.lowest),
            highest: self.highest.max(other.highest),
            scalar_range: (low.min(other_low), high.max(other_high)),
        }
    }

    /// The middle of the box.
    pub fn center(&self) -> DVec3 {
        self.lowest * 0.5 + self.highest * 0.5
    }

    /// The diagonal of the box, world length.
    pub fn diagonal(&self) -> f64 {
        let sides = self.highest - self.lowest;
        // Scaled, so that the squares of sides of 1e-200 or 1e200 stay numbers.
        let longest = sides.max_element();
        if longest > 0.0 { (sides / longest).length() * longest } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_facts_hold_both() {
        let a = MeshFacts { lowest: DVec3::ZERO, highest: DVec3::ONE, scalar_range: (-1.0, 2.0) };
        let b = MeshFacts { lowest: DVec3::NEG_X, highest: DVec3::splat(0.5), scalar_range: (0.0, 3.0) };
        let both = a.joined(&b);
        assert_eq!(both, MeshFacts { lowest: DVec3::NEG_X, highest: DVec3::ONE, scalar_range: (-1.0, 3.0) });
        assert_eq!(both, b.joined(&a));
    }
}
