//! Opacity curves, their points, and what they mean for a length.

use crate::{HALF_GRAY_LEVEL, Opacity, OpacityPoint, OpacityUnit, opacity_names};

fn value(points: &[[f64; 2]], scalar: f64) -> f64 {
    let after = points.partition_point(|point| point[0] <= scalar);
    let (from, to) = (points[after.saturating_sub(1)], points[after.min(points.len() - 1)]);
    let share = if to[0] > from[0] { ((scalar - from[0]) / (to[0] - from[0])).clamp(0.0, 1.0) } else { 0.0 };
    (1.0 - share) * from[1] + share * to[1]
}

fn check_points(curve: &Opacity, error: f64) -> usize {
    let points = curve.points(100.0, 200.0, error);
    let thick = curve.extinction_points(100.0, 200.0, OpacityUnit::OverLength(0.25), error);
    let thin = curve.extinction_points(100.0, 200.0, OpacityUnit::ExtinctionPerLength(0.25), error);
    for i in 0..2003 {
        let x = (f64::from(i) + 0.5) / 2003.0;
        let (scalar, wanted) = (100.0 + 100.0 * x, curve.at(x));
        let shown = [
            value(&points, scalar),
            value(&thin, scalar) * 0.25,
            // What a layer as thick as the unit's length takes.
            1.0 - (-value(&thick, scalar) * 0.25).exp(),
        ];
        for (i, shown) in shown.into_iter().enumerate() {
            assert!((shown - wanted).abs() <= error, "{} at {x}, {i}: {shown}, not {wanted}", curve.name());
        }
    }
    points.len()
}

#[test]
fn all_names_are_within_their_error() {
    let names = opacity_names();
    assert_eq!(names.len(), 2 * 15 + 1);
    for name in names {
        let points = check_points(&Opacity::named(&name).unwrap(), HALF_GRAY_LEVEL);
        assert!(points < 40, "{name}: {points}");
    }
    assert_eq!(Opacity::named("linear").unwrap().points(-1.0, 3.0, 0.01), [[-1.0, 0.0], [3.0, 1.0]]);
    let foreground = Opacity::named("foreground").unwrap().points(0.0, 256.0, 0.01);
    assert_eq!(foreground, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [256.0, 1.0]]);
}

#[test]
fn points_of_all_shapes_are_within_their_error() {
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..400 {
        let points: Vec<_> = (0..random.usize(1..6))
            .map(|i| OpacityPoint {
                x: f64::from(random.i32(-2..3)) + if i == 0 { -9.0 } else { 0.0 },
                opacity: f64::from(random.u8(0..=4)) / 4.0,
                midpoint: f64::from(random.u8(0..=4)) / 4.0,
                sharpness: f64::from(random.u8(0..=8)) / 8.0,
            })
            .collect();
        let curve = Opacity::new(&points).unwrap();
        check_points(&curve, HALF_GRAY_LEVEL);
        check_points(&curve.reversed(), 0.01);
    }
}

#[test]
fn full_opacity_has_a_finite_extinction() {
    let constant = Opacity::new(&[OpacityPoint::straight(7.0, 1.0)]).unwrap();
    assert_eq!(constant.extinction_points(0.0, 1.0, OpacityUnit::OverLength(2.0), 0.01), [[0.0, 4.0], [1.0, 4.0]]);
    assert_eq!(constant.extinction_points(3.0, 3.0, OpacityUnit::ExtinctionPerLength(2.0), 0.01), [[3.0, 0.5]]);
    let half = Opacity::new(&[OpacityPoint::straight(0.0, 0.5)]).unwrap();
    let [_, extinction] = half.extinction_points(0.0, 1.0, OpacityUnit::OverLength(1.0), 0.01)[0];
    assert!((extinction - 2.0_f64.ln()).abs() < 1e-15);
}

#[test]
fn sharpest_and_midpoint() {
    let way = |midpoint, sharpness| {
        let first = OpacityPoint { x: 0.0, opacity: 0.0, midpoint, sharpness };
        Opacity::new(&[first, OpacityPoint::straight(1.0, 1.0)]).unwrap()
    };
    for sharpness in [0.0, 0.3, 1.0] {
        for midpoint in [0.1, 0.5, 0.8] {
            assert!((way(midpoint, sharpness).at(midpoint) - 0.5).abs() < 1e-12);
        }
    }
    assert!((way(0.2, 0.0).at(0.1) - 0.25).abs() < 1e-12);
    assert!(way(0.5, 1.0).at(0.4) < 0.05 && way(0.5, 1.0).at(0.6) > 0.95);
}

#[test]
fn texts() {
    let parse = |text: &str| text.parse::<Opacity>();
    assert_eq!(parse(" sigmoid_5 ").unwrap().name(), "sigmoid_5");
    assert_eq!(parse("Linear_R").unwrap().at(0.25), 0.75);
    assert_eq!(parse("0, 0.2 .9").unwrap().points(0.0, 1.0, 0.01), [[0.0, 0.0], [0.5, 0.2], [1.0, 0.9]]);
    assert_eq!(parse("10:0;30:.5 20:1").unwrap().points(0.0, 1.0, 0.01), [[0.0, 0.0], [0.5, 1.0], [1.0, 0.5]]);
    assert!((parse("0.3").unwrap().at(0.9) - 0.3).abs() < 1e-15);
    let message = |text: &str| parse(text).unwrap_err().to_string();
    for (text, part) in [
        ("", "no opacity is called"),
        ("sigmoid_11", "sigmoid_20"),
        ("foreground_r", "foreground"),
        ("0, x", "point 2: \"x\" is not a number"),
        ("0:1, 2", "some opacities have a place"),
        ("0, 200", "divided by 255"),
        ("0, -1", "-1, not between 0 and 1"),
        ("1:0 1:1", "lie at 1"),
        ("inf:0", "no opacity is called"),
        ("0:nan", "NaN"),
        ("1e999:0, 0:1", "not a finite number"),
        ("\u{1b}[1m", "\u{fffd}[1m"),
    ] {
        assert!(message(text).contains(part), "{text}: {}", message(text));
    }
}
