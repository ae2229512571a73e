//! Hard cases of numbers: coordinates and scalars far from 1 and far from 0.

use glam::DVec3;
use tetrascope::{Camera, Projection};

use super::case::{Group, HardCase, HardScene, scene_of, volume_of};
use crate::meshes::Tets;

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, text, scenes| HardCase { name, group: Group::Numbers, text, scenes };
    vec![
        case(
            "tiny-and-huge-coordinates",
            "A mesh 1e-9 across, and 1e9, 1e-20, 1e20. Absolute tolerances swallow the one, squares and volumes overflow in the \
             other. Here every mesh lives in a frame of its own in which it is about 1 across, lengths get their unit back in the \
             optical depth, and no tolerance is absolute.",
            tiny_and_huge_coordinates,
        ),
        case(
            "detail-far-from-the-origin",
            "Meters and millimeters at northing 5,000,000, and a cube of 1 at 1e9. In 32 bits such coordinates have steps of half a \
             meter. Here differences to the frame's origin are taken in 64 bits before anything else, and a picture is as exact as \
             the coordinates in the file are.",
            detail_far_from_the_origin,
        ),
        case(
            "tiny-and-huge-scalars",
            "A field of 1e-30, of 1e30, and of numbers that 32 bits do not have at all, subnormal ones included. Here scalars are \
             in a unit in which their range is between 1 and 2, by a power of two, which changes no digit.",
            tiny_and_huge_scalars,
        ),
        case(
            "small-variation-of-large-scalars",
            "A pressure of 101,325 that varies by 1e-6, a field of 1e9 that varies by 1e-3: an interpolated value has lost what its \
             corners differ by, in 64 bits too. Here scalars of such a field count from the lowest of them, of which the difference \
             is exact, and so do transfer function and isosurfaces.",
            small_variation,
        ),
    ]
}

/// A bent block of about 2 across, scaled and moved, its scalars mapped; looked at so that each picture is the same but for rounding.
fn block(place: String, scale: f64, offset: DVec3, map: impl Fn(f64) -> f64, is_perspective: bool) -> HardScene {
    let tets = Tets::block(3, 7_001);
    let points: Vec<DVec3> = tets.points.iter().map(|&p| p * scale + offset).collect();
    let (low, high) = tets.range();
    let scalars: Vec<f64> = tets.scalars.iter().map(|&s| map((s - low) / (high - low))).collect();
    let projection = if is_perspective {
        Projection::Perspective { fov_y: 0.7 }
    } else {
        Projection::Orthographic { height: 2.9 * scale }
    };
    let camera = Camera {
        eye: DVec3::new(2.1, 1.7, 3.3) * scale + offset,
        target: offset,
        up: DVec3::new(0.1, 1.0, 0.0),
        projection,
    };
    let colors = [[0.0, 0.1, 0.2, 0.9], [0.35, 0.1, 0.9, 0.8], [0.6, 0.9, 0.9, 0.1], [1.0, 1.0, 0.1, 0.1]];
    let color: Vec<[f64; 4]> = colors.iter().map(|&[s, r, g, b]| [map(s), r, g, b]).collect();
    let extinctions = [[0.0, 0.0], [0.3, 3.0], [0.5, 0.2], [0.8, 5.0], [1.0, 1.0]];
    let extinction: Vec<[f64; 2]> = extinctions.iter().map(|&[s, e]| [map(s), e / scale]).collect();
    HardScene::partition(
        place,
        volume_of(&points, &tets.cells, &scalars),
        scene_of(&camera, [48, 45], &color, &extinction),
    )
}

fn tiny_and_huge_coordinates() -> Vec<HardScene> {
    let mut scenes = Vec::new();
    for scale in [1e-9, 1e9, 1e-20, 1e20] {
        for is_perspective in [true, false] {
            let place = format!("{scale:e} across, {}", if is_perspective { "perspective" } else { "parallel" });
            scenes.push(block(place, scale, DVec3::ZERO, |s| s, is_perspective));
        }
    }
    scenes
}

fn detail_far_from_the_origin() -> Vec<HardScene> {
    let utm = DVec3::new(5e5, 5e6, 120.0);
    vec![
        block("40 m at northing 5,000,000".to_owned(), 20.0, utm, |s| s, true),
        block("1 cm at northing 5,000,000".to_owned(), 0.005, utm, |s| s, true),
        block("1 mm at northing 5,000,000".to_owned(), 0.0005, utm, |s| s, false),
        block("1 at 1e9".to_owned(), 0.5, DVec3::splat(1e9), |s| s, true),
    ]
}

fn tiny_and_huge_scalars() -> Vec<HardScene> {
    let scene = |size: f64| block(format!("scalars up to {size:e}"), 1.0, DVec3::ZERO, move |s| s * size, true);
    // The last are subnormal: an f32 has no number of that size at all.
    [1e-30, 1e30, 1e-300, 1e300, 1e-310].map(scene).into()
}

fn small_variation() -> Vec<HardScene> {
    let scene = |offset: f64, size: f64| {
        block(format!("{size:e} about {offset:e}"), 1.0, DVec3::ZERO, move |s| offset + s * size, true)
    };
    vec![scene(1e9, 1.0), scene(1e9, 1e-3), scene(-1e9, 1e-3), scene(101_325.0, 1e-6)]
}
