//! The flat map against the composition along the ray, and where the two differ.

use proptest::prelude::*;

use super::*;
use crate::{Isosurface, OpticalModel, SurfaceShading, TransferFunction, exact};

pub(in crate::surface) fn set(surfaces: &[(f64, f64)]) -> Isosurfaces {
    let surface = |(index, &(value, opacity)): (usize, &(f64, f64))| {
        let color = [0.25 + 0.125 * (index % 7) as f64, 0.5, 1.5];
        Isosurface { value, color, back_color: [color[0], 1.0, 0.0], opacity, shading: SurfaceShading::Smooth }
    };
    Isosurfaces::new(surfaces.iter().enumerate().map(surface).collect()).unwrap()
}

/// The surfaces of a segment, one by one.
fn composed(surfaces: &Isosurfaces, scalar_front: f64, scalar_back: f64) -> RgbaAssoc {
    let segment = Segment { scalar_front, scalar_back, chord_length: 1.0 };
    let nothing = |_: &Segment| RgbaAssoc::TRANSPARENT;
    surfaces.compose(surfaces.ranks(&segment), &segment, nothing, |crossing| crossing.color)
}

fn difference(left: RgbaAssoc, right: RgbaAssoc) -> f64 {
    let light = left.rgb.iter().zip(right.rgb).map(|(l, r)| (l - r).abs()).fold(0.0, f64::max);
    light.max((left.opacity - right.opacity).abs())
}

/// Rounding of an entry to 32 bits; the brightest color is 1.5.
const ROUNDING: f64 = 1.5 * 6e-8;

#[test]
fn one_opaque_surface_is_the_checkerboard() {
    let surfaces = set(&[(0.5, 1.0)]);
    let map = IsosurfaceMap::new(&surfaces, [0.0, 1.0], 4).unwrap();
    let surface = surfaces.as_slice()[0];
    for (front, back) in (0..4).flat_map(|front| (0..4).map(move |back| (front, back))) {
        let expected = match (front < 2, back < 2) {
            (true, false) => [surface.back_color[0], 1.0, 0.0, 1.0],
            (false, true) => [surface.color[0], 0.5, 1.5, 1.0],
            _ => [0.0; 4],
        };
        let entry = map.entries()[(front * 4 + back) as usize].map(f64::from);
        assert_eq!(entry, expected, "{front} {back}");
    }
}

#[test]
fn scalars_fall_into_texels() {
    let axis = IsosurfaceMap::new(&set(&[]), [-1.0, 3.0], 8).unwrap().axis();
    assert_eq!((axis.start, axis.per_scalar, axis.texels), (-1.0, 2.0, 8));
    for (scalar, texel) in [(-9.0, 0), (-1.0, 0), (-0.51, 0), (-0.5, 1), (0.0, 2), (2.99, 7), (3.0, 7), (1e300, 7)] {
        assert_eq!(axis.texel(scalar), texel, "{scalar}");
    }
    assert_eq!(axis.texel(f64::NAN), 0);
    for texel in 0..8 {
        // The ends of the range stand for the first and the last.
        let center = [-1.0, -0.25, 0.25, 0.75, 1.25, 1.75, 2.25, 3.0][texel as usize];
        assert_eq!(axis.center(texel), center);
        assert_eq!(axis.texel(center), texel);
    }
    for (value, boundary) in
        [(-2.0, -2.0), (-1.0, -1.0), (-0.99, -0.5), (-0.25, -0.5), (-0.24, 0.0), (2.9, 2.5), (3.0, 2.5), (4.0, 4.0)]
    {
        assert_eq!(axis.boundary(value), boundary, "{value}");
    }
}

#[test]
fn a_range_without_width_has_one_texel() {
    for width in [0.0, 1e-310] {
        let surfaces = set(&[(2.0, 1.0)]);
        let map = IsosurfaceMap::new(&surfaces, [2.0, 2.0 + width], 2).unwrap();
        let segment = Segment { scalar_front: 2.0, scalar_back: 2.0, chord_length: 1.0 };
        assert_eq!(map.look_up(&segment), RgbaAssoc::TRANSPARENT);
        assert!(map.entries().iter().all(|entry| *entry == [0.0; 4]));
    }
    let narrow = IsosurfaceMap::new(&set(&[(1e-310, 1.0)]), [0.0, 2e-310], 2).unwrap();
    assert_eq!((narrow.axis().per_scalar, narrow.axis().texel(2e-310)), (0.0, 0));
}

#[test]
fn refusals_say_what_is_possible() {
    let refusal = |scalars, size| IsosurfaceMap::new(&set(&[]), scalars, size).unwrap_err().to_string();
    assert_eq!(refusal([0.0, 1.0], 1), "a map of 1 by 1 texels is not possible; give 2 to 4096");
    assert_eq!(refusal([0.0, 1.0], 4097), "a map of 4097 by 4097 texels is not possible; give 2 to 4096");
    let range = "give a range that ascends and whose width is finite";
    assert_eq!(refusal([1.0, 0.0], 8), format!("no map covers scalars from 1 to 0; {range}"));
    for scalars in [[f64::NAN, 1.0], [0.0, f64::INFINITY], [f64::MIN, f64::MAX]] {
        assert!(refusal(scalars, 8).ends_with(range), "{scalars:?}");
    }
}

#[test]
fn numbers_beyond_32_bits_become_the_largest() {
    let mut surface = set(&[(0.5, 1.0)]).as_slice()[0];
    surface.color = [1e300, f64::MAX, 0.0];
    let surfaces = Isosurfaces::new(vec![surface]).unwrap();
    let map = IsosurfaceMap::new(&surfaces, [0.0, 1.0], 2).unwrap();
    assert_eq!(map.entries()[2], [f32::MAX, f32::MAX, 0.0, 1.0]);
}

#[test]
fn opaque_maps_are_the_limit_of_peaks_of_growing_area() {
    // Peaks between the centers of texels, so that a segment from center to center has each of them as a whole or not.
    let (values, size, length) = ([0.25, 0.625, 0.75], 16, 0.5);
    let map = IsosurfaceMap::new(&set(&values.map(|value| (value, 1.0))), [0.0, 1.0], size).unwrap();
    let axis = map.axis();
    for (area, half_width) in [(0.1, 1.0 / 40.0), (1.0, 1e-4), (10.0, 1e-6), (100.0, 1e-9)] {
        let peak = |value: f64| [[value - half_width, 0.0], [value, area / half_width], [value + half_width, 0.0]];
        let transfer = TransferFunction::new(&[[0.0; 4]], &values.map(peak).concat()).unwrap();
        for (front, back) in (0..size).flat_map(|front| (0..size).map(move |back| (front, back))) {
            let (scalar_front, scalar_back) = (axis.center(front), axis.center(back));
            let segment = Segment { scalar_front, scalar_back, chord_length: length };
            let opacity = exact(&transfer, OpticalModel::Absorption, &segment).opacity;
            let surface = map.at(front, back).opacity;
            // The optical depth of a peak is its area times the length over the change of the scalar; what a surface
            // hides and the peaks do not is what comes through them.
            let count = values.iter().filter(|&&c| (scalar_front < c) != (scalar_back < c)).count() as f64;
            let missing =
                if count > 0.0 { (-count * area * length / (scalar_back - scalar_front).abs()).exp() } else { 0.0 };
            let tolerance = 1e-12 + 2e-16 / half_width;
            assert!(
                (surface - opacity - missing).abs() < tolerance,
                "{front} {back} {area}: {surface} {opacity} {missing}"
            );
        }
    }
}

#[test]
fn more_surfaces_than_texels_are_all_composed() {
    // Thirty-odd of the two thousand share each texel.
    let surfaces = set(&(0..2000).map(|i| (f64::from(i) / 2000.0, 0.01)).collect::<Vec<_>>());
    let map = IsosurfaceMap::new(&surfaces, [0.0, 1.0], 64).unwrap();
    for (front, back) in [(0, 1), (1, 0), (0, 63), (63, 0), (30, 34), (63, 62)] {
        let [s, t] = [front, back].map(|texel| map.axis().center(texel));
        assert!(difference(map.at(front, back), composed(&surfaces, s, t)) < ROUNDING, "{front} {back}");
    }
}

fn any_surfaces() -> impl Strategy<Value = Isosurfaces> {
    let value = prop_oneof![-0.2..1.2f64, (0..64i32).prop_map(|s| (f64::from(s) + 0.5) / 64.0)];
    prop::collection::vec((value, prop_oneof![0.0..1.0, Just(1.0)]), 0..9).prop_map(|all| set(&all))
}

proptest! {
    #[test]
    fn texels_are_composed_between_their_centers(surfaces in any_surfaces(), size in 2..40u32) {
        let map = IsosurfaceMap::new(&surfaces, [0.0, 1.0], size).unwrap();
        for (front, back) in (0..size).flat_map(|front| (0..size).map(move |back| (front, back))) {
            let [s, t] = [front, back].map(|texel| map.axis().center(texel));
            let expected = composed(&surfaces, s, t);
            prop_assert!(difference(map.at(front, back), expected) < ROUNDING, "{front} {back}");
        }
    }

    /// Between the centers the map is as good, unless a surface comes between a scalar and its texel's center.
    #[test]
    fn only_where_a_rank_differs_does_the_map(surfaces in any_surfaces(), s in 0.0..1.0f64, t in 0.0..1.0f64) {
        let map = IsosurfaceMap::new(&surfaces, [0.0, 1.0], 64).unwrap();
        let axis = map.axis();
        let has_rank = |scalar: f64| surfaces.rank(scalar) == surfaces.rank(axis.center(axis.texel(scalar)));
        let segment = Segment { scalar_front: s, scalar_back: t, chord_length: 1.0 };
        if has_rank(s) && has_rank(t) {
            prop_assert!(difference(map.look_up(&segment), composed(&surfaces, s, t)) < ROUNDING);
        } else {
            // Half a texel away at most; a whole one in the first and the last, which stand for the ends of the range.
            let near = |scalar: f64| {
                let texels = if matches!(axis.texel(scalar), 0 | 63) { 1.0 } else { 0.5 };
                surfaces.as_slice().iter().any(|c| (c.value - scalar).abs() <= texels / 64.0 + 1e-15)
            };
            prop_assert!(near(s) || near(t));
        }
    }

    /// Texels of a joint are those of both cells: nothing is met twice or missed, wherever the joints are.
    #[test]
    fn a_chain_shows_what_the_whole_does(
        surfaces in any_surfaces(),
        mut joints in prop::collection::vec(0.0..1.0f64, 2..9),
    ) {
        joints.sort_by(f64::total_cmp);
        let map = IsosurfaceMap::new(&surfaces, [0.0, 1.0], 64).unwrap();
        for _ in 0..2 {
            let look_up = |scalar_front, scalar_back| {
                map.look_up(&Segment { scalar_front, scalar_back, chord_length: 0.0 })
            };
            let parts = joints.windows(2).map(|pair| look_up(pair[0], pair[1]));
            let light = parts.fold(RgbaAssoc::TRANSPARENT, RgbaAssoc::over);
            let whole = look_up(joints[0], joints[joints.len() - 1]);
            prop_assert!(difference(light, whole) < joints.len() as f64 * ROUNDING);
            joints.reverse();
        }
    }
}
