//! What the program says: lines for people or one JSON object, and warnings on standard error.

use std::io::Write;
use std::path::Path;
use std::sync::OnceLock;
use std::time::Duration;

use serde_json::{Map, Value, json};
use tetrascope::{
    Backend, BufferRole, Cause, Completed, CycleRemedy, DeviceReport, ErrorEstimate, ErrorFigures, ErrorPart,
    Gradients, Integration, LengthAxis, OrderWorth, Plan, Projection, Rendered, TargetBits, Volume, VolumeField, rough,
    short,
};

use crate::interrupt;

/// Collects what was done; people read it line by line as it happens, machines at the end.
#[derive(Debug)]
pub(crate) struct Report {
    quiet: bool,
    json: bool,
    object: Map<String, Value>,
    warnings: Vec<String>,
    written: Vec<String>,
    timings: Vec<(String, Duration)>,
}

impl Report {
    pub(crate) fn new(quiet: bool, json: bool) -> Self {
        Self { quiet, json, object: Map::new(), warnings: Vec::new(), written: Vec::new(), timings: Vec::new() }
    }

    fn say(&self, subject: &str, text: &str) {
        if !self.quiet && !self.json {
            line(&format!("{subject:<11} {text}"));
        }
    }

    fn put(&mut self, key: &str, value: Value) {
        self.object.insert(key.to_owned(), value);
    }

    pub(crate) fn warn(&mut self, text: &str) {
        warning(text);
        self.warnings.push(text.to_owned());
    }

    pub(crate) fn volume(&mut self, volume: &Volume) {
        let (points, cells) = (volume.dataset.points.len(), volume.decomposition.counts.cell_count());
        let tetrahedra = volume.decomposition.mesh.tetrahedra().len();
        self.say("mesh", &format!("{} ({})", volume.source_name, volume.format));
        self.say("", &format!("{points} points, {cells} cells, {tetrahedra} tetrahedra"));
        if let Some(time) = volume.times.get(volume.step) {
            self.say("", &format!("time step {} of 0 to {}, at {}", volume.step, volume.times.len() - 1, short(*time)));
        }
        self.put(
            "mesh",
            json!({ "path": volume.source_name, "format": volume.format, "points": points, "cells": cells,
                "tetrahedra": tetrahedra, "step": volume.step, "times": volume.times }),
        );
        self.timings.extend(volume.timings.iter().map(|(step, time)| ((*step).to_owned(), *time)));
        for text in volume.warnings.iter().chain(&volume.decomposition.counts.findings()) {
            self.warn(text);
        }
    }

    pub(crate) fn field(&mut self, field: &VolumeField<'_>, time: Duration) {
        let (low, high) = field.on_mesh.range;
        self.say("field", &format!("{}, {} to {}", field.field.name, short(low), short(high)));
        for note in &field.field.notes {
            self.say("", note);
        }
        self.put(
            "field",
            json!({ "name": field.field.name, "association": field.field.association.to_string(),
                "range": [low, high], "notes": field.field.notes,
                "non_finite_values": field.on_mesh.non_finite, "left_out": field.on_mesh.left_out }),
        );
        self.timings.push(("field".to_owned(), time));
        for text in field.field.warnings.iter().chain(&field.on_mesh.warning()) {
            self.warn(text);
        }
    }

    pub(crate) fn plan(&mut self, completed: &Completed, plan: &Plan, threads: Option<usize>) {
        let camera = &completed.scene.camera;
        let (eye, target) = (camera.eye, camera.target);
        let place = |p: [f64; 3]| p.map(short).join(", ");
        let projection = match camera.projection {
            Projection::Perspective { fov_y } => format!("perspective, {} degrees", short(fov_y.to_degrees())),
            Projection::Orthographic { height } => format!("orthographic, {} high", short(height)),
        };
        let (from, to) = (place(eye.to_array()), place(target.to_array()));
        let chose_camera = plan.decisions.iter().any(|d| d.subject == "camera");
        if !chose_camera {
            self.say("camera", &format!("from ({from}) to ({to}), {projection}"));
        }
        self.say("model", &plan.model.to_string());
        // Who draws has a line of its own.
        for decision in plan.decisions.iter().filter(|decision| decision.subject != "backend") {
            let extra = if decision.subject == "camera" { format!(", {projection}") } else { String::new() };
            self.say(decision.subject, &format!("{}{extra}: {}", decision.choice, decision.reason));
        }
        let max_error = completed.file.quality.max_error.unwrap_or_default();
        let used = threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
        let threads = match plan.backend {
            Backend::Gpu => String::new(),
            Backend::Cpu | Backend::Reference => format!(", {used} thread{}", if used == 1 { "" } else { "s" }),
        };
        let reason = plan.decisions.iter().find(|decision| decision.subject == "backend");
        let reason = reason.map_or_else(String::new, |decision| format!(": {}", decision.reason));
        self.say("backend", &format!("{}{threads}{reason}", plan.backend));
        let decisions: Vec<Value> = plan
            .decisions
            .iter()
            .map(|d| json!({ "subject": d.subject, "choice": d.choice, "reason": d.reason }))
            .collect();
        self.put("decisions", json!(decisions));
        self.put("integration", json!(plan.integration.to_string()));
        self.put("interpolation", json!(plan.interpolation.to_string()));
        self.put("tables", tables_of(plan));
        self.put("isosurfaces", isosurfaces_of(plan));
        let gradients = match plan.gradients() {
            Gradients::None => "none",
            Gradients::Cells => "cells",
            Gradients::Points => "points",
        };
        self.put("gradients", json!(gradients));
        // The reference takes no order of cells: it sorts along every ray.
        let order = match plan.backend {
            Backend::Reference => "per-pixel".to_owned(),
            Backend::Cpu | Backend::Gpu => plan.order.to_string(),
        };
        self.put("order", json!(order));
        self.put("cycles", json!(completed.file.quality.cycles.map(|remedy| remedy.to_string())));
        self.put("model", json!(plan.model.to_string()));
        self.put("backend", json!(plan.backend.to_string()));
        self.put("threads", json!(used));
        self.put("max_error", json!(max_error));
        self.put("image", json!({ "width": plan.view.width, "height": plan.view.height }));
        self.put(
            "camera",
            json!({ "eye": eye.to_array(), "target": target.to_array(), "up": camera.up.to_array(),
                "projection": projection }),
        );
        for text in &completed.warnings {
            self.warn(text);
        }
    }

    pub(crate) fn chose_in(&mut self, time: Duration) {
        self.timings.push(("choose".to_owned(), time));
    }

    pub(crate) fn rendered(&mut self, rendered: &Rendered, plan: &Plan, worth: &OrderWorth) {
        let counts = &rendered.counts;
        self.say(
            "drawn",
            &format!(
                "{} ({} invisible by the transfer function, {} out of view or between pixels), {}",
                drawn(rendered, plan),
                counts.transparent,
                counts.outside,
                fragments(rendered)
            ),
        );
        self.say("guarantee", &worth.summary);
        if let Some(rings) = &worth.rings {
            self.say("rings", rings);
        }
        self.put(
            "order_worth",
            json!({ "summary": worth.summary, "rings": rendered.order.rings, "cyclic": counts.cyclic }),
        );
        for text in &worth.warnings {
            self.warn(text);
        }
        if counts.crossings > 0 {
            self.say("crossings", &format!("{} of rays with isosurfaces", counts.crossings));
        }
        self.put(
            "counts",
            json!({ "cells": counts.cells, "drawn": counts.drawn, "transparent": counts.transparent,
                "outside": counts.outside, "fragments": counts.fragments, "crossings": counts.crossings, "cyclic": counts.cyclic }),
        );
        self.timings.extend(rendered.timings.iter().map(|(stage, time)| (stage.to_string(), *time)));
    }

    /// The device that drew the picture; with `explain` what it was given to do, too.
    pub(crate) fn device(&mut self, rendered: &Rendered, plan: &Plan, explain: bool) {
        let Some(device) = &rendered.device else {
            if explain {
                let text = format!("the back end {} uses no device; its times are below", plan.backend);
                self.say("explain", &text);
            }
            return;
        };
        let DeviceReport { name, driver, api, .. } = device;
        self.say("device", &format!("{name} ({api}; {driver}), {}", path_of(device)));
        for note in &device.notes {
            self.say("", note);
        }
        let cells = rendered.counts.cells;
        if explain {
            for role in BufferRole::ALL.into_iter().filter(|role| device.bytes(*role) > 0) {
                self.say("memory", &memory_of(device, role, cells));
            }
            if device.stages.is_empty() {
                self.say("stages", "the device has no clock that could be read");
            }
            for (stage, time) in &device.stages {
                self.say("stage", &format!("{stage} {}", seconds(*time)));
            }
            for pipeline in &device.pipelines {
                self.say("pipeline", pipeline);
            }
        }
        let buffers: Vec<Value> = device
            .buffers
            .iter()
            .map(|buffer| json!({ "label": buffer.label, "role": buffer.role.to_string(), "bytes": buffer.bytes }))
            .collect();
        let stages: Vec<Value> =
            device.stages.iter().map(|(stage, time)| json!({ "stage": stage, "secs": time.as_secs_f64() })).collect();
        self.put(
            "device",
            json!({ "name": name, "driver": driver, "api": api, "path": device.path.to_string(),
                "target_bits": device.target_bits.map(TargetBits::bits), "buffers": buffers, "stages": stages,
                "pipelines": device.pipelines, "notes": device.notes }),
        );
    }

    /// The picture shows nothing, and why that may be.
    pub(crate) fn blank(&mut self, reasons: &[String]) {
        self.put("blank", json!(true));
        let why = if reasons.is_empty() {
            "no reason was found; compare the transfer function with the field's range and the camera with the mesh"
                .to_owned()
        } else {
            reasons.join("; ")
        };
        self.warn(&format!("the picture is blank: {why}"));
    }

    /// How wrong the picture is thought to be; a warning if the scene itself wants less.
    pub(crate) fn error(&mut self, estimate: &ErrorEstimate, wanted: Option<f64>, time: Duration) {
        let ErrorEstimate { parts, expected, bound, rays } = estimate;
        let text = format!(
            "{} is the largest expected in a channel, an estimate from {rays} ray{}; at most {}",
            rough(*expected),
            if *rays == 1 { "" } else { "s" },
            rough(*bound)
        );
        self.say("error", &text);
        self.say("", &parts.iter().map(part_of_error).collect::<Vec<_>>().join(", "));
        let of_parts: Map<String, Value> = parts
            .iter()
            .map(|part| (part.cause.to_string(), json!({ "expected": part.expected, "bound": part.bound })))
            .collect();
        self.put("error", json!({ "expected": expected, "bound": bound, "rays": rays, "parts": of_parts }));
        self.timings.push(("estimate".to_owned(), time));
        if let Some(wanted) = wanted.filter(|wanted| expected > wanted) {
            let worst = parts.iter().max_by(|a, b| a.expected.total_cmp(&b.expected));
            let remedy = worst.map_or("", |part| remedy_of(part.cause));
            self.warn(&format!(
                "the error is expected to be {}, more than the {} that is wanted; {remedy}, or --verify for what it is",
                rough(*expected),
                rough(wanted)
            ));
        }
    }

    /// How wrong the picture is; a warning if the scene itself wants less.
    pub(crate) fn verified(&mut self, figures: &ErrorFigures, wanted: Option<f64>) {
        let &ErrorFigures { largest, at: (x, y), root_mean_square, percentile_99_9, share_above_step } = figures;
        let text = format!(
            "the largest error is {} at column {x}, row {y}; rms {}, 99.9 % of the pixels within {}, {} % over 1/255",
            rough(largest),
            rough(root_mean_square),
            rough(percentile_99_9),
            short(100.0 * share_above_step)
        );
        self.say("verified", &text);
        self.put(
            "verified",
            json!({ "largest": largest, "at": [x, y], "rms": root_mean_square, "p99.9": percentile_99_9,
                "share_above_1/255": share_above_step }),
        );
        if let Some(wanted) = wanted.filter(|wanted| largest > *wanted) {
            self.warn(&format!("the error is {}, more than the {} that is wanted", rough(largest), rough(wanted)));
        }
    }

    pub(crate) fn verified_in(&mut self, time: Duration) {
        self.timings.push(("verify".to_owned(), time));
    }

    pub(crate) fn wrote(&mut self, path: &Path) {
        interrupt::wrote(path);
        self.written.push(path.display().to_string());
        self.say("wrote", &path.display().to_string());
    }

    pub(crate) fn wrote_in(&mut self, time: Duration) {
        self.timings.push(("write".to_owned(), time));
    }

    /// Times, and for machines everything.
    pub(crate) fn finish(mut self, total: Duration) {
        let steps: Vec<String> = self.timings.iter().map(|(step, time)| format!("{step} {}", seconds(*time))).collect();
        self.say("time", &format!("{}; {} in all", steps.join(", "), seconds(total)));
        if self.json {
            let steps: Map<String, Value> =
                self.timings.iter().map(|(step, time)| (step.replace(' ', "_"), json!(time.as_secs_f64()))).collect();
            self.put("timings_secs", Value::Object(steps));
            self.put("total_secs", json!(total.as_secs_f64()));
            let (written, warnings) = (std::mem::take(&mut self.written), std::mem::take(&mut self.warnings));
            self.put("written", json!(written));
            self.put("warnings", json!(warnings));
            self.object.entry("blank").or_insert(json!(false));
            object(&Value::Object(self.object));
        }
    }
}

/// How much of the mesh was drawn; cells that were cut, in rings or for their fans at the plane of the eye, count piece by piece.
fn drawn(rendered: &Rendered, plan: &Plan) -> String {
    let counts = &rendered.counts;
    let seen = counts.cells - counts.transparent - counts.outside;
    if plan.cycles == CycleRemedy::Cut && rendered.order.rings > 0 || counts.drawn > seen {
        return format!("{} tetrahedra and pieces, of {} tetrahedra", counts.drawn, counts.cells);
    }
    format!("{} of {} tetrahedra", counts.drawn, counts.cells)
}

/// How cells became pixels, and in which precision.
fn path_of(device: &DeviceReport) -> String {
    match device.target_bits {
        Some(target) => format!("{} blended in {} bits", device.path, target.bits()),
        None => format!("path {}", device.path),
    }
}

/// Bytes of one role, a tetrahedron where they grow with the mesh, and what they are made of.
fn memory_of(device: &DeviceReport, role: BufferRole, cells: u64) -> String {
    let bytes = device.bytes(role);
    let share = match role {
        BufferRole::Mesh | BufferRole::Order | BufferRole::Frame => {
            format!(", {} bytes a tetrahedron", short(bytes as f64 / cells.max(1) as f64))
        }
        BufferRole::Lookup => String::new(),
    };
    let parts: Vec<String> = device
        .buffers
        .iter()
        .filter(|buffer| buffer.role == role)
        .map(|buffer| format!("{} {}", buffer.label, buffer.bytes))
        .collect();
    format!("{role}: {bytes} bytes{share} ({})", parts.join(", "))
}

/// Pairs of a pixel and a tetrahedron, where somebody counts them.
fn fragments(rendered: &Rendered) -> String {
    let counts = &rendered.counts;
    if counts.counts_fragments { format!("{} fragments", counts.fragments) } else { "fragments not counted".to_owned() }
}

/// Sizes of the integration's table; null if it has none.
fn tables_of(plan: &Plan) -> Value {
    let Some(tables) = plan.table_settings() else { return Value::Null };
    if plan.integration != Integration::Table3d {
        return json!({ "scalars": tables.scalars });
    }
    let length_axis = match tables.length_axis {
        LengthAxis::Linear => "linear",
        LengthAxis::Logarithmic => "logarithmic",
    };
    json!({ "scalars": tables.scalars, "lengths": tables.lengths, "length_axis": length_axis })
}

/// How many isosurfaces are drawn, where and by which method.
fn isosurfaces_of(plan: &Plan) -> Value {
    let Some(isosurfaces) = &plan.isosurfaces else { return json!({ "count": 0, "values": [] }) };
    let values: Vec<f64> = isosurfaces.surfaces.as_slice().iter().map(|surface| surface.value).collect();
    json!({ "count": values.len(), "values": values, "method": isosurfaces.method.name() })
}

/// A duration for people.
pub(crate) fn seconds(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    if seconds < 1.0 { format!("{:.1} ms", seconds * 1e3) } else { format!("{seconds:.2} s") }
}

/// A JSON object on standard output.
pub(crate) fn object(value: &Value) {
    line(&format!("{value:#}"));
}

/// Why standard output was not written, the first time.
static NOT_SAID: OnceLock<String> = OnceLock::new();

/// A line on standard output. A reader that went away (`| head`) is no error; any other failure is one at the end ([`not_said`]).
pub(crate) fn line(text: &str) {
    let mut output = std::io::stdout().lock();
    note_failure(writeln!(output, "{text}").and_then(|()| output.flush()));
}

/// Notes what an attempt to write to standard output came to.
pub(crate) fn note_failure(done: std::io::Result<()>) {
    if let Err(error) = done
        && error.kind() != std::io::ErrorKind::BrokenPipe
    {
        let _ = NOT_SAID.set(error.to_string());
    }
}

/// Why the report is not whole, if it is not.
pub(crate) fn not_said() -> Option<String> {
    NOT_SAID.get().map(|problem| format!("standard output: cannot be written: {problem}; the report is not whole"))
}

/// The last line after Ctrl-C.
pub(crate) fn interrupted(text: &str) {
    to_stderr("interrupted", text);
}

pub(crate) fn warning(text: &str) {
    to_stderr("warning", text);
}

pub(crate) fn error(text: &str) {
    to_stderr("error", text);
}

fn to_stderr(kind: &str, text: &str) {
    // With standard error closed there is nowhere left to complain.
    let _ = writeln!(std::io::stderr().lock(), "{kind}: {text}");
}

/// One cause in a line of causes.
fn part_of_error(part: &ErrorPart) -> String {
    let ErrorPart { cause, expected, bound } = *part;
    match bound {
        Some(0.0) => format!("{cause} none"),
        Some(bound) => format!("{cause} {} (estimate; at most {})", rough(expected), rough(bound)),
        None => format!("{cause} {} (estimate)", rough(expected)),
    }
}

/// What makes a cause's error less.
const fn remedy_of(cause: Cause) -> &'static str {
    match cause {
        Cause::Integration => "use --integration exact or auto",
        Cause::Order => "use --order auto",
        Cause::Interpolation => "use --interpolation exact",
        Cause::Isosurfaces => "use quality.isosurfaces = \"exact\"",
        Cause::Blending => "use --backend reference",
    }
}
