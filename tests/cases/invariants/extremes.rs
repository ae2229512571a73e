//! Shapes, distances and pictures at the ends of what there is: every opacity is that of the mesh's chord.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{Camera, Integration, Projection, View};
use tetrascope_tests::chords::{boundary, chords};
use tetrascope_tests::meshes::{Random, Tets, bent_block};
use tetrascope_tests::pictures::{Renderer, WHITE, Worst, plan, random_camera, random_turn};

/// The opacity of every pixel against the chord of the boundary, by both renderers, and nothing but finite numbers from all.
fn check(mesh: &TetMesh, view: View, extinction: f64, place: &str, worst: &mut Worst) {
    let known = chords(&boundary(mesh), &view);
    let skipped = known.iter().filter(|c| c.is_none()).count();
    // Right above an edge all rays along the boundary are near it.
    assert!(skipped * 10 <= known.len(), "{place}: {skipped} of {} pixels are at an edge", known.len());
    let scalars: Vec<f64> = (0..mesh.positions().len()).map(|i| i as f64 * 0.1).collect();
    for renderer in Renderer::ALL {
        // Draws, and fails for what is not finite.
        let image = renderer.draw(mesh, &scalars, &plan(view, WHITE, &[[0.0, extinction]]));
        if renderer == Renderer::Fast(Integration::Vertex) {
            assert!(image.pixels().iter().all(|p| (0.0..=1.0).contains(&p[3])), "{place}: {renderer:?}");
            continue;
        }
        for (i, (pixel, chord)) in image.pixels().iter().zip(&known).enumerate() {
            let Some(chord) = chord else { continue };
            let expected = -(-extinction * chord).exp_m1();
            worst.note((f64::from(pixel[3]) - expected).abs(), || {
                format!("{place}, {renderer:?}, pixel {i}: {} instead of {expected}", pixel[3])
            });
        }
    }
}

/// Slivers are planes of a cell that hardly differ. Whatever a sliver gets wrong is at most its own chord, and its neighbors share
/// its faces' planes. 1e-5 as for good cells.
#[test]
fn slivers_and_needles() {
    let mut worst = Worst::new("slivers and needles", 1e-5);
    let mut random = Random::new(2000);
    for height in [1e-3, 1e-6, 1e-9] {
        for seed in 0..3 {
            // A good block in which points are put right beside a face, an edge and a corner of cells.
            let mut tets = Tets::block(2, 2001 + seed);
            for _ in 0..12 {
                let cell = tets.cells[(random.unit() * tets.cells.len() as f64) as usize];
                tets.split(&cell, &[height, 0.4, 0.3, 0.3 - height]);
                let cell = tets.cells[(random.unit() * tets.cells.len() as f64) as usize];
                tets.split(&cell, &[height, height, 0.4, 0.6 - 2.0 * height]);
                let cell = tets.cells[(random.unit() * tets.cells.len() as f64) as usize];
                tets.split(&cell, &[height, height, height, 1.0 - 3.0 * height]);
            }
            // Cells split again and again may end below what the coordinates resolve and are left out then, with less than 1e-14
            // of the mesh's volume.
            let mesh = TetMesh::from_tetrahedra(&tets.points, &tets.cells).unwrap().mesh;
            let outline = tets_before(seed).mesh();
            for is_perspective in [false, true] {
                let camera = random_camera(&mut random, DVec3::ZERO, 1.0, is_perspective);
                let view = View::new(&camera, 41, 33).unwrap();
                let known = chords(&boundary(&outline), &view);
                let scalars = vec![0.0; mesh.positions().len()];
                for renderer in Renderer::EXACT.into_iter().chain([Renderer::Fast(Integration::Average)]) {
                    let image = renderer.draw(&mesh, &scalars, &plan(view, WHITE, &[[0.0, 2.0]]));
                    for (pixel, chord) in image.pixels().iter().zip(&known) {
                        let Some(chord) = chord else { continue };
                        let expected = -(-2.0 * chord).exp_m1();
                        worst.note((f64::from(pixel[3]) - expected).abs(), || {
                            format!("height {height:e}, seed {seed}, perspective {is_perspective}, {renderer:?}")
                        });
                    }
                }
            }
        }
    }
    worst.finish();
}

fn tets_before(seed: u64) -> Tets {
    Tets::block(2, 2001 + seed)
}

/// One cell alone: flat, long, or both, from all sides, with an extinction that makes its usual chord opaque.
///
/// Alone nothing makes up for an error, so the limit is relative to the cell's depth: 1e-4 in opacity, since a pixel as wide
/// as the cell is flat samples planes whose slope is up to 256 times the cell's depth a pixel.
#[test]
fn one_odd_cell() {
    let mut worst = Worst::new("one odd cell", 1e-4);
    let mut random = Random::new(2100);
    for (name, size) in [
        ("flat", DVec3::new(1.0, 1.0, 1e-6)),
        ("needle", DVec3::new(1e-6, 1e-6, 1.0)),
        ("blade", DVec3::new(1e-6, 1e-3, 1.0)),
        ("plain", DVec3::ONE),
    ] {
        for _ in 0..12 {
            let points: Vec<DVec3> = [[-1., -1., -0.9], [1., -0.8, -1.], [-0.7, 1., -0.8], [0.1, 0.2, 1.]]
                .map(|p| (DVec3::from(p) + random.point() * 0.2) * size)
                .to_vec();
            let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]]).unwrap().mesh;
            for is_perspective in [false, true] {
                let camera = random_camera(&mut random, DVec3::ZERO, 1.0, is_perspective);
                let view = View::new(&camera, 33, 31).unwrap();
                check(&mesh, view, 2.0, &format!("{name}, perspective {is_perspective}"), &mut worst);
                // As near as its size, so that the thin side fills the picture.
                let across = size.min_element() * 2.0;
                let near = Camera {
                    eye: DVec3::new(0.0, 0.0, 4.0),
                    target: DVec3::ZERO,
                    up: DVec3::new(0.3, 1.0, 0.0),
                    projection: Projection::Orthographic { height: across },
                };
                check(&mesh, View::new(&near, 33, 31).unwrap(), 2.0, &format!("{name}, near"), &mut worst);
            }
        }
    }
    worst.finish();
}

/// A cube whose cells shrink towards a corner by a factor of a million.
#[test]
fn sizes_a_million_to_one() {
    let mut worst = Worst::new("size ratio 1e6", 1e-5);
    let mut tets = Tets::block(1, 2200);
    let corner = tets.points[0];
    // Bisecting the edges at one corner again and again: 20 halvings.
    for _ in 0..20 {
        let nearest: Vec<u32> = tets
            .cells
            .iter()
            .filter(|cell| cell.contains(&0))
            .flat_map(|cell| cell.iter().copied().filter(|&p| p != 0))
            .collect::<std::collections::BTreeSet<_>>()
            .into_iter()
            .collect();
        for other in nearest {
            tets.split(&[0, other], &[0.5, 0.5]);
        }
    }
    let smallest = tets.points[1..].iter().map(|p| (*p - corner).length()).fold(f64::INFINITY, f64::min);
    assert!(smallest < 2e-6, "{smallest}");
    let mesh = tets.mesh();
    let mut random = Random::new(2201);
    for _ in 0..3 {
        for is_perspective in [false, true] {
            let camera = random_camera(&mut random, DVec3::ZERO, 1.0, is_perspective);
            check(&mesh, View::new(&camera, 40, 40).unwrap(), 1.0, "whole", &mut worst);
            // Down to the smallest cells: the eye stays outside in a parallel view and goes near in perspective.
            for zoom in [1e-2, 1e-4, 1e-6] {
                let towards = random_turn(&mut random) * DVec3::Z;
                let projection = if is_perspective {
                    Projection::Perspective { fov_y: 0.8 }
                } else {
                    Projection::Orthographic { height: 2.0 * zoom }
                };
                let camera = Camera {
                    eye: corner + towards * if is_perspective { 2.0 * zoom } else { 5.0 },
                    target: corner,
                    up: towards.any_orthogonal_vector(),
                    projection,
                };
                let place = format!("zoom {zoom:e}, perspective {is_perspective}");
                check(&mesh, View::new(&camera, 31, 31).unwrap(), 1.0, &place, &mut worst);
            }
        }
    }
    worst.finish();
}

/// An eye so far away that all rays are parallel in f32, with the angle of view that keeps the picture full.
///
/// Coordinates about the eye have an error of 1e-16 of the distance, which is 1e-11 of the mesh at 1e5 sizes and 1e-8 at 1e8.
#[test]
fn far_eyes() {
    let mut worst = Worst::new("far eye", 1e-5);
    for seed in 0..3 {
        let mesh = bent_block(3, 0.12, 2300 + seed).mesh;
        let mut random = Random::new(seed);
        for distance in [1e3, 1e5, 1e8] {
            let away = random_turn(&mut random) * DVec3::Z;
            let camera = Camera {
                eye: away * distance,
                target: DVec3::ZERO,
                up: away.any_orthogonal_vector(),
                projection: Projection::Perspective { fov_y: 2.0 * (1.6 / distance).atan() },
            };
            let view = View::new(&camera, 41, 33).unwrap();
            check(&mesh, view, 2.0, &format!("distance {distance:e}, seed {seed}"), &mut worst);
        }
    }
    worst.finish();
}

/// An eye 1e-7 from a face, an edge and a vertex of the boundary and of inner cells, on either side.
#[test]
fn near_eyes() {
    let mut worst = Worst::new("near eye", 1e-5);
    for seed in 0..4 {
        let mesh = bent_block(2, 0.12, 2400 + seed).mesh;
        let mut random = Random::new(seed);
        let outer = boundary(&mesh);
        for away in [1e-3, 1e-7, -1e-7] {
            let [a, b, c] = outer[(random.unit() * outer.len() as f64) as usize];
            let normal = (b - a).cross(c - a).normalize();
            for (name, place) in [("face", (a + b + c) / 3.0), ("edge", (a + b) / 2.0), ("vertex", a)] {
                for fov_y in [0.5_f64, 2.0] {
                    // Into the mesh, and along the face.
                    for direction in [-normal + 0.3 * random.point(), (b - a).normalize() + 0.2 * random.point()] {
                        let eye = place + normal * away;
                        let camera = Camera {
                            eye,
                            target: eye + direction,
                            up: normal + direction.any_orthogonal_vector() * 1.5,
                            projection: Projection::Perspective { fov_y },
                        };
                        let view = View::new(&camera, 31, 25).unwrap();
                        check(&mesh, view, 2.0, &format!("{away:e} from a {name}, seed {seed}"), &mut worst);
                    }
                }
            }
        }
    }
    worst.finish();
}

#[test]
fn narrow_and_wide_angles() {
    let mut worst = Worst::new("angle of view 1 and 170 degrees", 1e-5);
    for seed in 0..4 {
        let mesh = bent_block(3, 0.12, 2500 + seed).mesh;
        let mut random = Random::new(seed);
        for degrees in [0.01_f64, 1.0, 170.0, 179.0] {
            for distance in [0.3, 1.6, 60.0] {
                let away = random_turn(&mut random) * DVec3::Z;
                let camera = Camera {
                    eye: away * distance,
                    target: random.point() * 0.1,
                    up: away.any_orthogonal_vector(),
                    projection: Projection::Perspective { fov_y: degrees.to_radians() },
                };
                let view = View::new(&camera, 37, 31).unwrap();
                check(&mesh, view, 2.0, &format!("{degrees} degrees from {distance}"), &mut worst);
            }
        }
    }
    worst.finish();
}

/// Sizes that are no multiple of any block or tile.
#[test]
fn odd_pictures() {
    let mut worst = Worst::new("odd picture sizes", 1e-5);
    let mesh = bent_block(3, 0.12, 2600).mesh;
    let mut random = Random::new(2600);
    for (width, height) in [(1, 1), (3, 500), (500, 3), (33, 31), (32, 32), (1, 64), (65, 1), (4, 2), (5, 3), (2, 1)] {
        for is_perspective in [false, true] {
            let mut camera = random_camera(&mut random, DVec3::ZERO, 1.0, is_perspective);
            // A pixel high and many wide would see nothing but a strip.
            if width > 4 * height {
                let factor = f64::from(height) / f64::from(width);
                camera.projection = match camera.projection {
                    Projection::Perspective { fov_y } => {
                        Projection::Perspective { fov_y: 2.0 * ((fov_y / 2.0).tan() * factor).atan() }
                    }
                    Projection::Orthographic { height } => Projection::Orthographic { height: height * factor },
                };
            }
            let view = View::new(&camera, width, height).unwrap();
            check(&mesh, view, 2.0, &format!("{width} x {height}, perspective {is_perspective}"), &mut worst);
        }
    }
    worst.finish();
}

/// Extinctions from hardly anything to opaque: a thin picture is linear in f32, an opaque one is one.
#[test]
fn extinctions_of_any_size() {
    let mesh = bent_block(3, 0.12, 2700).mesh;
    let view = View::new(&random_camera(&mut Random::new(2700), DVec3::ZERO, 1.0, true), 40, 32).unwrap();
    let known = chords(&boundary(&mesh), &view);
    for renderer in Renderer::EXACT {
        for extinction in [0.0, 1e-30, 1e-12, 1e-6, 1e3, 1e6, 1e12, 1e30, 1e300] {
            let image =
                renderer.draw(&mesh, &vec![0.0; mesh.positions().len()], &plan(view, WHITE, &[[0.0, extinction]]));
            for (pixel, chord) in image.pixels().iter().zip(&known) {
                let Some(chord) = chord else { continue };
                let expected = -(-extinction * chord).exp_m1();
                // Color keeps its digits where opacity, one minus a product in f32, has only steps of 6e-8.
                let within = 1e-5_f64.min(1e-5 * expected + 1e-38);
                let color = f64::from(pixel[0]);
                // The depth of a chord that ends at an edge can be anything above zero.
                let is_clear = *chord > 1e-2 || *chord == 0.0;
                assert!(
                    !is_clear || (color - expected).abs() <= within,
                    "{renderer:?}, extinction {extinction:e}: {color:e} instead of {expected:e}"
                );
                assert!(
                    !is_clear || (f64::from(pixel[3]) - expected).abs() <= 1e-5,
                    "{renderer:?}, extinction {extinction:e}"
                );
            }
        }
    }
}
