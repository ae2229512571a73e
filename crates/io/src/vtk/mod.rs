//! The readers of VTK's meshes: legacy files (`.vtk`), XML files (`.vtu`, `.vti`, `.vtr`, `.vts`) and files that name others (`.pvtu`, `.pvd`, ...).
//!
//! All hand the same things to the same code: numbers of a declared type ([`scalars`]), cells as rows of point
//! indices ([`cells`]), grids in their pieces ([`grids`]) and arrays with names ([`named`]). What differs is how each finds them in its file.
//! [`write_vtu`] writes unstructured grids as XML.

pub(crate) mod cell_types;
pub(crate) mod cells;
mod grids;
mod join;
mod legacy;
pub(crate) mod named;
mod numbers;
pub(crate) mod scalars;
mod tuples;
mod write;
mod xml;

#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod hostile_tests;
#[cfg(test)]
mod test_support;
#[cfg(test)]
pub(crate) use test_support::sanity_check;

pub(crate) use legacy::LegacyVtk;
pub use write::{VtuEncoding, VtuOptions, WrittenVtu, write_vtu, write_vtu_with};
pub(crate) use xml::AppendedSearch;
use xml::{BlocksReader, Kind, ParallelReader, PvdReader, SeriesReader, XmlReader};

/// The reader of legacy files.
pub(crate) static LEGACY: LegacyVtk = LegacyVtk;

/// The readers of XML files, one a kind of dataset.
pub(crate) static VTU: XmlReader = XmlReader { kind: Kind::Unstructured };
pub(crate) static VTI: XmlReader = XmlReader { kind: Kind::Image };
pub(crate) static VTR: XmlReader = XmlReader { kind: Kind::Rectilinear };
pub(crate) static VTS: XmlReader = XmlReader { kind: Kind::Structured };

/// The readers of files that name pieces.
pub(crate) static PVTU: ParallelReader = ParallelReader { kind: Kind::Unstructured };
pub(crate) static PVTI: ParallelReader = ParallelReader { kind: Kind::Image };
pub(crate) static PVTR: ParallelReader = ParallelReader { kind: Kind::Rectilinear };
pub(crate) static PVTS: ParallelReader = ParallelReader { kind: Kind::Structured };

/// The readers of files that name whole meshes.
pub(crate) static PVD: PvdReader = PvdReader;
pub(crate) static SERIES: SeriesReader = SeriesReader;
pub(crate) static BLOCKS: BlocksReader = BlocksReader;

/// What to advise when a file is damaged rather than of an odd form.
const DAMAGED: &str = "the file is cut off or damaged; write it again, or open it in ParaView to see what is left";
