//! Hard cases of optics.

use super::check;

#[test]
fn hard_optical_depths() {
    check("optical-depths");
}

#[test]
fn hard_short_chords() {
    check("short-chords");
}

#[test]
fn hard_equal_scalars() {
    check("equal-scalars");
}

#[test]
fn hard_steps_and_peaks() {
    check("steps-and-peaks");
}

#[test]
fn hard_slope_through_zero() {
    check("slope-through-zero");
}

#[test]
fn hard_ten_thousand_layers() {
    check("ten-thousand-layers");
}

#[test]
fn hard_accumulation() {
    check("accumulation");
}
