//! Optics of chance: transfer functions of every kind, all models, isosurfaces and light.

use tetrascope::{IsosurfaceSection, LightDirection, LightName, LightSection, OpticalModel, SceneFile, Shading};

use super::case::{Bounds, scalar_range};
use super::mesh::pick;
use crate::meshes::{Random, Tets};

/// Gives a scene its optics, and says what kind of transfer function it has.
pub(super) fn optics(random: &mut Random, tets: &Tets, bounds: Bounds, scene: &mut SceneFile) -> &'static str {
    let [low, high] = scalar_range(tets);
    scene.optics.model = OpticalModel::ALL[[0, 0, 0, 0, 1, 1, 2, 3][pick(random, 8)]];
    let (kind, shares) = extinction(random);
    let mean: f64 = shares.windows(2).map(|w| (w[1][0] - w[0][0]) * (w[0][1] + w[1][1]) / 2.0).sum();
    let depth = match pick(random, 14) {
        0 => 10.0_f64.powf(random.between(-12.0, 12.0)),
        1 | 2 => 10.0_f64.powf(random.between(1.0, 4.0)),
        _ => 10.0_f64.powf(random.between(-0.5, 1.5)),
    };
    // About so deep along the mesh's diagonal.
    let scale = depth / (2.0 * bounds.radius) / mean.max(0.05);
    let at = |share: f64| (low * (1.0 - share) + high * share).clamp(low, high);
    let mut extinction: Vec<[f64; 2]> = shares.iter().map(|&[s, e]| [at(s), e * scale]).collect();
    if kind == "step of one ulp" {
        // Between two floats next to each other.
        let middle = extinction[1][0];
        extinction[2][0] = middle.next_up();
        extinction[3][0] = extinction[3][0].max(middle.next_up());
    }
    let glow = if scene.optics.model.color_is_per_length() {
        10.0_f64.powf(random.between(-1.0, 1.0)) / (2.0 * bounds.radius)
    } else {
        1.0
    };
    scene.transfer.color =
        Some(colors(random).iter().map(|&[s, r, g, b]| [at(s), r * glow, g * glow, b * glow]).collect());
    extinction.sort_by(|a, b| a[0].total_cmp(&b[0]));
    scene.transfer.extinction = Some(extinction);
    if random.unit() < 0.3 {
        isosurfaces(random, tets, [low, high], scene);
    }
    if random.unit() < 0.15 || scene.isosurface.iter().any(|surface| surface.shading != Shading::None) {
        light(random, scene);
    }
    kind
}

/// Extinction over the range from 0 to 1, not scaled yet, and what kind it is.
fn extinction(random: &mut Random) -> (&'static str, Vec<[f64; 2]>) {
    match pick(random, 10) {
        0 | 1 => ("ramp", vec![[0.0, random.unit()], [1.0, random.unit()]]),
        2 => ("constant", vec![[0.0, 1.0], [1.0, 1.0]]),
        3 => {
            // Width from a tenth of the range down to nearly nothing, area about 1.
            let half = 10.0_f64.powf(-random.between(1.0, 9.0));
            let middle = random.between(0.2, 0.8);
            let height = 0.1 / half.max(1e-5);
            ("delta peak", vec![[0.0, 0.0], [middle - half, 0.0], [middle, height], [middle + half, 0.0], [1.0, 0.0]])
        }
        4 => {
            let [from, to] = [random.between(0.1, 0.4), random.between(0.5, 0.9)];
            ("steps", vec![[0.0, 0.0], [from, 0.0], [from, 1.0], [to, 1.0], [to, 0.2], [1.0, 0.2]])
        }
        5 => {
            let at = random.between(0.2, 0.8);
            ("step of one ulp", vec![[0.0, 0.1], [at, 0.1], [at, 1.0], [1.0, 1.0]])
        }
        6 => ("polygon", (0..=8).map(|i| [f64::from(i) / 8.0, random.unit()]).collect()),
        7 => ("256 entries", (0..256).map(|i| [f64::from(i) / 255.0, random.unit()]).collect()),
        8 => {
            // Visible in a band, nothing elsewhere: most cells show nothing.
            let from = random.between(0.1, 0.7);
            let to = from + random.between(0.01, 0.3);
            ("band", vec![[from, 0.0], [from, 1.0], [to, 1.0], [to, 0.0]])
        }
        _ => {
            let at = random.unit();
            ("zero range", vec![[at, 0.3], [at, 1.0]])
        }
    }
}

fn colors(random: &mut Random) -> Vec<[f64; 4]> {
    let count = [1, 2, 4, 33, 256][pick(random, 5)];
    let phases = random.point();
    (0..count)
        .map(|i| {
            let s = f64::from(i) / f64::from((count - 1).max(1));
            if count == 256 {
                return [s, random.unit(), random.unit(), random.unit()];
            }
            let channel = |phase: f64| 0.5 + 0.5 * (4.0 * s + 3.0 * phase).sin();
            [s, channel(phases.x), channel(phases.y), channel(phases.z)]
        })
        .collect()
}

fn isosurfaces(random: &mut Random, tets: &Tets, [low, high]: [f64; 2], scene: &mut SceneFile) {
    let count = 1 + pick(random, 3);
    for index in 0..count {
        let value = match pick(random, 5) {
            // Exactly at a point, where a crossing lies in a vertex; at the end of the range.
            0 => tets.scalars[pick(random, tets.scalars.len())],
            1 => [low, high][pick(random, 2)],
            _ => low + (high - low) * random.unit(),
        };
        if !value.is_finite() {
            continue;
        }
        let color = [random.unit(), random.unit(), random.unit()];
        let mut section = IsosurfaceSection::new(value, color);
        section.opacity = if random.unit() < 0.5 { 1.0 } else { random.unit() };
        section.shading = [Shading::None, Shading::None, Shading::Flat, Shading::Smooth][pick(random, 4)];
        if random.unit() < 0.5 {
            section.back_color = Some([0.9, 0.1, f64::from(index as u32) * 0.3]);
        }
        scene.isosurface.push(section);
    }
}

fn light(random: &mut Random, scene: &mut SceneFile) {
    let direction = if random.unit() < 0.5 {
        LightDirection::Named(LightName::Headlight)
    } else {
        LightDirection::Vector(random.point().to_array())
    };
    let volume = random.unit() < 0.5;
    scene.light = Some(LightSection { direction, volume, ..LightSection::default() });
}
