//! From a cell and a viewpoint to its fan and what lies in front of and behind the thick vertex.

use glam::DVec3;
use tetrascope_view::Viewpoint;

use crate::class::{Classified, Corners, ProjectionClass, by_planes};
use crate::fan::{Fan, FanVertex};
use crate::volumes::SignedVolumes;

/// The chord at the thick vertex, where a cell's fan has its center, and the field at the chord's ends.
///
/// It is the longest of all chords in an orthographic view. In perspective it is the one with the largest difference of
/// inverse depths, which is what falls linearly to zero at the silhouette; beside it, a cell that is large for its distance
/// can have longer ones.
///
/// All sums behind it run over terms of one sign, so that no class needs care and nothing cancels:
/// with P and N as in [`Classified`], `S_P = Σ_P A`, `S_N = Σ_N −A`, the near end is `Σ_P A p / S_P`, the far end
/// `Σ_N −A p / S_N`, and the scalars are the same means.
///
/// Rounding may give a tiny volume A the wrong sign, and with it the cell another class, but no picture shows it: relative
/// to itself, the length changes by less than 3 |A| / Σ|A| in orthographic views and from five longest edges away, and by
/// about `|A| (1/S_N + (1 + |v|/|near|)/S_P)` at most from anywhere (v, near: from the eye to the corner and to the
/// near end).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThickVertex {
    /// The end towards the eye, in the space of the positions.
    pub near: DVec3,
    /// The end away from the eye.
    pub far: DVec3,
    /// The field at the near end; between the smallest and the largest of the corners that span it.
    pub scalar_front: f64,
    /// The field at the far end.
    pub scalar_back: f64,
    /// The length between the ends, in the unit of the positions; never above the cell's longest edge.
    pub chord_length: f64,
    /// Perspective: from the eye to the near end, more exact than `near − eye`. Orthographic: the direction.
    pub ray: DVec3,
    /// The corner in whose place the vertex lies on the screen: use its position, so that no crack opens. Class 2: none.
    pub corner: Option<usize>,
}

/// A cell as one view shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    /// What the silhouette looks like.
    pub class: ProjectionClass,
    /// The chord at the center of the fan; `None` for [`ProjectionClass::EyeInside`] and [`ProjectionClass::Degenerate`].
    pub thick: Option<ThickVertex>,
    /// Triangles that cover the silhouette once; empty where there is no thick vertex.
    pub fan: Fan,
    /// The volumes behind it all.
    pub volumes: SignedVolumes,
}

/// What is linear along an edge of a fan in an orthographic view: the attributes of [Marroquim 2006], figure 7.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FanAttributes {
    /// Field where the ray enters.
    pub scalar_front: f64,
    /// Field where it leaves.
    pub scalar_back: f64,
    /// Length between both.
    pub chord_length: f64,
}

/// What is linear on the screen along an edge of a fan in a perspective view.
///
/// With depth Z along the line of sight, 1/Z and s/Z are affine functions of pixel coordinates on each face. Per pixel:
/// `q_back = q_front − dq`, `s_front = u_front / q_front`, `s_back = u_back / q_back`, and the chord's length is
/// `|r| dq / (q_front q_back)` with r the pixel's ray of unit depth. Chord lengths and scalars themselves are *not* linear:
/// three cell sizes from the eye that costs 7 % in the median and 110 % at worst.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenAttributes {
    /// Difference of inverse depths, front minus back; not negative. On its own because the difference would cancel.
    pub dq: f64,
    /// Inverse depth at the front, 1 / length.
    pub q_front: f64,
    /// Front scalar times front inverse depth.
    pub u_front: f64,
    /// Back scalar times back inverse depth.
    pub u_back: f64,
}

/// Projects a cell.
///
/// - `positions`: finite, positively oriented (see [`SignedVolumes::new`]); cells whose volume is not positive come back
///   as [`ProjectionClass::Degenerate`] and draw nothing, so swap two corners of inverted cells when they are loaded
/// - `scalars`: the field at the corners, finite
/// - `ids`: the corners' global indices, which make neighbors agree
///
/// Perspective: the class and the thick vertex are right wherever the corners lie, behind the eye too, as no division by
/// depth takes part; the fan then is one of directions from the eye. Screen positions exist only for corners in front of
/// the eye plane: where one is not, or lies nearer than what is to be seen, take the pieces of [`crate::cut_at_depth`]
/// instead of the cell. The same is right for [`ProjectionClass::EyeInside`]. An orthographic view has no eye in a cell;
/// where rounding says so, the class is [`ProjectionClass::Degenerate`].
pub fn project<K: Ord + Copy>(
    positions: &[DVec3; 4],
    scalars: &[f64; 4],
    ids: [K; 4],
    viewpoint: Viewpoint,
) -> Projected {
    Projected::from_volumes(SignedVolumes::new(positions, ids, viewpoint), positions, scalars, viewpoint)
}

impl Projected {
    /// The same as [`project`], for volumes that are there already: those of this cell and viewpoint.
    pub fn from_volumes(
        volumes: SignedVolumes,
        positions: &[DVec3; 4],
        scalars: &[f64; 4],
        viewpoint: Viewpoint,
    ) -> Self {
        let nothing = |class| Self { class, thick: None, fan: Fan::EMPTY, volumes };
        let has_volume = volumes.six_volume > 0.0;
        let classified = by_planes(volumes.signs());
        match (classified.class, viewpoint) {
            _ if !has_volume => nothing(ProjectionClass::Degenerate),
            (ProjectionClass::EyeInside, Viewpoint::Eye(_)) => nothing(ProjectionClass::EyeInside),
            (ProjectionClass::EyeInside, Viewpoint::Direction(_)) | (ProjectionClass::Degenerate, _) => {
                nothing(ProjectionClass::Degenerate)
            }
            (class, _) => Self {
                class,
                thick: Some(thick_vertex(&volumes, &classified, positions, scalars, viewpoint)),
                fan: classified.fan(),
                volumes,
            },
        }
    }

    /// Scalars and chord length at a vertex of the fan. Interpolate them linearly in an orthographic view only.
    ///
    /// `None` for a thick vertex where there is none.
    pub fn attributes(&self, vertex: FanVertex, scalars: &[f64; 4]) -> Option<FanAttributes> {
        match vertex {
            FanVertex::Corner(corner) => {
                let scalar = scalars[corner];
                Some(FanAttributes { scalar_front: scalar, scalar_back: scalar, chord_length: 0.0 })
            }
            FanVertex::Thick => self.thick.map(|thick| FanAttributes {
                scalar_front: thick.scalar_front,
                scalar_back: thick.scalar_back,
                chord_length: thick.chord_length,
            }),
        }
    }

    /// The attributes of a vertex of the fan that are linear on the screen of a perspective view.
    ///
    /// `eye` is that of the projection, `forward` the unit line of sight. `None` where the vertex does not lie in front of
    /// the eye plane, and for a thick vertex where there is none. In an orthographic view use [`Projected::attributes`].
    pub fn screen_attributes(
        &self,
        vertex: FanVertex,
        positions: &[DVec3; 4],
        scalars: &[f64; 4],
        eye: DVec3,
        forward: DVec3,
    ) -> Option<ScreenAttributes> {
        let inverse = |ray: DVec3| {
            let depth = ray.dot(forward);
            (depth > 0.0).then(|| depth.recip())
        };
        match vertex {
            FanVertex::Corner(corner) => {
                let q = inverse(positions[corner] - eye)?;
                let u = scalars[corner] * q;
                Some(ScreenAttributes { dq: 0.0, q_front: q, u_front: u, u_back: u })
            }
            FanVertex::Thick => {
                let thick = self.thick?;
                let q_front = inverse(thick.ray)?;
                let sum_plus = self.volumes.sum_plus();
                Some(ScreenAttributes {
                    dq: q_front * (self.volumes.six_volume / sum_plus),
                    q_front,
                    u_front: thick.scalar_front * q_front,
                    u_back: thick.scalar_back * (q_front * (self.volumes.sum_minus() / sum_plus)),
                })
            }
        }
    }
}

/// The thick vertex of a cell for which both signs occur.
fn thick_vertex(
    volumes: &SignedVolumes,
    classified: &Classified,
    positions: &[DVec3; 4],
    scalars: &[f64; 4],
    viewpoint: Viewpoint,
) -> ThickVertex {
    let (sum_plus, sum_minus) = (volumes.sum_plus(), volumes.sum_minus());
    let near = |points: &[DVec3; 4]| mean_point(&classified.plus, volumes, sum_plus, points);
    let (ray, length) = match viewpoint {
        Viewpoint::Eye(eye) => {
            let ray = near(&positions.map(|p| p - eye));
            // |W| 6V / (S_P S_N) with W = S_P ray: quotients first, so that no product of volumes overflows.
            (ray, ray.length() * (volumes.six_volume / sum_minus))
        }
        Viewpoint::Direction(direction) => (direction, volumes.six_volume / (0.5 * sum_plus + 0.5 * sum_minus)),
    };
    ThickVertex {
        near: near(positions),
        far: mean_point(&classified.minus, volumes, sum_minus, positions),
        scalar_front: mean_scalar(&classified.plus, volumes, sum_plus, scalars),
        scalar_back: mean_scalar(&classified.minus, volumes, sum_minus, scalars),
        // Where rounding makes up all of the volumes the quotient can be anything; no chord exceeds the longest edge.
        chord_length: length.min(longest_edge(positions)),
        ray,
        corner: classified.thick_corner(),
    }
}

/// The mean of some corners' positions, weighted by the magnitude of their volumes; one corner is returned unchanged.
fn mean_point(corners: &Corners, volumes: &SignedVolumes, sum: f64, points: &[DVec3; 4]) -> DVec3 {
    let base = points[corners.first()];
    corners
        .as_slice()
        .iter()
        .skip(1)
        .fold(base, |mean, &corner| mean + (volumes.a[corner].abs() / sum) * (points[corner] - base))
}

/// The same for the field; never outside the corners' range.
fn mean_scalar(corners: &Corners, volumes: &SignedVolumes, sum: f64, scalars: &[f64; 4]) -> f64 {
    let base = scalars[corners.first()];
    let (mut mean, mut low, mut high) = (base, base, base);
    for &corner in &corners.as_slice()[1..] {
        mean += (volumes.a[corner].abs() / sum) * (scalars[corner] - base);
        low = low.min(scalars[corner]);
        high = high.max(scalars[corner]);
    }
    // Not `clamp`, which panics where a scalar is NaN.
    if mean < low {
        low
    } else if mean > high {
        high
    } else {
        mean
    }
}

fn longest_edge(positions: &[DVec3; 4]) -> f64 {
    let mut longest: f64 = 0.0;
    for i in 1..4 {
        for j in 0..i {
            longest = longest.max(positions[i].distance_squared(positions[j]));
        }
    }
    longest.sqrt()
}
