//! Fans and thick vertices against rays clipped by the cell.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use tetrascope_view::Viewpoint;

use super::{
    cell, clip, direction, field_at, hull_area, line_of_sight, on_screen, point, ray_of, scalars, turn, viewpoint,
};
use crate::{FanVertex, Projected, ProjectionClass, SignedVolumes, by_planes, project};

const IDS: [u32; 4] = [0, 1, 2, 3];

/// Where a fan's vertex lies on the screen; in class 2 that of the thick vertex's ray.
fn place(shown: &Projected, positions: &[DVec3; 4], viewpoint: Viewpoint, vertex: FanVertex) -> DVec2 {
    match vertex {
        FanVertex::Corner(corner) => on_screen(positions[corner], viewpoint),
        FanVertex::Thick => {
            let thick = shown.thick.unwrap();
            on_screen(thick.corner.map_or(thick.near, |corner| positions[corner]), viewpoint)
        }
    }
}

/// A cell seen along z whose projection has the given class, and its expected thick chord.
#[test]
fn known_chords() {
    let look = Viewpoint::Direction(DVec3::Z);
    let cases = [
        // Apex towards the eye above the middle of a triangle; the same from behind.
        ([[1.0, 1.0, 0.0], [0.0, 0.0, 2.0], [0.0, 3.0, 2.0], [3.0, 0.0, 2.0]], ProjectionClass::OneA, 2.0),
        ([[1.0, 1.0, 2.0], [0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0]], ProjectionClass::OneB, 2.0),
        ([[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 3.0], [0.0, 2.0, 3.0]], ProjectionClass::Two, 3.0),
        ([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 2.0, 1.0], [2.0, 0.0, 1.0]], ProjectionClass::ThreeA, 1.0),
        ([[1.0, 0.0, 1.0], [0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]], ProjectionClass::ThreeB, 1.0),
        ([[0.0, 0.0, 0.0], [0.0, 0.0, 5.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]], ProjectionClass::Four, 5.0),
    ];
    for (positions, class, chord) in cases {
        let positions = super::oriented(positions.map(DVec3::from_array));
        let shown = project(&positions, &[0.0; 4], IDS, look);
        assert_eq!(shown.class, class);
        let thick = shown.thick.unwrap();
        assert_eq!(thick.chord_length, chord, "{class:?}");
        assert_eq!(thick.far - thick.near, DVec3::new(0.0, 0.0, chord), "{class:?}");
        assert_eq!(thick.corner.is_none(), class == ProjectionClass::Two);
        assert_eq!(shown.fan.triangles().count(), class.triangle_count());
    }
}

#[test]
fn nothing_to_draw() {
    let eye = Viewpoint::Eye(DVec3::new(5.0, 6.0, 7.0));
    let inverted = [DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::Z];
    let flat = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
    let point = [DVec3::ONE; 4];
    let not_a_number = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.0, f64::NAN, 1.0)];
    for positions in [inverted, flat, point, not_a_number] {
        for viewpoint in [eye, Viewpoint::Direction(DVec3::Z)] {
            let shown = project(&positions, &[1.0; 4], IDS, viewpoint);
            assert_eq!(shown.class, ProjectionClass::Degenerate);
            assert!(shown.thick.is_none() && shown.fan.as_slice().is_empty());
            assert!(shown.attributes(FanVertex::Thick, &[1.0; 4]).is_none());
        }
    }
}

/// Close to the eye the thick vertex's chord is not the longest: two faces that part like rays leave more beside it.
#[test]
fn perspective_chords_beside_the_thick_vertex_can_be_longer() {
    let along = |slope: f64| DVec3::new(1.0, 0.0, slope).normalize();
    let positions = super::oriented([
        DVec3::new(0.0, 0.0, 1.0),
        DVec3::new(0.0, 0.0, 2.0),
        DVec3::new(10.0, -1.0, 11.0),
        DVec3::new(10.0, 1.0, 11.0),
    ]);
    let shown = project(&positions, &[0.0; 4], IDS, Viewpoint::Eye(DVec3::ZERO));
    assert_eq!(shown.class, ProjectionClass::Four);
    assert!((shown.thick.unwrap().chord_length - 1.0).abs() < 1e-15);
    let (enter, leave) = clip(&positions, DVec3::ZERO, along(1.2)).unwrap();
    assert!(leave - enter > 2.5, "{}", leave - enter);
}

/// Volumes that are all rounding, as of a flat cell seen along its plane, may ask for any length.
#[test]
fn made_up_volumes_give_no_chord_beyond_the_cell() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let volumes = SignedVolumes { a: [1e-20, -1e-20, 0.0, 0.0], six_volume: 1e-18 };
    let shown = Projected::from_volumes(volumes, &positions, &[0.0; 4], Viewpoint::Direction(DVec3::X));
    assert_eq!(shown.thick.unwrap().chord_length, 2.0_f64.sqrt());
}

#[test]
fn eye_on_the_boundary_is_inside() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let quarter = DVec3::splat(0.25);
    for (eye, is_inside) in [
        (quarter, true),
        (DVec3::new(0.25, 0.25, 0.0), true),
        (DVec3::new(0.5, 0.0, 0.0), true),
        (DVec3::ZERO, true),
        (DVec3::new(0.25, 0.25, -1e-300), false),
        (DVec3::new(-1e-300, 0.0, 0.0), false),
    ] {
        let shown = project(&positions, &[0.0; 4], IDS, Viewpoint::Eye(eye));
        assert_eq!(shown.class == ProjectionClass::EyeInside, is_inside, "{eye}");
        assert_eq!(shown.thick.is_none(), is_inside, "{eye}");
    }
    // No direction is inside.
    let wrong = SignedVolumes { a: [1.0, 1.0, 0.0, 0.0], six_volume: 1.0 };
    let shown = Projected::from_volumes(wrong, &positions, &[0.0; 4], Viewpoint::Direction(DVec3::Z));
    assert_eq!(shown.class, ProjectionClass::Degenerate);
}

proptest! {
    /// The ends of the chord are where its ray meets the planes, and the field there is the cell's.
    #[test]
    fn thick_vertex_is_the_clipped_ray(positions in cell(), scalars in scalars(), viewpoint in viewpoint()) {
        let thick = project(&positions, &scalars, IDS, viewpoint).thick.unwrap();
        let (origin, ray) = match viewpoint {
            Viewpoint::Eye(eye) => (eye, thick.ray),
            Viewpoint::Direction(direction) => (thick.near - 10.0 * direction, direction),
        };
        // The ray may run along an edge, where rounding decides whether it meets the cell: move it inwards by 1e-9.
        let inwards = positions.iter().sum::<DVec3>() / 4.0 - thick.near;
        let (enter, leave) = clip(&positions, origin, ray + 1e-9 * inwards).unwrap();
        prop_assert!(((leave - enter) * ray.length() - thick.chord_length).abs() < 1e-5);
        prop_assert!((origin + enter * ray - thick.near).length() < 1e-5);
        prop_assert!((origin + leave * ray - thick.far).length() < 1e-5);
        prop_assert!((thick.near.distance(thick.far) - thick.chord_length).abs() < 1e-12);
        prop_assert!((thick.far - thick.near).dot(ray) > 0.0);
        prop_assert!((field_at(&positions, &scalars, thick.near) - thick.scalar_front).abs() < 1e-9);
        prop_assert!((field_at(&positions, &scalars, thick.far) - thick.scalar_back).abs() < 1e-9);
    }

    /// Line through the lone corner and plane of the three others; line closest to two lines: the papers' constructions.
    #[test]
    fn thick_vertex_is_the_papers_intersection(positions in cell(), viewpoint in viewpoint()) {
        let shown = project(&positions, &[0.0; 4], IDS, viewpoint);
        let classified = by_planes(shown.volumes.signs());
        let thick = shown.thick.unwrap();
        let meet_plane = |[p, q, r]: [DVec3; 3], origin: DVec3, ray: DVec3| {
            let normal = (q - p).cross(r - p);
            origin + ray * (normal.dot(p - origin) / normal.dot(ray))
        };
        let toward = |p: DVec3| match viewpoint {
            Viewpoint::Eye(eye) => p - eye,
            Viewpoint::Direction(direction) => direction,
        };
        let (plus, minus) = (classified.plus.as_slice(), classified.minus.as_slice());
        let lone_and_face = |lone: usize, others: &[usize]| {
            let face = [positions[others[0]], positions[others[1]], positions[others[2]]];
            (positions[lone], meet_plane(face, positions[lone], toward(positions[lone])))
        };
        let (near, far) = match shown.class {
            ProjectionClass::OneA => lone_and_face(plus[0], minus),
            ProjectionClass::OneB => {
                let (far, near) = lone_and_face(minus[0], plus);
                (near, far)
            }
            ProjectionClass::Two => {
                // Each edge meets the plane that the other one spans with the viewpoint.
                let meet = |edge: &[usize], other: &[usize]| {
                    let [p, q] = [positions[edge[0]], positions[edge[1]]];
                    let [r, s] = [positions[other[0]], positions[other[1]]];
                    meet_plane([r, s, r + toward(r)], p, q - p)
                };
                (meet(plus, minus), meet(minus, plus))
            }
            _ => return Ok(()),
        };
        prop_assert!(near.distance(thick.near) < 1e-9, "{} {}", near, thick.near);
        prop_assert!(far.distance(thick.far) < 1e-9, "{} {}", far, thick.far);
    }

    /// Orthographic: no chord is longer. Perspective: no difference of inverse depths is larger.
    #[test]
    fn no_ray_is_thicker(
        positions in cell(), viewpoint in viewpoint(), inside in prop::array::uniform32(prop::array::uniform4(0.0..1.0_f64)),
    ) {
        let shown = project(&positions, &[0.0; 4], IDS, viewpoint);
        let most = match viewpoint {
            Viewpoint::Eye(eye) => {
                let forward = line_of_sight(viewpoint);
                shown.screen_attributes(FanVertex::Thick, &positions, &[0.0; 4], eye, forward).unwrap().dq
            }
            Viewpoint::Direction(_) => shown.thick.unwrap().chord_length,
        };
        for weights in inside {
            let sum: f64 = weights.iter().sum::<f64>() + 1e-9;
            let at = positions.iter().zip(weights).map(|(p, weight)| *p * (weight / sum)).sum::<DVec3>();
            let (origin, ray) = ray_of(on_screen(at, viewpoint), viewpoint);
            let Some((enter, leave)) = clip(&positions, origin, ray) else { continue };
            let thickness = match viewpoint {
                Viewpoint::Eye(_) => enter.recip() - leave.recip(),
                Viewpoint::Direction(_) => leave - enter,
            };
            prop_assert!(thickness <= most * (1.0 + 1e-9));
        }
    }

    /// Areas add up to the hull's, and points of the hull are in one triangle each.
    #[test]
    fn fan_covers_the_silhouette_once(
        positions in cell(), viewpoint in viewpoint(), picks in prop::array::uniform32(prop::array::uniform4(0.01..1.0_f64)),
    ) {
        let shown = project(&positions, &[0.0; 4], IDS, viewpoint);
        let triangles: Vec<[DVec2; 3]> = shown
            .fan.triangles().map(|triangle| triangle.map(|vertex| place(&shown, &positions, viewpoint, vertex))).collect();
        // Counterclockwise as seen is negative with y down.
        let areas: Vec<f64> = triangles.iter().map(|&[p, q, r]| -turn(p, q, r)).collect();
        let points = positions.map(|p| on_screen(p, viewpoint));
        let hull = hull_area(&points);
        prop_assert!(areas.iter().all(|area| *area > -1e-12 * hull), "{:?}", areas);
        prop_assert!((areas.iter().sum::<f64>() - hull).abs() < 1e-12 * hull.max(1.0));
        for weights in picks {
            let sum: f64 = weights.iter().sum();
            let at = points.iter().zip(weights).map(|(p, weight)| *p * (weight / sum)).sum::<DVec2>();
            let sides = triangles.iter().map(|&[p, q, r]| [-turn(p, q, at), -turn(q, r, at), -turn(r, p, at)]);
            let least: Vec<f64> = sides.map(|sides| sides.into_iter().fold(f64::INFINITY, f64::min)).collect();
            if least.iter().all(|side| side.abs() > 1e-12) {
                prop_assert_eq!(least.iter().filter(|side| **side > 0.0).count(), 1);
            }
        }
    }

    /// The chord has no length on the outline of the fan.
    #[test]
    fn chord_vanishes_on_the_silhouette(positions in cell(), viewpoint in viewpoint(), fraction in 0.1..0.9_f64) {
        let shown = project(&positions, &[0.0; 4], IDS, viewpoint);
        let thick = shown.thick.unwrap();
        for triangle in shown.fan.triangles() {
            let [center, q, r] = triangle.map(|vertex| place(&shown, &positions, viewpoint, vertex));
            let (origin, ray) = ray_of(q.lerp(r, fraction), viewpoint);
            let (enter, leave) = clip(&positions, origin, ray).unwrap_or((0.0, 0.0));
            // Rounding puts the ray beside the outline, and the chord grows towards the center with this slope.
            let slope = thick.chord_length * q.distance(r) / turn(center, q, r).abs();
            prop_assert!((leave - enter) * ray.length() < 1e-11 * (1.0 + slope));
        }
    }

    /// Inside of a fan's triangle the attributes, interpolated linearly on the screen, are those of the ray.
    #[test]
    fn attributes_are_linear_on_the_screen(
        positions in cell(), scalars in scalars(), viewpoint in viewpoint(), weights in prop::array::uniform3(0.05..1.0_f64),
    ) {
        let shown = project(&positions, &scalars, IDS, viewpoint);
        let forward = line_of_sight(viewpoint);
        let weights = weights.map(|weight| weight / weights.iter().sum::<f64>());
        for triangle in shown.fan.triangles() {
            let places = triangle.map(|vertex| place(&shown, &positions, viewpoint, vertex));
            if turn(places[0], places[1], places[2]).abs() < 1e-4 {
                continue;
            }
            let at = (0..3).map(|i| places[i] * weights[i]).sum::<DVec2>();
            let (origin, ray) = ray_of(at, viewpoint);
            let (enter, leave) = clip(&positions, origin, ray).unwrap();
            let mean = |values: [f64; 3]| (0..3).map(|i| values[i] * weights[i]).sum::<f64>();
            let (chord, front, back) = match viewpoint {
                Viewpoint::Eye(eye) => {
                    let all = triangle.map(|vertex| {
                        shown.screen_attributes(vertex, &positions, &scalars, eye, forward).unwrap()
                    });
                    let (dq, q_front) = (mean(all.map(|a| a.dq)), mean(all.map(|a| a.q_front)));
                    let q_back = q_front - dq;
                    (
                        ray.length() * dq / (q_front * q_back),
                        mean(all.map(|a| a.u_front)) / q_front,
                        mean(all.map(|a| a.u_back)) / q_back,
                    )
                }
                Viewpoint::Direction(_) => {
                    let all = triangle.map(|vertex| shown.attributes(vertex, &scalars).unwrap());
                    (
                        mean(all.map(|a| a.chord_length)),
                        mean(all.map(|a| a.scalar_front)),
                        mean(all.map(|a| a.scalar_back)),
                    )
                }
            };
            prop_assert!(((leave - enter) * ray.length() - chord).abs() < 1e-9);
            prop_assert!((field_at(&positions, &scalars, origin + enter * ray) - front).abs() < 1e-7);
            prop_assert!((field_at(&positions, &scalars, origin + leave * ray) - back).abs() < 1e-7);
        }
    }

    /// Flipping the sign of a tiny volume, as rounding may, changes little.
    #[test]
    fn continuous_across_classes(
        positions in cell(), viewpoint in viewpoint(), corner in 0_usize..4, exponent in -14.0..-4.0_f64,
    ) {
        // Bring the viewpoint close to the plane of a face.
        let [p, q, r] = crate::FACES[corner].map(|corner| positions[corner]);
        let normal = (q - p).cross(r - p).normalize();
        let slip = 10.0_f64.powf(exponent);
        let viewpoint = match viewpoint {
            Viewpoint::Eye(eye) => Viewpoint::Eye(eye - normal * (normal.dot(eye - p) - slip)),
            Viewpoint::Direction(way) => Viewpoint::Direction((way - normal * (normal.dot(way) - slip)).normalize()),
        };
        let volumes = SignedVolumes::new(&positions, IDS, viewpoint);
        let mut flipped = volumes;
        flipped.a[corner] = -flipped.a[corner];
        let scalars = [0.0, 1.0, -2.0, 5.0];
        let shown = Projected::from_volumes(volumes, &positions, &scalars, viewpoint);
        let other = Projected::from_volumes(flipped, &positions, &scalars, viewpoint);
        let (Some(thick), Some(other)) = (shown.thick, other.thick) else {
            // The eye came to lie inside, or the face was the only one of its sign.
            return Ok(());
        };
        let tiny = volumes.a[corner].abs();
        let (plus, minus) =
            (volumes.sum_plus().min(flipped.sum_plus()), volumes.sum_minus().min(flipped.sum_minus()));
        prop_assume!(tiny < 0.01 * plus.min(minus));
        let change = (other.chord_length / thick.chord_length - 1.0).abs();
        // From l = |Σ_P A v| 6V / (S_P S_N), term by term, and a little for the second order.
        let ratio = match viewpoint {
            Viewpoint::Eye(eye) => positions[corner].distance(eye) / thick.ray.length(),
            Viewpoint::Direction(_) => 1.0,
        };
        let bound = tiny * (1.0 / minus + (1.0 + ratio) / plus);
        prop_assert!(change <= 1.1 * bound + 1e-13, "{} for {}", change, bound);
        // The plain bound, for cells that are not large beside their distance.
        let longest = (0..4).flat_map(|i| (0..i).map(move |j| positions[i].distance(positions[j]))).fold(0.0, f64::max);
        let is_distant = match viewpoint {
            Viewpoint::Eye(_) => thick.ray.length() >= 5.0 * longest,
            Viewpoint::Direction(_) => true,
        };
        if is_distant {
            let share = tiny / volumes.a.iter().map(|a| a.abs()).sum::<f64>();
            prop_assert!(change <= 3.0 * share + 1e-13, "{} for {}", change, share);
        }
        // A mean of scalars within a range of 7 that gains or loses a term.
        prop_assert!((other.scalar_front - thick.scalar_front).abs() <= 7.0 * tiny / plus + 1e-13);
        prop_assert!((other.scalar_back - thick.scalar_back).abs() <= 7.0 * tiny / minus + 1e-13);
    }

    #[test]
    fn eye_inside(positions in cell(), weights in prop::array::uniform4(0.01..1.0_f64)) {
        let sum: f64 = weights.iter().sum();
        let eye = positions.iter().zip(weights).map(|(p, weight)| *p * (weight / sum)).sum::<DVec3>();
        let shown = project(&positions, &[0.0; 4], IDS, Viewpoint::Eye(eye));
        prop_assert_eq!(shown.class, ProjectionClass::EyeInside);
        prop_assert!(shown.thick.is_none() && shown.fan.as_slice().is_empty());
    }

    /// Eyes anywhere, among the corners too: no division by depth makes a case of cells behind the eye.
    #[test]
    fn thick_vertex_around_the_eye(positions in cell(), eye in point()) {
        let shown = project(&positions, &[0.0; 4], IDS, Viewpoint::Eye(eye));
        let Some(thick) = shown.thick else {
            prop_assert!(clip(&positions, eye, DVec3::X).is_some_and(|(enter, leave)| enter < 0.0 && leave > 0.0));
            return Ok(());
        };
        let inwards = positions.iter().sum::<DVec3>() / 4.0 - thick.near;
        let (enter, leave) = clip(&positions, eye, thick.ray + 1e-9 * inwards).unwrap();
        prop_assert!(enter > 0.0);
        prop_assert!(((leave - enter) * thick.ray.length() - thick.chord_length).abs() < 1e-4);
    }

    #[test]
    fn orthographic_is_the_limit_of_perspective(positions in cell(), scalars in scalars(), way in direction()) {
        let flat = project(&positions, &scalars, IDS, Viewpoint::Direction(way));
        let least = flat.volumes.a.iter().fold(f64::INFINITY, |least, a| least.min(a.abs()));
        prop_assume!(least > 1e-3);
        let reference = flat.thick.unwrap();
        for distance in [1e5, 1e6, 1e7] {
            let far = project(&positions, &scalars, IDS, Viewpoint::Eye(-way * distance));
            prop_assert_eq!((far.class, far.fan), (flat.class, flat.fan));
            let thick = far.thick.unwrap();
            // First order in size over distance, over the smallest share of the volumes.
            let bound = 1e5 / distance;
            prop_assert!((thick.chord_length / reference.chord_length - 1.0).abs() < 1e-2 * bound);
            prop_assert!((thick.scalar_front - reference.scalar_front).abs() < bound);
            prop_assert!(thick.near.distance(reference.near) < 1e-1 * bound);
        }
    }

    /// Scales by powers of two change no bit, others nothing but rounding; so do offsets as far as positions allow.
    #[test]
    fn scales_and_offsets(positions in cell(), scalars in scalars(), viewpoint in viewpoint()) {
        let reference = project(&positions, &scalars, IDS, viewpoint);
        let least = reference.volumes.a.iter().fold(f64::INFINITY, |least, a| least.min(a.abs()));
        prop_assume!(least > 1e-3);
        let expected = reference.thick.unwrap();
        let cases = [
            (1e-9, 0.0, 1e-11), (1e9, 0.0, 1e-11), (2.0_f64.powi(40), 0.0, 0.0), (2.0_f64.powi(-200), 0.0, 0.0),
            (1.0, 1e6, 1e-5), (1e3, 1e6, 1e-8),
        ];
        for (scale, offset, tolerance) in cases {
            let moved = |p: DVec3| p * scale + DVec3::splat(offset);
            let viewpoint = match viewpoint {
                Viewpoint::Eye(eye) => Viewpoint::Eye(moved(eye)),
                Viewpoint::Direction(_) => viewpoint,
            };
            let shown = project(&positions.map(moved), &scalars, IDS, viewpoint);
            prop_assert_eq!((shown.class, shown.fan), (reference.class, reference.fan));
            let thick = shown.thick.unwrap();
            prop_assert!((thick.chord_length / scale / expected.chord_length - 1.0).abs() <= tolerance);
            prop_assert!((thick.scalar_front - expected.scalar_front).abs() <= 20.0 * tolerance);
            prop_assert!((thick.scalar_back - expected.scalar_back).abs() <= 20.0 * tolerance);
        }
    }

    /// Slivers a millionth as high as wide, and cells flatter still: finite, bounded, ordered.
    #[test]
    fn slivers_stay_bounded(
        p in prop::array::uniform4(point()), height in -18.0..-5.0_f64, scalars in scalars(), viewpoint in viewpoint(),
    ) {
        let height = 10.0_f64.powf(height);
        let positions = super::oriented(p.map(|p| DVec3::new(p.x, p.y, p.z * height)));
        let shown = project(&positions, &scalars, IDS, viewpoint);
        if let Some(thick) = shown.thick {
            prop_assert!(thick.chord_length >= 0.0 && thick.chord_length <= 12.0_f64.sqrt());
            for scalar in [thick.scalar_front, thick.scalar_back] {
                prop_assert!(scalars.iter().any(|s| *s <= scalar) && scalars.iter().any(|s| *s >= scalar));
            }
        }
    }

    #[test]
    fn equal_scalars_stay_equal(positions in cell(), viewpoint in viewpoint(), scalar in -1e9..1e9_f64) {
        let thick = project(&positions, &[scalar; 4], IDS, viewpoint).thick.unwrap();
        prop_assert_eq!((thick.scalar_front, thick.scalar_back), (scalar, scalar));
    }
}
