//! Control points against the maps that they stand for.

use crate::{ColorMap, ColorPoint, ColorSpace, HALF_GRAY_LEVEL, all_names, linear_from_srgb, srgb_from_linear};

/// The color that a renderer shows between control points, sRGB; on a step, from below.
fn shown_color(points: &[[f64; 4]], scalar: f64) -> [f64; 3] {
    let after = points.partition_point(|point| point[0] < scalar);
    let (from, to) = (points[after.saturating_sub(1)], points[after.min(points.len() - 1)]);
    let share = if to[0] > from[0] { ((scalar - from[0]) / (to[0] - from[0])).clamp(0.0, 1.0) } else { 1.0 };
    core::array::from_fn(|i| srgb_from_linear((1.0 - share) * from[i + 1] + share * to[i + 1]))
}

/// Largest difference, and the number of control points.
fn check_linear(map: &ColorMap, error: f64) -> (f64, usize) {
    let points = map.linear_points(-3.0, 5.0, error);
    assert!(points.is_sorted_by(|a, b| a[0] <= b[0]), "{}", map.name());
    assert_eq!((points[0][0], points[points.len() - 1][0]), (-3.0, 5.0), "{}", map.name());
    assert!(points.iter().flatten().all(|value| value.is_finite()));
    let mut largest: f64 = 0.0;
    // A prime number of places, so that they fall on no point.
    for i in 0..10_007 {
        let x = (f64::from(i) + 0.5) / 10_007.0;
        let (ours, wanted) = (shown_color(&points, -3.0 + 8.0 * x), map.color_at(x));
        largest = ours.into_iter().zip(wanted).fold(largest, |largest, (a, b)| largest.max((a - b).abs()));
    }
    assert!(largest <= error, "{}: {} gray levels", map.name(), 255.0 * largest);
    (largest, points.len())
}

#[test]
fn all_named_maps_are_within_half_a_gray_level() {
    let names = all_names();
    assert_eq!(names.len(), 78 + 141 + 10);
    let mut most = 0;
    for named in names {
        let map = named.map().unwrap();
        assert_eq!(map.name(), named.name);
        let (_, points) = check_linear(&map, HALF_GRAY_LEVEL);
        most = most.max(points);
        // A flag's stripes take the most.
        assert!(
            points <= if named.name == "flag" || named.name == "prism" { 1400 } else { 160 },
            "{}: {points}",
            named.name
        );
    }
    assert!(most > 160);
}

#[test]
fn smaller_errors_take_more_points() {
    let map = ColorMap::named("viridis").unwrap();
    let [coarse, fine, finest] = [4.0, 1.0, 0.1].map(|levels| check_linear(&map, levels * HALF_GRAY_LEVEL).1);
    assert!(coarse < fine && fine < finest, "{coarse} {fine} {finest}");
    assert!(fine < 33, "{fine}");
    let points = map.linear_points(0.0, 1.0, f64::NAN);
    assert!(points.len() > finest && points.len() < 100_000);
}

#[test]
fn every_space_is_within_half_a_gray_level() {
    let spaces = [
        ColorSpace::Rgb,
        ColorSpace::Hsv { wrap: false },
        ColorSpace::Hsv { wrap: true },
        ColorSpace::Lab,
        ColorSpace::Diverging,
        ColorSpace::LabCiede2000,
        ColorSpace::Prolab,
        ColorSpace::Step,
    ];
    let mut random = fastrand::Rng::with_seed(7);
    for space in spaces {
        for number in 0..40 {
            let points: Vec<_> = (0..random.usize(1..6))
                .map(|i| ColorPoint {
                    // Some at one place.
                    x: f64::from(random.i32(-2..3)) + if i == 0 { -9.0 } else { 0.0 },
                    rgb: core::array::from_fn(|_| f64::from(random.u8(0..=4)) / 4.0),
                })
                .collect();
            let map = ColorMap::new(&format!("{space:?} {number}"), space, &points).unwrap();
            if map.points().len() > 1 {
                check_linear(&map, HALF_GRAY_LEVEL);
                check_linear(&map.reversed(), HALF_GRAY_LEVEL);
            }
        }
    }
}

#[test]
fn black_to_white_in_known_points() {
    let map = ColorMap::named("gray").unwrap();
    assert_eq!(map.color_at(0.5), [0.5; 3]);
    let points = map.linear_points(10.0, 20.0, HALF_GRAY_LEVEL);
    assert_eq!((points[0], points[points.len() - 1]), ([10.0, 0.0, 0.0, 0.0], [20.0, 1.0, 1.0, 1.0]));
    for [scalar, r, g, b] in points {
        assert!((r - linear_from_srgb((scalar - 10.0) / 10.0)).abs() < 1e-12);
        assert_eq!((r, r), (g, b));
    }
}

#[test]
fn steps_are_two_points_at_one_scalar() {
    let point = |x, value| ColorPoint { x, rgb: [value; 3] };
    let points = [point(2.0, 0.0), point(3.0, 0.25), point(3.0, 0.75), point(4.0, 1.0)];
    let map = ColorMap::new("step", ColorSpace::Rgb, &points).unwrap();
    assert_eq!((map.color_at(0.5), map.color_at(0.500_000_1)[0] > 0.75), ([0.25; 3], true));
    let linear = map.linear_points(0.0, 2.0, HALF_GRAY_LEVEL);
    let at_step: Vec<_> = linear.iter().filter(|point| point[0] == 1.0).map(|point| point[1]).collect();
    assert_eq!(at_step, [linear_from_srgb(0.25), linear_from_srgb(0.75)]);

    let step = ColorMap::new("step", ColorSpace::Step, &points).unwrap();
    assert_eq!((step.color_at(0.0), step.color_at(0.1), step.color_at(0.9)), ([0.0; 3], [0.25; 3], [1.0; 3]));
    let linear: Vec<_> =
        step.linear_points(0.0, 1.0, HALF_GRAY_LEVEL).iter().map(|point| (point[0], point[1])).collect();
    let [dark, light] = [0.25, 1.0].map(linear_from_srgb);
    assert_eq!(linear, [(0.0, 0.0), (0.0, dark), (0.5, dark), (0.5, light), (1.0, light)]);
}

#[test]
fn ranges_of_all_kinds() {
    let map = ColorMap::named("viridis").unwrap();
    assert_eq!(
        map.linear_points(3.0, 3.0, HALF_GRAY_LEVEL),
        [[3.0; 1].map(|_| {
            let [r, g, b] = map.color_at(0.5).map(linear_from_srgb);
            [3.0, r, g, b]
        })[0]]
    );
    let forth = map.linear_points(0.0, 1.0, HALF_GRAY_LEVEL);
    let back = map.linear_points(1.0, 0.0, HALF_GRAY_LEVEL);
    assert_eq!((forth[0][1..].to_vec(), forth[0][0]), (back[back.len() - 1][1..].to_vec(), 0.0));
    assert_eq!(back, ColorMap::named("viridis_r").unwrap().linear_points(0.0, 1.0, HALF_GRAY_LEVEL));
    for (lo, hi) in [(-f64::MAX, f64::MAX), (1.0, 1.0 + f64::EPSILON), (0.0, 5e-324), (1e300, 1.1e300)] {
        let points = map.linear_points(lo, hi, HALF_GRAY_LEVEL);
        assert!(points.is_sorted_by(|a, b| a[0] <= b[0]));
        assert!(points.iter().flatten().all(|value| value.is_finite()));
        assert_eq!((points[0][0], points[points.len() - 1][0]), (lo, hi));
    }
    for x in [f64::NAN, f64::NEG_INFINITY, -1.0] {
        assert_eq!(map.color_at(x), map.points()[0].rgb);
    }
    assert_eq!(map.color_at(f64::INFINITY), map.color_at(1.0));
}

#[test]
fn reversed_twice_is_the_map() {
    for name in ["Cool to Warm", "hsv", "blot", "Fast"] {
        let map = ColorMap::named(name).unwrap();
        let (back, again) = (map.reversed(), map.reversed().reversed());
        assert_eq!(back.name(), format!("{name}_r"));
        assert_eq!(again.name(), name);
        for i in 0..=100 {
            let x = f64::from(i) / 101.0;
            for c in 0..3 {
                assert!((back.color_at(1.0 - x)[c] - map.color_at(x)[c]).abs() < 1e-3, "{name} at {x}");
                assert!((again.color_at(x)[c] - map.color_at(x)[c]).abs() < 1e-9, "{name} at {x}");
            }
        }
    }
}

#[test]
fn names_in_all_ways() {
    let first = |name: &str| ColorMap::named(name).unwrap().points()[0].rgb;
    assert_eq!(ColorMap::named("cool TO warm").unwrap().name(), "Cool to Warm");
    assert_eq!(ColorMap::named(" VIRIDIS_R ").unwrap().name(), "viridis_r");
    assert_eq!(ColorMap::named("Cool to Warm_r").unwrap().name(), "Cool to Warm_r");
    // Two maps of different makers.
    assert_eq!(ColorMap::named("Jet").unwrap().points().len(), 7);
    assert_eq!(ColorMap::named("jet").unwrap().points().len(), 12);
    assert_eq!(ColorMap::named("paraview:Blues").unwrap().space(), ColorSpace::Lab);
    assert_eq!(ColorMap::named("matplotlib: Blues").unwrap().space(), ColorSpace::Rgb);
    assert_ne!(first("Blues"), first("paraview:Blues"));
    assert!(ColorMap::named("matplotlib:Cool to Warm").is_err());
    assert_eq!(ColorMap::named("Viridis (matplotlib)").unwrap().space(), ColorSpace::Diverging);

    let message = |name: &str| ColorMap::named(name).unwrap_err().to_string();
    assert!(
        message("virids").starts_with("no color map is called \"virids\"; near it are \"viridis\""),
        "{}",
        message("virids")
    );
    assert!(message("Desaturated").contains("\"Rainbow Desaturated\""));
    assert!(message("").contains("matplotlib"), "{}", message(""));
    assert!(!message("\u{1b}[31mred").contains('\u{1b}'));
    assert!(message(&"x".repeat(10_000)).len() < 500);
    // Names for categories are not along a range.
    assert!(ColorMap::named("tab10").is_err());
}

#[test]
fn points_that_are_refused() {
    let point = |x, value| ColorPoint { x, rgb: [value; 3] };
    let message = |points: &[ColorPoint]| ColorMap::new("m", ColorSpace::Lab, points).unwrap_err().to_string();
    assert!(message(&[]).contains("no color point"));
    assert!(message(&[point(1.0, 0.0), point(1.0, 1.0)]).contains("lie at 1"));
    assert!(message(&[point(0.0, 0.0), point(f64::NAN, 1.0)]).contains("color point 2: its position is NaN"));
    assert!(message(&[point(0.0, 0.0), point(f64::INFINITY, 1.0)]).contains("inf"));
    assert!(message(&[point(0.0, 128.0)]).contains("divided by 255"));
    assert!(message(&[point(0.0, f64::NAN)]).contains("color point 1: the red is NaN"));
    let nearly = ColorMap::new("m", ColorSpace::Rgb, &[point(0.0, 1.000_01)]).unwrap();
    assert_eq!((nearly.color_at(0.3), nearly.points()[0].rgb), ([1.0; 3], [1.0; 3]));
    let many: Vec<_> = (0..300).map(|i| point(f64::from(i), 0.5)).collect();
    assert!(ColorMap::new("m", ColorSpace::LabCiede2000, &many).is_err());
    let wide =
        ColorMap::new("m", ColorSpace::Rgb, &[point(-f64::MAX, 0.0), point(0.0, 0.5), point(f64::MAX, 1.0)]).unwrap();
    assert_eq!(wide.points()[1].x, 0.5);
}
