//! A study from beginning to end: the reference, the places, the settings, the frontier.

use std::time::{Duration, Instant};

use tetrascope::{
    AdapterDescription, Backend, Integration, Interpolation, LinearImage, MeshFacts, OrderMethod, Plan, Progress,
    TargetBits, VolumeField, adapter_of_auto, adapters,
};

use crate::progress::{Meter, Untold};
use crate::rounds::Runs;
use crate::settings::{Scope, settings};
use crate::turn::{Pooling, angles, reduced, shrunk};
use crate::{Error, Figure, LeftOut, Outcome, Place, Setting, StudyProgress, frontier};

/// How a scene is studied.
#[derive(Clone, Debug)]
pub struct Options {
    /// What the scene is called, on the page.
    pub name: String,
    /// Few settings, few frames and a small picture, for an answer in seconds.
    pub is_quick: bool,
    /// Frames of each setting that are timed; made odd, so that the middle one is the scene's own view. `None` takes 9, or 5 in a quick study.
    pub frames: Option<u32>,
    /// How far the eye turns about the mesh from the first frame to the last, degrees.
    pub turn_degrees: f64,
    /// A part of the name of a GPU's adapter, or its number, which may be software; `None` takes a graphics card if there is one.
    pub adapter: Option<String>,
    /// Whether a GPU is asked at all.
    pub uses_gpu: bool,
    /// Longest side of the pictures that are kept of each setting, pixels.
    pub kept_side: u32,
    /// What the scene itself asks for, where that is not the plan that the study begins with; it is studied too, and marked.
    pub scene_plan: Option<Plan>,
    /// Which of the settings that are worth a look are drawn.
    pub keeps: fn(&Setting) -> bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            name: "scene".to_owned(),
            is_quick: false,
            frames: None,
            turn_degrees: 4.0,
            adapter: None,
            uses_gpu: true,
            kept_side: 256,
            scene_plan: None,
            keeps: |_| true,
        }
    }
}

impl Options {
    /// Longest side of a picture in a quick study, pixels.
    pub const QUICK_SIDE: u32 = 160;

    /// How many frames of each setting are timed: an odd number.
    pub fn frame_count(&self) -> usize {
        let asked = self.frames.unwrap_or(if self.is_quick { 5 } else { 9 });
        asked.max(1) as usize | 1
    }
}

/// A scene drawn with every setting that is worth a look.
#[derive(Clone, Debug)]
pub struct Study {
    /// What the scene is called.
    pub name: String,
    /// The plan that the study began with.
    pub start: Plan,
    /// Name of the field.
    pub field: String,
    /// Tetrahedra and points of the mesh.
    pub mesh: [u64; 2],
    /// What defaults are made from.
    pub facts: MeshFacts,
    /// The settings, in the order in which they were drawn.
    pub outcomes: Vec<Outcome>,
    /// What is not among them.
    pub left_out: Vec<LeftOut>,
    /// The exact picture, not larger than [`Options::kept_side`].
    pub reference: LinearImage,
    /// How long that took.
    pub reference_time: Duration,
    /// How long a device took to open and to take the mesh, for each place on a GPU.
    pub opened: Vec<(Place, Duration)>,
    /// Frames of each setting that were timed, from one end of the turn to the other.
    pub frames: usize,
    /// The whole turn, degrees.
    pub turn_degrees: f64,
    /// Threads that the CPU's work is spread over.
    pub threads: usize,
    /// Wall time of the whole study.
    pub took: Duration,
}

impl Study {
    /// Draws the exact reference, then every setting over a small turn, and compares.
    ///
    /// - `start`: what `auto` chose for the scene; every setting differs from it in one axis, or in the few that somebody in a hurry would change
    ///
    /// The settings take turns, in up to three rounds, so that a machine that slows down slows all alike. Before the frames that are timed
    /// a setting draws one that is not, since what renderers keep from frame to frame belonged to another one. What cannot be drawn
    /// is left out with its reason.
    ///
    /// # Errors
    /// [`Error::Tetrascope`] if the reference is not drawn, or the study is to be given up ([`StudyProgress::is_stopped`]);
    /// [`Error::NothingToCompare`] if no setting is drawn.
    pub fn run(
        field: &VolumeField<'_>,
        start: &Plan,
        options: &Options,
        progress: &dyn StudyProgress,
    ) -> Result<Self, Error> {
        let begin = Instant::now();
        let meter = Meter::new(progress);
        let start = &start_of(start, options);
        field.check_memory(&exact_plan(start), &[])?;
        let reference = Instant::now();
        let exact = field.render(&exact_plan(start), &meter)?.image;
        let reference_time = reference.elapsed();

        let mut left_out = Vec::new();
        meter.frames("opening devices", 0, 1);
        let opened = open_places(field, start, options, &meter, &mut left_out)?;
        let (settings, not_there) = list(field, start, options, &opened)?;
        left_out.extend(not_there);

        let runs = Runs { field, angles: angles(options.frame_count(), options.turn_degrees), meter };
        let measured = runs.measure(settings, &exact, options, &mut left_out)?;
        if measured.is_empty() {
            return Err(Error::NothingToCompare { left_out });
        }
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let points = field.on_mesh.scalars.len() as u64;
        Ok(Self {
            name: options.name.clone(),
            start: start.clone(),
            field: field.field.name.clone(),
            mesh: [field.on_mesh.mesh.tetrahedra().len() as u64, points],
            facts: field.facts,
            outcomes: with_frontiers(measured),
            left_out,
            reference: reduced(&exact, options.kept_side, Pooling::Mean),
            reference_time,
            opened: opened.into_iter().filter(|(place, _)| *place != Place::Cpu).collect(),
            frames: options.frame_count(),
            turn_degrees: options.turn_degrees,
            threads: start.threads.unwrap_or(threads),
            took: begin.elapsed(),
        })
    }
}

/// The settings that a study of the plan draws, and what it leaves out, without drawing anything.
///
/// # Errors
/// [`Error::Tetrascope`] if the mesh has no renderer.
pub fn settings_of(
    field: &VolumeField<'_>,
    start: &Plan,
    options: &Options,
) -> Result<(Vec<Setting>, Vec<LeftOut>), Error> {
    list(field, &start_of(start, options), options, &[(Place::Cpu, Duration::ZERO)])
}

fn list(
    field: &VolumeField<'_>,
    start: &Plan,
    options: &Options,
    opened: &[(Place, Duration)],
) -> Result<(Vec<Setting>, Vec<LeftOut>), Error> {
    let renderer = field.renderer()?;
    let has_heights = !start.commutes() && renderer.visibility().quick_certificate(renderer.cells()).is_exact();
    let places: Vec<Place> = opened.iter().map(|(place, _)| *place).collect();
    let own = options.scene_plan.as_ref();
    let scope = Scope { places: &places, is_quick: options.is_quick, has_heights, own };
    let (mut settings, left_out) = settings(start, scope);
    settings.retain(options.keeps);
    Ok((settings, left_out))
}

/// The plan that the study begins with: on the CPU, which is everywhere.
fn start_of(plan: &Plan, options: &Options) -> Plan {
    let mut start = plan.clone();
    start.backend = Backend::Cpu;
    start.gpu.adapter.clone_from(&options.adapter);
    if options.is_quick {
        start.view = shrunk(&start.view, Options::QUICK_SIDE);
    }
    start
}

/// What every setting is compared with.
fn exact_plan(start: &Plan) -> Plan {
    let (integration, interpolation) = (Integration::Exact, Interpolation::Exact);
    Plan { backend: Backend::Reference, integration, interpolation, tables: None, termination: 0.0, ..start.clone() }
}

/// Who can draw the field, and how long it took to get ready; why others cannot.
fn open_places(
    field: &VolumeField<'_>,
    start: &Plan,
    options: &Options,
    meter: &Meter<'_>,
    left_out: &mut Vec<LeftOut>,
) -> Result<Vec<(Place, Duration)>, Error> {
    let mut opened = vec![(Place::Cpu, Duration::ZERO)];
    let mut leave_out = |name: &str, reason: String| left_out.push(LeftOut { name: name.to_owned(), reason });
    if !options.uses_gpu {
        leave_out("gpu", "it was not asked for".to_owned());
        return Ok(opened);
    }
    let found: Vec<AdapterDescription> = if options.adapter.is_some() { Vec::new() } else { adapters() };
    if options.adapter.is_none() && adapter_of_auto(&found).is_none() {
        leave_out(
            "gpu",
            "no graphics card was found; software that poses as one is studied if it is asked for by name".to_owned(),
        );
        return Ok(opened);
    }
    let targets = TargetBits::ALL.map(Place::GpuTriangles);
    for place in [Place::GpuCompute].into_iter().chain(targets.into_iter().rev()) {
        // A tiny picture with the plainest methods: the device, the mesh on it, and hardly a program.
        let (integration, order) = (Integration::Average, OrderMethod::None);
        let mut tiny = Plan { integration, order, tables: None, view: shrunk(&start.view, 16), ..start.clone() };
        tiny.isosurfaces = None;
        place.take(&mut tiny);
        let begin = Instant::now();
        let drawn = field.render(&tiny, &Untold(meter));
        meter.go_on().map_err(tetrascope::Error::from)?;
        match drawn {
            Ok(_) => opened.push((place, begin.elapsed())),
            Err(error) => leave_out(&place.to_string(), error.to_string()),
        }
    }
    Ok(opened)
}

fn with_frontiers(mut outcomes: Vec<Outcome>) -> Vec<Outcome> {
    for (index, figure) in Figure::ALL.into_iter().enumerate() {
        let costs: Vec<_> = outcomes.iter().map(|one| (one.frame.median, figure.of(&one.errors))).collect();
        for (outcome, is_there) in outcomes.iter_mut().zip(frontier(&costs, figure.rounding())) {
            outcome.on_frontier[index] = is_there;
        }
    }
    outcomes
}
