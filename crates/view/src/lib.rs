//! Cameras, the rays of their pixels, and the picture that the pixels make.
//!
//! A [`Camera`] is what a scene says; a [`View`] is a camera that was checked and joined with a picture's size: an
//! orthonormal basis and the map from pixels to rays. A [`Viewpoint`] is all that classification and visibility order
//! need of it. A [`LinearImage`] is what every back end fills and every writer takes;
//! [`ErrorFigures`] say how far one is from another.
//!
//! The crate knows no mesh and no optics.

mod camera;
mod difference;
mod image;

pub use camera::{Camera, Projection, Ray, View, ViewError, Viewpoint};
pub use difference::{ErrorFigures, PixelDifference};
pub use image::LinearImage;

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
