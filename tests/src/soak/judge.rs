//! Draws a case in every way and says what is wrong.

use std::collections::HashMap;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use glam::DVec3;
use tetrascope::{
    Backend, Error, Gpu, GpuError, GpuRenderer, Gradients, Guarantee, Integration, Interpolation, IsosurfaceMethod,
    LinearImage, OpticalModel, OrderMethod, Plan, Rendered, SceneFile, Silent, Volume, VolumeField,
};

use super::Case;
use super::truth::{Reach, envelope, ray_by_ray};
use crate::gpu;
use crate::hard::is_sound;
use crate::ways::Way;

/// What is wrong, without the numbers: a reduced case fails in the same manner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// It panicked.
    Panic,
    /// Pixels are not finite, negative or of an opacity beyond 1.
    Unsound,
    /// Other bits with another number of threads.
    Threads,
    /// Another picture than the reference's.
    Differs,
    /// Refused by this way and by no other, for no reason of the way's own.
    Refused,
}

/// One thing that is wrong with one way's picture.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Who drew it.
    pub way: Way,
    /// What.
    pub fault: Fault,
    /// In words, with figures.
    pub words: String,
    /// Column and row, where it is a matter of one.
    pub pixel: Option<[u32; 2]>,
    /// How much it is: of a difference the difference, else 1.
    pub size: f64,
}

impl Failure {
    fn new(way: Way, fault: Fault, words: String) -> Self {
        Self { way, fault, words, pixel: None, size: 1.0 }
    }
}

/// How near a picture came to its limit.
#[derive(Clone, Copy, Debug)]
pub struct Margin {
    /// Who drew it.
    pub way: Way,
    /// Largest difference from the reference, over all pixels that are not at an edge of something.
    pub difference: f64,
    /// The limit.
    pub limit: f64,
}

/// What came of a case.
#[derive(Clone, Debug, Default)]
pub struct Judged {
    /// Pictures drawn, those for the number of threads and of the reference included.
    pub pictures: usize,
    /// What is wrong.
    pub failures: Vec<Failure>,
    /// Who did not draw it, and why.
    pub refusals: Vec<(Way, String)>,
    /// How near pictures came to their limits.
    pub margins: Vec<Margin>,
    /// Whether there is nothing to see.
    pub is_blank: bool,
    /// Pixels that were right only for a scene a rounding away.
    pub at_edges: usize,
    /// What pictures had to agree in, and why not in all.
    pub agreement: &'static str,
}

/// Draws a field as a plan says: [`draw`], but for tests of the soak itself, which plant faults.
pub type Drawing<'a> = &'a (dyn Fn(Way, &VolumeField<'_>, &Plan) -> Result<Rendered, Error> + Sync);

/// Draws with the renderer of a way; all pictures of GPUs on one device.
///
/// # Errors
/// As [`VolumeField::render`].
pub fn draw(way: Way, field: &VolumeField<'_>, plan: &Plan) -> Result<Rendered, Error> {
    if !way.needs_gpu() {
        return field.render(plan, &Silent);
    }
    let gpu: Arc<Gpu> = gpu::gpu("soak").ok_or_else(|| GpuError::NoAdapter { problem: "none is open".to_owned() })?;
    let visibility = Arc::clone(field.renderer()?.visibility());
    let renderer = GpuRenderer::new(gpu, field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars, visibility)?;
    Ok(renderer.render(plan, &Silent)?)
}

/// What pictures have to agree in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Agreement {
    Light,
    /// Opacities alone, which no order changes.
    Opacity,
    /// Nothing but to be pictures.
    Soundness,
}

/// Draws a case in these ways, the reference first, and compares.
pub fn judge(case: &Case, ways: &[Way], drawing: Drawing<'_>) -> Judged {
    let mut judged = Judged { agreement: "light", ..Judged::default() };
    match catching(|| judge_inner(case, ways, drawing, &mut judged)) {
        Ok(()) => {}
        Err(words) => judged.failures.push(Failure::new(Way::Reference, Fault::Panic, words)),
    }
    judged
}

fn judge_inner(case: &Case, ways: &[Way], drawing: Drawing<'_>, judged: &mut Judged) {
    let refuse_all = |judged: &mut Judged, error: &Error| {
        judged.refusals.extend(ways.iter().map(|&way| (way, error.to_string())));
    };
    let volume: Volume = match case.volume() {
        Ok(volume) => volume,
        Err(error) => return refuse_all(judged, &error),
    };
    let field = match volume.field(case.scene.mesh.field.as_deref()) {
        Ok(field) => field,
        Err(error) => return refuse_all(judged, &error),
    };
    // What the CPU's choice leads to is asked of all: else methods would be compared and not renderers.
    let settled = catching(|| settle(&field, &case.scene));
    let scene = match settled {
        Ok(Ok(scene)) => scene,
        Ok(Err(_)) => case.scene.clone(),
        Err(words) => {
            judged.failures.push(Failure::new(Way::Cpu, Fault::Panic, words));
            return;
        }
    };
    let mut drawn: Vec<(Way, Plan, Rendered)> = Vec::new();
    for &way in ways {
        match catching(|| draw_once(way, &field, &scene, drawing, None)) {
            Ok(Ok((plan, rendered))) => drawn.push((way, plan, rendered)),
            Ok(Err(error)) => judged.refusals.push((way, error.to_string())),
            Err(words) => judged.failures.push(Failure::new(way, Fault::Panic, words)),
        }
    }
    judged.pictures += drawn.len();
    check_refusals(ways, &drawn, judged);
    for (way, plan, rendered) in &drawn {
        check_soundness(*way, &rendered.image, judged);
        check_brightness(*way, plan, &scene, &rendered.image, judged);
    }
    for (way, _, rendered) in drawn.iter().filter(|(way, ..)| !way.needs_gpu()) {
        for threads in [1, 3] {
            match catching(|| draw_once(*way, &field, &scene, drawing, Some(threads))) {
                Ok(Ok((_, other))) if other.image == rendered.image => judged.pictures += 1,
                Ok(other) => {
                    let words = match other {
                        Ok(_) => format!("{threads} threads give other bits"),
                        Err(error) => format!("{threads} threads: {error}"),
                    };
                    judged.failures.push(Failure::new(*way, Fault::Threads, words));
                }
                Err(words) => judged.failures.push(Failure::new(*way, Fault::Panic, words)),
            }
        }
    }
    let Some((plan, reference)) = reference_of(&field, &drawn) else { return };
    judged.is_blank = tetrascope::is_blank(&reference);
    let compared = Compared { field: &field, scene: &scene, plan, range: case.scalar_range() };
    for (way, own, rendered) in drawn.iter().filter(|(way, ..)| *way != Way::Reference) {
        let (agreement, why) = agreement(&field, own, rendered);
        if agreement != Agreement::Light {
            judged.agreement = why;
        }
        compared.check(*way, own, [&reference, &rendered.image], agreement, judged);
    }
}

/// The plan and the picture that all others are held against.
fn reference_of<'a>(field: &VolumeField<'_>, drawn: &'a [(Way, Plan, Rendered)]) -> Option<(&'a Plan, LinearImage)> {
    if let Some((_, plan, rendered)) = drawn.iter().find(|(way, ..)| *way == Way::Reference) {
        return Some((plan, rendered.image.clone()));
    }
    let (_, plan, _) = drawn.iter().find(|(_, plan, _)| plan.integration.needs_fan())?;
    Some((plan, ray_by_ray(field, plan)?))
}

/// What a closure gives, or what it said when it panicked.
fn catching<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str).or(payload.downcast_ref::<&str>().copied());
        format!("it panicked: {}", text.unwrap_or("without a word"))
    })
}

/// The scene with the integration by name that the CPU takes where it is left open.
fn settle(field: &VolumeField<'_>, scene: &SceneFile) -> Result<SceneFile, Error> {
    let mut completed = Way::Cpu.scene(scene).complete(&field.facts)?;
    field.plan(&mut completed)?;
    let quality = completed.file.quality;
    let mut settled = scene.clone();
    settled.quality.integration = quality.integration;
    settled.quality.table_size = quality.table_size;
    (settled.quality.table_lengths, settled.quality.length_axis) = (quality.table_lengths, quality.length_axis);
    Ok(settled)
}

fn draw_once(
    way: Way,
    field: &VolumeField<'_>,
    scene: &SceneFile,
    drawing: Drawing<'_>,
    threads: Option<usize>,
) -> Result<(Plan, Rendered), Error> {
    let mut completed = way.scene(scene).complete(&field.facts)?;
    completed.scene.threads = threads;
    let plan = field.plan(&mut completed)?;
    let rendered = drawing(way, field, &plan)?;
    Ok((plan, rendered))
}

/// A scene is refused by all that need no device or by none of them, and in the same words. A GPU may refuse by itself, in words that name what it cannot.
fn check_refusals(ways: &[Way], drawn: &[(Way, Plan, Rendered)], judged: &mut Judged) {
    let said = |way: Way| judged.refusals.iter().find(|(w, _)| *w == way).map(|(_, words)| words.clone());
    let mut failures = Vec::new();
    if let (Some(words), true) = (said(Way::Cpu), drawn.iter().any(|(way, ..)| *way == Way::Reference)) {
        failures.push(Failure::new(Way::Cpu, Fault::Refused, words));
    }
    if let (Some(words), true) = (said(Way::Reference), drawn.iter().any(|(way, ..)| *way == Way::Cpu))
        && !words.contains(REFERENCE_REASON)
    {
        failures.push(Failure::new(Way::Reference, Fault::Refused, words));
    }
    for &way in ways.iter().filter(|way| way.needs_gpu()) {
        if let Some(words) = said(way)
            && said(Way::Reference).is_none()
            && !GPU_REASONS.iter().any(|reason| words.contains(reason))
        {
            failures.push(Failure::new(way, Fault::Refused, words));
        }
    }
    judged.failures.append(&mut failures);
}

/// What the reference cannot: its rays draw it one by one.
const REFERENCE_REASON: &str = "has no fan of triangles";

/// What a way on a GPU cannot and the CPU can.
const GPU_REASONS: &[&str] = &[
    "draws whole ones",
    "is drawn on the back end \"cpu\" alone",
    "draws the volume alone on the back end \"gpu\"",
    "which triangles on the back end \"gpu\" cannot",
    "triangles cannot sort pixel by pixel",
    "which the path \"compute\" of the back end \"gpu\" does not have",
    // A driver's limit, which it does not tell: sorting hundreds of layers in a pixel takes more turns than it grants.
    "ended a loop before its end",
];

fn check_soundness(way: Way, image: &LinearImage, judged: &mut Judged) {
    let unsound: Vec<usize> = (0..image.pixels().len()).filter(|&p| !is_sound(&image.pixels()[p])).collect();
    if let Some(&first) = unsound.first() {
        let words = format!(
            "{} pixels are not finite, negative or of an opacity beyond 1, the first {:?}",
            unsound.len(),
            image.pixels()[first]
        );
        let pixel = Some(place(image, first));
        judged.failures.push(Failure { pixel, ..Failure::new(way, Fault::Unsound, words) });
    }
}

fn place(image: &LinearImage, pixel: usize) -> [u32; 2] {
    [pixel as u32 % image.width(), pixel as u32 / image.width()]
}

/// What a way's picture must have in common with the reference's, and why not all.
fn agreement(field: &VolumeField<'_>, plan: &Plan, rendered: &Rendered) -> (Agreement, &'static str) {
    // Both are models of the segment that the reference, which clips rays, does not have.
    if plan.interpolation != Interpolation::Exact {
        return (Agreement::Soundness, "soundness: segments are interpolated over triangles");
    }
    if plan.isosurfaces.as_ref().is_some_and(|isosurfaces| isosurfaces.method != IsosurfaceMethod::Exact) {
        return (Agreement::Soundness, "soundness: isosurfaces are looked up in maps");
    }
    // What is shown of cells that reach the eye's plane, which have no fan, is not the same in both.
    if plan.integration.needs_fan() && reaches_the_eye(field, plan) {
        return (Agreement::Soundness, "soundness: fans of cells that reach the plane of the eye are cut");
    }
    let (agreement, why) = agreement_of_order(field, plan, rendered);
    let is_lit_in_thin_cells =
        plan.lighting.is_some() && plan.gradients() == Gradients::Points && has_thin_cells(field);
    if agreement == Agreement::Light && is_lit_in_thin_cells {
        return (Agreement::Opacity, "opacity: normals change within less than 32 bits know of a place");
    }
    (agreement, why)
}

/// What is left of it by the order of cells, and where isosurfaces are met.
fn agreement_of_order(field: &VolumeField<'_>, plan: &Plan, rendered: &Rendered) -> (Agreement, &'static str) {
    if plan.commutes() {
        return (Agreement::Light, "light");
    }
    // The side of a surface is handed on from cell to cell: in a wrong order crossings are missed or doubled.
    let without_order = if plan.isosurfaces.is_some() { Agreement::Soundness } else { Agreement::Opacity };
    if plan.isosurfaces.is_some() && jumps(field) {
        return (Agreement::Soundness, "soundness: isosurfaces lie in jumps of the field, in no cell");
    }
    if plan.isosurfaces.is_some() && plan.backend == Backend::Gpu && has_sheets(field) {
        return (Agreement::Soundness, "soundness: isosurfaces lie in cells that a GPU cannot tell from faces");
    }
    let Ok(renderer) = field.renderer() else { return (without_order, "opacity: no order is known") };
    let (cells, visibility) = (renderer.cells(), renderer.visibility());
    let overlaps = visibility.overlaps(cells);
    if overlaps.any() || !overlaps.is_complete {
        return (without_order, "opacity: cells overlap, and no order is right");
    }
    if matches!(plan.order, OrderMethod::PerPixel) {
        return (Agreement::Light, "light");
    }
    let is_mended = plan.cycles != tetrascope::CycleRemedy::Report || rendered.order.rings == 0;
    let is_right = match plan.order {
        OrderMethod::Power => {
            let certificate = visibility.power(cells).certificate();
            certificate.is_exact() && (visibility.is_convex(cells) || certificate.is_exact_across_gaps())
        }
        _ => match rendered.order.guarantee {
            Guarantee::Exact => is_mended,
            Guarantee::Faces => is_mended && visibility.is_convex(cells),
            _ => false,
        },
    };
    if is_right {
        (Agreement::Light, "light")
    } else {
        (without_order, "opacity: the order that was asked for is not right here")
    }
}

/// Whether a cell is thinner than a thousandth of its longest edge. A place along a ray is known to some 3e-7 of the cell's size, and gradients that are
/// interpolated across so thin a cell to 3e-4 of their difference, which a highlight multiplies by its exponent.
fn has_thin_cells(field: &VolumeField<'_>) -> bool {
    shapes(field).any(|[height, longest]| height < 1e-3 * longest)
}

/// Whether a cell is thinner than what a GPU holds points by, of which it warns: what the field does across it is a jump there.
fn has_sheets(field: &VolumeField<'_>) -> bool {
    shapes(field).any(|[height, _]| height < 1e-7)
}

/// The least height and the longest edge of every cell, local units.
fn shapes(field: &VolumeField<'_>) -> impl Iterator<Item = [f64; 2]> {
    let mesh = field.on_mesh.mesh.as_ref();
    mesh.tetrahedra().iter().map(|cell| {
        let [a, b, c, d] = cell.map(|v| mesh.positions()[v.index()]);
        let six_volume = (b - a).dot((c - a).cross(d - a)).abs();
        let faces = [[a, b, c], [a, b, d], [a, c, d], [b, c, d]];
        let largest = faces.map(|[p, q, r]| (q - p).cross(r - p).length()).into_iter().fold(0.0, f64::max);
        let longest = [b - a, c - a, d - a, c - b, d - b, d - c].map(DVec3::length).into_iter().fold(0.0, f64::max);
        [if largest > 0.0 { six_volume / largest } else { 0.0 }, longest]
    })
}

/// Whether cells that touch have different scalars there: two points at one place. Isosurfaces between the two lie in no cell, and which of them the
/// next cell draws depends on what is near its own scalars.
fn jumps(field: &VolumeField<'_>) -> bool {
    let mesh = field.on_mesh.mesh.as_ref();
    let points = mesh.tetrahedra().iter().flatten().map(|v| v.index());
    let mut seen = HashMap::new();
    points.into_iter().any(|point| {
        // Equal zeros have equal bits.
        let place = (mesh.positions()[point] + 0.0).to_array().map(f64::to_bits);
        *seen.entry(place).or_insert(field.on_mesh.scalars[point]) != field.on_mesh.scalars[point]
    })
}

/// Whether a cell has points on both sides of the plane through the eye: in an orthographic view too cells are cut there.
fn reaches_the_eye(field: &VolumeField<'_>, plan: &Plan) -> bool {
    let mesh = field.on_mesh.mesh.as_ref();
    let frame = mesh.frame();
    let view = plan.view.in_frame(frame.origin, frame.scale);
    let is_behind = |v: usize| (mesh.positions()[v] - view.eye).dot(view.forward) <= 0.0;
    mesh.tetrahedra().iter().any(|cell| {
        let behind = cell.iter().filter(|v| is_behind(v.index())).count();
        (1..4).contains(&behind)
    })
}

/// Color that is multiplied by opacity is a mean of the colors that there are.
fn check_brightness(way: Way, plan: &Plan, scene: &SceneFile, image: &LinearImage, judged: &mut Judged) {
    if plan.model != OpticalModel::DensityEmitter || plan.lighting.is_some() {
        return;
    }
    let of_volume = scene.transfer.color.iter().flatten().flat_map(|point| &point[1..]);
    let of_surfaces = scene.isosurface.iter().flat_map(|s| s.color.iter().chain(s.back_color.iter().flatten()));
    let brightest = of_volume.chain(of_surfaces).copied().fold(0.0, f64::max) * (1.0 + 1e-4);
    let beyond = |p: &[f32; 4]| p[..3].iter().any(|&c| f64::from(c) > brightest);
    if let Some(pixel) = image.pixels().iter().position(beyond) {
        let words = format!("{:?} is brighter than {brightest}, the brightest there is", image.pixels()[pixel]);
        let pixel = Some(place(image, pixel));
        judged.failures.push(Failure { pixel, ..Failure::new(way, Fault::Unsound, words) });
    }
}

/// What is compared: pixels by the scene that they belong to.
struct Compared<'a> {
    field: &'a VolumeField<'a>,
    scene: &'a SceneFile,
    plan: &'a Plan,
    range: [f64; 2],
}

impl Compared<'_> {
    /// - `own`: the plan that the way drew by
    fn check(
        &self,
        way: Way,
        own: &Plan,
        [reference, image]: [&LinearImage; 2],
        agreement: Agreement,
        judged: &mut Judged,
    ) {
        let channels: &[usize] = match agreement {
            Agreement::Light => &[0, 1, 2, 3],
            Agreement::Opacity => &[3],
            Agreement::Soundness => return,
        };
        let limit = self.limit(way, reference);
        let difference = |p: &[f32; 4], q: &[f32; 4]| {
            channels
                .iter()
                .map(|&c| (f64::from(p[c]) - f64::from(q[c])).abs())
                .fold(0.0_f64, |a, b| if b > a || b.is_nan() { b } else { a })
        };
        let differences: Vec<f64> =
            image.pixels().iter().zip(reference.pixels()).map(|(p, q)| difference(p, q)).collect();
        let beyond: Vec<usize> = (0..differences.len()).filter(|&p| differences[p] > limit).collect();
        let inside = differences.iter().copied().filter(|&d| d <= limit).fold(0.0, f64::max);
        let mut margin = Margin { way, difference: inside, limit };
        if !beyond.is_empty() {
            let pixels: Vec<[u32; 2]> = beyond.iter().map(|&p| place(image, p)).collect();
            let plan = Plan { order: own.order, cycles: own.cycles, ..self.plan.clone() };
            let may_be = envelope(self.field, &plan, self.scene, &pixels, self.range, reach(way), limit);
            let (mut worst, mut wrong) = ((0.0, 0), 0);
            for (index, &pixel) in beyond.iter().enumerate() {
                let off = may_be.as_ref().map_or(differences[pixel], |may_be| {
                    channels
                        .iter()
                        .map(|&c| {
                            let (value, [low, high]) = (f64::from(image.pixels()[pixel][c]), may_be[index][c]);
                            (low - value).max(value - high)
                        })
                        .fold(0.0, f64::max)
                });
                if off > limit {
                    wrong += 1;
                    if off > worst.0 {
                        worst = (off, pixel);
                    }
                } else {
                    judged.at_edges += 1;
                }
            }
            if wrong <= self.lone_pixels(image) {
                judged.at_edges += wrong;
            } else {
                let pixel = worst.1;
                let words = format!(
                    "{:.2e} from all that the pixel may be, where {limit:.1e} is allowed, by {}: {:?}, the reference has {:?}; {wrong} pixels are so, {} differ",
                    worst.0,
                    self.plan.integration,
                    image.pixels()[pixel],
                    reference.pixels()[pixel],
                    beyond.len()
                );
                margin.difference = worst.0;
                let pixel = Some(place(image, pixel));
                judged.failures.push(Failure { pixel, size: worst.0, ..Failure::new(way, Fault::Differs, words) });
            }
        }
        judged.margins.push(margin);
    }

    /// Pixels that may be wrong besides, in scenes with isosurfaces: on which side of a surface a ray is when it comes into a cell is handed on from
    /// cell to cell, so that a crossing in a face may fall to either by a rounding of that cell alone, which no scene as a whole has. It takes
    /// a ray that meets the line of surface and face within rounding: single pixels, and never a region.
    fn lone_pixels(&self, image: &LinearImage) -> usize {
        if self.plan.isosurfaces.is_none() {
            return 0;
        }
        (image.pixels().len() / 200).max(2)
    }

    /// What a channel may differ by, before a pixel's neighborhood is asked.
    ///
    /// A chord is known to some parts in a million of its cell's size, and a transmittance exp(-x) changes by at most x exp(-x) < 0.4 of that;
    /// errors of the layers of a ray add up like their root. Triangles come with the rounding of the hardware's attributes besides, which is
    /// what golden images are held to as well. Light that is not bounded by 1 is measured by the largest in the picture.
    fn limit(&self, way: Way, reference: &LinearImage) -> f64 {
        let base: f64 = match way {
            Way::Cpu | Way::Reference | Way::Compute => 2e-5,
            Way::Triangles => 3e-4,
        };
        let base = if way.needs_gpu() { base.max(self.limit_of_sheets()) } else { base };
        let brightest = reference.pixels().iter().flatten().map(|&c| f64::from(c)).fold(1.0, f64::max);
        let layers = (self.field.on_mesh.mesh.as_ref().tetrahedra().len() as f64).cbrt();
        // Between samples of tables and of running integrals lies another rounding.
        let steep = if self.plan.integration == Integration::Exact { 1.0 } else { 2.0 };
        // A highlight is a power of a cosine: its relative error is the exponent times the cosine's, half of which is the light's usual exponent.
        let lit = self.plan.lighting.map_or(1.0, |lighting| 1.0 + 0.5 * lighting.phong.shininess);
        base * brightest * steep * lit * (layers / 4.0).sqrt().max(1.0)
    }

    /// What the opacity of a cell that is thin for its length may be off by on a GPU, where chords are known to some parts in a million of the
    /// cell's size however short they are; 0 without such cells.
    fn limit_of_sheets(&self) -> f64 {
        let thin = shapes(self.field).filter(|[height, longest]| *height < 1e-3 * longest);
        let longest = thin.map(|[_, longest]| longest).fold(0.0, f64::max);
        let densest = self.plan.transfer.max_extinction(self.range[0], self.range[1]);
        3e-6 * densest * longest * self.field.on_mesh.mesh.frame().scale
    }
}

/// How far a way's numbers may be from the scene's.
///
/// The CPU knows points, pixels and scalars relative to a cell, in 24 bits (6e-8), of which set-up takes a few; cells may be many times as
/// large as the picture. Scalars are a plane that may run through 256 times the cell's range before it is found in f64, which makes 1.5e-5 of it, and
/// a tenth of that in all but the worst cases. A GPU has no f64 for cells that are steep, and its points and scalars are on a lattice of 2e-9 of the mesh's size besides.
fn reach(way: Way) -> Reach {
    match way {
        Way::Cpu | Way::Reference => Reach { pixels: 2e-4, scalars: 1.6e-6, edges: 4e-7, size: 0.0 },
        Way::Compute | Way::Triangles => Reach { pixels: 1e-3, scalars: 2e-6, edges: 2e-6, size: 4e-9 },
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.fault {
            Fault::Panic => "panics",
            Fault::Unsound => "is no picture",
            Fault::Threads => "depends on threads",
            Fault::Differs => "differs",
            Fault::Refused => "is refused",
        };
        write!(f, "{} {what}", self.way)?;
        if let Some([x, y]) = self.pixel {
            write!(f, " at ({x}, {y})")?;
        }
        write!(f, ": {}", self.words)
    }
}
