//! Hard cases of optics: depths, lengths and transfer functions at the ends of what there is.

use std::sync::Arc;

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::view::Ray;
use tetrascope::{Camera, Projection, Volume};

use super::case::{Beyond, Group, HardCase, HardScene, Truth, scene_of, volume_of};
use crate::chords::{chord_of_box, world};
use crate::meshes::grid;
use crate::ways::Way;

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, text, scenes| HardCase { name, group: Group::Optics, text, scenes };
    vec![
        case(
            "optical-depths",
            "A chord's optical depth is 1e-12 in one scene and 1e12 in the next. 1 - exp(-x) has no digits left where x is below \
             1e-7, exp(-x) is 0 beyond 88, and products of a huge extinction and a tiny length overflow before they are of use. \
             Here opacity is found by a polynomial of its own that keeps all digits of thin chords, depths are limited where all is \
             opaque already, and lengths count in the cell's unit. The thin scenes have colors as bright as they are thin, so that \
             the limit is one of the light.",
            depths,
        ),
        case(
            "short-chords",
            "At a silhouette chords go to 0; here the picture is all silhouette, down to 1e-7 of the cell. As a difference of two \
             depths such a chord has no digits in 32 bits. Here depths are relative to a point inside of the cell, and the planes \
             of the faces to a pixel near it; what is too steep for that is drawn in 64 bits.",
            short_chords,
        ),
        case(
            "equal-scalars",
            "The scalar is the same where a ray enters a cell and where it leaves it, or differs by some units in the last place, \
             on a step of the transfer function too. Pre-integration divides by that difference. Here a segment of one scalar lies \
             in one piece of the transfer function as a whole, in the upper one on a step, and shares of pieces are differences to \
             the segment's own ends.",
            equal_scalars,
        ),
        case(
            "steps-and-peaks",
            "A step, and a peak down to 1e-9 of the range wide, whose depth is its area over the slope of the scalar whatever its \
             width. Samples, tables and transfer functions at vertices miss it. Here segments are cut at control points, which \
             finds every peak, and a cell in which the transfer function changes faster than 32 bits can tell the scalar is drawn \
             in 64 bits on the CPU. A GPU has none: from 1e-6 of the range on it misses peaks, and the user is told how many cells \
             are concerned.",
            steps_and_peaks,
        ),
        case(
            "slope-through-zero",
            "The slope of the extinction along the ray goes through 0 within the picture and within cells. The closed form divides \
             by it, and by its root. Here thin segments are a series about the mean of both ends that knows no slope, and thick \
             ones are split until they are thin.",
            slope_through_zero,
        ),
        case(
            "ten-thousand-layers",
            "A column of 10,000 cubes, 20,000 cells to a ray, each nearly transparent and all alike. A product of transmittances \
             next to 1 rounds the same way in each of them: chords were off by 9e-4, and the opacity of a picture of depth 1e-3 by \
             four fifths. Here cells hand their opacity on, a pixel is known by its opacity below one half and by its transmittance \
             beyond, and tiles of more than 4,096 cells keep what rounding takes off their sums. On a GPU, whose compilers may undo \
             that last, 5e-5 is left; the fixed function that blends triangles knows no other way than to multiply by 1 - opacity.",
            ten_thousand_layers,
        ),
        case(
            "accumulation",
            "The same column into a target of 16 bits, by the triangles of a GPU (the other ways have no such target and draw it as \
             before). Floats of 16 bits have steps of 5e-4 next to 1 where a layer adds 5e-5. Blocks of cells are blended on their \
             own and added up in 32 bits, which keeps pictures of a hundred layers within 3e-3; here it is 6e-2, and the user is \
             told so and what to ask for instead.",
            accumulation,
        ),
    ]
}

/// Colors over scalars from 0 to 1 that no two points share.
const RAINBOW: &[[f64; 4]] = &[[0.0, 0.9, 0.1, 0.1], [0.4, 0.2, 0.9, 0.1], [0.7, 0.1, 0.3, 1.0], [1.0, 1.0, 0.9, 0.2]];

/// The points of a mesh with a scalar each, as a volume.
fn with_field(mesh: &TetMesh, field: impl Fn(DVec3) -> f64) -> Volume {
    let points: Vec<DVec3> = (0..mesh.positions().len() as u32).map(|p| world(mesh, p)).collect();
    let scalars: Vec<f64> = points.iter().map(|&p| field(p)).collect();
    let tetrahedra: Vec<[u32; 4]> = mesh.tetrahedra().iter().map(|t| t.map(|v| v.0)).collect();
    volume_of(&points, &tetrahedra, &scalars)
}

/// The cube from 0 to 1, in `n` cells a side.
fn cube(n: usize, field: impl Fn(DVec3) -> f64) -> Volume {
    with_field(&grid([n; 3], DVec3::ZERO, 1.0 / n as f64).mesh, field)
}

/// From aslant, with the cube in full.
fn aslant() -> Camera {
    Camera {
        eye: DVec3::new(2.3, 1.9, 3.1),
        target: DVec3::splat(0.5),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.6 },
    }
}

/// Parallel rays along z, a little turned so that none meets a vertex, over the middle of the cube's front.
fn down_z(height: f64) -> Camera {
    Camera {
        eye: DVec3::new(0.51, 0.47, 4.0),
        target: DVec3::new(0.51, 0.47, 0.0),
        up: DVec3::new(0.07, 1.0, 0.0),
        projection: Projection::Orthographic { height },
    }
}

/// Depths of 1e-12 to 1e12. Where the picture is thin its color is as bright as that it comes to about 1 all the same, so that the limit is one
/// of the light and not of nothing.
fn depths() -> Vec<HardScene> {
    let scene = |extinction: f64| {
        let brightness = if extinction < 1.0 { 1.0 / extinction } else { 1.0 };
        let camera = aslant();
        let colors = [[0.0, brightness, 0.5 * brightness, 0.25 * brightness]];
        let scene = scene_of(&camera, [48, 45], &colors, &[[0.0, extinction]]);
        let light = Arc::new(move |ray: &Ray| {
            let opacity = -(-extinction * chord_of_box(DVec3::ZERO, DVec3::ONE, ray)).exp_m1();
            let color = brightness * opacity;
            // An opacity of 1e-12 cannot differ from 1e-12 by 1e-5; its color can.
            (opacity == 0.0 || opacity > 1e-3 * extinction.min(1.0)).then_some([
                color,
                0.5 * color,
                0.25 * color,
                opacity,
            ])
        });
        let volume = cube(3, |p| p.x - 0.3 * p.y);
        HardScene::new(format!("extinction {extinction:e}"), volume, scene, Truth::Light(light))
    };
    [1.0, 1e-12, 1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9, 1e12].map(scene).into()
}

/// The sharp edge of a wedge, nearer and nearer: chords from nothing to the width of the picture.
fn short_chords() -> Vec<HardScene> {
    let points = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.3, 0.1], [1.0, -0.25, 0.2]].map(DVec3::from);
    let scene = |(height, gpu_within): (f64, Option<f64>)| {
        let camera = Camera {
            eye: DVec3::new(0.3 * height, 3.0, 0.05),
            target: DVec3::new(0.3 * height, 0.0, 0.05),
            up: DVec3::new(0.2, 0.0, 1.0),
            projection: Projection::Orthographic { height },
        };
        let volume = volume_of(&points, &[[0, 1, 2, 3]], &[0.0, 1.0, 0.3, 0.8]);
        let scene = scene_of(&camera, [41, 40], RAINBOW, &[[0.0, 2.0 / height], [1.0, 5.0 / height]]);
        let beyond = gpu_within.map(|within| Beyond::gpu("less than a hundredth of the mesh", within));
        HardScene { beyond, ..HardScene::partition(format!("{height:e} high"), volume, scene) }
    };
    // A step of a GPU's coordinates is 2e-9 of the mesh: at 1e-7 it is a good part of a pixel.
    [(1.0, None), (1e-3, Some(1e-4)), (1e-6, Some(5e-2)), (1e-7, Some(1.0))].map(scene).into()
}

/// Scalars that are the same at both ends of every chord, or differ by some ulps: quotients by their difference are 0 / 0 there.
fn equal_scalars() -> Vec<HardScene> {
    let extinction = [[0.0, 0.0], [0.3, 4.0], [0.3, 1.0], [0.6, 2.0], [1.0, 0.5]];
    let scene = |name: &str, volume: Volume| {
        HardScene::partition(name, volume, scene_of(&down_z(1.3), [48, 45], RAINBOW, &extinction))
    };
    vec![
        scene("the same along each ray", cube(3, |p| p.x)),
        scene("the same everywhere", cube(3, |_| 0.45)),
        scene("the same everywhere, on a step", cube(3, |_| 0.3)),
        scene("some ulps apart", cube(3, |p| 0.45 + p.z * 4e-16)),
        scene("1e-7 apart", cube(3, |p| p.x + 1e-7 * p.z)),
        scene("some ulps about a step", cube(3, |p| 0.3 + (p.z - 0.5) * 4e-16)),
    ]
}

/// Steps, and peaks so narrow that no sample meets them: their depth is their area over the field's slope, whatever their width.
fn steps_and_peaks() -> Vec<HardScene> {
    let peak = |width: f64, gpu_within: Option<f64>| {
        let volume = cube(4, |p| p.z);
        let (area, middle) = (0.7, 0.377);
        let height = 2.0 * area / width;
        let extinction =
            [[0.0, 0.0], [middle - width / 2.0, 0.0], [middle, height], [middle + width / 2.0, 0.0], [1.0, 0.0]];
        let camera = aslant();
        let color = [[0.0, 0.9, 0.5, 0.2]];
        let scene = scene_of(&camera, [48, 45], &color, &extinction);
        let light = Arc::new(move |ray: &Ray| {
            // Where the ray crosses the layer of that scalar: within the cube or not, and not near its rim.
            let along = (middle - ray.origin.z) / ray.direction.z;
            let at = ray.origin + ray.direction * along;
            let inside = at.x.min(at.y).min(1.0 - at.x).min(1.0 - at.y);
            if inside.abs() < 2.0 * width {
                return None;
            }
            let slope = (ray.direction.z / ray.direction.length()).abs();
            let opacity = if inside < 0.0 { 0.0 } else { -(-area / slope).exp_m1() };
            Some([0.9 * opacity, 0.5 * opacity, 0.2 * opacity, opacity])
        });
        // In f32 a scalar is known to 3e-8 of its cell's range.
        let beyond = gpu_within.map(|within| Beyond::gpu("changes faster than 32-bit scalars", within));
        HardScene { beyond, ..HardScene::new(format!("a peak {width:e} wide"), volume, scene, Truth::Light(light)) }
    };
    let steps = {
        let extinction =
            [[0.0, 0.2], [0.25, 0.2], [0.25, 3.0], [0.5, 3.0], [0.5, 0.0], [0.75, 0.0], [0.75, 6.0], [1.0, 6.0]];
        let volume = cube(4, |p| 0.5 + 0.5 * (3.0 * p.x + 1.0).sin() * (2.0 * p.y + 3.0 * p.z).cos());
        HardScene::partition("steps", volume, scene_of(&aslant(), [48, 45], RAINBOW, &extinction))
    };
    vec![steps, peak(1e-2, None), peak(1e-4, None), peak(1e-6, Some(2e-4)), peak(1e-9, Some(1.0))]
}

/// The field's slope along the ray, and with it the extinction's, goes through 0 within the picture and within cells: closed forms divide by it.
fn slope_through_zero() -> Vec<HardScene> {
    let scene = |name: &str, strength: f64| {
        let volume = cube(4, move |p| 0.5 + strength * (p.x - 0.5) * (p.z - 0.45));
        // The range is 0.25 wide at a strength of 1 already.
        let spread = 0.3 * strength;
        let extinction = [[0.5 - spread, 0.0], [0.5 + spread, 12.0]];
        let color: Vec<[f64; 4]> =
            RAINBOW.iter().map(|&[s, r, g, b]| [0.5 + (2.0 * s - 1.0) * spread, r, g, b]).collect();
        HardScene::partition(name, volume, scene_of(&down_z(1.3), [48, 45], &color, &extinction))
    };
    vec![scene("a saddle", 1.0), scene("a saddle of 1e-6", 1e-6), scene("a saddle of 1e-12", 1e-12)]
}

/// A column of 10,000 cubes, each nearly transparent, all seen through: what is lost at each layer adds up.
fn ten_thousand_layers() -> Vec<HardScene> {
    const LAYERS: usize = 10_000;
    let scene = |name: &str, depth: f64| {
        let mesh = grid([1, 1, LAYERS], DVec3::ZERO, 1.0).mesh;
        let length = LAYERS as f64;
        let volume = with_field(&mesh, |p| p.z / length);
        let camera = Camera {
            eye: DVec3::new(0.52, 0.47, length + 2.0),
            target: DVec3::new(0.52, 0.47, 0.0),
            up: DVec3::new(0.1, 1.0, 0.0),
            projection: Projection::Orthographic { height: 1.4 },
        };
        let scene = scene_of(&camera, [13, 12], RAINBOW, &[[0.0, depth / length]]);
        let mut hard = HardScene::partition(name, volume, scene);
        // The fixed function multiplies by 1 - opacity, which rounds alike in alike layers.
        (hard.within.triangles, hard.chord_within.triangles, hard.crack_within.triangles) = (2e-4, 3e-4, 1e-4);
        // What is left of the sums that compilers of a GPU may undo.
        hard.within.compute = 1e-4;
        hard
    };
    vec![scene("depth 1 in all", 1.0), scene("depth 1e-3 in all", 1e-3)]
}

/// The same column into a target of 16 bits on a GPU's path of triangles, whose steps are 5e-4 of an opacity near 1 where a layer adds 1e-4.
fn accumulation() -> Vec<HardScene> {
    let mut hard = ten_thousand_layers().swap_remove(0);
    hard.scene.quality.target_bits = Some(16);
    hard.beyond = Some(Beyond { ways: &[Way::Triangles], words: "16 bits round after each of them", within: 1e-1 });
    vec![hard]
}
