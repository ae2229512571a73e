//! What the picture on a sheet settles is what the exact predicates say.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_view::Viewpoint;

use super::flat::{Flat, overlap_surely};
use super::overlap::{Seen, overlap};
use super::tiles::Sheets;
use crate::signs::eye_side;

/// Both triangles on the sheet that shows both of them whole, if there is one.
fn on_one_sheet(viewpoint: Viewpoint, triangles: [[DVec3; 3]; 2]) -> Option<([Flat; 2], [Seen; 2], f64)> {
    let largest = triangles.iter().flatten().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let sheets = Sheets::new(viewpoint, largest);
    let corners = triangles.concat();
    let number = |p: DVec3| corners.iter().position(|q| *q == p).unwrap_or(0) as u32;
    let seen = triangles.map(|points| Seen { points, eye_side: eye_side(points, viewpoint) });
    if seen.iter().any(|seen| seen.eye_side == 0) {
        return None;
    }
    let mut found = Vec::new();
    for seen in seen {
        sheets.project(&seen.points, |rectangle, corners| {
            let turn = if Sheets::is_mirror(rectangle.sheet) { -seen.eye_side } else { seen.eye_side };
            if rectangle.is_whole {
                found.push((rectangle.sheet, Flat::new(corners, seen.points.map(number), turn)));
            }
        });
    }
    let [(first_sheet, first), (second_sheet, second)] = found[..] else { return None };
    (first_sheet == second_sheet).then_some(([first, second], seen, sheets.rounding()))
}

fn anywhere() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0_f64).prop_map(DVec3::from)
}

/// Few places, so that corners coincide and lines run through corners; far from the origin, so that rounding bites.
fn on_lattice() -> impl Strategy<Value = DVec3> {
    (-2..3_i32, -2..3_i32, -2..3_i32)
        .prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into()) * 0.3 + DVec3::splat(1e5))
}

fn check(viewpoint: Viewpoint, triangles: [[DVec3; 3]; 2]) -> Result<(), TestCaseError> {
    let Some(([a, b], [first, second], rounding)) = on_one_sheet(viewpoint, triangles) else { return Ok(()) };
    if let Some(overlaps) = overlap_surely(&a, &b, rounding) {
        prop_assert_eq!(overlaps, overlap(viewpoint, &first, &second, true));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn sure_answers_are_exact(
        first in [anywhere(), anywhere(), anywhere()], second in [anywhere(), anywhere(), anywhere()], way in anywhere(),
    ) {
        // Far enough to see most triangles whole on one sheet.
        check(Viewpoint::Eye(way.normalize_or(DVec3::Z) * 4.0), [first, second])?;
        check(Viewpoint::Direction(way.normalize_or(DVec3::Z)), [first, second])?;
    }

    #[test]
    fn sure_answers_are_exact_where_corners_meet(
        corners in [on_lattice(), on_lattice(), on_lattice(), on_lattice(), on_lattice(), on_lattice()],
        eye in on_lattice(), offset in anywhere(), is_askew: bool,
    ) {
        let [a, b, c, d, e, f] = corners;
        let away = if is_askew { offset } else { offset.round() };
        for second in [[d, e, f], [a, d, e], [b, a, d]] {
            check(Viewpoint::Eye(eye + away * 4.0), [[a, b, c], second])?;
            check(Viewpoint::Direction(away.normalize_or(DVec3::Y)), [[a, b, c], second])?;
        }
    }
}

/// The picture settles what is far from the rounding, also for triangles with a common edge; it leaves the rest open.
#[test]
fn most_pairs_are_settled() {
    let eye = Viewpoint::Eye(DVec3::new(0.1, 0.2, 5.0));
    let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let settle = |second: [DVec3; 3]| {
        let ([a, b], _, rounding) = on_one_sheet(eye, [[a, b, c], second]).unwrap();
        overlap_surely(&a, &b, rounding)
    };
    assert_eq!(settle([DVec3::splat(0.2), b, c]), Some(true));
    assert_eq!(settle([DVec3::new(1.0, 1.0, 0.5), b, c]), Some(false));
    assert_eq!(settle([DVec3::ONE, DVec3::new(1.5, 1.0, 1.0), DVec3::new(1.0, 1.5, 1.0)]), Some(false));
    // A corner that is seen on an edge but is none of its ends.
    let on_edge = (b + c) * 0.5;
    assert_eq!(settle([on_edge, on_edge + DVec3::X, on_edge + DVec3::Y]), None);
}
