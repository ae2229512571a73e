//! What effects cost that are switched off: scenes with their keys, beside scenes that never had them, frame by frame.
//!
//! The two of a pair are drawn in turn, each by a renderer of its own, so that a machine whose speed drifts slows both alike. Reported is
//! the median of the ratios of neighboring frames, and how far its quartiles are apart: an effect that costs nothing has a ratio of 1 within
//! that. Counted work must be the same to the last cell.

use std::time::{Duration, Instant};

use tetrascope::{Choice, Counts, CpuRenderer, OrderMethod, Plan, SceneFile, Silent, Volume, VolumeField};
use tetrascope_tests::effects::{Pair, only_above, pairs, thin_extinction};

use crate::Failure;

/// One of the scenes that take turns.
struct Turn {
    plan: Plan,
    renderer: CpuRenderer,
    times: Vec<Duration>,
    counts: Counts,
}

impl Turn {
    fn new(scene: &SceneFile, field: &VolumeField<'_>) -> Result<Self, Failure> {
        let mut completed = scene.complete(&field.facts)?;
        let plan = field.plan(&mut completed)?;
        let renderer = CpuRenderer::new(field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars)?;
        Ok(Self { plan, renderer, times: Vec::new(), counts: Counts::default() })
    }

    fn draw(&mut self, is_warm: bool) -> Result<(), Failure> {
        let start = Instant::now();
        let rendered = self.renderer.render(&self.plan, &Silent)?;
        let time = start.elapsed();
        if is_warm {
            self.times.push(time);
        }
        self.counts = rendered.counts;
        Ok(())
    }

    fn median_ms(&self) -> f64 {
        let mut times = self.times.clone();
        times.sort();
        times.get(times.len() / 2).map_or(0.0, |time| time.as_secs_f64() * 1e3)
    }
}

/// Measures all pairs and prints a table.
pub(super) fn run(
    volume: &Volume,
    field_name: Option<&str>,
    only: &str,
    size: u32,
    frames: u32,
) -> Result<(), Failure> {
    let field = volume.field(field_name)?;
    let shown = thin_extinction(&field, 0.1);
    let threshold = shown.first().map_or(0.0, |first| first[0]);
    let cells = field.on_mesh.mesh.tetrahedra().len();
    println!("{}: {cells} tetrahedra, {size} x {size}, {frames} frames of each, in turn", volume.source_name);
    println!("effect | never had it, ms | off, ms | off / never, quartiles | counted work | on, ms");
    for pair in pairs(&field.facts, shown, size) {
        if pair.name.contains(only) {
            measure(&pair, &field, threshold, frames)?;
        }
    }
    Ok(())
}

fn measure(pair: &Pair, field: &VolumeField<'_>, threshold: f64, frames: u32) -> Result<(), Failure> {
    let fewer = if pair.is_of_fewer_cells { Some(only_above(field, threshold)?) } else { None };
    let fewer = fewer.as_ref().map(|volume| volume.field(None)).transpose()?;
    let scene = |scene: &SceneFile| {
        let mut scene = scene.clone();
        if pair.is_of_fewer_cells {
            // The cheapest order of the whole mesh need not be that of a part of it.
            scene.quality.replace_order(Choice::Named(OrderMethod::Centroid));
        }
        scene
    };
    let mut turns =
        vec![Turn::new(&scene(&pair.never), fewer.as_ref().unwrap_or(field))?, Turn::new(&scene(&pair.off), field)?];
    for (_, on) in &pair.on {
        turns.push(Turn::new(&scene(on), field)?);
    }
    for frame in 0..frames + 2 {
        // The other one goes first in every other frame.
        if frame % 2 == 1 {
            turns[..2].reverse();
        }
        let drawn = turns.iter_mut().try_for_each(|turn| turn.draw(frame >= 2));
        if frame % 2 == 1 {
            turns[..2].reverse();
        }
        drawn?;
    }
    let [never, off, on @ ..] = turns.as_slice() else { return Ok(()) };
    let mut ratios: Vec<f64> =
        off.times.iter().zip(&never.times).map(|(off, never)| off.as_secs_f64() / never.as_secs_f64()).collect();
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios.get((ratios.len() as f64 * share) as usize).copied().unwrap_or(f64::NAN);
    // A mesh without cells has fewer of them; what is done with the others is the same.
    let same = |counts: &Counts| Counts { cells: 0, transparent: 0, ..*counts };
    let is_same = if pair.is_of_fewer_cells {
        same(&never.counts).drawn == same(&off.counts).drawn && never.counts.fragments == off.counts.fragments
    } else {
        never.counts == off.counts
    };
    let work = format!(
        "{} drawn, {} fragments, {}",
        off.counts.drawn,
        off.counts.fragments,
        if is_same { "the same" } else { "NOT the same" }
    );
    let on: Vec<String> =
        on.iter().zip(&pair.on).map(|(turn, (what, _))| format!("{what}: {:.1}", turn.median_ms())).collect();
    println!(
        "{} ({}) | {:.1} | {:.1} | {:.3}, {:.3} to {:.3} | {work} | {}",
        pair.name,
        pair.off_by,
        never.median_ms(),
        off.median_ms(),
        at(0.5),
        at(0.25),
        at(0.75),
        on.join(", ")
    );
    if is_same {
        Ok(())
    } else {
        Err(format!("{}: what is off takes other work than what never was", pair.name).into())
    }
}
