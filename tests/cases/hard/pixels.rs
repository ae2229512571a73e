//! Hard cases of pixels.

use super::check;

#[test]
fn hard_rays_through_vertices() {
    check("rays-through-vertices");
}

#[test]
fn hard_rays_along_edges() {
    check("rays-along-edges");
}

#[test]
fn hard_rays_in_faces() {
    check("rays-in-faces");
}

#[test]
fn hard_grid_of_five_in_line_with_pixels() {
    check("grid-of-five-in-line-with-pixels");
}

#[test]
fn hard_grid_of_six_in_line_with_pixels() {
    check("grid-of-six-in-line-with-pixels");
}
