//! Hard cases of numbers.

use super::check;

#[test]
fn hard_tiny_and_huge_coordinates() {
    check("tiny-and-huge-coordinates");
}

#[test]
fn hard_detail_far_from_the_origin() {
    check("detail-far-from-the-origin");
}

#[test]
fn hard_tiny_and_huge_scalars() {
    check("tiny-and-huge-scalars");
}

#[test]
fn hard_small_variation_of_large_scalars() {
    check("small-variation-of-large-scalars");
}
