//! Drawing every setting again and again, in turn, and comparing it with the reference.

use std::time::{Duration, Instant};

use tetrascope::{ErrorFigures, LinearImage, PixelDifference, Plan, Progress, Rendered, Stage, VolumeField};

use crate::measure::{add_stages, memory_of, stages_of};
use crate::progress::{Meter, Untold};
use crate::turn::{Pooling, reduced, turned};
use crate::{Error, LeftOut, Options, Outcome, Setting, Spread};

/// Settings taking turns.
pub(crate) struct Runs<'a> {
    pub(crate) field: &'a VolumeField<'a>,
    /// Degrees; in ascending order.
    pub(crate) angles: Vec<f64>,
    pub(crate) meter: Meter<'a>,
}

/// What is known so far of a setting.
struct Run {
    setting: Setting,
    /// Of the first frame: all of it, and what the host spent on what is kept for others.
    first: Duration,
    made: Duration,
    times: Vec<Duration>,
    stages: Vec<(String, Duration)>,
    /// Of the middle frame.
    outcome: Option<Outcome>,
}

impl Runs<'_> {
    /// Draws all settings, and compares the frame of the scene's own view; those that fail are left out.
    ///
    /// # Errors
    /// [`Error::Tetrascope`] where the study is to be given up, and nothing else.
    pub(crate) fn measure(
        &self,
        settings: Vec<Setting>,
        exact: &LinearImage,
        options: &Options,
        left_out: &mut Vec<LeftOut>,
    ) -> Result<Vec<Outcome>, Error> {
        let rounds = self.angles.len().min(3);
        let per_visit = self.angles.len().div_ceil(rounds);
        let visits: Vec<&[f64]> = self.angles.chunks(per_visit).collect();
        let total = (settings.len() * (1 + visits.len() + self.angles.len())) as u64;
        let mut done = 0;
        let mut runs = Vec::new();
        for setting in settings {
            done += 1;
            self.meter.frames(&setting.name, done, total);
            let begin = Instant::now();
            match self.draw(&setting, 0.0) {
                Ok(rendered) => {
                    let (first, made) = (begin.elapsed(), made_in(&rendered));
                    runs.push(Run { setting, first, made, times: Vec::new(), stages: Vec::new(), outcome: None });
                }
                Err(error) => {
                    self.go_on()?;
                    left_out.push(LeftOut { name: setting.name, reason: error.to_string() });
                }
            }
        }
        for visit in visits {
            let mut kept = Vec::new();
            for mut run in runs {
                done += 1 + visit.len() as u64;
                self.meter.frames(&run.setting.name, done, total);
                match self.visit(&mut run, visit, exact, options) {
                    Ok(()) => kept.push(run),
                    Err(error) => {
                        self.go_on()?;
                        left_out.push(LeftOut { name: run.setting.name, reason: error.to_string() });
                    }
                }
            }
            runs = kept;
        }
        self.meter.frames("done", total, total);
        Ok(runs.into_iter().filter_map(Run::finish).collect())
    }

    /// A frame that was not drawn as the study is to be given up is no reason to leave its setting out.
    fn go_on(&self) -> Result<(), Error> {
        self.meter.go_on().map_err(tetrascope::Error::from).map_err(Error::from)
    }

    /// One frame that is not timed, and then those that are.
    fn visit(&self, run: &mut Run, angles: &[f64], exact: &LinearImage, options: &Options) -> Result<(), Error> {
        // Between two frames of the turn: nothing that depends on the view is there already for one that is timed.
        self.draw(&run.setting, angles[0] + 0.37)?;
        for &angle in angles {
            let begin = Instant::now();
            let rendered = self.draw(&run.setting, angle)?;
            run.times.push(begin.elapsed());
            add_stages(&mut run.stages, stages_of(&rendered));
            if angle == 0.0 {
                run.outcome = Some(self.outcome(&run.setting, rendered, exact, options)?);
            }
        }
        Ok(())
    }

    fn draw(&self, setting: &Setting, angle: f64) -> Result<Rendered, tetrascope::Error> {
        let center = self.field.facts.center().to_array();
        let view = if angle == 0.0 { setting.plan.view } else { turned(&setting.plan.view, center, angle) };
        self.field.render(&Plan { view, ..setting.plan.clone() }, &Untold(&self.meter))
    }

    fn outcome(
        &self,
        setting: &Setting,
        rendered: Rendered,
        exact: &LinearImage,
        options: &Options,
    ) -> Result<Outcome, Error> {
        let errors = ErrorFigures::between(&rendered.image, exact).ok_or(Error::NoPixel)?;
        let map = PixelDifference::between(&rendered.image, exact).map(exact.width()).ok_or(Error::NoPixel)?;
        Ok(Outcome {
            setting: setting.clone(),
            errors,
            frame: Spread::default(),
            set_up: Duration::ZERO,
            stages: Vec::new(),
            memory: memory_of(self.field, &setting.plan, &rendered),
            order: self.field.order_worth(&setting.plan, &rendered).summary,
            device: rendered.device.map(|device| format!("{} ({}, {})", device.name, device.api, device.driver)),
            counts: rendered.counts,
            picture: reduced(&rendered.image, options.kept_side, Pooling::Mean),
            difference: reduced(&map, options.kept_side, Pooling::Largest),
            on_frontier: [false; 3],
        })
    }
}

impl Run {
    fn finish(self) -> Option<Outcome> {
        let frame = Spread::of(&self.times);
        let frames = self.times.len().max(1) as u32;
        let stages = self.stages.into_iter().map(|(stage, sum)| (stage, sum / frames)).collect();
        let set_up = self.first.saturating_sub(frame.median).max(self.made);
        self.outcome.map(|outcome| Outcome { frame, set_up, stages, ..outcome })
    }
}

/// Time in which a frame made what the next ones find ready.
fn made_in(rendered: &Rendered) -> Duration {
    let is_kept = |stage: &Stage| matches!(stage, Stage::Prepare | Stage::Tabulate);
    rendered.timings.iter().filter(|(stage, _)| is_kept(stage)).map(|(_, time)| *time).sum()
}
