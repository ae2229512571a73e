//! Projected Tetrahedra: silhouette class, thick vertex and triangle fan of one tetrahedron in one view.

mod class;
mod exact;
mod fan;
mod project;
mod volumes;

pub use class::{Classified, Corners, ProjectionClass, Sign, by_planes};
pub use exact::{exact_face_sign, exact_orientation, exact_signs};
pub use fan::{Fan, FanVertex};
pub use project::{FanAttributes, Projected, ScreenAttributes, ThickVertex, project};
pub use tetrascope_view::Viewpoint;
pub use volumes::{FACES, SignedVolumes, face_volume, six_volume};
