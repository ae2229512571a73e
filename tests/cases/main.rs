//! Tests that cross crates, one binary.

mod golden;
mod hostile;
mod invariants;
mod real_meshes;
mod references;
mod saving;
