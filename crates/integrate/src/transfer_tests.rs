//! Pieces, steps, ranges and refusals of transfer functions.

use proptest::prelude::*;

use super::*;

fn gray(color: &[[f64; 2]], extinction: &[[f64; 2]]) -> TransferFunction {
    let color: Vec<_> = color.iter().map(|&[s, v]| [s, v, v, v]).collect();
    TransferFunction::new(&color, extinction).unwrap()
}

#[test]
fn one_point_is_a_constant_everywhere() {
    let transfer = TransferFunction::new(&[[3.0, 0.1, 0.2, 0.3]], &[[5.0, 7.0]]).unwrap();
    assert_eq!(transfer.pieces().len(), 1);
    assert_eq!(transfer.domain(), (3.0, 5.0));
    for s in [-1e308, 0.0, 3.0, 4.0, 5.0, 1e308] {
        assert_eq!((transfer.color(s), transfer.extinction(s)), ([0.1, 0.2, 0.3], 7.0));
        assert_eq!((transfer.max_extinction(s, 4.0), transfer.max_emission(s, 4.0)), (7.0, 0.3));
    }
}

#[test]
fn points_of_both_lists_cut_and_both_are_linear_between() {
    let transfer = gray(&[[0.0, 1.0], [4.0, 3.0]], &[[1.0, 0.0], [3.0, 10.0]]);
    let ends: Vec<_> = transfer.pieces().iter().map(|piece| (piece.start, piece.end)).collect();
    let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
    assert_eq!(ends, [(low, 0.0), (0.0, 1.0), (1.0, 3.0), (3.0, 4.0), (4.0, high)]);
    assert_eq!(transfer.pieces()[2].extinction, [0.0, 10.0]);
    assert_eq!(transfer.pieces()[2].color, [[1.5; 3], [2.5; 3]]);
    assert_eq!(transfer.extinction(2.0), 5.0);
    assert_eq!(transfer.color(3.5), [2.75; 3]);
    assert_eq!((transfer.extinction(-9.0), transfer.extinction(9.0)), (0.0, 10.0));
}

#[test]
fn a_step_takes_the_second_value_and_of_three_the_last() {
    let transfer = gray(&[[0.0, 1.0]], &[[0.0, 2.0], [1.0, 4.0], [1.0, 99.0], [1.0, 6.0], [2.0, 8.0]]);
    assert_eq!(transfer.extinction(1.0), 6.0);
    assert_eq!(transfer.pieces()[transfer.piece_at(1.0)].start, 1.0);
    assert!((transfer.extinction(1.0f64.next_down()) - 4.0).abs() < 1e-12);
    assert_eq!(transfer.max_extinction(0.0, 2.0), 8.0);
    assert_eq!(transfer.max_extinction(0.0, 1.0), 6.0, "both sides of a step at an end count");
    assert_eq!(transfer.max_extinction(0.0, 1.0f64.next_down()).round(), 4.0);
    // Steps at the ends of the domain.
    let transfer = gray(&[[0.0, 0.0]], &[[0.0, 1.0], [0.0, 5.0], [1.0, 5.0], [1.0, 0.0]]);
    assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0].map(|s| transfer.extinction(s)), [1.0, 5.0, 5.0, 0.0, 0.0]);
    assert_eq!(transfer.max_extinction(1.0, 1.0), 5.0);
    assert_eq!(transfer.max_extinction(1.0f64.next_up(), 3.0), 0.0);
}

#[test]
fn pieces_between_are_those_touched_with_a_width() {
    let transfer = gray(&[[0.0, 0.0], [3.0, 1.0]], &[[1.0, 0.0], [2.0, 1.0]]);
    assert_eq!(transfer.pieces_between(0.5, 0.7), 1..2);
    assert_eq!(transfer.pieces_between(0.0, 1.0), 1..2);
    assert_eq!(transfer.pieces_between(1.0, 0.0), 1..2);
    assert_eq!(transfer.pieces_between(1.0, 1.0), 2..3);
    assert_eq!(transfer.pieces_between(-1.0, 9.0), 0..5);
    assert_eq!(transfer.pieces_between(0.0f64.next_down(), 0.0), 0..1);
}

#[test]
fn refusals_name_the_entry() {
    let color = [[0.0, 0.0, 0.0, 0.0]];
    let refuse = |extinction: &[[f64; 2]]| TransferFunction::new(&color, extinction).unwrap_err().to_string();
    assert_eq!(refuse(&[]), "the extinction list is empty; give at least one control point");
    assert_eq!(
        refuse(&[[1.0, 0.0], [0.5, 0.0]]),
        "extinction entry 1: scalar 0.5 lies below 1 of the entry before; sort the entries by scalar"
    );
    assert_eq!(refuse(&[[0.0, -2.0]]), "extinction entry 0: extinction is -2; give zero or more");
    assert_eq!(refuse(&[[f64::NAN, 0.0]]), "extinction entry 0: scalar is NaN; give a finite number");
    assert_eq!(refuse(&[[0.0, f64::INFINITY]]), "extinction entry 0: extinction is inf; give a finite number");
    let error = TransferFunction::new(&[[0.0, 2.0, 0.0, -1.0]], &[[0.0, 0.0]]).unwrap_err();
    assert_eq!(
        error,
        TransferFunctionError::Negative { list: "color", index: 0, component: "blue", value: -1.0 },
        "a color above 1 is none of the faults"
    );
}

#[test]
fn lengths_scale_the_extinction_and_the_color_that_is_per_length() {
    let transfer = gray(&[[0.0, 1.0], [1.0, 2.0]], &[[0.0, 3.0], [1.0, 1e300]]);
    let dense = transfer.with_lengths_scaled(1e10, OpticalModel::DensityEmitter);
    assert_eq!((dense.extinction(0.0), dense.color(1.0)), (3e10, [2.0; 3]));
    assert_eq!(dense.extinction(1.0), f64::MAX);
    let glowing = transfer.with_lengths_scaled(0.5, OpticalModel::Emitter);
    assert_eq!((glowing.extinction(0.0), glowing.color(1.0)), (1.5, [1.0; 3]));
}

#[test]
fn scalars_at_the_ends_of_the_floats() {
    let transfer = gray(&[[0.0, 0.0]], &[[-1.7e308, 0.0], [1.7e308, 4.0]]);
    assert_eq!(transfer.extinction(0.0), 2.0);
    assert_eq!(transfer.extinction(0.85e308), 3.0);
    let transfer = gray(&[[0.0, 0.0]], &[[0.0, 0.0], [0.0f64.next_up(), 4.0]]);
    assert_eq!(transfer.extinction(0.0f64.next_up()), 4.0);
    // Both zeros are one scalar.
    let transfer = gray(&[[0.0, 0.0]], &[[-0.0, 1.0], [0.0, 4.0]]);
    assert_eq!((transfer.extinction(-0.0), transfer.extinction(0.0)), (4.0, 4.0));
}

/// Control points on a coarse raster, so that steps and shared scalars come up.
fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
    prop::collection::vec((0..12i32, 0.0..8.0f64), 1..9).prop_map(|mut points| {
        points.sort_by_key(|point| point.0);
        points.into_iter().map(|(s, v)| [f64::from(s), v]).collect()
    })
}

proptest! {
    #[test]
    fn pieces_follow_each_other_and_hold_their_scalars(color in points(), extinction in points(), s in -2.0..14.0f64) {
        let transfer = gray(&color, &extinction);
        let pieces = transfer.pieces();
        prop_assert_eq!(pieces[0].start, f64::NEG_INFINITY);
        prop_assert_eq!(pieces[pieces.len() - 1].end, f64::INFINITY);
        for pair in pieces.windows(2) {
            prop_assert_eq!(pair[0].end, pair[1].start);
            prop_assert!(pair[0].start < pair[0].end);
        }
        for s in [s, s.round()] {
            let piece = &pieces[transfer.piece_at(s)];
            prop_assert!(piece.start <= s && s < piece.end);
        }
        for point in &extinction {
            let last = extinction.iter().rev().find(|other| other[0] == point[0]).unwrap();
            prop_assert_eq!(transfer.extinction(point[0]), last[1]);
        }
    }

    #[test]
    fn maxima_bound_every_value_and_are_reached(extinction in points(), lo in -2..14i32, hi in -2..14i32) {
        let transfer = gray(&[[5.0, 0.0]], &extinction);
        let (lo, hi) = (f64::from(lo.min(hi)), f64::from(lo.max(hi)));
        let largest = transfer.max_extinction(lo, hi);
        let step = (hi - lo) / 240.0;
        let seen = (0..=240).map(|i| transfer.extinction(lo + f64::from(i) * step)).fold(0.0, f64::max);
        prop_assert!(largest >= seen * (1.0 - 1e-12));
        let below = |s: f64| transfer.extinction(s.next_down());
        let at_ends = transfer.extinction(hi).max(transfer.extinction(lo)).max(below(lo)).max(below(hi));
        let points = extinction.iter().filter(|point| point[0] >= lo && point[0] <= hi);
        let reachable = points.map(|point| below(point[0]).max(transfer.extinction(point[0]))).fold(at_ends, f64::max);
        prop_assert!((largest - reachable).abs() < 1e-9, "{} {}", largest, reachable);
    }
}

#[test]
fn scalars_in_another_unit() {
    let transfer = TransferFunction::new(
        &[[-1e300, 0.1, 0.2, 0.3], [0.0, 1.0, 0.0, 0.5], [2e300, 0.7, 0.2, 0.1]],
        &[[-5e299, 0.0], [1e300, 4.0], [1e300, 1.0]],
    )
    .unwrap();
    // A power of two loses nothing.
    let factor = 2.0_f64.powi(-990);
    let scaled = transfer.with_scalars_scaled(factor);
    for s in [-2e300, -1e300, -4.3e299, 0.0, 1.7e299, 9.99e299, 1e300, 1.5e300, 3e300] {
        assert_eq!(transfer.extinction(s), scaled.extinction(s * factor), "{s:e}");
        assert_eq!(transfer.color(s), scaled.color(s * factor), "{s:e}");
    }
    assert_eq!(transfer, scaled.with_scalars_scaled(factor.recip()));
    assert_eq!(transfer.with_scalars_scaled(1e20).domain(), (f64::MIN, f64::MAX));
}
