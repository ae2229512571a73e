//! Projected Tetrahedra volume rendering, from mesh file to picture.
