//! Signs: against exact integers, between neighbors, under relabeling, a few ulp beside degenerate positions.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use tetrascope_view::Viewpoint;

use super::{cell, on_screen, permutations, point, scalars, viewpoint};
use crate::{
    FACES, ProjectionClass, Sign, SignedVolumes, TableEntry, Tests, by_planes, exact_orientation, exact_signs, project,
};

type Integers = [i128; 3];

fn det(u: Integers, v: Integers, w: Integers) -> i128 {
    u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0])
}

fn minus(p: Integers, q: Integers) -> Integers {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

fn sign(value: i128) -> Sign {
    Sign::of(value.signum() as f64)
}

fn floats(p: Integers) -> DVec3 {
    DVec3::new(p[0] as f64, p[1] as f64, p[2] as f64)
}

fn integer_point(limit: i128) -> impl Strategy<Value = Integers> {
    prop::array::uniform3(-limit..=limit)
}

/// A float some units in the last place away.
fn nudged(value: f64, ulps: i64) -> f64 {
    f64::from_bits(value.to_bits().wrapping_add_signed(ulps))
}

/// Whether flipping what rounding got wrong can be seen: only volumes below the rounding of their terms may differ.
fn differ_only_by_rounding(volumes: &SignedVolumes, exact: [Sign; 4], bound: f64) -> bool {
    volumes.a.iter().zip(exact).all(|(a, exact)| Sign::of(*a) == exact || a.abs() <= bound)
}

/// The definition in words: six times the volume of the cell with the eye in a corner's place.
#[test]
fn volumes_known_cell() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let volumes = SignedVolumes::new(&positions, [0, 1, 2, 3], Viewpoint::Eye(DVec3::new(-2.0, 0.25, 0.5)));
    assert_eq!(volumes, SignedVolumes { a: [2.25, -2.0, 0.25, 0.5], six_volume: 1.0 });
    let volumes = SignedVolumes::new(&positions, [0, 1, 2, 3], Viewpoint::Direction(DVec3::X));
    assert_eq!(volumes, SignedVolumes { a: [1.0, -1.0, 0.0, 0.0], six_volume: 1.0 });
    assert_eq!(by_planes(volumes.signs()).class, ProjectionClass::Four);
}

proptest! {
    #[test]
    fn lattice_signs_are_those_of_integers(
        p in prop::array::uniform4(integer_point(3)), eye in integer_point(4), far in integer_point(3),
    ) {
        let positions = p.map(floats);
        let by_eye = FACES.map(|[i, j, k]| sign(det(minus(p[j], p[i]), minus(p[k], p[i]), minus(p[i], eye))));
        let by_direction = FACES.map(|[i, j, k]| sign(det(minus(p[j], p[i]), minus(p[k], p[i]), far)));
        for (viewpoint, expected) in
            [(Viewpoint::Eye(floats(eye)), by_eye), (Viewpoint::Direction(floats(far)), by_direction)]
        {
            prop_assert_eq!(SignedVolumes::new(&positions, [0, 1, 2, 3], viewpoint).signs(), expected);
            prop_assert_eq!(exact_signs(&positions, viewpoint), expected);
        }
        let volume = sign(det(minus(p[1], p[0]), minus(p[2], p[0]), minus(p[3], p[0])));
        prop_assert_eq!(exact_orientation(&positions), volume);
        let shown = project(&positions, &[0.0; 4], [0, 1, 2, 3], Viewpoint::Eye(floats(eye)));
        if volume != Sign::Positive {
            prop_assert_eq!(shown.class, ProjectionClass::Degenerate);
        } else {
            // In exact arithmetic: no negative volume if and only if the eye is in the closed cell.
            let is_inside = !by_eye.contains(&Sign::Negative);
            prop_assert_eq!(shown.class == ProjectionClass::EyeInside, is_inside);
            prop_assert!(shown.class != ProjectionClass::Degenerate);
        }
    }

    /// Lattice cells along an axis: planes and cross products give the same entry, degenerate ones included.
    #[test]
    fn planes_agree_with_cross_products_on_the_lattice(
        p in prop::array::uniform4(integer_point(2)), eye in integer_point(2),
    ) {
        let positions = p.map(floats);
        let viewpoint = Viewpoint::Direction(DVec3::Z);
        let tests = Tests::of(&positions.map(DVec3::truncate));
        prop_assert_eq!(tests.signs(), SignedVolumes::new(&positions, [0, 1, 2, 3], viewpoint).signs());
        // Perspective with depths that are powers of two, so that the projection is exact.
        let eye = DVec3::new(eye[0] as f64, eye[1] as f64, -16.0);
        let depths = p.map(|p| 2.0_f64.powi(p[2] as i32));
        let positions: [DVec3; 4] =
            std::array::from_fn(|i| DVec3::new(eye.x + p[i][0] as f64, eye.y + p[i][1] as f64, eye.z + depths[i]));
        let screen: [DVec2; 4] = std::array::from_fn(|i| (positions[i] - eye).truncate() / depths[i]);
        let tests = Tests::of(&screen);
        prop_assert_eq!(tests.signs(), SignedVolumes::new(&positions, [0, 1, 2, 3], Viewpoint::Eye(eye)).signs());
        if exact_orientation(&positions) == Sign::Positive {
            let class = project(&positions, &[0.0; 4], [0, 1, 2, 3], Viewpoint::Eye(eye)).class;
            match *tests.entry() {
                TableEntry::Valid { class: by_table, .. } => prop_assert_eq!(by_table, class),
                TableEntry::Degenerate => prop_assert_eq!(ProjectionClass::Degenerate, class),
                TableEntry::Impossible => prop_assert!(false, "no points do that"),
            }
        }
    }

    /// Random cells and views, camera coordinates and all.
    #[test]
    fn planes_agree_with_cross_products(positions in cell(), viewpoint in viewpoint()) {
        let shown = project(&positions, &[0.0; 4], [0, 1, 2, 3], viewpoint);
        let least = shown.volumes.a.iter().fold(f64::INFINITY, |least, a| least.min(a.abs()));
        prop_assume!(least > 1e-10);
        let entry = *Tests::of(&positions.map(|p| on_screen(p, viewpoint))).entry();
        prop_assert_eq!(entry, TableEntry::Valid { class: shown.class, fan: shown.fan });
        prop_assert_eq!(exact_signs(&positions, viewpoint), shown.volumes.signs());
    }

    /// Corners on one another and on edges of the projection, some nudged by up to 1000 ulp: exact signs of planes are
    /// exact signs of cross products, and floats differ from them only in volumes that are rounding.
    #[test]
    fn planes_agree_with_cross_products_within_ulps(
        p in prop::array::uniform4(integer_point(2)), slips in prop::array::uniform4(prop::array::uniform2(-1000_i64..=1000)),
        are_nudged in prop::array::uniform4(any::<bool>()), scale in prop::sample::select(vec![1.0, 1e-9, 1e9]),
    ) {
        let positions: [DVec3; 4] = std::array::from_fn(|i| {
            let at = (floats(p[i]) + DVec3::new(3.1, 3.7, 0.0)) * scale;
            let [x, y] = if are_nudged[i] { slips[i] } else { [0; 2] };
            DVec3::new(nudged(at.x, x), nudged(at.y, y), at.z)
        });
        let viewpoint = Viewpoint::Direction(DVec3::Z);
        let exact = exact_signs(&positions, viewpoint);
        let tests = Tests::exact(&positions.map(DVec3::truncate));
        prop_assert_eq!(tests.signs(), exact);
        prop_assert!(*tests.entry() != TableEntry::Impossible);
        let volumes = SignedVolumes::new(&positions, [0, 1, 2, 3], viewpoint);
        prop_assert!(differ_only_by_rounding(&volumes, exact, 1e-14 * scale * scale), "{:?} {:?}", volumes, exact);
        if exact_orientation(&positions) == Sign::Positive {
            // Whatever rounding made of it can be drawn: no thick vertex without fan, no length that is not one.
            let shown = project(&positions, &[1.0; 4], [0, 1, 2, 3], viewpoint);
            prop_assert_eq!(shown.thick.is_some(), shown.fan.as_slice().len() >= 3);
            if let Some(thick) = shown.thick {
                prop_assert!(thick.chord_length > 0.0 && thick.chord_length <= 7.0 * scale);
                prop_assert_eq!((thick.scalar_front, thick.scalar_back), (1.0, 1.0));
            }
        }
    }

    /// Eyes a few ulp beside the plane of a face: exact arithmetic and floats agree but for rounding.
    #[test]
    fn eye_within_ulps_of_a_face_plane(
        positions in cell(), weights in prop::array::uniform3(-3.0..3.0_f64), slips in prop::array::uniform3(-1000_i64..=1000),
    ) {
        let [p, q, r, _] = positions;
        let on_plane = p + weights[0] * (q - p) + weights[1] * (r - p);
        let eye = DVec3::from_array(std::array::from_fn(|i| nudged(on_plane[i], slips[i])));
        let viewpoint = Viewpoint::Eye(eye);
        let (volumes, exact) = (SignedVolumes::new(&positions, [0, 1, 2, 3], viewpoint), exact_signs(&positions, viewpoint));
        prop_assert!(differ_only_by_rounding(&volumes, exact, 1e-13), "{:?} {:?}", volumes, exact);
        // Σ A = 6V survives in floats.
        prop_assert!((volumes.a.iter().sum::<f64>() - volumes.six_volume).abs() < 1e-13);
    }

    /// An oblique direction, exactly within a face's plane as far as floats go: the expansion has to decide.
    #[test]
    fn exact_sign_along_a_face(p in integer_point(9), u in integer_point(9), v in integer_point(9), m in -9_i128..9, n in -9_i128..9) {
        let far: Integers = std::array::from_fn(|i| m * u[i] + n * v[i]);
        let corners = [p, std::array::from_fn(|i| p[i] + u[i]), std::array::from_fn(|i| p[i] + v[i])].map(floats);
        let tenths = corners.map(|p| p * 0.5_f64.powi(3));
        let direction = floats(far);
        prop_assert_eq!(crate::exact_face_sign(tenths, Viewpoint::Direction(direction)), Sign::Zero);
        // One ulp to a side decides, as the normal's component there says.
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        for axis in 0..3 {
            let mut beside = direction;
            if beside[axis] == 0.0 {
                continue;
            }
            beside[axis] = nudged(beside[axis], 1);
            let moved = beside[axis] - direction[axis];
            let sign = crate::exact_face_sign(tenths, Viewpoint::Direction(beside));
            prop_assert_eq!(sign, Sign::of(normal[axis] * moved.signum()));
        }
    }

    /// Coordinates of 38 bits, whose products do not fit a float: within the plane, and one unit beside it.
    #[test]
    fn exact_sign_of_long_products(
        p in integer_point(1 << 38), u in integer_point(1 << 38), v in integer_point(1 << 38),
        m in -3_i128..=3, n in -3_i128..=3, beside in integer_point(1),
    ) {
        let corners = [p, std::array::from_fn(|i| p[i] + u[i]), std::array::from_fn(|i| p[i] + v[i])];
        for beside in [[0; 3], beside] {
            let far: Integers = std::array::from_fn(|i| m * u[i] + n * v[i] + beside[i]);
            let found = crate::exact_face_sign(corners.map(floats), Viewpoint::Direction(floats(far)));
            prop_assert_eq!(found, sign(det(u, v, far)));
            // The same direction as one from an eye.
            let eye: Integers = std::array::from_fn(|i| p[i] - far[i]);
            let found = crate::exact_face_sign(corners.map(floats), Viewpoint::Eye(floats(eye)));
            prop_assert_eq!(found, sign(det(u, v, far)));
        }
    }

    /// Both cells of a face see the same magnitude, bit for bit, however they number their corners.
    #[test]
    fn neighbors_see_opposite_volumes(
        positions in cell(), beyond in point(), viewpoint in viewpoint(), order in 0_usize..12,
        ids in Just([3_u32, 8, 11, 20, 7]).prop_shuffle(),
    ) {
        let [p, q, r, _] = positions;
        let volumes = SignedVolumes::new(&positions, [ids[0], ids[1], ids[2], ids[3]], viewpoint);
        let (neighbor, names) = ([p, r, q, beyond], [ids[0], ids[2], ids[1], ids[4]]);
        let order = permutations()[order];
        let other = SignedVolumes::new(&order.map(|i| neighbor[i]), order.map(|i| names[i]), viewpoint);
        let opposite = order.iter().position(|&corner| corner == 3).unwrap();
        prop_assert_eq!(volumes.a[3].to_bits(), (-other.a[opposite]).to_bits());
    }

    /// Even orders of the corners permute all results and change no bit of them.
    #[test]
    fn relabeling_is_equivariant(
        positions in cell(), scalars in scalars(), viewpoint in viewpoint(), ids in Just([3_u32, 8, 11, 20]).prop_shuffle(),
    ) {
        let shown = project(&positions, &scalars, ids, viewpoint);
        for order in permutations().into_iter().take(12) {
            let other =
                project(&order.map(|i| positions[i]), &order.map(|i| scalars[i]), order.map(|i| ids[i]), viewpoint);
            prop_assert_eq!(other.volumes.a, order.map(|i| shown.volumes.a[i]));
            prop_assert_eq!(other.volumes.six_volume, shown.volumes.six_volume);
            prop_assert_eq!(other.class, shown.class);
            let (thick, reference) = (other.thick.unwrap(), shown.thick.unwrap());
            // The order of summation is that of the corners, so that the last bits may differ.
            prop_assert!((thick.chord_length / reference.chord_length - 1.0).abs() < 1e-14);
            prop_assert!((thick.scalar_front - reference.scalar_front).abs() < 1e-13);
            prop_assert!((thick.scalar_back - reference.scalar_back).abs() < 1e-13);
            prop_assert_eq!(thick.corner.map(|corner| order[corner]), reference.corner);
        }
    }
}
