//! Draws one scene with every method, and shows what accuracy costs in time.
//!
//! A [`Study`] draws the exact reference of a scene, and then the scene with every [`Setting`] that is worth a look: each integration and size of
//! table, each order, each way to interpolate, each back end and target, from the plan that `auto` chose, one axis at a time, and the cheapest of
//! their products. What does not go together is left out with its reason. Each setting has an [`Outcome`]: how far its picture is from the
//! reference, the times of several frames of a small turn, set-up time, memory, and the stage that takes longest. The [`frontier()`] has those
//! that no other one beats in both error and time.
//!
//! ```
//! use tetrascope::{SceneFile, Silent, Volume};
//! use tetrascope_study::{Figure, Options, Study, csv};
//!
//! let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
//! (scene.image.width, scene.image.height) = (24, 24);
//! let volume = Volume::sample()?;
//! let field = volume.field(None)?;
//! let start = field.plan(&mut scene.complete(&field.facts)?)?;
//!
//! let options = Options { is_quick: true, frames: Some(1), uses_gpu: false, ..Options::default() };
//! let study = Study::run(&field, &start, &options, &Silent)?;
//! let best = study.outcomes.iter().filter(|outcome| outcome.is_on_frontier(Figure::Largest)).count();
//! assert!(best >= 1 && csv(&study).lines().count() == study.outcomes.len() + 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`csv()`], [`json()`], [`html()`] and [`chart_svg()`] show it, [`Study::write`] writes all of them into a folder.
//!
//! Limits: times are those of one machine in one hour, and of a picture of one size. What several settings share, such as what is
//! learned of the mesh, is in the set-up time of the first of them. Memory of the CPU back end is computed from what it documents of itself,
//! not measured.

mod chart;
mod csv;
mod error;
mod figure;
mod json;
mod measure;
mod page;
mod progress;
mod rounds;
mod run;
mod setting;
mod settings;
mod text;
mod turn;
mod write;

pub use chart::chart_svg;
pub use csv::csv;
pub use error::Error;
pub use figure::{Figure, frontier};
pub use json::json;
pub use measure::{Outcome, Spread};
pub use page::html;
pub use progress::StudyProgress;
pub use run::{Options, Study, settings_of};
pub use setting::{Axis, LeftOut, Place, Setting};
pub use text::{bytes_text, error_text, ms_text, percent_text};

/// The version of this program, as it stands in what a study writes.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
