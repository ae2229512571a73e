//! How wrong a picture will be, how wrong it is, and the cheapest way to one that is right enough.

mod bound;
mod choose;
mod cost;
mod estimate;
mod probe;
mod sample;
mod survey;

pub use choose::{Candidate, IntegrationChoice, ROUNDING_OF_32_BITS, choose_integration};
pub use estimate::{BlendingOrder, Cause, ErrorEstimate, ErrorPart, RAYS, Subject, estimate};
pub use survey::Survey;
