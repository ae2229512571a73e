//! The readers of VTK's unstructured grids: legacy files (`.vtk`) and XML files (`.vtu`).
//!
//! Both hand the same three things to the same code: numbers of a declared type ([`scalars`]), cells as rows of point
//! indices ([`cells`]) and arrays with names ([`named`]). What differs is how each finds them in its file. [`write_vtu`] writes the second.

pub(crate) mod cell_types;
pub(crate) mod cells;
mod legacy;
pub(crate) mod named;
pub(crate) mod scalars;
mod vtu;
mod write;

#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod hostile_tests;
#[cfg(test)]
mod shared_table;
#[cfg(test)]
mod shared_tests;
#[cfg(test)]
mod test_support;

pub(crate) use legacy::LegacyVtk;
pub(crate) use vtu::VtuReader;
pub use write::write_vtu;

/// The reader of legacy files.
pub(crate) static LEGACY: LegacyVtk = LegacyVtk;

/// The reader of XML unstructured grids.
pub(crate) static VTU: VtuReader = VtuReader;

/// What to advise when a file is damaged rather than of an odd form.
const DAMAGED: &str = "the file is cut off or damaged; write it again, or open it in ParaView to see what is left";
