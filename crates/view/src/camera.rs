//! The camera: from what a scene says to the ray of a pixel.

use glam::DVec3;

/// How a scene describes the eye; world coordinates, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the rays start (perspective), or the middle of the plane where they start (orthographic).
    pub eye: DVec3,
    /// A point that the middle of the picture shows; not the eye.
    pub target: DVec3,
    /// A direction that points up in the picture; not along the line of sight.
    pub up: DVec3,
    /// How rays spread.
    pub projection: Projection,
}

/// How rays spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays start at the eye.
    Perspective {
        /// The full vertical angle of view, radians, above 0 and below π.
        fov_y: f64,
    },
    /// All rays run along the line of sight.
    Orthographic {
        /// The full height of the view, world length, above 0.
        height: f64,
    },
}

/// What is wrong with a camera or a picture's size.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages are the definitions")]
pub enum ViewError {
    #[error("the camera's {what} is not finite: ({}, {}, {})", value.x, value.y, value.z)]
    NotFinite { what: &'static str, value: DVec3 },
    #[error("the camera's eye and target are the same point ({}, {}, {}); move one of them", eye.x, eye.y, eye.z)]
    EyeIsTarget { eye: DVec3 },
    #[error("the camera's up direction ({}, {}, {}) is zero or runs along the line of sight; choose another", up.x, up.y, up.z)]
    UpAlongSight { up: DVec3 },
    #[error("the vertical angle of view is {degrees} degrees; it must be above 0 and below 180")]
    FieldOfView { degrees: f64 },
    #[error("the height of the orthographic view is {height}; it must be positive and finite")]
    Height { height: f64 },
    #[error("the picture is {width} x {height} pixels; each side must be between 1 and {limit}")]
    ImageSize { width: u32, height: u32, limit: u32 },
}

/// Where rays come from: all that classification and visibility order need of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewpoint {
    /// Rays start at this point.
    Eye(DVec3),
    /// Rays run along this direction (a unit vector), from far away.
    Direction(DVec3),
}

/// A ray; a point on it is `origin + t * direction`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes; not normalized: its component along the line of sight is 1, so that t is depth.
    pub direction: DVec3,
}

/// A checked camera, joined with a picture's size.
///
/// `right`, `up`, `forward` are orthonormal. The ray of the point `(x, y)` of the picture (pixels from its upper left
/// corner, so that pixel centers are at halves) has `X = 2 x / width - 1`, `Y = 1 - 2 y / height` and
/// - perspective: starts at `eye`, runs along `forward + X half_width right + Y half_height up`,
/// - orthographic: starts at `eye + X half_width right + Y half_height up`, runs along `forward`.
///
/// `half_width` and `half_height` are slopes in a perspective view and lengths in an orthographic one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where rays start, or the middle of the plane where they start.
    pub eye: DVec3,
    /// To the right of the picture.
    pub right: DVec3,
    /// To the top of the picture.
    pub up: DVec3,
    /// Into the picture.
    pub forward: DVec3,
    /// Half the picture's width, as a slope or a length.
    pub half_width: f64,
    /// Half the picture's height, as a slope or a length.
    pub half_height: f64,
    /// Whether rays start at one point.
    pub is_perspective: bool,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl View {
    /// The longest side of a picture, in pixels.
    pub const MAX_SIDE: u32 = 32_768;

    /// Joins a camera with a picture of `width` by `height` pixels.
    ///
    /// # Errors
    /// [`ViewError`] if a number is not finite, the eye is at the target, up is along the line of sight, or the angle, the
    /// height or the picture's size is out of range.
    pub fn new(camera: &Camera, width: u32, height: u32) -> Result<Self, ViewError> {
        if width == 0 || height == 0 || width > Self::MAX_SIDE || height > Self::MAX_SIDE {
            return Err(ViewError::ImageSize { width, height, limit: Self::MAX_SIDE });
        }
        for (what, value) in [("eye", camera.eye), ("target", camera.target), ("up direction", camera.up)] {
            if !value.is_finite() {
                return Err(ViewError::NotFinite { what, value });
            }
        }
        let forward = unit(camera.target - camera.eye).ok_or(ViewError::EyeIsTarget { eye: camera.eye })?;
        let up_error = ViewError::UpAlongSight { up: camera.up };
        let up_hint = unit(camera.up).ok_or(up_error.clone())?;
        let sideways = forward.cross(up_hint);
        // Below 1e-9 of a radian, rounding in the scene file decides where up is.
        if sideways.length() < 1e-9 {
            return Err(up_error);
        }
        let right = unit(sideways).ok_or(up_error)?;
        let up = right.cross(forward);
        let (half_height, is_perspective) = match camera.projection {
            Projection::Perspective { fov_y } => {
                if !(fov_y > 0.0 && fov_y < std::f64::consts::PI) {
                    return Err(ViewError::FieldOfView { degrees: fov_y.to_degrees() });
                }
                ((fov_y / 2.0).tan(), true)
            }
            Projection::Orthographic { height } => {
                if !(height > 0.0 && height.is_finite()) {
                    return Err(ViewError::Height { height });
                }
                (height / 2.0, false)
            }
        };
        let half_width = half_height * f64::from(width) / f64::from(height);
        Ok(Self { eye: camera.eye, right, up, forward, half_width, half_height, is_perspective, width, height })
    }

    /// The ray of the point `(x, y)` of the picture, in pixels from its upper left corner.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let across = self.right * ((2.0 * x / f64::from(self.width) - 1.0) * self.half_width)
            + self.up * ((1.0 - 2.0 * y / f64::from(self.height)) * self.half_height);
        if self.is_perspective {
            Ray { origin: self.eye, direction: self.forward + across }
        } else {
            Ray { origin: self.eye + across, direction: self.forward }
        }
    }

    /// Where rays come from.
    pub fn viewpoint(&self) -> Viewpoint {
        if self.is_perspective { Viewpoint::Eye(self.eye) } else { Viewpoint::Direction(self.forward) }
    }

    /// The same view of a scene whose coordinates are `(world - origin) / scale`.
    pub fn in_frame(&self, origin: DVec3, scale: f64) -> Self {
        let lengths = if self.is_perspective { 1.0 } else { 1.0 / scale };
        Self {
            eye: (self.eye - origin) / scale,
            half_width: self.half_width * lengths,
            half_height: self.half_height * lengths,
            ..*self
        }
    }
}

/// A unit vector, or `None` for zero; right for vectors whose squared length over- or underflows.
fn unit(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    (largest > 0.0 && largest.is_finite()).then(|| (v / largest).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            eye: DVec3::new(0.0, 0.0, 5.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_2 },
        }
    }

    #[test]
    fn rays_of_the_corners() {
        let view = View::new(&camera(), 200, 100).unwrap();
        let ray = view.ray(0.0, 0.0);
        assert!((ray.direction - DVec3::new(-2.0, 1.0, -1.0)).length() < 1e-15);
        let ray = view.ray(200.0, 100.0);
        assert!((ray.direction - DVec3::new(2.0, -1.0, -1.0)).length() < 1e-15);
    }

    #[test]
    fn orthographic_rays_are_parallel() {
        let camera = Camera { projection: Projection::Orthographic { height: 4.0 }, ..camera() };
        let view = View::new(&camera, 100, 100).unwrap();
        let (a, b) = (view.ray(0.0, 0.0), view.ray(50.0, 50.0));
        assert_eq!(a.direction, b.direction);
        assert!((a.origin - DVec3::new(-2.0, 2.0, 5.0)).length() < 1e-15);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let bad = |change: fn(&mut Camera)| {
            let mut c = camera();
            change(&mut c);
            View::new(&c, 10, 10).unwrap_err()
        };
        assert!(matches!(bad(|c| c.target = c.eye), ViewError::EyeIsTarget { .. }));
        assert!(matches!(bad(|c| c.up = DVec3::Z), ViewError::UpAlongSight { .. }));
        assert!(matches!(bad(|c| c.up = DVec3::ZERO), ViewError::UpAlongSight { .. }));
        assert!(matches!(bad(|c| c.eye.x = f64::NAN), ViewError::NotFinite { what: "eye", .. }));
        assert!(matches!(
            bad(|c| c.projection = Projection::Perspective { fov_y: 4.0 }),
            ViewError::FieldOfView { .. }
        ));
        assert!(matches!(View::new(&camera(), 0, 10), Err(ViewError::ImageSize { .. })));
    }

    #[test]
    fn tiny_and_huge_coordinates_keep_their_basis() {
        for scale in [1e-300, 1e-9, 1e9, 1e300] {
            let mut c = camera();
            c.eye *= scale;
            c.up *= scale;
            let view = View::new(&c, 10, 10).unwrap();
            assert!((view.forward + DVec3::Z).length() < 1e-15, "{scale}");
            assert!((view.up - DVec3::Y).length() < 1e-15, "{scale}");
        }
    }
}
