//! A few hundred rays of a scene, and the exact light of each.

use std::collections::HashSet;

use rayon::prelude::*;
use tetrascope_cpu::RenderError;
use tetrascope_cpu::rays::{RayShader, RayTracer, Rays};
use tetrascope_integrate::{Integration, RgbaAssoc};
use tetrascope_scene::{Plan, Silent};

use crate::sample::{Spread, around, spread};

/// How the largest error of the picture is guessed from the largest one on the rays: this much more.
///
/// The largest of a sample is below the largest of all. Measured over random scenes and every method, see `docs/accuracy.md`: with this factor
/// the guess is between once and ten times the truth.
pub(crate) const EXTRAPOLATION: f64 = 4.5;

/// Rays about which more are traced, in each of the rounds that look for worse ones.
const WORST: usize = 12;
/// Rounds of looking for worse rays.
const ROUNDS: usize = 3;

/// Rays of a scene and their exact light, whatever integration its plan has.
pub(crate) struct Probe<'a> {
    tracer: &'a RayTracer<'a>,
    shader: RayShader<'a>,
    pub(crate) rays: Rays,
    /// Of each ray.
    pub(crate) exact: Vec<[f64; 4]>,
    known: HashSet<[u32; 2]>,
    size: [u32; 2],
    /// Whether every pixel that the mesh may cover is there.
    is_whole: bool,
}

impl<'a> Probe<'a> {
    /// Traces about `count` rays.
    pub(crate) fn new(tracer: &'a RayTracer<'a>, plan: &Plan, count: usize) -> Result<Self, RenderError> {
        let exact = Plan { integration: Integration::Exact, tables: None, ..plan.clone() };
        let shader = tracer.shader(&exact, &Silent)?;
        let Spread { pixels, is_whole } = spread(tracer, count);
        let size = [plan.view.width, plan.view.height];
        let mut probe = Self {
            tracer,
            shader,
            rays: Rays::default(),
            exact: Vec::new(),
            known: pixels.iter().copied().collect(),
            size,
            is_whole,
        };
        probe.add(&pixels);
        Ok(probe)
    }

    fn add(&mut self, pixels: &[[u32; 2]]) {
        let more = self.tracer.trace(pixels);
        self.exact.par_extend((0..more.len()).into_par_iter().map(|ray| channels(self.shader.light(&more, ray))));
        self.rays = std::mem::take(&mut self.rays).joined(&more);
    }

    /// Adds rays around the worst by `error`, again and again; gives the error of all.
    ///
    /// - `error`: of a ray, by its place
    pub(crate) fn look_for_worse(&mut self, error: impl Fn(&Self, usize) -> f64 + Sync) -> Vec<f64> {
        let mut errors: Vec<f64> = self.errors(0, &error);
        for _ in 0..if self.is_whole { 0 } else { ROUNDS } {
            let mut by_error: Vec<usize> = (0..errors.len()).collect();
            by_error.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]));
            let worst: Vec<[u32; 2]> = by_error.iter().take(WORST).map(|&ray| self.rays.pixels()[ray]).collect();
            let more = around(&worst, self.size, &mut self.known);
            let first = self.rays.len();
            self.add(&more);
            errors.extend(self.errors(first, &error));
        }
        errors
    }

    fn errors(&self, first: usize, error: &(impl Fn(&Self, usize) -> f64 + Sync)) -> Vec<f64> {
        (first..self.rays.len()).into_par_iter().map(|ray| error(self, ray)).collect()
    }

    /// What the largest error of the picture is expected to be, if that of the rays is `largest`.
    pub(crate) fn extrapolated(&self, largest: f64) -> f64 {
        if self.is_whole { largest } else { EXTRAPOLATION * largest }
    }
}

pub(crate) fn channels(light: RgbaAssoc) -> [f64; 4] {
    let [r, g, b] = light.rgb;
    [r, g, b, light.opacity]
}

/// The largest difference of a channel; infinite where one is no number.
pub(crate) fn difference(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, |m, d| if d.is_nan() { f64::INFINITY } else { m.max(d) })
}
