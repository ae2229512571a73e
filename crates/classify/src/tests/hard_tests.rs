//! What only rounding gives: signs that no four points have, tiny denominators, and a thick vertex between two classes.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use tetrascope_view::Viewpoint;

use super::{hull_area, oriented};
use crate::{
    FanVertex, Projected, ProjectionClass, Sign, SignedVolumes, TRUTH_TABLE, TableEntry, Tests, exact_signs, project,
};

const IDS: [u32; 4] = [0, 1, 2, 3];
const SCALARS: [f64; 4] = [0.1, 0.7, 0.4, 1.0];

fn magnitudes() -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(-300.0..300.0_f64).prop_map(|powers| powers.map(|power| 10.0_f64.powf(power)))
}

proptest! {
    /// Every combination of signs, the 30 impossible ones too, with volumes of any size that have nothing to do with the cell: a fan comes with
    /// a thick vertex or not at all, and what it has is within the cell.
    #[test]
    fn any_signs_give_a_fan_that_can_be_drawn_or_none(code in 0_usize..81, magnitudes in magnitudes(), is_perspective in any::<bool>()) {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + DVec3::new(0.3, -0.2, 4.0));
        let signs = Tests::from_code(code).signs();
        let volumes = SignedVolumes {
            a: std::array::from_fn(|i| f64::from(signs[i].value()) * magnitudes[i]),
            six_volume: 1.0,
        };
        let viewpoint = if is_perspective { Viewpoint::Eye(DVec3::ZERO) } else { Viewpoint::Direction(DVec3::Z) };
        let shown = Projected::from_volumes(volumes, &positions, &SCALARS, viewpoint);
        match TRUTH_TABLE[code] {
            TableEntry::Valid { class, fan } => {
                prop_assert_eq!((shown.class, shown.fan), (class, fan));
                let thick = shown.thick.unwrap();
                prop_assert!(thick.chord_length >= 0.0 && thick.chord_length <= 2.0_f64.sqrt(), "{:?}", thick);
                for scalar in [thick.scalar_front, thick.scalar_back] {
                    prop_assert!((0.1..=1.0).contains(&scalar), "{:?}", thick);
                }
                for end in [thick.near, thick.far] {
                    let inside = end - positions[0];
                    prop_assert!(inside.min_element() >= -1e-15 && inside.element_sum() <= 1.0 + 1e-15, "{:?}", thick);
                }
            }
            TableEntry::Degenerate | TableEntry::Impossible => {
                let is_around = is_perspective && signs.contains(&Sign::Positive);
                let class = if is_around { ProjectionClass::EyeInside } else { ProjectionClass::Degenerate };
                prop_assert_eq!(shown.class, class);
                prop_assert!(shown.thick.is_none() && shown.fan.as_slice().is_empty());
                prop_assert!(shown.attributes(FanVertex::Thick, &SCALARS).is_none());
            }
        }
    }

    /// Four points on a line but for rounding: where the rounded cross products or volumes are impossible, the exact ones are not, and the
    /// silhouette that is not drawn has no area but that of rounding.
    #[test]
    fn impossible_signs_lose_no_area(
        start in prop::array::uniform2(-1.0..1.0_f64), along in prop::array::uniform2(-1.0..1.0_f64),
        shares in prop::array::uniform4(0.0..1.0_f64), depths in prop::array::uniform4(0.0..1.0_f64),
    ) {
        let points: [DVec2; 4] = shares.map(|share| DVec2::from(start) + share * DVec2::from(along));
        let positions = oriented(std::array::from_fn(|i| points[i].extend(depths[i])));
        let look = Viewpoint::Direction(DVec3::Z);
        let screen = positions.map(DVec3::truncate);
        prop_assert!(*Tests::exact(&screen).entry() != TableEntry::Impossible);
        prop_assert_eq!(Tests::exact(&screen).signs(), exact_signs(&positions, look));
        let shown = project(&positions, &SCALARS, IDS, look);
        prop_assert_eq!(shown.thick.is_some(), !shown.fan.as_slice().is_empty());
        if shown.thick.is_none() || *Tests::of(&screen).entry() == TableEntry::Impossible {
            prop_assert!(hull_area(&screen) < 1e-15, "{}", hull_area(&screen));
        }
    }

    /// Two edges over one another at an angle down to 1e-14: the quotient of two cross products loses all digits, the means of volumes do not.
    /// The edges cross in their middles, and the chord there is the distance of the two.
    #[test]
    fn thick_vertex_between_nearly_parallel_edges(power in -14.0..-1.0_f64, turn in 0.0..6.3_f64, is_perspective in any::<bool>()) {
        let angle = 10.0_f64.powf(power);
        let (along, across) = (DVec2::from_angle(turn), DVec2::from_angle(turn).perp());
        let upper = along.extend(0.0);
        let lower = (along + angle * across).extend(0.0);
        let eye = DVec3::new(0.0, 0.0, -3.0);
        let positions = oriented([upper, -upper, lower + DVec3::Z, -lower + DVec3::Z]);
        let viewpoint = if is_perspective { Viewpoint::Eye(eye) } else { Viewpoint::Direction(DVec3::Z) };
        let shown = project(&positions, &[0.0; 4], IDS, viewpoint);
        prop_assert_eq!(shown.class, ProjectionClass::Two);
        let thick = shown.thick.unwrap();
        // Coordinates of one have an ulp of 1e-16 across, where the edges part by the angle.
        let within = 1e-14 + 4e-16 / angle;
        prop_assert!((thick.chord_length - 1.0).abs() < within, "{} of 1 at {angle:e}", thick.chord_length);
        prop_assert!(thick.near.length() < within && (thick.far - DVec3::Z).length() < within, "{:?} at {angle:e}", thick);
    }

    /// An eye at any height over a face: the sum of the volumes of faces that it sees goes to zero with the height, and the chord to the cell's.
    /// It is known as well as the height is, which has the ulp of the coordinates: to 1e-9 of itself from 1e-7.
    #[test]
    fn thick_vertex_with_the_eye_nearly_in_a_face(power in -15.0..-1.0_f64, x in 0.1..0.4_f64, y in 0.1..0.4_f64) {
        let height = 10.0_f64.powf(power);
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.25, 2.0)];
        let shown = project(&positions, &SCALARS, IDS, Viewpoint::Eye(DVec3::new(x, y, -height)));
        prop_assert_eq!(shown.class, ProjectionClass::OneB);
        let thick = shown.thick.unwrap();
        let eye = DVec3::new(x, y, 0.0);
        // From where the face is met to the apex.
        let within = 2.0 * height + 1e-14 + 1e-15 / height;
        prop_assert!((thick.chord_length - (positions[3] - eye).length()).abs() < within, "{:?}", thick);
        prop_assert!((thick.near - eye).length() < 2.0 * height + 1e-14, "{:?}", thick);
        prop_assert_eq!((thick.corner, thick.scalar_back), (Some(3), 1.0));
    }

    /// Two edges that cross where both begin: a step of any size to any side goes over into classes 1 to 4, and the thick vertex and its chord
    /// change by no more than the step.
    #[test]
    fn crossing_at_the_ends_is_continuous(power in -17.0..-1.0_f64, turn in 0.0..6.3_f64, is_perspective in any::<bool>()) {
        let viewpoint =
            if is_perspective { Viewpoint::Eye(DVec3::new(0.0, 0.0, 4.0)) } else { Viewpoint::Direction(DVec3::NEG_Z) };
        let at = |slip: DVec2| {
            let positions = [[0., 0., 0.75], [1.75, 0.25, 0.5], [0., 0., -0.75], [0.25, 1.75, -0.5]].map(DVec3::from);
            let [a, b, c, d] = positions;
            let positions = oriented([a, b, c + slip.extend(0.0), d]);
            project(&positions, &[0.5; 4], IDS, viewpoint)
        };
        let exact = at(DVec2::ZERO);
        prop_assert_eq!(exact.class, ProjectionClass::Four);
        let exact = exact.thick.unwrap();
        prop_assert_eq!(exact.chord_length, 1.5);
        let step = 10.0_f64.powf(power);
        let beside = at(DVec2::from_angle(turn) * step).thick.unwrap();
        prop_assert!((beside.chord_length - 1.5).abs() <= 8.0 * step + 1e-15, "{} at {step:e}", beside.chord_length);
        prop_assert!((beside.near - exact.near).length() <= 8.0 * step + 1e-15, "{:?} at {step:e}", beside);
        prop_assert!((beside.far - exact.far).length() <= 8.0 * step + 1e-15, "{:?} at {step:e}", beside);
    }
}

/// All the classes around a crossing at the ends: two, one, three and four meet there.
#[test]
fn crossing_at_the_ends_meets_all_classes() {
    let mut classes = Vec::new();
    let step = 2.0_f64.powi(-40);
    for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)] {
        let slip = DVec3::new(f64::from(x), f64::from(y), 0.0) * step;
        let [a, b, c, d] = [[0., 0., 0.75], [2., 0., 0.5], [0., 0., -0.75], [0., 2., -0.5]].map(DVec3::from);
        let positions = oriented([a, b, c + slip, d]);
        let shown = project(&positions, &[0.0; 4], IDS, Viewpoint::Direction(DVec3::NEG_Z));
        assert!((shown.thick.unwrap().chord_length - 1.5).abs() < 4.0 * step);
        if !classes.contains(&shown.class) {
            classes.push(shown.class);
        }
    }
    use ProjectionClass::{Four, OneA, OneB, ThreeA, ThreeB, Two};
    for class in [Two, Four] {
        assert!(classes.contains(&class), "{class:?} of {classes:?}");
    }
    assert!(classes.iter().any(|class| [OneA, OneB].contains(class)), "{classes:?}");
    assert!(classes.iter().any(|class| [ThreeA, ThreeB].contains(class)), "{classes:?}");
}
