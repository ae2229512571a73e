//! A field on the tetrahedra of a mesh, without those where it is not a number.

use std::borrow::Cow;

use tetrascope_mesh::{Decomposition, TetMesh};

use crate::{Field, FieldError, field::finite_range};

/// A mesh and a finite scalar at each corner of each of its tetrahedra.
#[derive(Clone, Debug)]
pub struct FieldOnMesh<'a> {
    /// The tetrahedra that are drawn: all, or those that touch no NaN and no infinity.
    pub mesh: Cow<'a, TetMesh>,
    /// One value a point of the mesh; finite on every tetrahedron.
    pub scalars: Vec<f64>,
    /// Lowest and highest value on the tetrahedra that are drawn.
    pub range: (f64, f64),
    /// Points of the dataset whose value is NaN or infinite.
    pub non_finite_points: usize,
    /// Tetrahedra left out because they touch such a point.
    pub left_out: usize,
}

impl FieldOnMesh<'_> {
    /// What was left out, in a sentence; `None` if nothing was.
    pub fn warning(&self) -> Option<String> {
        (self.left_out > 0).then(|| {
            format!(
                "{} of {} tetrahedra are left out: they touch one of {} points where the field is NaN or infinite",
                self.left_out,
                self.left_out + self.mesh.tetrahedra().len(),
                self.non_finite_points
            )
        })
    }
}

/// Brings a field onto the tetrahedra that its dataset was cut into.
///
/// # Errors
/// [`FieldError::NothingFinite`] if no tetrahedron has four finite values.
pub fn place_on_mesh<'a>(field: &Field, decomposition: &'a Decomposition) -> Result<FieldOnMesh<'a>, FieldError> {
    let scalars = decomposition.point_scalars(&field.values);
    let whole = &decomposition.mesh;
    let non_finite_points = field.values.iter().filter(|v| !v.is_finite()).count();
    let is_finite = |corners: &[tetrascope_mesh::VertexId; 4]| corners.iter().all(|v| scalars[v.index()].is_finite());
    // Most fields are finite: then nothing is copied.
    let mesh = if whole.tetrahedra().iter().all(is_finite) {
        Cow::Borrowed(whole)
    } else {
        Cow::Owned(whole.retain(|cell| is_finite(&whole.tetrahedra()[cell.index()])))
    };
    let on_cells = mesh.tetrahedra().iter().flatten().map(|v| scalars[v.index()]);
    let (Some(range), _) = finite_range(on_cells) else {
        return Err(FieldError::NothingFinite {
            name: field.name.clone(),
            non_finite: non_finite_points,
            points: field.values.len(),
        });
    };
    let left_out = whole.tetrahedra().len() - mesh.tetrahedra().len();
    Ok(FieldOnMesh { mesh, scalars, range, non_finite_points, left_out })
}
