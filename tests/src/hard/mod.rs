//! The hard cases of volume rendering on tetrahedra, case by case as `docs/hard-cases.md` has them.
//!
//! A [`HardCase`] is a list of scenes with what is known of them; [`judge()`] draws a scene in every way and holds the pictures against that.
//! The tests, the figures of the document and the comparison with other renderers all take them from here.

mod case;
mod classification;
pub mod document;
mod eye;
mod judge;
mod mesh;
mod numbers;
mod optics;
mod order;
mod pixels;
mod views;

pub use case::{Beyond, Group, HardCase, HardScene, Light, Limits, Truth, scene_of, volume_of};
pub use classification::{cells_of_the_table, impossible_cells};
pub use eye::towards_parallel_scenes;
pub use judge::{CANNOT_SORT, CHORD_LIMITS, CRACK_LIMITS, Finding, LIGHT_LIMITS, is_sound, judge};

/// All cases, in the order of the document.
pub fn all() -> Vec<HardCase> {
    [
        classification::cases(),
        eye::cases(),
        pixels::cases(),
        optics::cases(),
        numbers::cases(),
        mesh::cases(),
        order::cases(),
    ]
    .concat()
}

/// The case of a name.
pub fn named(name: &str) -> Option<HardCase> {
    all().into_iter().find(|case| case.name == name)
}
