//! Hard cases: optics.

use super::HardCase;

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    Vec::new()
}
