//! Chord lengths are conserved: with one extinction everywhere, a pixel's opacity follows from the mesh's boundary alone.
//!
//! Tolerance 1e-5 in opacity. The fast renderer's planes are f32 about each cell's reference, so a cell's chord is off by
//! some 4e-7 of the cell's depth range, and by that times at most 256 where a face is nearly edge-on before the cell is
//! drawn in f64. On average it is the first; 60 cells along a ray, a depth of 4 in all, and errors of either sign leave
//! a few 1e-6. In f64 nothing comes near.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{Camera, Integration, OpticalModel, Projection, View};
use tetrascope_tests::chords::{boundary, boundary_faces, chords, world};
use tetrascope_tests::meshes::{Random, bent_block_dataset};
use tetrascope_tests::pictures::{Renderer, SMALL_TABLES, WHITE, Worst, plan, random_camera, random_turn};

/// A bent block of `n` cells a side, scaled and moved, with its center.
fn block(n: usize, seed: u64, scale: f64, offset: DVec3) -> TetMesh {
    let mut dataset = bent_block_dataset(n, 0.12, seed);
    dataset.points.iter_mut().for_each(|p| *p = *p * scale + offset);
    tetrascope::decompose(&dataset).unwrap().mesh
}

/// Draws with a depth of 4 along `size` and compares every pixel; adds to `skipped` those too near a boundary edge.
fn check_view(
    mesh: &TetMesh,
    view: View,
    size: f64,
    renderer: Renderer,
    place: &str,
    worst: &mut Worst,
    skipped: &mut [usize; 2],
) {
    let extinction = 2.0 / size;
    let image = renderer.draw(mesh, &vec![0.5; mesh.positions().len()], &plan(view, WHITE, &[[0.0, extinction]]));
    let known = chords(&boundary(mesh), &view);
    skipped[1] += known.len();
    for (i, (pixel, chord)) in image.pixels().iter().zip(known).enumerate() {
        let Some(chord) = chord else {
            skipped[0] += 1;
            continue;
        };
        let expected = -(-extinction * chord).exp_m1();
        let error = pixel.iter().map(|c| (f64::from(*c) - expected).abs()).fold(0.0, f64::max);
        worst.note(error, || {
            format!(
                "{place}, {renderer:?}, pixel ({}, {}), {} instead of {expected}",
                i as u32 % view.width,
                i as u32 / view.width,
                pixel[3]
            )
        });
    }
}

/// Few pixels may be left out: the strip along the edges is 1e-7 wide.
fn check_skipped([skipped, all]: [usize; 2], share: f64) {
    assert!(skipped as f64 <= share * all as f64, "{skipped} of {all} pixels are at an edge");
}

#[test]
fn chord_is_conserved_from_outside_at_any_scale_and_place() {
    let mut worst = Worst::new("opacity of the chord, from outside", 1e-5);
    let mut skipped = [0; 2];
    let utm = DVec3::new(5e5, 5e6, 120.0);
    let places = [
        (1.0, DVec3::ZERO),
        (1e-9, DVec3::ZERO),
        (1e9, DVec3::ZERO),
        (1.0, utm),
        (80.0, utm),
        (1e-4, DVec3::splat(3.0)),
        (1e9, DVec3::splat(1e12)),
    ];
    for (seed, (scale, offset)) in (0..4).flat_map(|i| places.map(|p| (i, p))) {
        let mesh = block(3 + (seed % 3) as usize, seed, scale, offset);
        let mut random = Random::new(seed + 100);
        for is_perspective in [false, true] {
            let camera = random_camera(&mut random, offset, scale, is_perspective);
            let view = View::new(&camera, 41, 30).unwrap();
            // Tables know a chord only as well as they resolve lengths.
            let others = Renderer::BETWEEN.into_iter().filter(|renderer| !renderer.integration().needs_table());
            for renderer in Renderer::EXACT.into_iter().chain([Renderer::Fast(Integration::Average)]).chain(others) {
                let place = format!("seed {seed}, scale {scale:e}, offset {offset}, perspective {is_perspective}");
                check_view(&mesh, view, scale, renderer, &place, &mut worst, &mut skipped);
            }
        }
    }
    check_skipped(skipped, 1e-3);
    worst.finish();
}

/// Points of a mesh at which an eye is a hard case: in a cell, on a face, an edge and a vertex, inside and on the boundary.
fn hard_eyes(mesh: &TetMesh, random: &mut Random) -> Vec<(&'static str, DVec3)> {
    let mean = |points: &[u32]| points.iter().map(|&p| world(mesh, p)).sum::<DVec3>() / points.len() as f64;
    let faces = boundary_faces(mesh);
    let is_outer = |p: u32| faces.iter().any(|f| f.contains(&p));
    let cells = mesh.tetrahedra();
    let cell = cells[(random.unit() * cells.len() as f64) as usize].map(|v| v.0);
    // A cell with an inner point: its faces and edges at that point are inner ones.
    let (inner, around) = cells
        .iter()
        .map(|c| c.map(|v| v.0))
        .skip(cells.len() / 2)
        .find_map(|c| Some((c.into_iter().find(|&p| !is_outer(p))?, c)))
        .expect("the block has inner points");
    let others: Vec<u32> = around.into_iter().filter(|&p| p != inner).collect();
    let face = faces[(random.unit() * faces.len() as f64) as usize];
    vec![
        ("in a cell", mean(&cell)),
        ("on an inner face", mean(&[inner, others[0], others[1]])),
        ("on an inner edge", mean(&[inner, others[0]])),
        ("on an inner vertex", world(mesh, inner)),
        ("on a boundary face", mean(&face)),
        ("on a boundary edge", mean(&face[..2])),
        ("on a boundary vertex", world(mesh, face[0])),
    ]
}

#[test]
fn chord_is_conserved_with_the_eye_in_and_on_the_mesh() {
    let mut worst = Worst::new("opacity of the chord, eye in and on the mesh", 1e-5);
    let mut skipped = [0; 2];
    for seed in 0..5 {
        let (scale, offset) = [
            (1.0, DVec3::ZERO),
            (80.0, DVec3::new(5e5, 5e6, 0.0)),
            (1e-9, DVec3::ZERO),
            (1e9, DVec3::ZERO),
            (1.0, DVec3::ZERO),
        ][seed as usize];
        let mesh = block(3, seed + 40, scale, offset);
        let mut random = Random::new(seed + 200);
        for (name, eye) in hard_eyes(&mesh, &mut random) {
            for fov_y in [1.0_f64, 2.4] {
                let turn = random_turn(&mut random);
                let camera = Camera {
                    eye,
                    target: eye + turn * DVec3::NEG_Z * scale,
                    up: turn * DVec3::Y,
                    projection: Projection::Perspective { fov_y },
                };
                let view = View::new(&camera, 33, 26).unwrap();
                for renderer in Renderer::EXACT {
                    let place = format!("seed {seed}, eye {name}, field of view {fov_y}");
                    check_view(&mesh, view, scale, renderer, &place, &mut worst, &mut skipped);
                }
            }
            // The plane from which parallel rays start, through the same point.
            let turn = random_turn(&mut random);
            let camera = Camera {
                eye,
                target: eye + turn * DVec3::NEG_Z * scale,
                up: turn * DVec3::Y,
                projection: Projection::Orthographic { height: 2.0 * scale },
            };
            let view = View::new(&camera, 33, 26).unwrap();
            for renderer in Renderer::EXACT {
                let place = format!("seed {seed}, plane of parallel rays {name}");
                check_view(&mesh, view, scale, renderer, &place, &mut worst, &mut skipped);
            }
        }
    }
    check_skipped(skipped, 5e-3);
    worst.finish();
}

/// Emission adds color along the chord. In parallel views the interpolation of the oldest method is exact for it too, since
/// the chord is linear over every triangle of a fan.
#[test]
fn light_of_emission_is_the_chord() {
    let mut worst = Worst::new("emission of the chord", 1e-5);
    for seed in 0..6 {
        let mesh = block(3, seed + 70, 1.0, DVec3::ZERO);
        let mut random = Random::new(seed + 300);
        for is_perspective in [false, true] {
            let view = View::new(&random_camera(&mut random, DVec3::ZERO, 1.0, is_perspective), 37, 28).unwrap();
            let mut plan = plan(view, &[[0.0, 0.3, 0.2, 0.1]], &[[0.0, 0.0]]);
            plan.model = OpticalModel::Emission;
            plan.tables = SMALL_TABLES;
            let known = chords(&boundary(&mesh), &view);
            for renderer in Renderer::ALL.into_iter().chain(Renderer::BETWEEN) {
                if renderer == Renderer::Fast(Integration::Vertex) && is_perspective {
                    continue;
                }
                let image = renderer.draw(&mesh, &vec![1.0; mesh.positions().len()], &plan);
                for (pixel, chord) in image.pixels().iter().zip(&known) {
                    assert_eq!(pixel[3], 0.0, "emission alone is transparent");
                    let Some(chord) = chord else { continue };
                    for (c, color) in [0.3, 0.2, 0.1].into_iter().enumerate() {
                        worst.note((f64::from(pixel[c]) - color * chord).abs(), || {
                            format!("seed {seed}, {renderer:?}, perspective {is_perspective}")
                        });
                    }
                }
            }
        }
    }
    worst.finish();
}
