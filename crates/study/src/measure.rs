//! What is measured of one setting.

use std::time::Duration;

use tetrascope::{Backend, BufferRole, Counts, ErrorFigures, LinearImage, OrderMethod, Plan, Rendered, VolumeField};

use crate::{Figure, Setting};

/// A setting, and what came of it.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was drawn.
    pub setting: Setting,
    /// How far its picture of the scene's own view is from the reference.
    pub errors: ErrorFigures,
    /// Wall time of its frames, the picture in the host's memory included.
    pub frame: Spread,
    /// By how much its first frame took longer than the others, and at least what that spent on tables, maps and preparing: programs of a GPU and what an
    /// order learns of the mesh are in it. What several settings share is paid by the first of them.
    pub set_up: Duration,
    /// Mean time of each stage of a frame, as the device measured it where it has a clock, else as the host did.
    pub stages: Vec<(String, Duration)>,
    /// Bytes in use, by what they are for.
    pub memory: Vec<(String, u64)>,
    /// What was done for the picture.
    pub counts: Counts,
    /// How far its order can be trusted.
    pub order: String,
    /// The device that drew it, if one did.
    pub device: Option<String>,
    /// The picture, not larger than the study asks for.
    pub picture: LinearImage,
    /// Where it differs from the reference, likewise: black up to rounding, white from 1 on, by the logarithm.
    pub difference: LinearImage,
    /// For each of [`Figure::ALL`] whether no other setting beats it in both time and that.
    pub on_frontier: [bool; 3],
}

impl Outcome {
    /// The stage that takes longest, and its share of the time of all stages, 0 to 1; `None` if nothing was measured.
    pub fn dominant(&self) -> Option<(&str, f64)> {
        let all: Duration = self.stages.iter().map(|(_, time)| *time).sum();
        let (stage, time) = self.stages.iter().max_by_key(|(_, time)| *time)?;
        (!all.is_zero()).then(|| (stage.as_str(), time.as_secs_f64() / all.as_secs_f64()))
    }

    /// All its memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.memory.iter().map(|(_, bytes)| bytes).sum()
    }

    /// Whether it is on the frontier of a figure.
    pub fn is_on_frontier(&self, figure: Figure) -> bool {
        Figure::ALL.iter().position(|one| *one == figure).is_some_and(|index| self.on_frontier[index])
    }
}

/// Several times of the same thing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spread {
    /// In the middle.
    pub median: Duration,
    /// The shortest.
    pub fastest: Duration,
    /// The longest.
    pub slowest: Duration,
}

impl Spread {
    /// Of times in any order; of an even number the later of the two in the middle. Zero if there are none.
    pub fn of(times: &[Duration]) -> Self {
        let mut ascending = times.to_vec();
        ascending.sort_unstable();
        match ascending[..] {
            [] => Self::default(),
            [fastest, ..] => {
                let (median, slowest) = (ascending[ascending.len() / 2], ascending[ascending.len() - 1]);
                Self { median, fastest, slowest }
            }
        }
    }
}

/// Times of each stage of a frame, by the clock that is nearer to the work.
pub(crate) fn stages_of(rendered: &Rendered) -> Vec<(String, Duration)> {
    match &rendered.device {
        Some(device) if !device.stages.is_empty() => device.stages.clone(),
        _ => rendered.timings.iter().map(|(stage, time)| (stage.to_string(), *time)).collect(),
    }
}

/// Adds the times of a frame to the sums of those before.
pub(crate) fn add_stages(sums: &mut Vec<(String, Duration)>, frame: Vec<(String, Duration)>) {
    for (stage, time) in frame {
        match sums.iter_mut().find(|(known, _)| *known == stage) {
            Some((_, sum)) => *sum += time,
            None => sums.push((stage, time)),
        }
    }
}

/// Bytes in use for a picture: a device's buffers as its back end counts them, or what is foreseen of the CPU back end.
pub(crate) fn memory_of(field: &VolumeField<'_>, plan: &Plan, rendered: &Rendered) -> Vec<(String, u64)> {
    let mut parts = match &rendered.device {
        Some(device) => BufferRole::ALL.map(|role| (role.to_string(), device.bytes(role))).to_vec(),
        None => memory_on_cpu(field, plan, rendered),
    };
    parts.retain(|(_, bytes)| *bytes > 0);
    parts
}

fn memory_on_cpu(field: &VolumeField<'_>, plan: &Plan, rendered: &Rendered) -> Vec<(String, u64)> {
    // Only a field that fits no mesh has none, and that was not drawn.
    let Ok(work) = field.work(plan) else { return Vec::new() };
    let threads = plan.threads.or_else(|| std::thread::available_parallelism().map(usize::from).ok()).unwrap_or(1);
    let held_back = 32 * rendered.counts.most_held * threads as u64;
    let parts = BufferRole::ALL.map(|role| {
        let foreseen: u64 = work.buffers.iter().filter(|b| b.role == role).map(|b| b.bytes.number()).sum();
        let learned = if role == BufferRole::Order { order_bytes(field, plan) } else { 0 };
        (role.to_string(), foreseen + learned)
    });
    parts.into_iter().chain([("fragments held back".to_owned(), held_back)]).collect()
}

/// What an order keeps of the mesh.
fn order_bytes(field: &VolumeField<'_>, plan: &Plan) -> u64 {
    let sorts_nothing = matches!(plan.order, OrderMethod::None | OrderMethod::PerPixel);
    if plan.backend != Backend::Cpu || sorts_nothing {
        return 0;
    }
    let Ok(renderer) = field.renderer() else { return 0 };
    renderer.visibility().prepare(renderer.cells(), plan.order).kept_bytes() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_in_the_middle_and_at_the_ends() {
        let ms = Duration::from_millis;
        let spread = Spread::of(&[ms(5), ms(1), ms(3)]);
        assert_eq!(spread, Spread { median: ms(3), fastest: ms(1), slowest: ms(5) });
        assert_eq!(Spread::of(&[ms(4), ms(2)]).median, ms(4));
        assert_eq!(Spread::of(&[]), Spread::default());
    }

    #[test]
    fn stages_of_one_name_are_added() {
        let ms = Duration::from_millis;
        let mut sums = vec![("order".to_owned(), ms(1))];
        add_stages(&mut sums, vec![("bin".to_owned(), ms(2)), ("order".to_owned(), ms(3))]);
        assert_eq!(sums, [("order".to_owned(), ms(4)), ("bin".to_owned(), ms(2))]);
    }
}
