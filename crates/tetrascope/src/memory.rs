//! Memory that is asked for, held against what the machine has before the work begins.

use sysinfo::{ProcessRefreshKind, ProcessesToUpdate, System, get_current_pid};
use tetrascope_scene::{Backend, BufferRole, Plan, Work, short};

use crate::{Error, VolumeField};

/// More memory is asked for than there is; nothing was begun.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{} of memory are needed ({}), and {}; {}", gib(*.needed), list(.parts), left_of(*.left), remedy_of(.parts))]
pub struct MemoryError {
    /// What it is needed for, bytes, the largest part first.
    pub parts: Vec<(&'static str, u64)>,
    /// All of it, bytes.
    pub needed: u64,
    /// What is left, bytes; `None` where that is not known, and the system refused.
    pub left: Option<u64>,
}

/// Memory that this process may still take, bytes: what is available, with what is left of the swap, within the limits of its control groups.
/// `None` where the system does not say.
pub fn memory_left() -> Option<u64> {
    let mut system = System::new().ok()?;
    system.refresh_memory();
    let available = system.available_memory();
    let mut left = (available > 0).then(|| available.saturating_add(system.free_swap()));
    if let Ok(process) = get_current_pid() {
        system.refresh_processes_specifics(ProcessesToUpdate::Some(&[process]), false, ProcessRefreshKind::nothing());
        let limits = system.process(process).and_then(sysinfo::Process::cgroup_limits);
        // Files that the system keeps in memory count as used in a control group, and make way.
        let of_group =
            limits.map(|limits| (limits.total_memory - limits.rss.min(limits.total_memory)) + limits.free_swap);
        left = left.into_iter().chain(of_group).min();
    }
    left
}

impl VolumeField<'_> {
    /// Whether there is memory for a picture, as far as it is foreseen ([`Self::work`]); nothing is drawn.
    ///
    /// - `more`: what the caller needs besides, bytes by what it is for
    ///
    /// Of a picture on a graphics card only what the host holds is looked at: the device says itself what it cannot hold. Where nobody knows how much memory
    /// is left, only what the system refuses is refused.
    ///
    /// # Errors
    /// [`Error::Memory`], else as [`Self::work`].
    pub fn check_memory(&self, plan: &Plan, more: &[(&'static str, u64)]) -> Result<(), Error> {
        let work = self.work(plan)?;
        Ok(check(parts_of(&work, more), memory_left(), is_given)?)
    }
}

/// What fits into any machine: nobody is asked about it.
const ALWAYS_THERE: u64 = 64 << 20;

/// Refuses a file that cannot be held, and it is held whole.
pub(crate) fn check_file(bytes: u64) -> Result<(), MemoryError> {
    check_large("mesh file", bytes)
}

/// Refuses a mesh of which not even the least can be held: tetrahedra and points as they are cut and drawn, a cell counted as one tetrahedron.
pub(crate) fn check_mesh(cells: usize, points: usize) -> Result<(), MemoryError> {
    // Four points and a sign, twice over; a position and a scalar, twice over.
    check_large("tetrahedra", 2 * (17 * cells as u64 + 32 * points as u64))
}

fn check_large(what: &'static str, bytes: u64) -> Result<(), MemoryError> {
    if bytes <= ALWAYS_THERE { Ok(()) } else { check(vec![(what, bytes)], memory_left(), is_given) }
}

/// What is held in the host's memory.
fn parts_of(work: &Work, more: &[(&'static str, u64)]) -> Vec<(&'static str, u64)> {
    let is_on_host = |role: BufferRole, label: &str| {
        work.backend != Backend::Gpu || role == BufferRole::Lookup || label == "picture"
    };
    let buffers = work.buffers.iter().filter(|buffer| is_on_host(buffer.role, buffer.label));
    let foreseen = buffers.map(|buffer| (buffer.label, buffer.bytes.number()));
    foreseen.chain(more.iter().copied()).filter(|(_, bytes)| *bytes > 0).collect()
}

fn check(
    mut parts: Vec<(&'static str, u64)>,
    left: Option<u64>,
    is_given: impl FnOnce(u64) -> bool,
) -> Result<(), MemoryError> {
    let needed = parts.iter().fold(0_u64, |sum, (_, bytes)| sum.saturating_add(*bytes));
    let is_known_to_lack = left.is_some_and(|left| needed > left);
    if !is_known_to_lack && is_given(needed) {
        return Ok(());
    }
    parts.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    let left = left.filter(|_| is_known_to_lack);
    Err(MemoryError { parts, needed, left })
}

/// Whether the system gives so much at once: what limits of the process leave, without touching it.
fn is_given(bytes: u64) -> bool {
    usize::try_from(bytes).is_ok_and(|bytes| Vec::<u8>::new().try_reserve_exact(bytes).is_ok())
}

fn gib(bytes: u64) -> String {
    const MIB: f64 = 1048576.0;
    let (number, unit) =
        if bytes >= 1 << 30 { (bytes as f64 / (1024.0 * MIB), "GiB") } else { (bytes as f64 / MIB, "MiB") };
    format!("{} {unit}", short((number * 10.0).round() / 10.0))
}

fn list(parts: &[(&str, u64)]) -> String {
    let shown = parts.iter().take(3).map(|(label, bytes)| format!("{label} {}", gib(*bytes)));
    shown.collect::<Vec<_>>().join(", ")
}

fn left_of(left: Option<u64>) -> String {
    left.map_or_else(
        || "the system does not give them to this process (limits are shown by `ulimit -a`)".to_owned(),
        |left| format!("{} are left", gib(left)),
    )
}

/// What makes the largest part smaller.
fn remedy_of(parts: &[(&'static str, u64)]) -> &'static str {
    match parts.first().map(|(label, _)| *label) {
        Some("table") => "ask for a smaller table (quality.table_size), or another integration",
        Some("maps of isosurfaces") => "ask for smaller maps (quality.map_size), or isosurfaces by \"exact\"",
        Some("picture" | "reference" | "files") => "ask for a smaller picture (image.width and image.height)",
        _ => "free some memory, or give a coarser mesh",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GIB: u64 = 1 << 30;

    #[test]
    fn what_is_asked_for_is_held_against_what_is_left() {
        let parts = vec![("cells", GIB / 2), ("table", 16 * GIB), ("picture", GIB)];
        assert_eq!(check(parts.clone(), Some(18 * GIB), |_| true), Ok(()));
        assert_eq!(check(parts.clone(), None, |_| true), Ok(()));
        let error = check(parts.clone(), Some(17 * GIB), |_| true).unwrap_err();
        assert_eq!(
            error.to_string(),
            "17.5 GiB of memory are needed (table 16 GiB, picture 1 GiB, cells 512 MiB), and 17 GiB are left; ask for a smaller table \
             (quality.table_size), or another integration"
        );
        // Known to be there, and refused by the system all the same.
        let error = check(parts, Some(18 * GIB), |bytes| bytes < 17 * GIB).unwrap_err();
        assert!(error.left.is_none() && error.to_string().contains("ulimit -a"), "{error}");
        let huge = check(vec![("picture", u64::MAX), ("files", 1)], Some(GIB), |_| true).unwrap_err();
        assert!(huge.needed == u64::MAX && huge.to_string().contains("a smaller picture"), "{huge}");
    }

    #[test]
    fn the_system_gives_little_and_not_everything() {
        assert!(is_given(0) && is_given(1 << 20) && !is_given(u64::MAX) && !is_given(1 << 62));
        assert!(memory_left().is_none_or(|left| left > 1 << 20));
    }
}
