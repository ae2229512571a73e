//! One tetrahedron in every projection class, exactly degenerate ones too: the fast renderer against the reference, and both
//! against the chord that the classification knows.

use glam::DVec3;
use tetrascope::classify::{ProjectionClass, project};
use tetrascope::mesh::TetMesh;
use tetrascope::{Camera, Integration, Projection, View};
use tetrascope_tests::pictures::{Renderer, WHITE, Worst, largest, plan};

/// Integer corners, positively oriented, seen along -z from above: every sign of every face is exact.
struct Case {
    class: ProjectionClass,
    corners: [[i32; 3]; 4],
}

const CASES: &[Case] = &[
    Case { class: ProjectionClass::OneA, corners: [[-2, -2, 0], [4, -2, 0], [-2, 4, 0], [0, 0, 3]] },
    Case { class: ProjectionClass::OneB, corners: [[-2, -2, 0], [-2, 4, 0], [4, -2, 0], [0, 0, -3]] },
    Case { class: ProjectionClass::Two, corners: [[-2, 0, 2], [2, 0, 2], [0, 2, -1], [0, -2, -1]] },
    Case { class: ProjectionClass::ThreeA, corners: [[-2, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 3]] },
    Case { class: ProjectionClass::ThreeB, corners: [[-2, 0, 0], [0, 4, 0], [4, 0, 0], [0, 0, -3]] },
    Case { class: ProjectionClass::Four, corners: [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 3]] },
];

const SCALARS: [f64; 4] = [0.1, 0.7, 0.4, 1.0];
const EXTINCTION: f64 = 0.4;

fn corners(case: &Case) -> [DVec3; 4] {
    let [mut a, mut b, c, d] = case.corners.map(|p| DVec3::from(p.map(f64::from)));
    if (b - a).dot((c - a).cross(d - a)) < 0.0 {
        std::mem::swap(&mut a, &mut b);
    }
    [a, b, c, d]
}

/// Both projections from above, looking down on `target`, so that its ray is that of the middle pixel.
fn views(target: DVec3, side: u32) -> [(View, bool); 2] {
    [(Projection::Orthographic { height: 8.0 }, false), (Projection::Perspective { fov_y: 0.7 }, true)].map(
        |(projection, is_perspective)| {
            let eye = DVec3::new(target.x, target.y, 12.0);
            let camera = Camera { eye, target, up: DVec3::Y, projection };
            (View::new(&camera, side, side).unwrap(), is_perspective)
        },
    )
}

/// Fast and reference may differ by f32's rounding of one cell: a chord off by a few 1e-7 of the cell's depth, times 0.4.
#[test]
fn every_class_is_drawn_alike_by_both() {
    let mut worst = Worst::new("every class, fast against reference", 1e-6);
    for case in CASES {
        let corners = corners(case);
        let mesh = TetMesh::from_tetrahedra(&corners, &[[0, 1, 2, 3]]).unwrap().mesh;
        // Right above each corner, an edge's middle, a face's middle, and nothing in particular: edges and faces seen edge-on
        // lie exactly in the middle column of pixels.
        let targets = [corners[0], corners[3], (corners[0] + corners[1]) / 2.0, DVec3::ZERO, DVec3::new(0.3, 0.7, 0.0)];
        for target in targets {
            for (side, color) in [(17, WHITE), (16, WHITE), (33, &[[0.0, 1.0, 0.0, 0.5], [1.0, 0.2, 1.0, 0.5]])] {
                for (view, is_perspective) in views(target, side) {
                    let plan = plan(view, color, &[[0.0, EXTINCTION], [1.0, 2.0 * EXTINCTION]]);
                    for integration in [Integration::Exact, Integration::Average] {
                        let fast = Renderer::Fast(integration).draw(&mesh, &SCALARS, &plan);
                        let slow = Renderer::Reference(integration).draw(&mesh, &SCALARS, &plan);
                        assert!(slow.pixels().iter().any(|p| p[3] > 0.1), "{:?} shows nothing", case.class);
                        worst.note(largest(&fast, &slow, 0..4), || {
                            format!("{:?}, above {target}, {side} pixels, perspective {is_perspective}", case.class)
                        });
                    }
                }
            }
        }
    }
    worst.finish();
}

/// The thick vertex in the middle of the picture: opacity `1 - exp(-rho l)` of its chord.
///
/// In classes 3 and 4 the thick vertex lies on the outline, where a pixel may show nothing, so there the middle is moved by a
/// quarter of the way to the opposite edge of the fan: in a parallel view 3/4 of the chord are left.
#[test]
fn opacity_at_the_thick_vertex_is_that_of_its_chord() {
    let mut worst = Worst::new("opacity at the thick vertex", 1e-6);
    for case in CASES {
        let corners = corners(case);
        let mesh = TetMesh::from_tetrahedra(&corners, &[[0, 1, 2, 3]]).unwrap().mesh;
        let is_on_outline =
            matches!(case.class, ProjectionClass::ThreeA | ProjectionClass::ThreeB | ProjectionClass::Four);
        let from_above = tetrascope::classify::Viewpoint::Direction(DVec3::NEG_Z);
        let shown = project(&corners, &SCALARS, [0, 1, 2, 3], from_above);
        assert_eq!(shown.class, case.class);
        let thick = shown.thick.expect("the case has a thick vertex");
        let (middle, share) = if is_on_outline {
            let ring: Vec<DVec3> = match case.class {
                // Towards the corner that is seen edge-on, between the pair.
                ProjectionClass::ThreeA | ProjectionClass::ThreeB => vec![corners[shown_zero(&shown.fan)]],
                _ => shown.fan.as_slice()[1..].iter().map(|v| corners[corner(*v)]).collect(),
            };
            let across = ring.iter().sum::<DVec3>() / ring.len() as f64;
            (thick.near.lerp(across, 0.25), 0.75)
        } else {
            (thick.near, 1.0)
        };
        let expected = -(-EXTINCTION * share * thick.chord_length).exp_m1();
        for renderer in Renderer::EXACT {
            let [(view, _), (perspective, _)] = views(middle, 21);
            let image = renderer.draw(&mesh, &SCALARS, &plan(view, WHITE, &[[0.0, EXTINCTION]]));
            let found = f64::from(image.pixel(10, 10)[3]);
            worst.note((found - expected).abs(), || format!("{:?}, {renderer:?}: {found} not {expected}", case.class));

            // The middle ray is the same in perspective.
            let image = renderer.draw(&mesh, &SCALARS, &plan(perspective, WHITE, &[[0.0, EXTINCTION]]));
            let found = f64::from(image.pixel(10, 10)[3]);
            worst.note((found - expected).abs(), || {
                format!("{:?}, {renderer:?}, perspective: {found} not {expected}", case.class)
            });
        }
    }
    worst.finish();
}

fn corner(vertex: tetrascope::classify::FanVertex) -> usize {
    match vertex {
        tetrascope::classify::FanVertex::Corner(corner) => corner,
        tetrascope::classify::FanVertex::Thick => unreachable!("only the first vertex is thick"),
    }
}

/// The corner between the pair in a fan of class 3: T; p, z, q.
fn shown_zero(fan: &tetrascope::classify::Fan) -> usize {
    corner(fan.as_slice()[2])
}

/// Two cells that share the face which the view sees edge-on: pixels in it show the one or the other, never both or none.
#[test]
fn a_face_seen_edge_on_belongs_to_one_cell() {
    let mut worst = Worst::new("two cells of a face seen edge-on", 1e-6);
    // The face x = 0, seen along z; left and right of it a corner.
    let points = [
        DVec3::new(0.0, -2.0, 0.0),
        DVec3::new(0.0, 2.0, 0.0),
        DVec3::new(0.0, 0.0, 3.0),
        DVec3::X * 3.0,
        DVec3::X * -3.0,
    ];
    let both = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3], [0, 1, 2, 4]]).unwrap().mesh;
    let chord = |y: f64| (3.0 - 1.5 * y.abs()).max(0.0);
    for renderer in Renderer::EXACT {
        for side in [17, 33, 65] {
            let camera = Camera {
                eye: DVec3::Z * 9.0,
                target: DVec3::ZERO,
                up: DVec3::Y,
                projection: Projection::Orthographic { height: 4.25 },
            };
            let view = View::new(&camera, side, side).unwrap();
            let image = renderer.draw(&both, &[0.0; 5], &plan(view, WHITE, &[[0.0, EXTINCTION]]));
            for row in 0..side {
                let y = (f64::from(row) + 0.5 - f64::from(side) / 2.0) * 4.25 / f64::from(side);
                let expected = -(-EXTINCTION * chord(y)).exp_m1();
                let found = f64::from(image.pixel(side / 2, row)[3]);
                worst.note((found - expected).abs(), || {
                    format!("{renderer:?}, row {row} of {side}: {found} not {expected}")
                });
            }
        }
    }
    worst.finish();
}
