//! Memory that is asked for, held against what the machine has before the work begins.

use sysinfo::{ProcessRefreshKind, ProcessesToUpdate, System, get_current_pid};
use tetrascope_scene::{Backend, BufferRole, IsosurfaceMethod, Plan, Work, memory_text};

use crate::{Error, VolumeField};

/// More memory is asked for than there is; nothing was begun.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[error("{} of memory are needed ({}), and {}; {}", memory_text(*.needed), list(.parts), left_of(*.left), remedy_of(.parts))]
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
    /// Counts of cells, points and pixels are enough where there is plenty; only where there may not be enough every cell is looked at.
    /// What the CPU's renderer of this field holds already, from an earlier picture or an order, is not asked for again.
    ///
    /// Of a picture on a graphics card only what the host holds is looked at: the device says itself what it cannot hold. Where nobody knows how much memory
    /// is left, only what the system refuses is refused.
    ///
    /// # Errors
    /// [`Error::Memory`], else as [`Self::work`].
    pub fn check_memory(&self, plan: &Plan, more: &[(&'static str, u64)]) -> Result<(), Error> {
        self.check_memory_within(plan, more, memory_left())
    }

    fn check_memory_within(&self, plan: &Plan, more: &[(&'static str, u64)], left: Option<u64>) -> Result<(), Error> {
        let besides = more.iter().fold(0_u64, |sum, (_, bytes)| sum.saturating_add(*bytes));
        let most = self.never_more(plan).saturating_add(besides);
        if most <= ALWAYS_THERE || left.is_some_and(|left| most <= left) && is_given(most) {
            return Ok(());
        }
        let work = self.work(plan)?;
        let mut parts = parts_of(&work, more);
        self.leave_out_held(&work, &mut parts);
        Ok(check(parts, left, is_given)?)
    }

    /// What the host needs for a picture at the very most, bytes, from counts alone: every cell is drawn, as the most costly of all plans
    /// has it.
    fn never_more(&self, plan: &Plan) -> u64 {
        let [cells, points] = [self.mesh().tetrahedra().len(), self.mesh().positions().len()];
        let pixels = u64::from(plan.view.width) * u64::from(plan.view.height);
        let table = plan.table_settings().map_or(0, |table| {
            u64::from(table.scalars).pow(2).saturating_mul(u64::from(table.lengths.max(1))).saturating_mul(ENTRY)
        });
        let maps = match plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.method) {
            Some(IsosurfaceMethod::Map { size, .. }) => 2 * u64::from(size).pow(2) * ENTRY,
            _ => 0,
        };
        let counted = [(cells as u64, A_CELL), (points as u64, A_POINT), (pixels, A_PIXEL)];
        counted.iter().fold(table.saturating_add(maps), |sum, (count, bytes)| sum.saturating_add(count * bytes))
    }

    /// Takes off what the CPU's renderer has already: the mesh, and of its last frame what the next one fills again.
    fn leave_out_held(&self, work: &Work, parts: &mut [(&'static str, u64)]) {
        let Some(last) = self.made.last_frame().filter(|_| work.backend == Backend::Cpu) else { return };
        for (label, bytes) in parts {
            match *label {
                "cells" | "points" => *bytes = 0,
                "points in view" | "outlines" if last > 0 => *bytes = 0,
                // Of a view that shows fewer cells less is kept.
                "cells set up" if last > 0 => {
                    let share = last as f64 / work.drawn_at_most().max(1) as f64;
                    *bytes -= (*bytes as f64 * share.min(1.0)) as u64;
                }
                _ => {}
            }
        }
    }
}

/// Bytes of an entry of a table or a map.
const ENTRY: u64 = 16;

/// Bytes of a cell, of a point and of a pixel that no plan exceeds.
const A_CELL: u64 = 1024;
const A_POINT: u64 = 128;
const A_PIXEL: u64 = 96;

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

/// Refuses constants of cells where not even the least of them can be held: a position, a scalar and its place for each of four corners.
pub(crate) fn check_cell_points(cells: usize) -> Result<(), MemoryError> {
    check_large("points of cells", 4 * 36 * cells as u64)
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

fn list(parts: &[(&str, u64)]) -> String {
    let shown = parts.iter().take(3).map(|(label, bytes)| format!("{label} {}", memory_text(*bytes)));
    shown.collect::<Vec<_>>().join(", ")
}

fn left_of(left: Option<u64>) -> String {
    left.map_or_else(
        || "the system does not give them to this process (limits are shown by `ulimit -a`)".to_owned(),
        |left| format!("{} are left", memory_text(left)),
    )
}

/// What makes the largest part smaller.
fn remedy_of(parts: &[(&'static str, u64)]) -> &'static str {
    match parts.first().map(|(label, _)| *label) {
        Some("table") => "ask for a smaller table (quality.table_size), or another integration",
        Some("maps of isosurfaces") => "ask for smaller maps (quality.map_size), or isosurfaces by \"exact\"",
        Some("picture" | "pictures compared" | "files") => "ask for a smaller picture (image.width and image.height)",
        Some("reference") => {
            "leave out what is compared with it (--verify, --error-map), or ask for a smaller picture (image.width and image.height)"
        }
        Some("fans") => {
            "use quality.interpolation = \"exact\" and quality.integration = \"exact\", or give a coarser mesh"
        }
        Some("effects of cells") => "leave out the light and the isosurfaces, or give a coarser mesh",
        _ => "free some memory, or give a coarser mesh",
    }
}

#[cfg(test)]
mod tests {
    use tetrascope_integrate::Integration;
    use tetrascope_mesh::rings_sample;
    use tetrascope_scene::{Interpolation, IsosurfaceSection, Lighting, Mixing, SceneFile, Silent};

    use super::*;
    use crate::Volume;

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

    #[test]
    fn no_plan_needs_more_than_counts_alone_allow() {
        let volume = Volume::from_dataset(rings_sample(4), "rings").unwrap();
        let field = volume.field(None).unwrap();
        let mut scene = SceneFile::of_mesh(crate::SAMPLE);
        scene.isosurface.push(IsosurfaceSection::new(0.5, [1.0; 3]));
        let start = field.plan(&mut scene.complete(&field.facts).unwrap()).unwrap();
        let lit = Lighting { volume: true, ..Lighting::default() };
        let map = IsosurfaceMethod::Map { size: 256, mixing: Mixing::Smooth };
        for change in [
            &|_: &mut Plan| {},
            &|plan| plan.lighting = Some(lit),
            &|plan| (plan.lighting, plan.interpolation) = (Some(lit), Interpolation::Perspective),
            &|plan| plan.integration = Integration::Table2d,
            &|plan| plan.integration = Integration::Table3d,
            &|plan| plan.backend = Backend::Reference,
            &|plan| plan.isosurfaces.iter_mut().for_each(|isosurfaces| isosurfaces.method = map),
        ] as [&dyn Fn(&mut Plan); 7]
        {
            let mut plan = start.clone();
            change(&mut plan);
            let work = field.work(&plan).unwrap();
            let foreseen: u64 = work.buffers.iter().map(|buffer| buffer.bytes.number()).sum();
            let most = field.never_more(&plan);
            assert!(foreseen <= most, "{foreseen} {most} {:?}", work.buffers);
        }
    }

    #[test]
    fn what_is_held_is_not_asked_for_again() {
        let volume = Volume::from_dataset(rings_sample(12), "rings").unwrap();
        let field = volume.field(None).unwrap();
        let mut scene = SceneFile::of_mesh(crate::SAMPLE);
        (scene.image.width, scene.image.height) = (16, 16);
        let plan = field.plan(&mut scene.complete(&field.facts).unwrap()).unwrap();
        // More than nobody is asked about.
        let more = [("files", ALWAYS_THERE)];
        let needed = parts_of(&field.work(&plan).unwrap(), &more).iter().map(|(_, bytes)| bytes).sum::<u64>();
        let fresh = volume.field(None).unwrap();
        assert!(fresh.check_memory_within(&plan, &more, Some(needed)).is_ok());
        assert!(fresh.check_memory_within(&plan, &more, Some(needed - 1)).is_err());
        field.render(&plan, &Silent).unwrap();
        assert!(field.check_memory_within(&plan, &more, Some(needed - 1)).is_ok());
        let pixels_alone = ALWAYS_THERE + 16 * 16 * 40;
        assert!(field.check_memory_within(&plan, &more, Some(pixels_alone)).is_err());
    }
}
