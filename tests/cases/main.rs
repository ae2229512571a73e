//! Tests that cross crates, one binary.

mod hostile;
mod invariants;
mod real_meshes;
mod references;
mod saving;
