//! The two passes against the flat map, the weights of single surfaces, and shading through them.

use proptest::prelude::*;

use super::super::maps::tests::set;
use super::*;
use crate::{Phong, Segment};

fn pairs(size: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..size).flat_map(move |front| (0..size).map(move |back| (front, back)))
}

#[test]
fn one_opaque_surface_has_the_weights_of_the_paper() {
    let (value, size) = (0.3, 16);
    let surfaces = set(&[(value, 1.0)]);
    let maps = SmoothMaps::new(&surfaces, [0.0, 1.0], size).unwrap();
    let flat = IsosurfaceMap::new(&surfaces, [0.0, 1.0], size).unwrap();
    assert_eq!(maps.front().axis(), maps.back().axis());
    assert_eq!(maps.back().entries(), flat.entries(), "the pass for the back faces has the map unchanged");
    let mut crossed = 0;
    for (front, back) in pairs(size) {
        let [s, t] = [front, back].map(|texel| flat.axis().center(texel));
        let (got, whole) = (maps.front().at(front, back), flat.at(front, back));
        if (s < value) == (t < value) {
            assert_eq!(got, RgbaAssoc::TRANSPARENT);
            continue;
        }
        crossed += 1;
        let weight = (value - t) / (s - t);
        assert!((got.opacity - weight).abs() < 6e-8, "{front} {back}: {got:?} {weight}");
        for channel in 0..3 {
            assert!((got.rgb[channel] - weight * whole.rgb[channel]).abs() < 1e-7, "{front} {back}");
        }
    }
    assert_eq!(crossed, 2 * 5 * 11, "0.3 lies between the centers of the texels 4 and 5");
}

#[test]
fn two_surfaces_have_the_weights_of_the_sum() {
    // From 1/8 to 7/8 with surfaces a third and two thirds of the way.
    let surfaces = set(&[(0.375, 0.5), (0.625, 0.8)]);
    let maps = SmoothMaps::new(&surfaces, [-0.25, 1.25], 6).unwrap();
    let [low, high] = [0, 1].map(|index| surfaces.as_slice()[index]);
    for (front, back, parts) in [
        (1, 4, [(2.0 / 3.0 * 0.5, low.back_color), (1.0 / 3.0 * 0.5 * 0.8, high.back_color)]),
        (4, 1, [(2.0 / 3.0 * 0.8, high.color), (1.0 / 3.0 * 0.2 * 0.5, low.color)]),
    ] {
        let got = maps.front().at(front, back);
        assert!((got.opacity - parts[0].0 - parts[1].0).abs() < 6e-8, "{got:?}");
        for channel in 0..3 {
            let expected: f64 = parts.iter().map(|(weight, color)| weight * color[channel]).sum();
            assert!((got.rgb[channel] - expected).abs() < 1e-7, "{got:?} {expected}");
        }
    }
}

#[test]
fn a_surface_at_a_face_is_shaded_there_alone() {
    // Both centers are surfaces: falling, the first is met at the front; rising, the second at the back.
    let surfaces = set(&[(0.25, 1.0), (0.75, 1.0)]);
    let maps = SmoothMaps::new(&surfaces, [-0.5, 1.5], 4).unwrap();
    assert_eq!([maps.front().at(2, 1).opacity, maps.back().at(2, 1).opacity], [1.0, 0.0]);
    assert_eq!([maps.front().at(1, 2).opacity, maps.back().at(1, 2).opacity], [0.0, 1.0]);
}

#[test]
fn shading_is_interpolated_between_the_faces() {
    let (value, size) = (0.5, 8);
    let maps = SmoothMaps::new(&set(&[(value, 1.0)]), [0.0, 1.0], size).unwrap();
    let flat = IsosurfaceMap::new(&set(&[(value, 1.0)]), [0.0, 1.0], size).unwrap();
    let phong = Phong { ambient: 0.2, diffuse: 0.6, specular: 0.3, shininess: 8.0 };
    let eye = [0.0, 0.0, 1.0];
    let intensities =
        [[0.0, 0.6, 0.8], [0.6, 0.0, 0.8]].map(|gradient| phong.intensities(gradient, eye, [0.0, 0.6, 0.8]));
    for (front, back) in pairs(size).filter(|&(front, back)| (front < 4) != (back < 4)) {
        let shaded = |light: RgbaAssoc, [body, highlight]: [f64; 2]| RgbaAssoc {
            rgb: light.rgb.map(|channel| channel * body + light.opacity * highlight),
            ..light
        };
        let front_light = shaded(maps.front().at(front, back), intensities[0]);
        let got = front_light.over(shaded(maps.back().at(front, back), intensities[1]));
        let [s, t] = [front, back].map(|texel| flat.axis().center(texel));
        let weight = (value - t) / (s - t);
        let [body, highlight] = [0, 1].map(|i| weight * intensities[0][i] + (1.0 - weight) * intensities[1][i]);
        for (got, color) in got.rgb.into_iter().zip(flat.at(front, back).rgb) {
            assert!((got - (color * body + highlight)).abs() < 4e-7, "{front} {back}");
        }
    }
}

#[test]
fn narrow_ranges_and_refusals_are_those_of_the_flat_map() {
    let surfaces = set(&[(1e-310, 0.5)]);
    let maps = SmoothMaps::new(&surfaces, [0.0, 2e-310], 2).unwrap();
    for light in [maps.front(), maps.back()].into_iter().flat_map(|map| map.entries()) {
        assert!(light.iter().all(|number| number.is_finite()), "{light:?}");
    }
    let one = Segment { scalar_front: 3.0, scalar_back: 3.0, chord_length: 1.0 };
    assert_eq!(SmoothMaps::new(&surfaces, [3.0, 3.0], 2).unwrap().front().look_up(&one), RgbaAssoc::TRANSPARENT);
    assert!(matches!(SmoothMaps::new(&surfaces, [0.0, 1.0], 0), Err(IsosurfaceError::MapSize { size: 0, .. })));
    assert!(matches!(SmoothMaps::new(&surfaces, [1.0, 0.0], 8), Err(IsosurfaceError::MapRange { .. })));
}

proptest! {
    /// The tolerance is the rounding of two entries to 32 bits at colors up to 1.5, the second times that of the first.
    #[test]
    fn the_passes_over_each_other_are_the_flat_map(
        all in prop::collection::vec((-0.2..1.2f64, prop_oneof![0.0..1.0f64, Just(1.0), 0.99..1.0]), 0..9),
        size in 2..24u32,
    ) {
        let surfaces = set(&all);
        let maps = SmoothMaps::new(&surfaces, [0.0, 1.0], size).unwrap();
        let flat = IsosurfaceMap::new(&surfaces, [0.0, 1.0], size).unwrap();
        for (front, back) in pairs(size) {
            let [over, under, whole] = [maps.front(), maps.back(), &flat].map(|map| map.at(front, back));
            prop_assert!((0.0..=1.0).contains(&over.opacity) && (0.0..=1.0).contains(&under.opacity));
            prop_assert!(over.opacity <= whole.opacity + 6e-8);
            let both = over.over(under);
            prop_assert!((both.opacity - whole.opacity).abs() < 3.0 * 6e-8);
            for channel in 0..3 {
                prop_assert!((both.rgb[channel] - whole.rgb[channel]).abs() < 4.5 * 6e-8, "{front} {back}");
            }
        }
    }
}
