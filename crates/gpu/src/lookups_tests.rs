//! Segments integrated on the device against the 64-bit forms.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};
use tetrascope_integrate::{Integrator, Isosurface, LengthAxis, RgbaAssoc, Segment, SurfaceShading, exact};
use tetrascope_scene::{IsosurfacePlan, Plan};
use tetrascope_shaders::Program;
use tetrascope_view::{Camera, Projection, View};

use super::*;
use crate::kernel::Kernel;
use crate::testing::{checked, contents, gpu};

/// Of the fields here, in the renderer's unit.
const RANGE: [f64; 2] = [2.0, 3.75];
const MIDDLE: f64 = 2.875;
/// Of the plans' scalars.
const FACTOR: f64 = 4.0;
const WORLD_PER_LOCAL: f64 = 3.0;
const LENGTHS: ChordLengths = ChordLengths { mean: 0.25, longest: 1.5 };
const HIGHEST: i32 = 469_762_048;

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct GpuSegment {
    reference: i32,
    low: i32,
    high: i32,
    unused: i32,
    front: f32,
    back: f32,
    length: f32,
    unused_too: f32,
}

impl GpuSegment {
    /// As the integrators take it: scalars in the renderer's unit, world length; moved by some rounding of both scalars.
    fn known(&self, moves: [f64; 2]) -> Segment {
        let scale = f64::from((self.low - self.reference).abs().max((self.high - self.reference).abs())) * LATTICE_STEP;
        let scalar = |local: f32, by: f64| {
            let [low, high] = [self.low, self.high].map(|end| f64::from(end) * LATTICE_STEP);
            let local = f64::from(local) + by * scale;
            MIDDLE + (f64::from(self.reference) * LATTICE_STEP + local).clamp(low, high)
        };
        Segment {
            scalar_front: scalar(self.front, moves[0]),
            scalar_back: scalar(self.back, moves[1]),
            chord_length: f64::from(self.length) * WORLD_PER_LOCAL,
        }
    }

    fn range(&self) -> [f64; 2] {
        [self.low, self.high].map(|end| MIDDLE + f64::from(end) * LATTICE_STEP)
    }
}

/// Numbers by chance, the same in every run.
struct Chance(TestRng);

impl Chance {
    fn new(seed: u8) -> Self {
        Self(TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]))
    }

    /// 0 to 1.
    fn share(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    fn below(&mut self, count: u32) -> u32 {
        self.0.next_u32() % count
    }

    /// As many in every octave.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }

    fn lattice(&mut self) -> i32 {
        ((2.0 * self.share() - 1.0) * f64::from(HIGHEST)) as i32
    }

    /// A transfer function over the plans' scalars with control points on the lattice: steps, peaks and stretches without anything.
    fn transfer(&mut self, points: u32, strength: f64) -> TransferFunction {
        let mut scalars: Vec<i32> = (0..points).map(|_| self.lattice()).collect();
        for i in 1..scalars.len() {
            match self.below(6) {
                0 => scalars[i] = scalars[i - 1],
                1 => scalars[i] = scalars[i - 1] + self.between(1.0, 1e6) as i32,
                _ => {}
            }
        }
        scalars.sort_unstable();
        let scalars: Vec<f64> = scalars.iter().map(|&at| (MIDDLE + f64::from(at) * LATTICE_STEP) / FACTOR).collect();
        let mut entry = || if self.below(3) == 0 { 0.0 } else { self.share() };
        let color: Vec<_> = scalars.iter().step_by(2).map(|&s| [s, entry(), entry(), entry()]).collect();
        let extinction: Vec<_> = scalars.iter().map(|&s| [s, strength * entry()]).collect();
        TransferFunction::new(&color, &extinction).unwrap()
    }

    /// A segment in a cell of any size, flat ones and such without length among them.
    fn segment(&mut self, cuts: &[i32]) -> GpuSegment {
        let width = if self.below(8) == 0 { 0.0 } else { self.between(1.0, 2.0 * f64::from(HIGHEST)) };
        let mut low = self.lattice();
        if self.below(4) == 0 && !cuts.is_empty() {
            low = cuts[self.below(cuts.len() as u32) as usize].clamp(-HIGHEST, HIGHEST);
        }
        let high = (f64::from(low) + width).min(f64::from(HIGHEST)) as i32;
        let reference = low + ((f64::from(high) - f64::from(low)) * self.share()) as i32;
        let inside = |share: f64| {
            let [from, to] = [low, high].map(|end| (end - reference) as f32 * LATTICE_STEP as f32);
            (from + (to - from) * share as f32).clamp(from, to)
        };
        let front = inside(self.share());
        let back = if self.below(8) == 0 { front } else { inside(self.share()) };
        let length = if self.below(16) == 0 { 0.0 } else { self.between(1e-7, 1.5) as f32 };
        GpuSegment { reference, low, high, unused: 0, front, back, length, unused_too: 0.0 }
    }
}

fn plan(transfer: TransferFunction, model: OpticalModel, integration: Integration) -> Plan {
    let projection = Projection::Orthographic { height: 2.0 };
    let camera = Camera { eye: DVec3::Z * 5.0, target: DVec3::ZERO, up: DVec3::Y, projection };
    let mut plan = Plan::new(View::new(&camera, 16, 16).unwrap(), transfer, model);
    plan.integration = integration;
    plan
}

fn field() -> FieldUnits<'static> {
    FieldUnits {
        scalar_factor: FACTOR,
        scalar_middle: MIDDLE,
        scalar_range: RANGE,
        world_per_local: WORLD_PER_LOCAL,
        chord_lengths: &|| Some(LENGTHS),
    }
}

/// Light and opacity of each segment; first piece, number of pieces, visibility of its cell.
fn integrate(gpu: &Gpu, plan: &Plan, segments: &[GpuSegment]) -> (Vec<[f32; 4]>, Vec<[u32; 4]>) {
    checked(gpu, || {
        let lookups = Lookups::new(gpu, plan, &field(), &|_, _| ()).unwrap();
        assert!(lookups.is_for(plan) && lookups.bytes() > 0);
        let program = Program::compose("test/integrate.wgsl", &lookups.slots(), &[]).unwrap();
        let kernel = Kernel::new(gpu, &program, "integrate");
        let given = gpu.storage_of("segments", segments);
        let [lights, found] = ["lights", "found"].map(|name| gpu.storage(name, 16 * segments.len() as u64));
        let mut resources = lookups.resources();
        resources.push(("segments", given.as_entire_binding()));
        resources.push(("lights", lights.as_entire_binding()));
        resources.push(("found", found.as_entire_binding()));
        let group = kernel.bind(gpu, &resources);
        let mut encoder = gpu.encoder("integrate");
        kernel.run_alone(&mut encoder, &group, (segments.len() as u32).div_ceil(256));
        let light = contents(gpu, encoder, &lights, segments.len());
        (light, contents(gpu, gpu.encoder("found"), &found, segments.len()))
    })
}

fn scaled(plan: &Plan) -> TransferFunction {
    plan.transfer.with_scalars_scaled(FACTOR)
}

fn cuts(transfer: &TransferFunction) -> Vec<i32> {
    transfer.pieces()[1..].iter().map(|piece| lattice(piece.start * FACTOR, MIDDLE)).collect()
}

/// The largest light and opacity that rounding is measured by: what a segment would send with white for its colors.
fn most(plan: &Plan, transfer: &TransferFunction, segment: &Segment, known: &RgbaAssoc) -> [f64; 2] {
    let brightest = transfer.max_emission(segment.scalar_front, segment.scalar_back);
    let length = segment.chord_length;
    match plan.model {
        OpticalModel::DensityEmitter | OpticalModel::Absorption => [brightest * known.opacity, known.opacity],
        OpticalModel::Emission => [brightest * length, 0.0],
        OpticalModel::Emitter => {
            let ends =
                |pair: &[Piece]| [[pair[1].start, pair[0].extinction[1]], [pair[1].start, pair[1].extinction[0]]];
            let points: Vec<_> = transfer.pieces().windows(2).flat_map(ends).collect();
            let points = if points.is_empty() { vec![[0.0, transfer.extinction(0.0)]] } else { points };
            let white = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &points).unwrap();
            let white = exact(&white, OpticalModel::Emitter, segment).rgb[0];
            // Methods that look at fewer scalars may find more light.
            [known.rgb.into_iter().fold(brightest * white, f64::max), known.opacity]
        }
    }
}

/// By how much a result moves where both scalars move by the rounding of 32 bits.
fn sensitivity(segment: &GpuSegment, integrate: &dyn Fn(&Segment) -> RgbaAssoc) -> [f64; 4] {
    const ROUNDING: f64 = 1.2e-7;
    let all = |light: RgbaAssoc| [light.rgb[0], light.rgb[1], light.rgb[2], light.opacity];
    let known = all(integrate(&segment.known([0.0; 2])));
    let mut largest = [0.0f64; 4];
    for moves in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]
    {
        let moved = all(integrate(&segment.known(moves.map(|by: f64| by * ROUNDING))));
        for channel in 0..4 {
            largest[channel] = largest[channel].max((moved[channel] - known[channel]).abs());
        }
    }
    largest
}

/// The largest error of light and opacity relative to what they may at most be, but at least `floor`, beyond what rounding of the
/// scalars brings. Each is below the tolerance.
fn worst(
    gpu: &Gpu,
    plan: &Plan,
    segments: &[GpuSegment],
    integrate_f64: &dyn Fn(&Segment) -> RgbaAssoc,
    floor: f64,
    tolerance: f64,
) -> f64 {
    let transfer = scaled(plan);
    let (lights, found) = integrate(gpu, plan, segments);
    let mut worst = 0.0f64;
    for ((segment, light), [_, count, ..]) in segments.iter().zip(lights).zip(found) {
        assert!(light.iter().all(|value| value.is_finite() && *value >= 0.0), "{segment:?}: {light:?}");
        let given = segment.known([0.0; 2]);
        let known = integrate_f64(&given);
        if segment.length == 0.0 {
            assert_eq!(light, [0.0; 4], "{segment:?}");
            continue;
        }
        let [light_scale, opacity_scale] = most(plan, &transfer, &given, &known);
        let moved = sensitivity(segment, integrate_f64);
        for channel in 0..4 {
            let (got, known, scale) = match channel {
                3 => (f64::from(light[3]), known.opacity, opacity_scale),
                _ => (f64::from(light[channel]), known.rgb[channel], light_scale),
            };
            // Next to 1 an opacity has as many digits as a transmittance, and one of several pieces is made of such.
            let rounding = if channel == 3 { 1.2e-7 + 6e-8 * f64::from(count) } else { 1e-30 };
            let beyond = ((got - known).abs() - 2.0 * moved[channel] - rounding).max(0.0);
            let error = beyond / scale.max(floor).max(1e-30);
            let about = || format!("{} {} {segment:?}, channel {channel}", plan.integration, plan.model);
            assert!(error < tolerance, "{}: {got} {known} {scale:e} {moved:?}", about());
            worst = worst.max(error);
        }
    }
    worst
}

/// Optical depths from 1e-9 to 1e6 together with the lengths; running integrals take what is deeper than 1e6 for that deep.
fn strengths(integration: Integration) -> [f64; 3] {
    [0.01, 5.0, if integration == Integration::Cumulative { 1e5 } else { 1e6 }]
}

/// Plans and segments for them.
fn cases(integration: Integration, model: OpticalModel, seed: u8) -> Vec<(Plan, Vec<GpuSegment>)> {
    let mut chance = Chance::new(seed);
    let mut all = Vec::new();
    for points in [1, 2, 3, 8, 40, 300] {
        for strength in strengths(integration) {
            let plan = plan(chance.transfer(points, strength), model, integration);
            let cuts = cuts(&plan.transfer);
            let segments = (0..1500).map(|_| chance.segment(&cuts)).collect();
            all.push((plan, segments));
        }
    }
    all
}

fn check(integration: Integration, model: OpticalModel, tolerance: f64) {
    let Some(gpu) = gpu() else { return };
    let mut largest = 0.0f64;
    for (plan, segments) in cases(integration, model, 7) {
        let integrator = Integrator::new(integration, &scaled(&plan), model, None, &|_, _| ()).unwrap();
        let known = |segment: &Segment| integrator.integrate(segment);
        largest = largest.max(worst(&gpu, &plan, &segments, &known, 0.0, tolerance));
    }
    println!("{integration}, {model}: {largest:.1e}");
}

#[test]
fn exact_is_exact() {
    for model in OpticalModel::ALL {
        check(Integration::Exact, model, 1e-6);
    }
}

#[test]
fn methods_of_a_few_scalars_are_as_in_64_bits() {
    for integration in [Integration::Average, Integration::Opacity2d, Integration::Partial] {
        for model in OpticalModel::ALL.into_iter().filter(|&model| integration.covers(model)) {
            check(integration, model, 1e-6);
        }
    }
}

#[test]
fn running_integrals_are_as_in_64_bits() {
    for model in OpticalModel::ALL {
        check(Integration::Cumulative, model, 4e-6);
    }
}

#[test]
fn tables_are_as_in_64_bits() {
    let Some(gpu) = gpu() else { return };
    for (integration, scalars, lengths) in [
        (Integration::Table2d, 64, 2),
        (Integration::Table2d, 256, 2),
        (Integration::Table3d, 64, 64),
        (Integration::Table3d, 33, 21),
    ] {
        for model in OpticalModel::ALL {
            let mut largest = 0.0f64;
            for length_axis in [LengthAxis::Linear, LengthAxis::Logarithmic] {
                for (mut plan, segments) in cases(integration, model, 3).into_iter().step_by(4) {
                    let settings = TableSettings { scalars, lengths, length_axis };
                    plan.tables = Some(settings);
                    let domain = TableDomain { scalars: RANGE, mean_length: LENGTHS.mean, max_length: LENGTHS.longest };
                    let table = Some((&settings, &domain));
                    let integrator = Integrator::new(integration, &scaled(&plan), model, table, &|_, _| ()).unwrap();
                    let known = |segment: &Segment| integrator.integrate(segment);
                    // Of the largest light there is, as entries around may be brighter than the one in between.
                    largest = largest.max(worst(&gpu, &plan, &segments, &known, 1.0, 2e-6));
                }
            }
            println!("{integration} {scalars} {lengths}, {model}: {largest:.1e}");
        }
    }
}

#[test]
fn linear_pieces_of_any_depth_are_good_to_their_opacity() {
    let Some(gpu) = gpu() else { return };
    let mut chance = Chance::new(5);
    let ends = [RANGE[0] / FACTOR, RANGE[1] / FACTOR];
    // Light of one color is the sum of both weights; of one that rises from 0, the back's and some of the front's.
    let color = [[ends[0], 1.0, 0.0, 1.0], [ends[1], 1.0, 1.0, 0.0]];
    for model in [OpticalModel::DensityEmitter, OpticalModel::Emitter] {
        let mut largest = [0.0f64; 4];
        for depth in [1e-9, 1e-3, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 1e4, 1e6] {
            for sides in [[0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.1, 0.3]] {
                let extinction = [[ends[0], depth * sides[0]], [ends[1], depth * sides[1]]];
                let plan = plan(TransferFunction::new(&color, &extinction).unwrap(), model, Integration::Exact);
                let transfer = scaled(&plan);
                let segments: Vec<_> = (0..400)
                    .map(|_| {
                        let (front, back) = (chance.share() * 1.75 - 0.875, chance.share() * 1.75 - 0.875);
                        let length = chance.between(0.01, 0.8) as f32;
                        let (front, back) = (front as f32, back as f32);
                        let [low, high] = [-HIGHEST, HIGHEST];
                        GpuSegment { reference: 0, low, high, unused: 0, front, back, length, unused_too: 0.0 }
                    })
                    .collect();
                let (lights, _) = integrate(&gpu, &plan, &segments);
                for (segment, light) in segments.iter().zip(lights) {
                    let given = segment.known([0.0; 2]);
                    let known = exact(&transfer, model, &given);
                    for channel in 0..3 {
                        let error = (f64::from(light[channel]) - known.rgb[channel]).abs() / known.rgb[0].max(1e-35);
                        largest[channel] = largest[channel].max(error);
                    }
                    largest[3] = largest[3].max((f64::from(light[3]) - known.opacity).abs());
                }
            }
        }
        println!("{model}: light {:.1e} {:.1e} {:.1e}, opacity {:.1e}", largest[0], largest[1], largest[2], largest[3]);
        assert!(largest.iter().all(|&error| error < 6e-7), "{model}: {largest:?}");
    }
}

#[test]
fn pieces_and_visibility_are_those_of_the_transfer_function() {
    let Some(gpu) = gpu() else { return };
    for model in OpticalModel::ALL {
        for (plan, segments) in cases(Integration::Exact, model, 11) {
            let transfer = scaled(&plan);
            let (_, found) = integrate(&gpu, &plan, &segments);
            for (segment, [first, count, is_visible, _]) in segments.iter().zip(found) {
                let [low, high] = segment.range();
                let shows = (model.needs_extinction() && transfer.max_extinction(low, high) > 0.0)
                    || (!model.is_dark_without_extinction() && transfer.max_emission(low, high) > 0.0);
                assert_eq!(is_visible == 1, shows, "{model} {segment:?}");
                let range = transfer.pieces_between(low, high);
                // A float may round onto a cut that lies next to a wide cell's end.
                let differs = (first as usize).abs_diff(range.start).max((first + count) as usize).abs_diff(range.end);
                let is_narrow = segment.high - segment.low < 1 << 24;
                let got = first as usize..(first + count) as usize;
                assert!(
                    count >= 1 && (got == range || !is_narrow && differs <= range.len()),
                    "{got:?} {range:?} {segment:?}"
                );
            }
        }
    }
}

#[test]
fn a_cell_constant_on_a_step_takes_the_upper_side() {
    let Some(gpu) = gpu() else { return };
    let step = MIDDLE / FACTOR;
    let color = [[0.0, 1.0, 0.0, 0.0], [step, 1.0, 0.0, 0.0], [step, 0.0, 1.0, 0.0], [1.0, 0.0, 1.0, 0.0]];
    let transfer = TransferFunction::new(&color, &[[0.0, 1e6]]).unwrap();
    let segment = GpuSegment { length: 1.0, ..GpuSegment::zeroed() };
    for integration in [Integration::Exact, Integration::Average, Integration::Opacity2d, Integration::Partial] {
        let plan = plan(transfer.clone(), OpticalModel::DensityEmitter, integration);
        let wide = GpuSegment { low: -1000, high: 1000, ..segment };
        let (lights, found) = integrate(&gpu, &plan, &[segment, wide]);
        assert_eq!(lights, [[0.0, 1.0, 0.0, 1.0]; 2], "{integration}");
        assert_eq!(found.iter().map(|one| one[1]).collect::<Vec<_>>(), [1, 2]);
    }
}

#[test]
fn extremes_stay_finite() {
    let Some(gpu) = gpu() else { return };
    for model in OpticalModel::ALL {
        for extinction in [0.0, f64::MIN_POSITIVE, 1e-30, 1.0, 1e20, 1e300] {
            for scalars in [[-1e300, 1e300], [0.7, 0.7f64.next_up()], [0.0, 0.1], [5.0, 6.0], [0.6, 0.8]] {
                let color = [[scalars[0], 1e300, 0.0, 1.0], [scalars[1], 0.0, 1e-300, 1.0]];
                let transfer = TransferFunction::new(&color, &[[scalars[0], 0.0], [scalars[1], extinction]]).unwrap();
                for integration in Integration::ALL.into_iter().filter(|i| i.covers(model) && !i.needs_table()) {
                    let mut chance = Chance::new(9);
                    let segments: Vec<_> = (0..200).map(|_| chance.segment(&cuts(&transfer))).collect();
                    let (lights, _) = integrate(&gpu, &plan(transfer.clone(), model, integration), &segments);
                    for light in lights {
                        assert!(light.iter().all(|value| value.is_finite() && *value >= 0.0), "{light:?}");
                        assert!(light[3] <= 1.0);
                    }
                }
            }
        }
    }
}

#[test]
fn lookups_are_kept_while_what_they_come_from_stays() {
    let Some(gpu) = gpu() else { return };
    let transfer = Chance::new(1).transfer(5, 1.0);
    let mut plan = plan(transfer, OpticalModel::DensityEmitter, Integration::Table2d);
    let lookups = Lookups::new(&gpu, &plan, &field(), &|_, _| ()).unwrap();
    plan.termination = 0.5;
    assert!(lookups.is_for(&plan));
    plan.tables = Some(TableSettings { scalars: 8192, lengths: 2, length_axis: LengthAxis::Linear });
    assert!(!lookups.is_for(&plan));
    assert!(matches!(Lookups::new(&gpu, &plan, &field(), &|_, _| ()), Err(GpuError::Method(_))));
    plan.integration = Integration::Table3d;
    plan.tables = Some(TableSettings { scalars: 1024, lengths: 64, length_axis: LengthAxis::Linear });
    let too_large = Lookups::new(&gpu, &plan, &field(), &|_, _| ()).unwrap_err();
    assert!(matches!(too_large, GpuError::TooLarge { needed: 0x4000_0000, .. }), "{too_large}");
}

#[test]
fn tables_stop_at_isosurfaces() {
    let Some(gpu) = gpu() else { return };
    let mut chance = Chance::new(2);
    let mut plan = plan(chance.transfer(8, 5.0), OpticalModel::DensityEmitter, Integration::Table2d);
    let without = plan.clone();
    let color = [0.5; 3];
    let surface =
        |value, opacity| Isosurface { value, color, back_color: color, opacity, shading: SurfaceShading::None };
    let surfaces = Isosurfaces::new(vec![surface(0.7, 1.0), surface(0.8, 0.0)]).unwrap();
    let method = IsosurfaceMethod::Map { size: 64, mixing: Mixing::Stopped };
    plan.isosurfaces = Some(IsosurfacePlan { surfaces: surfaces.clone(), method });

    let segments: Vec<_> = (0..1000).map(|_| chance.segment(&[])).collect();
    let seen = surfaces.visible().with_scalars_scaled(FACTOR);
    let domain = TableDomain { scalars: RANGE, mean_length: LENGTHS.mean, max_length: LENGTHS.longest };
    let settings = plan.table_settings().unwrap();
    let stops = Some((&seen, SurfaceRole::Stop));
    let table = Table2d::build(&scaled(&plan), plan.model, &domain, &settings, stops, &|_, _| ()).unwrap();
    worst(&gpu, &plan, &segments, &|segment| table.look_up(segment), 1.0, 2e-6);
    let (with, without_any) = (integrate(&gpu, &plan, &segments).0, integrate(&gpu, &without, &segments).0);
    assert_ne!(with, without_any, "the volume behind the surface is not in it");

    // What a surface looks like does not count, where it is does.
    let lookups = Lookups::new(&gpu, &plan, &field(), &|_, _| ()).unwrap();
    assert!(lookups.is_for(&plan) && !lookups.is_for(&without));
    let moved = |value, opacity| {
        let surfaces = Isosurfaces::new(vec![surface(value, opacity)]).unwrap();
        Plan { isosurfaces: Some(IsosurfacePlan { surfaces, method }), ..plan.clone() }
    };
    assert!(lookups.is_for(&moved(0.7, 0.5)) && !lookups.is_for(&moved(0.71, 1.0)));
}
