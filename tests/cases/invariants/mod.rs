//! What every picture must hold to, whatever the mesh, the view and the renderer.

mod chords;
mod color;
mod degenerate;
mod determinism;
mod extremes;
mod far_scalars;
mod grids;
mod models;
mod numbering;
mod order;
mod peaks;
mod refinement;
mod similarity;
