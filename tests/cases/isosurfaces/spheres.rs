//! Surfaces in meshes that are no grids, with cells in a wrong order by their centroids: the fast renderer against the reference.
//!
//! A transparent surface counts once wherever a ray crosses it, so that opacities tell what is missing or doubled.

use glam::DVec3;
use tetrascope::mesh::{TetMesh, rings_sample};
use tetrascope::{Camera, Integration, IsosurfaceMethod, LinearImage, Mixing, Projection, SurfaceShading, View};
use tetrascope_tests::compare::difference;
use tetrascope_tests::meshes::{Random, Tets};
use tetrascope_tests::pictures::{Renderer, mean_opacity, random_camera};
use tetrascope_tests::surfaces::{by_method, points, ray_of, surfaces_alone, white};

/// The built-in sample, with the distance to its sphere.
pub(crate) fn sample(cells: usize) -> (TetMesh, Vec<f64>) {
    let mesh = tetrascope::decompose(&rings_sample(cells)).unwrap().mesh;
    let scalars = points(&mesh).iter().map(|p| p.length() - 0.6).collect();
    (mesh, scalars)
}

/// A view of the sample in which it keeps its size, whatever the distance.
pub(crate) fn view_from(distance: f64, side: u32) -> View {
    let camera = Camera {
        eye: DVec3::new(0.3, -0.4, 1.0).normalize() * distance,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 2.0 * (1.6 / distance).atan() },
    };
    View::new(&camera, side, side).unwrap()
}

/// What differs by more than rounding.
fn wrong(fast: &LinearImage, slow: &LinearImage) -> usize {
    difference(fast, slow, 1e-6, &[]).beyond
}

/// Two layers inside the outline, none outside; the sphere of linear cells lies up to 0.01 inside the true one.
#[test]
fn sphere_is_two_layers_and_no_stray_pixel() {
    let (mesh, scalars) = sample(16);
    for distance in [3.0, 6.0, 100.0] {
        let view = view_from(distance, 80);
        for opacity in [1.0, 0.3] {
            let plan = surfaces_alone(view, vec![white(0.0, opacity)]);
            for renderer in Renderer::EXACT {
                let image = renderer.draw(&mesh, &scalars, &plan);
                let mut inside = 0;
                for (i, pixel) in image.pixels().iter().enumerate() {
                    let ray = ray_of(&view, i);
                    // Distance of the ray from the center.
                    let beside = ray.origin.cross(ray.direction.normalize()).length();
                    let expected = if beside < 0.58 {
                        inside += 1;
                        1.0 - (1.0 - opacity) * (1.0 - opacity)
                    } else if beside > 0.605 {
                        0.0
                    } else {
                        continue;
                    };
                    let error = (f64::from(pixel[3]) - expected).abs();
                    assert!(error < 1e-6, "{renderer:?} from {distance}, pixel {i}: {} not {expected}", pixel[3]);
                }
                assert!(inside > 300, "{inside} pixels");
            }
        }
    }
}

/// A ray that grazes a surface, in cells of a wrong order, may count it otherwise: 2 pixels of 7200 at most.
#[test]
fn surfaces_of_chance_agree_with_the_reference() {
    for seed in 0..6 {
        let tets = Tets::block(5, seed + 5600);
        let mesh = tets.mesh();
        for is_perspective in [false, true] {
            let camera = random_camera(&mut Random::new(seed), DVec3::ZERO, 1.0, is_perspective);
            let view = View::new(&camera, 90, 80).unwrap();
            for opacity in [1.0, 0.4] {
                let plan = surfaces_alone(view, vec![white(0.1, opacity), white(-0.4, opacity)]);
                let [fast, slow] = Renderer::EXACT.map(|renderer| renderer.draw(&mesh, &tets.scalars, &plan));
                assert!(mean_opacity(&slow) > 0.03);
                let count = wrong(&fast, &slow);
                println!("seed {seed}, perspective {is_perspective}, opacity {opacity}: {count} pixels");
                assert!(count <= 2, "seed {seed}, perspective {is_perspective}, opacity {opacity}: {count} pixels");
            }
        }
    }
}

/// Up to 1e8 sizes of the mesh nothing is lost or doubled, but for rays that graze a surface: 4 of 4900 at most.
#[test]
fn far_eyes_lose_no_surface() {
    for cells in [8, 24] {
        let (mesh, scalars) = sample(cells);
        for distance in [10.0, 1e3, 1e4, 1e5, 1e6, 1e8] {
            let plan = surfaces_alone(view_from(distance, 70), vec![white(0.0, 0.4), white(0.31, 0.4)]);
            let [fast, slow] = Renderer::EXACT.map(|renderer| renderer.draw(&mesh, &scalars, &plan));
            let count = wrong(&fast, &slow);
            assert!(count <= 4, "{cells} cells a side from {distance:e}: {count} pixels");
        }
    }
}

/// A hundred surfaces at the cost of their crossings: layers count, however many there are in a cell.
#[test]
fn hundred_surfaces() {
    let (mesh, scalars) = sample(8);
    let view = view_from(6.0, 60);
    let surfaces = (0..100).map(|i| white(-0.55 + 0.013 * f64::from(i), 0.01)).collect();
    let plan = surfaces_alone(view, surfaces);
    let [fast, slow] = Renderer::EXACT.map(|renderer| renderer.draw(&mesh, &scalars, &plan));
    assert!(slow.pixels().iter().any(|p| p[3] > 0.7));
    // A hundred roundings, and one layer of a hundredth where a ray grazes it.
    let found = difference(&fast, &slow, 1e-5, &[]);
    println!("hundred surfaces: {found:?}");
    assert!(found.beyond <= 5 && found.largest < 0.02, "{found:?}");
}

/// A map moves a surface by up to half a texel: nothing is missing inside the outline, and only the outline moves.
#[test]
fn maps_leave_no_gap() {
    let (mesh, scalars) = sample(12);
    for distance in [3.0, 20.0] {
        let view = view_from(distance, 80);
        for opacity in [1.0, 0.4] {
            let plan = surfaces_alone(view, vec![white(0.0, opacity)]);
            let slow = Renderer::Reference(Integration::Exact).draw(&mesh, &scalars, &plan);
            let method = IsosurfaceMethod::Map { size: 256, mixing: Mixing::Smooth };
            let plan = by_method(&plan, vec![white(0.0, opacity)], method);
            for integration in [Integration::Exact, Integration::Vertex, Integration::Table3d] {
                let fast = Renderer::Fast(integration).draw(&mesh, &scalars, &plan);
                let found = difference(&fast, &slow, 1.0 / 255.0, &[]);
                println!("smooth map, {integration}, from {distance}, opacity {opacity}: {} pixels", found.beyond);
                // Along the outline, of some 150 pixels.
                assert!(found.beyond <= 8, "{integration} from {distance}: {found:?}");
                let inside = |i: usize| {
                    let ray = ray_of(&view, i);
                    ray.origin.cross(ray.direction.normalize()).length() < 0.56
                };
                for (i, (p, q)) in fast.pixels().iter().zip(slow.pixels()).enumerate().filter(|(i, _)| inside(*i)) {
                    assert!(
                        (p[3] - q[3]).abs() < 1e-6,
                        "{integration} from {distance}, pixel {i}: {} not {}",
                        p[3],
                        q[3]
                    );
                }
            }
        }
    }
}

/// Opaque surfaces end the table's integral and are looked up behind it: nothing comes through. Transparent ones are refused.
#[test]
fn stopped_in_the_table() {
    let (mesh, scalars) = sample(12);
    let view = view_from(6.0, 80);
    let method = IsosurfaceMethod::Map { size: 256, mixing: Mixing::Stopped };
    for shading in [SurfaceShading::None, SurfaceShading::Flat, SurfaceShading::Smooth] {
        let surface = tetrascope::Isosurface { shading, ..white(0.0, 1.0) };
        let lighting = (shading != SurfaceShading::None).then(tetrascope::Lighting::default);
        let plan = tetrascope::Plan { lighting, ..surfaces_alone(view, vec![surface]) };
        for integration in [Integration::Table3d, Integration::Table2d] {
            let stopped = by_method(&plan, vec![surface], method);
            let picture = Renderer::Fast(integration).draw(&mesh, &scalars, &stopped);
            for (i, pixel) in picture.pixels().iter().enumerate() {
                let ray = ray_of(&view, i);
                if ray.origin.cross(ray.direction.normalize()).length() < 0.54 {
                    assert!(1.0 - pixel[3] < 1e-6, "{integration}, {shading:?}, pixel {i}: {}", pixel[3]);
                }
            }
        }
    }
    let plan = by_method(&surfaces_alone(view, vec![]), vec![white(0.0, 0.5)], method);
    let plan = tetrascope::Plan { integration: Integration::Table3d, ..plan };
    let refused =
        tetrascope::CpuRenderer::new(&mesh, &scalars).unwrap().render(&plan, &tetrascope::Silent).unwrap_err();
    assert!(refused.to_string().contains("only opaque isosurfaces end an integral"), "{refused}");
}

/// A map has a surface at the boundary of two texels and nowhere else: the picture is that of the surface there, without gaps, however
/// few texels there are and however fine the cells.
#[test]
fn maps_are_exact_at_the_boundaries_of_their_texels() {
    let (mesh, scalars) = sample(24);
    let [lo, hi] = scalars.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], &s| [lo.min(s), hi.max(s)]);
    let view = view_from(6.0, 90);
    for (size, value) in
        [(2, 0.1), (3, 0.1), (8, 0.1), (16, -0.2), (64, 0.1), (256, 0.1), (256, hi - 1e-4), (256, lo + 1e-4)]
    {
        let surface = white(value, 0.4);
        let method = IsosurfaceMethod::Map { size, mixing: Mixing::Smooth };
        let map = by_method(&surfaces_alone(view, vec![surface]), vec![surface], method);
        let axis =
            tetrascope::IsosurfaceMap::new(&map.isosurfaces.as_ref().unwrap().surfaces, [lo, hi], size).unwrap().axis();
        let moved = surfaces_alone(view, vec![white(axis.boundary(value), 0.4)]);
        let found = difference(
            &Renderer::Fast(Integration::Exact).draw(&mesh, &scalars, &map),
            &Renderer::Fast(Integration::Exact).draw(&mesh, &scalars, &moved),
            1e-5,
            &[],
        );
        assert!((axis.boundary(value) - value).abs() <= 1.0001 * (hi - lo) / f64::from(size), "{size}");
        println!("map of {size} texels, {value}: {found:?}");
        // One ray in all of them grazes the surface.
        assert!(found.beyond <= 1, "{size} texels, {value} at {}: {found:?}", axis.boundary(value));
    }
}
