//! The programs of the GPU back end: composed from files, checked, and described.
//!
//! A program is one file of the folder `shaders`, a stage or a pipeline, joined with what it uses. A line `#use path` brings in a
//! file, once; `#use <slot>` brings in the file that the caller names for the slot, so that a variant holds what its plan asks for and
//! nothing else. Constants are written once, in Rust, and put in front ([`Program::compose`]).
//!
//! Every program is validated with [`CAPABILITIES`], which is nothing beyond what each browser has, and tells what it binds
//! ([`Program::bindings`]): a binding's number is one and the same in all programs, so that a back end binds by name.
//!
//! ```
//! use tetrascope_shaders::Program;
//!
//! let program = Program::compose("include/frame.wgsl", &[], &[])?;
//! assert_eq!(program.entry_points().count(), 0, "a part of programs, and none by itself");
//! # Ok::<(), tetrascope_shaders::ShaderError>(())
//! ```
//!
//! Structures that both languages know are in [`layout`]; a test compares every offset. No device, no buffer.

mod compose;
mod constants;
pub mod layout;
mod layout_effects;
mod layout_optics;
mod program;
mod sources;

pub use compose::Slot;
pub use constants::Constant;
pub use program::{Access, Binding, BindingKind, CAPABILITIES, Program, ShaderError};
pub use sources::SOURCES;

#[cfg(test)]
mod tests;
