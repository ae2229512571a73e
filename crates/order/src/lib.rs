//! Visibility orders: which tetrahedron is blended before which.
//!
//! Every method is a [`VisibilityOrder`]: it is given the mesh and where rays come from, and fills an [`Order`]: a
//! permutation of the cells to be drawn, front to back, and a [`Guarantee`] that says how far it can be trusted.
//!
//! The crate knows no color and no pixel.
