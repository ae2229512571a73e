//! What the tests that cross crates share: random meshes, another way to know a chord, and the distance of two pictures.

pub mod chords;
pub mod compare;
pub mod effects;
pub mod fuzz;
pub mod golden;
pub mod gpu;
pub mod hard;
pub mod meshes;
pub mod peers;
pub mod pictures;
pub mod presets;
pub mod scenes;
pub mod shapes;
pub mod shared;
pub mod soak;
pub mod surfaces;
pub mod ways;
