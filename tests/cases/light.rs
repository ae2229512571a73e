//! Light on surfaces and in the volume, in both renderers.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{Camera, Gradients, Isosurface, Lighting, LinearImage, Phong, Plan, Projection, SurfaceShading, View};
use tetrascope_tests::compare::difference;
use tetrascope_tests::meshes::{Random, Tets, grid};
use tetrascope_tests::pictures::{Renderer, Worst, largest, mean_opacity, plan, random_camera, random_turn};
use tetrascope_tests::surfaces::{points, ray_of, surfaces_alone, white, with_surfaces};

const COLOR: [f64; 3] = [0.8, 0.5, 0.2];
const PHONG: Phong = Phong { ambient: 0.1, diffuse: 0.6, specular: 0.3, shininess: 8.0 };

/// A surface with light on it.
fn lit(value: f64, shading: SurfaceShading) -> Isosurface {
    Isosurface { color: COLOR, back_color: COLOR, shading, ..white(value, 0.5) }
}

/// A block with a linear field, seen from above.
fn slope() -> (TetMesh, Vec<f64>, DVec3) {
    let gradient = DVec3::new(0.2, -0.3, 1.0);
    let mesh = grid([3; 3], DVec3::splat(-1.5), 1.0).mesh;
    let scalars = points(&mesh).iter().map(|p| gradient.dot(*p)).collect();
    (mesh, scalars, gradient)
}

fn from_above(projection: Projection) -> View {
    let camera = Camera { eye: DVec3::new(0.3, 0.1, 7.0), target: DVec3::ZERO, up: DVec3::Y, projection };
    View::new(&camera, 24, 24).unwrap()
}

/// The plane of a linear field has one normal, flat or smooth; what comes back follows from the angles alone.
#[test]
fn light_on_a_plane_is_known() {
    let mut worst = Worst::new("light on a plane", 1e-5);
    let (mesh, scalars, gradient) = slope();
    for projection in [Projection::Orthographic { height: 1.6 }, Projection::Perspective { fov_y: 0.22 }] {
        let view = from_above(projection);
        for direction in
            [None, Some(DVec3::new(1.0, 0.4, 0.8).normalize()), Some(DVec3::new(0.3, 0.2, -1.0).normalize())]
        {
            for shading in [SurfaceShading::Flat, SurfaceShading::Smooth] {
                let lighting = Some(Lighting { phong: PHONG, direction, volume: false });
                let plan = Plan { lighting, ..surfaces_alone(view, vec![lit(0.2, shading)]) };
                for renderer in Renderer::EXACT {
                    let image = renderer.draw(&mesh, &scalars, &plan);
                    for (i, pixel) in image.pixels().iter().enumerate() {
                        let to_eye = -ray_of(&view, i).direction.normalize();
                        let normal = gradient.normalize() * gradient.dot(to_eye).signum();
                        let to_light = direction.unwrap_or(to_eye);
                        let cosine = normal.dot(to_light);
                        let reflected = 2.0 * cosine * normal - to_light;
                        let highlight =
                            if cosine > 0.0 { reflected.dot(to_eye).max(0.0).powf(PHONG.shininess) } else { 0.0 };
                        let body = PHONG.ambient + PHONG.diffuse * cosine.max(0.0);
                        for c in 0..3 {
                            let expected = 0.5 * (COLOR[c] * body + PHONG.specular * highlight);
                            worst.note((f64::from(pixel[c]) - expected).abs(), || {
                                format!(
                                    "{renderer:?}, {shading:?}, light {direction:?}, pixel {i}: {} not {expected}",
                                    pixel[c]
                                )
                            });
                        }
                    }
                }
            }
        }
    }
    worst.finish();
}

/// Without a direction the light is at the eye: the same as a light from there in a parallel view.
#[test]
fn light_at_the_eye_is_a_light_from_there() {
    let tets = Tets::block(3, 6000);
    let view = View::new(&random_camera(&mut Random::new(1), DVec3::ZERO, 1.0, false), 50, 50).unwrap();
    for renderer in Renderer::EXACT {
        let draw = |direction| {
            let lighting = Some(Lighting { phong: PHONG, direction, volume: true });
            let plan = Plan { lighting, ..with_surfaces(&volume(view), vec![lit(0.1, SurfaceShading::Smooth)]) };
            renderer.draw(&tets.mesh(), &tets.scalars, &plan)
        };
        let (one, other) = (draw(None), draw(Some(-view.forward)));
        assert!(mean_opacity(&one) > 0.1);
        // The direction is rounded to f32 on another way.
        assert!(largest(&one, &other, 0..4) < 1e-5, "{renderer:?}: {}", largest(&one, &other, 0..4));
        assert!(largest(&one, &draw(Some(view.right)), 0..4) > 0.01, "{renderer:?}: the light shows");
    }
}

/// Facets are seen in a curved field with one normal a cell: both renderers draw them, and neither draws them smoothly.
#[test]
fn flat_and_smooth_differ_where_the_field_is_curved() {
    let tets = Tets::block(4, 6100);
    let mesh = tets.mesh();
    let view = View::new(&random_camera(&mut Random::new(3), DVec3::ZERO, 1.0, true), 60, 50).unwrap();
    let pictures: Vec<[LinearImage; 2]> = [SurfaceShading::Flat, SurfaceShading::Smooth]
        .map(|shading| {
            let lighting = Some(Lighting { phong: PHONG, ..Lighting::default() });
            let opaque = Isosurface { opacity: 1.0, ..lit(0.1, shading) };
            let plan = Plan { lighting, ..surfaces_alone(view, vec![opaque]) };
            Renderer::EXACT.map(|renderer| renderer.draw(&mesh, &tets.scalars, &plan))
        })
        .into();
    for [fast, slow] in &pictures {
        // Where a ray leaves a cell right at the surface, the one or the other cell's normal counts. Elsewhere the fast renderer's
        // surface lies 1e-5 of a cell's range beside, and what curvature makes of that is little more.
        let found = difference(fast, slow, 5e-5, &[]);
        println!("shaded surface: {found:?}");
        assert!(found.beyond <= 3, "{found:?}");
    }
    assert!(largest(&pictures[0][1], &pictures[1][1], 0..3) > 0.1);
}

/// A volume of one color, so that no order of cells shows.
fn volume(view: View) -> Plan {
    plan(view, &[[0.0, 0.9, 0.5, 0.2]], &[[-1.0, 0.2], [0.0, 2.0], [1.0, 0.1]])
}

/// Ambient light of 1 and nothing else is no light: to the bit but for rounding of one product.
#[test]
fn ambient_light_alone_changes_nothing() {
    let mut worst = Worst::new("volume in ambient light", 1e-6);
    for seed in 0..3 {
        let tets = Tets::block(3, 6200 + seed);
        let mesh = tets.mesh();
        for is_perspective in [false, true] {
            let view =
                View::new(&random_camera(&mut Random::new(seed), DVec3::ZERO, 1.0, is_perspective), 40, 40).unwrap();
            let dark = volume(view);
            let phong = Phong { ambient: 1.0, diffuse: 0.0, specular: 0.0, shininess: 1.0 };
            let lit = Plan { lighting: Some(Lighting { phong, direction: None, volume: true }), ..dark.clone() };
            let other = Plan { lighting: Some(Lighting { volume: true, ..Lighting::default() }), ..dark.clone() };
            assert_eq!((dark.gradients(), lit.gradients()), (Gradients::None, Gradients::Points));
            for renderer in Renderer::EXACT {
                let unlit = renderer.draw(&mesh, &tets.scalars, &dark);
                let image = renderer.draw(&mesh, &tets.scalars, &lit);
                worst.note(largest(&unlit, &image, 0..4), || format!("seed {seed}, {renderer:?}"));
                assert!(largest(&unlit, &renderer.draw(&mesh, &tets.scalars, &other), 0..3) > 0.01);
            }
        }
    }
    worst.finish();
}

/// The lit volume of one tetrahedron, whatever the integration: the light is a factor of the cell's color.
#[test]
fn lit_volume_agrees_with_the_reference() {
    let mut worst = Worst::new("lit volume of one cell", 1e-5);
    let mut random = Random::new(6300);
    for case in 0..12 {
        let points = [[-1.0, -1.0, -0.9], [1.0, -0.8, -1.0], [-0.7, 1.0, -0.8], [0.1, 0.2, 1.0]]
            .map(|p| DVec3::from(p) + random.point() * 0.2);
        let scalars: Vec<f64> = (0..4).map(|_| random.between(-1.0, 1.0)).collect();
        let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]]).unwrap().mesh;
        let view = View::new(&random_camera(&mut random, DVec3::ZERO, 1.0, case % 2 == 0), 40, 40).unwrap();
        let lighting = Lighting { phong: PHONG, direction: Some(random_turn(&mut random) * DVec3::X), volume: true };
        let plan = Plan { lighting: Some(lighting), ..volume(view) };
        let [fast, slow] = Renderer::EXACT.map(|renderer| renderer.draw(&mesh, &scalars, &plan));
        worst.note(largest(&fast, &slow, 0..4), || format!("case {case}"));
    }
    worst.finish();
}

/// Turning and moving all, scaling lengths, scaling scalars: the picture stays.
#[test]
fn light_turns_and_scales_with_the_scene() {
    for seed in 0..4 {
        let tets = Tets::block(3, 6400 + seed);
        let mut random = Random::new(seed);
        let (turn, by) = (random_turn(&mut random), random.point() * 100.0);
        let direction = random_turn(&mut random) * DVec3::X;
        let camera = random_camera(&mut random, DVec3::ZERO, 1.0, seed % 2 == 0);
        let draw = |renderer: Renderer, length: f64, scalar: f64, moves: bool| {
            let place = |p: DVec3| if moves { turn * p * length + by } else { p * length };
            let turned = |d: DVec3| if moves { turn * d } else { d };
            let mut other = tets.clone();
            other.points.iter_mut().for_each(|p| *p = place(*p));
            other.scalars.iter_mut().for_each(|s| *s *= scalar);
            let projection = match camera.projection {
                Projection::Orthographic { height } => Projection::Orthographic { height: height * length },
                perspective => perspective,
            };
            let with =
                Camera { eye: place(camera.eye), target: place(camera.target), up: turned(camera.up), projection };
            let color = [[0.0, 0.9, 0.5, 0.2]];
            let extinction = [[-scalar, 0.2 / length], [0.0, 2.0 / length], [scalar, 0.1 / length]];
            let plan = plan(View::new(&with, 40, 40).unwrap(), &color, &extinction);
            let surface = Isosurface {
                color: [0.9, 0.5, 0.2],
                back_color: [0.9, 0.5, 0.2],
                ..lit(0.1 * scalar, SurfaceShading::Smooth)
            };
            let lighting = Some(Lighting { phong: PHONG, direction: Some(turned(direction)), volume: false });
            renderer.draw(&other.mesh(), &other.scalars, &Plan { lighting, ..with_surfaces(&plan, vec![surface]) })
        };
        for renderer in Renderer::EXACT {
            let usual = draw(renderer, 1.0, 1.0, false);
            assert!(mean_opacity(&usual) > 0.1);
            for (length, scalar, moves) in [
                (1.0, 1.0, true),
                (1e-9, 1.0, false),
                (1e9, 1.0, false),
                (1.0, 1e-9, false),
                (1.0, 1e9, false),
                (7.0, 0.3, true),
            ] {
                // Twice what one picture is off, and a ray that grazes the surface may count it or not. The fast renderer may put
                // cells at nearly one depth in another order, which shows where the surface's light is not the volume's.
                let found = difference(&usual, &draw(renderer, length, scalar, moves), 2e-5, &[]);
                assert!(found.beyond <= 4, "seed {seed}, {renderer:?}, {length:e}, {scalar:e}, {moves}: {found:?}");
            }
        }
    }
}
