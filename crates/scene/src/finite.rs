//! A field on the tetrahedra of a mesh, without those where it is not a number.

use std::borrow::Cow;

use tetrascope_mesh::{Decomposition, TetMesh};

use crate::{Association, Field, FieldError, field::finite_range};

/// A mesh and a finite scalar at each corner of each of its tetrahedra.
#[derive(Clone, Debug)]
pub struct FieldOnMesh<'a> {
    /// The tetrahedra that are drawn: all, or those that touch no NaN and no infinity.
    pub mesh: Cow<'a, TetMesh>,
    /// One value a point of the mesh; finite on every tetrahedron.
    pub scalars: Vec<f64>,
    /// Lowest and highest value on the tetrahedra that are drawn.
    pub range: (f64, f64),
    /// What the field has a value for, of the dataset.
    pub of: Association,
    /// How many of these have one that is NaN or infinite.
    pub non_finite: usize,
    /// Tetrahedra left out because they touch such a point.
    pub left_out: usize,
}

impl FieldOnMesh<'_> {
    /// What was left out, in a sentence; `None` if nothing was.
    pub fn warning(&self) -> Option<String> {
        (self.left_out > 0).then(|| {
            format!(
                "{} of {} tetrahedra are left out: they touch one of {} {}s where the field is NaN or infinite",
                self.left_out,
                self.left_out + self.mesh.tetrahedra().len(),
                self.non_finite,
                self.of
            )
        })
    }
}

/// The same of a field that is constant in each cell: every point belongs to one cell then.
fn place_cells_on_mesh<'a>(field: &Field, decomposition: &'a Decomposition) -> Result<FieldOnMesh<'a>, FieldError> {
    let whole = &decomposition.mesh;
    let value = |cell: usize| field.values.get(whole.source_cells()[cell] as usize).copied().unwrap_or(f64::NAN);
    let is_finite = |cell: usize| value(cell).is_finite();
    let cells = 0..whole.tetrahedra().len();
    let (Some(range), _) = finite_range(cells.clone().map(value)) else {
        return Err(FieldError::NothingFinite {
            name: field.name.clone(),
            of: Association::Cell,
            non_finite: field.values.iter().filter(|value| !value.is_finite()).count(),
            all: field.values.len(),
        });
    };
    let kept = if cells.clone().all(is_finite) {
        Cow::Borrowed(whole)
    } else {
        Cow::Owned(whole.retain(|cell| is_finite(cell.index())))
    };
    let mesh = kept.with_points_of_cells().map_err(FieldError::TooLarge)?;
    // Points that no cell uses are nowhere seen.
    let mut scalars = vec![f64::NAN; mesh.positions().len()];
    for (corners, source) in mesh.tetrahedra().iter().zip(mesh.source_cells()) {
        let value = field.values.get(*source as usize).copied().unwrap_or(f64::NAN);
        corners.iter().for_each(|vertex| scalars[vertex.index()] = value);
    }
    let left_out = cells.len() - mesh.tetrahedra().len();
    let non_finite = field.values.iter().filter(|value| !value.is_finite()).count();
    Ok(FieldOnMesh { mesh: Cow::Owned(mesh), scalars, range, of: Association::Cell, non_finite, left_out })
}

/// Brings a field onto the tetrahedra that its dataset was cut into.
///
/// # Errors
/// [`FieldError::NothingFinite`] if no tetrahedron has four finite values.
pub fn place_on_mesh<'a>(field: &Field, decomposition: &'a Decomposition) -> Result<FieldOnMesh<'a>, FieldError> {
    if field.is_per_cell {
        return place_cells_on_mesh(field, decomposition);
    }
    let scalars = decomposition.point_scalars(&field.values);
    let whole = &decomposition.mesh;
    let non_finite = field.values.iter().filter(|v| !v.is_finite()).count();
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
            of: Association::Point,
            non_finite,
            all: field.values.len(),
        });
    };
    let left_out = whole.tetrahedra().len() - mesh.tetrahedra().len();
    Ok(FieldOnMesh { mesh, scalars, range, of: Association::Point, non_finite, left_out })
}
