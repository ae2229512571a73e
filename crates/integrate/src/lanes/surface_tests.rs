//! Light and look-ups of surfaces in eight lanes against the 64-bit forms, at every level at hand.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::{Isosurface, IsosurfaceMap, Isosurfaces, Phong, SurfaceShading};

fn levels() -> [Level; 2] {
    [Level::new(), Level::baseline()]
}

/// A vector of length 1, some other for every number.
fn direction(number: u32) -> [f32; 3] {
    let z = 2.0 * (f64::from(number) * 0.618_033_988_7).fract() - 1.0;
    let angle = f64::from(number) * 2.399_963;
    let radius = (1.0 - z * z).sqrt();
    [radius * angle.cos(), radius * angle.sin(), z].map(|component| component as f32)
}

/// One component of eight vectors.
fn lanes(vectors: [[f32; 3]; 8], component: usize) -> [f32; 8] {
    vectors.map(|vector| vector[component])
}

fn in_lanes(
    level: Level,
    light: &Phong,
    gradient: [[f32; 3]; 8],
    eye: [[f32; 3]; 8],
    to_light: [[f32; 3]; 8],
) -> [[f32; 8]; 2] {
    dispatch!(level, simd => {
        let [gradient, eye, to_light] = [gradient, eye, to_light].map(|vectors| {
            [lanes(vectors, 0).simd_into(simd), lanes(vectors, 1).simd_into(simd), lanes(vectors, 2).simd_into(simd)]
        });
        let [body, highlight] = phong(simd, light, gradient, eye, to_light);
        [body.into(), highlight.into()]
    })
}

#[test]
fn intensities_are_good_to_1e_6() {
    let mut worst = [0.0f64; 2];
    for level in levels() {
        for shininess in [0.0, 0.5, 1.0, 20.0, 300.0, 1e6] {
            let light = Phong { ambient: 0.1, diffuse: 0.9, specular: 0.7, shininess };
            for block in 0..2000u32 {
                // Gradients from the shortest whose components are normal numbers to the longest.
                let lengths = [1.0, 1e-30, 1e30, 1e-36, 3e38, 7.0, 1e-9, 1e9];
                let gradient =
                    core::array::from_fn(|lane| direction(block * 8 + lane as u32).map(|g| g * lengths[lane]));
                let eye = core::array::from_fn(|lane| direction(block * 11 + 3 * lane as u32 + 1));
                let to_light = core::array::from_fn(|lane| direction(block * 5 + 7 * lane as u32 + 2));
                let got = in_lanes(level, &light, gradient, eye, to_light);
                for lane in 0..8 {
                    let [g, v, l] = [gradient[lane], eye[lane], to_light[lane]].map(|vector| vector.map(f64::from));
                    let facing = g.iter().zip(l).map(|(g, l)| g / f64::from(lengths[lane]) * l).sum::<f64>();
                    let grazing = facing.abs() < 1e-6;
                    let known = light.intensities(g, v, l);
                    let errors = [0, 1].map(|i| (f64::from(got[i][lane]) - known[i]).abs());
                    worst[0] = worst[0].max(errors[0]);
                    // Below a sharpness of 1 highlights have edges so steep that rounding moves them.
                    let is_edge = grazing || (shininess > 0.0 && known[1] < 0.1);
                    if shininess >= 1.0 || !is_edge {
                        worst[1] = worst[1].max(errors[1] / (0.7 * (1.0 + shininess)));
                    }
                }
            }
        }
    }
    println!("body {:.2e}, highlight {:.2e}", worst[0], worst[1]);
    assert!(worst[0] < 1e-6 && worst[1] < 1e-6, "{worst:?}");
}

#[test]
fn lanes_without_a_direction_stay_alone() {
    let light = Phong { ambient: 0.25, diffuse: 0.5, specular: 1.0, shininess: 3.0 };
    let z = [[0.0, 0.0, 1.0]; 8];
    let mut gradient = [[0.0, 0.0, 2.0]; 8];
    gradient[1] = [0.0; 3];
    gradient[2] = [f32::NAN; 3];
    gradient[3] = [f32::INFINITY, 0.0, 0.0];
    gradient[4] = [0.0, 0.0, -f32::MIN_POSITIVE];
    gradient[5] = [0.0, 0.0, f32::MAX];
    for level in levels() {
        let [body, highlight] = in_lanes(level, &light, gradient, z, z);
        assert_eq!(body, [0.75, 0.25, 0.25, 0.25, 0.75, 0.75, 0.75, 0.75]);
        assert_eq!(highlight, [1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
        let dull = Phong { specular: 0.0, ..light };
        assert_eq!(in_lanes(level, &dull, gradient, z, z), [body, [0.0; 8]]);
        let [body, highlight] = in_lanes(level, &light, gradient, z, [[0.0, 0.0, -1.0]; 8]);
        assert_eq!((body, highlight), ([0.25; 8], [0.0; 8]));
    }
}

#[test]
fn powers_are_good_to_3e_7() {
    let mut worst = 0.0f64;
    for level in levels() {
        for exponent in [0.0, 1e-30, 0.1, 1.0, 2.5, 33.0, 1000.0, 1e7, f32::MAX] {
            for block in 0..4000u32 {
                let bases: [f32; 8] = core::array::from_fn(|lane| {
                    let step = (block * 8 + lane as u32) as f32 / 32_000.0;
                    if block % 2 == 0 { 1.0 - step * step * step } else { step * step * step * step }
                });
                let got: [f32; 8] =
                    dispatch!(level, simd => phong::power(simd, bases.simd_into(simd), exponent).into());
                for lane in 0..8 {
                    let known = f64::from(bases[lane]).powf(f64::from(exponent));
                    worst = worst.max((f64::from(got[lane]) - known).abs());
                }
            }
            let ends = [0.0, 1.0, f32::MIN_POSITIVE, 1e-45, 1.0, 0.0, 1.0, 1.0];
            let got: [f32; 8] = dispatch!(level, simd => phong::power(simd, ends.simd_into(simd), exponent).into());
            assert_eq!((got[0], got[1]), (if exponent == 0.0 { 1.0 } else { 0.0 }, 1.0), "{exponent}");
        }
    }
    println!("power {worst:.2e}");
    assert!(worst < 3e-7, "{worst:e}");
}

#[test]
fn look_ups_are_those_of_one_lane() {
    let surface = |value| Isosurface {
        value,
        color: [value, 0.5, 1.0],
        back_color: [1.0, value, 0.0],
        opacity: 0.4,
        shading: SurfaceShading::None,
    };
    let surfaces = Isosurfaces::new([0.2, 0.5, 0.7].map(surface).to_vec()).unwrap();
    let map = IsosurfaceMap::new(&surfaces, [0.0, 1.0], 32).unwrap();
    let coordinates = [-5.0, 0.0, 3.99, 4.0, 17.5, 31.99, 32.0, f32::INFINITY];
    let mirrored: [f32; 8] = core::array::from_fn(|lane| coordinates[7 - lane]);
    for level in levels() {
        let (front, back, channels) = dispatch!(level, simd => {
            let front = map.axis().texel_lanes(simd, coordinates.simd_into(simd));
            let back = map.axis().texel_lanes(simd, mirrored.simd_into(simd));
            let (rgb, opacity) = map.look_up_lanes(simd, front, back);
            let channels: [[f32; 8]; 4] = [rgb[0].into(), rgb[1].into(), rgb[2].into(), opacity.into()];
            (front, back, channels)
        });
        assert_eq!(front, [0, 0, 3, 4, 17, 31, 31, 31]);
        assert!(channels[3].iter().any(|&opacity| opacity > 0.7));
        for lane in 0..8 {
            let known = map.at(front[lane], back[lane]);
            let got = [0, 1, 2, 3].map(|channel| f64::from(channels[channel][lane]));
            assert_eq!(got, [known.rgb[0], known.rgb[1], known.rgb[2], known.opacity]);
        }
        // What is not a number has some texel.
        let (opacity, texels): ([f32; 8], [u32; 8]) = dispatch!(level, simd => {
            let texels = map.axis().texel_lanes(simd, f32x8::splat(simd, f32::NAN));
            (map.look_up_lanes(simd, [u32::MAX; 8], texels).1.into(), texels)
        });
        assert_eq!(f64::from(opacity[0]), map.at(u32::MAX, texels[0]).opacity);
    }
}
