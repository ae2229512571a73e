//! The scene file, its defaults, and the plan of what will be computed.

mod plan;

pub use plan::{Backend, Decision, Plan, Progress, Silent, Stage, UnknownBackend};
