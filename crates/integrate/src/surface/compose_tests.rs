//! Segments with isosurfaces: known answers, order, chains of segments, and the limit of a narrow peak.

use proptest::prelude::*;

use super::*;
use crate::{OpticalModel, SurfaceShading, TransferFunction, exact};

const MODEL: OpticalModel = OpticalModel::DensityEmitter;

fn segment(scalar_front: f64, scalar_back: f64, chord_length: f64) -> Segment {
    Segment { scalar_front, scalar_back, chord_length }
}

/// A surface whose colors tell which one it is and from where it is seen.
fn surface(value: f64, opacity: f64) -> Isosurface {
    let color = [0.5 + 0.25 * (7.0 * value).sin(), 0.2, 1.0];
    Isosurface { value, color, back_color: [color[0], 0.9, 0.0], opacity, shading: SurfaceShading::None }
}

fn set(surfaces: &[(f64, f64)]) -> Isosurfaces {
    Isosurfaces::new(surfaces.iter().map(|&(value, opacity)| surface(value, opacity)).collect()).unwrap()
}

fn transfer() -> TransferFunction {
    let color = [[0.0, 0.1, 0.2, 0.9], [1.0, 0.9, 0.2, 0.1]];
    TransferFunction::new(&color, &[[0.0, 0.0], [0.4, 3.0], [0.6, 0.5], [1.0, 2.0]]).unwrap()
}

fn element(color: [f64; 3], opacity: f64) -> RgbaAssoc {
    RgbaAssoc { rgb: color.map(|channel| opacity * channel), opacity }
}

fn difference(left: RgbaAssoc, right: RgbaAssoc) -> f64 {
    let light = left.rgb.iter().zip(right.rgb).map(|(l, r)| (l - r).abs()).fold(0.0, f64::max);
    light.max((left.opacity - right.opacity).abs())
}

/// Unshaded, with the exact integral as volume.
fn compose(surfaces: &Isosurfaces, transfer: &TransferFunction, segment: &Segment) -> RgbaAssoc {
    let volume = |part: &Segment| exact(transfer, MODEL, part);
    surfaces.compose(surfaces.ranks(segment), segment, volume, |crossing| crossing.color)
}

/// Index, share and color of all crossings, with nothing between them.
fn crossings(surfaces: &Isosurfaces, ranks: [usize; 2], segment: &Segment) -> Vec<(usize, f64, [f64; 3])> {
    let mut all = Vec::new();
    let nothing = |_: &Segment| RgbaAssoc::TRANSPARENT;
    surfaces.compose(ranks, segment, nothing, |crossing| {
        all.push((crossing.index, crossing.share, crossing.color));
        crossing.color
    });
    all
}

#[test]
fn without_a_surface_in_it_a_segment_is_its_volume() {
    let transfer = transfer();
    for surfaces in [Isosurfaces::default(), set(&[(0.1, 1.0), (0.9, 0.5)])] {
        for (front, back) in [(0.2, 0.8), (0.8, 0.2), (0.3, 0.3), (0.1, 0.5), (0.5, 0.1)] {
            let here = segment(front, back, 2.0);
            assert_eq!(compose(&surfaces, &transfer, &here), exact(&transfer, MODEL, &here), "{front} {back}");
        }
    }
}

#[test]
fn an_opaque_surface_hides_what_is_behind() {
    let (transfer, surfaces) = (transfer(), set(&[(0.5, 1.0)]));
    let surface = surfaces.as_slice()[0];
    for (front, back, color) in [(0.25, 1.0, surface.back_color), (1.0, 0.25, surface.color)] {
        let share = (0.5 - front) / (back - front);
        let before = exact(&transfer, MODEL, &segment(front, 0.5, 3.0 * share));
        let mut parts = Vec::new();
        let here = segment(front, back, 3.0);
        let volume = |part: &Segment| {
            parts.push(*part);
            exact(&transfer, MODEL, part)
        };
        let light = surfaces.compose(surfaces.ranks(&here), &here, volume, |crossing| crossing.color);
        assert_eq!(light.opacity, 1.0);
        assert!(difference(light, before.over(element(color, 1.0))) < 1e-15);
        assert_eq!(parts.len(), 1, "nothing is computed behind it: {parts:?}");
    }
}

#[test]
fn transparent_surfaces_and_volume_are_met_in_order() {
    let (transfer, surfaces) = (transfer(), set(&[(0.25, 0.4), (0.5, 0.7), (0.75, 0.1)]));
    let volume = |front, back| exact(&transfer, MODEL, &segment(front, back, 0.25 * 2.0));
    let [low, middle, high] = [0, 1, 2].map(|index| surfaces.as_slice()[index]);
    let rising = volume(0.0, 0.25)
        .over(element(low.back_color, 0.4))
        .over(volume(0.25, 0.5))
        .over(element(middle.back_color, 0.7))
        .over(volume(0.5, 0.75))
        .over(element(high.back_color, 0.1))
        .over(volume(0.75, 1.0));
    assert!(difference(compose(&surfaces, &transfer, &segment(0.0, 1.0, 2.0)), rising) < 1e-15);
    let falling = volume(1.0, 0.75)
        .over(element(high.color, 0.1))
        .over(volume(0.75, 0.5))
        .over(element(middle.color, 0.7))
        .over(volume(0.5, 0.25))
        .over(element(low.color, 0.4))
        .over(volume(0.25, 0.0));
    assert!(difference(compose(&surfaces, &transfer, &segment(1.0, 0.0, 2.0)), falling) < 1e-15);
    assert!(difference(rising, falling) > 0.01, "the order shows");
}

#[test]
fn crossings_know_place_side_and_index() {
    let surfaces = set(&[(0.25, 0.4), (0.5, 0.7)]);
    let [low, high] = [0, 1].map(|index| surfaces.as_slice()[index]);
    let here = segment(0.0, 1.0, 1.0);
    let rising = [(0, 0.25, low.back_color), (1, 0.5, high.back_color)];
    assert_eq!(crossings(&surfaces, surfaces.ranks(&here), &here), rising);
    let here = segment(1.0, 0.0, 1.0);
    assert_eq!(crossings(&surfaces, surfaces.ranks(&here), &here), [(1, 0.5, high.color), (0, 0.75, low.color)]);
    // A surface at the front end counts where the scalar falls, one at the back where it rises.
    for (front, back, count) in [(0.25, 0.3, 0), (0.25, 0.2, 1), (0.2, 0.25, 1), (0.3, 0.25, 0), (0.25, 0.25, 0)] {
        let here = segment(front, back, 1.0);
        assert_eq!(crossings(&surfaces, surfaces.ranks(&here), &here).len(), count, "{front} {back}");
    }
}

#[test]
fn surfaces_shine_in_every_model_and_hide_what_is_behind() {
    let (transfer, surfaces) = (transfer(), set(&[(0.5, 0.75)]));
    let color = surfaces.as_slice()[0].back_color;
    for model in OpticalModel::ALL {
        let here = segment(0.0, 1.0, 1.0);
        let volume = |part: &Segment| exact(&transfer, model, part);
        let light = surfaces.compose([0, 1], &here, volume, |crossing| crossing.color);
        let [before, behind] = [(0.0, 0.5), (0.5, 1.0)].map(|(s, t)| exact(&transfer, model, &segment(s, t, 0.5)));
        assert!(difference(light, before.over(element(color, 0.75)).over(behind)) < 1e-15, "{model}");
        assert!(light.opacity >= 0.75 && light.rgb[1] > 0.0, "{model}: {light:?}");
    }
}

#[test]
fn shading_changes_the_color_and_not_the_opacity() {
    let surfaces = set(&[(0.5, 0.5)]);
    let nothing = |_: &Segment| RgbaAssoc::TRANSPARENT;
    let light = surfaces.compose([0, 1], &segment(0.0, 1.0, 1.0), nothing, |_| [4.0, 2.0, 0.0]);
    assert_eq!(light, RgbaAssoc { rgb: [2.0, 1.0, 0.0], opacity: 0.5 });
}

#[test]
fn a_hundred_surfaces_are_all_met() {
    let surfaces = set(&(1..=100).map(|i| (f64::from(i) / 101.0, 0.02)).collect::<Vec<_>>());
    for (front, back) in [(0.0, 1.0), (1.0, 0.0)] {
        let here = segment(front, back, 1.0);
        let met = crossings(&surfaces, surfaces.ranks(&here), &here);
        assert_eq!(met.len(), 100);
        assert!(met.windows(2).all(|pair| pair[0].1 < pair[1].1), "front to back");
        let nothing = TransferFunction::new(&[[0.0; 4]], &[[0.0, 0.0]]).unwrap();
        let opacity = compose(&surfaces, &nothing, &here).opacity;
        assert!((opacity - (1.0 - 0.98f64.powi(100))).abs() < 1e-14);
    }
}

#[test]
fn ranks_decide_whatever_the_scalars_say() {
    let surfaces = set(&[(0.5, 0.3)]);
    let share = |ranks, front, back| {
        let met = crossings(&surfaces, ranks, &segment(front, back, 1.0));
        assert_eq!(met.len(), 1);
        met[0].1
    };
    assert_eq!(share([0, 1], 0.6, 0.9), 0.0, "behind the entry already: at the front");
    assert_eq!(share([1, 0], 0.4, 0.1), 0.0);
    assert_eq!(share([0, 1], 0.1, 0.4), 1.0, "not reached yet: at the back");
    assert_eq!(share([0, 1], 0.5, 0.5), 0.0, "one scalar, two ranks: at the front");
    assert_eq!(crossings(&surfaces, [1, 1], &segment(0.4, 0.6, 1.0)), []);
    assert_eq!(crossings(&surfaces, [7, 9], &segment(0.4, 0.6, 1.0)), [], "more than there are");
}

#[test]
fn the_whole_length_is_integrated_once_whatever_the_ranks_are() {
    let surfaces = set(&[(0.2, 0.3), (0.5, 0.3), (0.5, 0.1), (0.8, 0.2)]);
    let ends = [-1e308f64, -1.0, 0.2, 0.2 + 1e-16, 0.5, 0.8, 1.0, 1e308];
    for (front, back) in ends.into_iter().flat_map(|front| ends.map(|back| (front, back))) {
        // A part whose share of the length is no number above 0 is left out.
        let is_one = |a: f64, b: f64| (0.5 * a - 0.5 * b).abs() <= 1e-300 * (0.5 * front - 0.5 * back).abs();
        for (p, q) in (0..=4).flat_map(|p| (0..=4).map(move |q| (p, q))) {
            let (mut length, mut at) = (0.0, front);
            let volume = |part: &Segment| {
                assert!(is_one(part.scalar_front, at), "parts follow each other");
                at = part.scalar_back;
                length += part.chord_length;
                RgbaAssoc::TRANSPARENT
            };
            surfaces.compose([p, q], &segment(front, back, 3.0), volume, |crossing| {
                assert!((0.0..=1.0).contains(&crossing.share), "{crossing:?}");
                crossing.color
            });
            assert!((length - 3.0).abs() < 1e-14, "{front} {back} {p} {q}: {length}");
            assert!(is_one(at, back));
        }
    }
}

#[test]
fn what_is_not_a_number_does_not_end_the_program() {
    let surfaces = set(&[(0.2, 0.3), (0.5, 1.0)]);
    for (front, back) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, f64::NAN), (0.0, f64::INFINITY)] {
        for ranks in [[0, 2], [2, 0], [0, 0]] {
            let light = surfaces.compose(ranks, &segment(front, back, 1.0), |_| RgbaAssoc::TRANSPARENT, |c| c.color);
            assert!(light.rgb.iter().all(|channel| channel.is_finite()), "{front} {back} {ranks:?}");
        }
    }
}

/// An extinction without width but of area `area` about each value is a surface ([Röttger 2000], appendix): a peak of
/// half width `h` and height `area / h`.
fn peaks(values: &[f64], area: f64, half_width: f64) -> TransferFunction {
    let peak = |&value: &f64| [[value - half_width, 0.0], [value, area / half_width], [value + half_width, 0.0]];
    let extinction: Vec<_> = values.iter().flat_map(peak).collect();
    TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &extinction).unwrap()
}

#[test]
fn opaque_surfaces_are_the_limit_of_peaks_of_growing_area() {
    let values = [0.3, 0.7];
    let (surfaces, nothing) = (set(&values.map(|value| (value, 1.0))), peaks(&values, 0.0, 0.1));
    for (front, back, length) in [(0.0, 1.0, 2.0), (1.0, 0.5, 0.1), (0.29, 0.31, 0.5), (0.4, 0.6, 9.0), (0.8, 0.9, 9.0)]
    {
        let here = segment(front, back, length);
        let unshaded = compose(&surfaces, &nothing, &here).opacity;
        let heaviside = values.iter().any(|&value| (front < value) != (back < value));
        assert_eq!(unshaded, if heaviside { 1.0 } else { 0.0 });
        let count = surfaces.between(front, back).len() as f64;
        for area in [0.01, 0.1, 1.0, 10.0] {
            // Whole peaks only: the optical depth is their area over the change of the scalar along the length.
            let missing = (-count * area * length / f64::abs(back - front)).exp();
            for half_width in [5e-3, 1e-6, 1e-9] {
                let opacity = exact(&peaks(&values, area, half_width), MODEL, &here).opacity;
                // The ends of the peak are rounded to 1e-16 beside a half width.
                let tolerance = 1e-12 + 2e-16 / half_width;
                assert!((opacity - (1.0 - missing) * unshaded).abs() < tolerance, "{front} {back} {area} {half_width}");
            }
        }
    }
}

/// Some surfaces, some at one value, on a raster that joints may lie on too.
fn any_surfaces() -> impl Strategy<Value = Isosurfaces> {
    prop::collection::vec((1..16i32, prop_oneof![0.0..1.0, Just(1.0)]), 0..6).prop_map(|all| {
        set(&all.iter().map(|&(value, opacity)| (f64::from(value) / 16.0, opacity)).collect::<Vec<_>>())
    })
}

/// Two ends and joints between them, on the raster or off it, in the order of the ray.
fn any_chain() -> impl Strategy<Value = Vec<f64>> {
    let scalar = || prop_oneof![0.0..1.0f64, (0..=16i32).prop_map(|s| f64::from(s) / 16.0)];
    (prop::collection::vec(scalar(), 2..8), any::<bool>()).prop_map(|(mut scalars, rises)| {
        scalars.sort_by(f64::total_cmp);
        if !rises {
            scalars.reverse();
        }
        scalars
    })
}

proptest! {
    /// Cut at any joints, also exactly on a surface, a ray shows what it shows in one piece. The tolerance is that of
    /// `exact`; lengths are shares of the scalar's range, so that they are rounded relative to a part's ends.
    #[test]
    fn a_chain_shows_what_the_whole_does(surfaces in any_surfaces(), joints in any_chain(), length in 0.0..5.0f64) {
        let (first, last) = (joints[0], joints[joints.len() - 1]);
        prop_assume!((last - first).abs() > 1e-3);
        let transfer = transfer();
        let mut light = RgbaAssoc::TRANSPARENT;
        let mut met = Vec::new();
        for pair in joints.windows(2) {
            let part = segment(pair[0], pair[1], length * (pair[1] - pair[0]) / (last - first));
            light = light.over(compose(&surfaces, &transfer, &part));
            met.extend(surfaces.between(pair[0], pair[1]));
        }
        let whole = segment(first, last, length);
        prop_assert!(difference(light, compose(&surfaces, &transfer, &whole)) < 1e-11);
        met.sort_unstable();
        prop_assert_eq!(met, surfaces.between(first, last).collect::<Vec<_>>());
    }

    /// Two cells may not agree on the scalar between them. With ranks that are handed on, nothing is met twice or
    /// missed, in no other order, and the volume changes only as much as its scalars do.
    #[test]
    fn handed_on_ranks_close_what_does_not_fit(
        surfaces in any_surfaces(),
        joints in any_chain(),
        jitter in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 8),
        size in prop_oneof![Just(0.0), (-15.0..-4.0f64).prop_map(|exponent| 10f64.powf(exponent))],
    ) {
        // Cells are longer than the gaps between them.
        prop_assume!(joints.windows(2).all(|pair| (pair[1] - pair[0]).abs() > 4e-4));
        let count = joints.len() - 1;
        let (first, last) = (joints[0], joints[count]);
        let (mut light, mut met, mut rank) = (RgbaAssoc::TRANSPARENT, Vec::new(), surfaces.rank(first));
        for (cell, pair) in joints.windows(2).enumerate() {
            let front = if cell == 0 { first } else { pair[0] + size * jitter[cell].0 };
            let back = if cell + 1 == count { last } else { pair[1] + size * jitter[cell].1 };
            let part = segment(front, back, (pair[1] - pair[0]).abs());
            let ranks = [rank, surfaces.rank(back)];
            rank = ranks[1];
            let volume = |part: &Segment| exact(&transfer(), MODEL, part);
            light = light.over(surfaces.compose(ranks, &part, volume, |crossing| crossing.color));
            met.extend(crossings_to_the_end(&surfaces, ranks, &part));
        }
        let whole = segment(first, last, (last - first).abs());
        prop_assert_eq!(met, crossings_to_the_end(&surfaces, surfaces.ranks(&whole), &whole));
        // Extinction changes by 30 per unit of the scalar at most, color by 1, over a length of 1 in all; a surface
        // moves by twice the jitter among an extinction of up to 3.
        let tolerance = 1e-11 + 60.0 * size;
        prop_assert!(difference(light, compose(&surfaces, &transfer(), &whole)) < tolerance);
    }
}

/// Which surfaces are met and from where, those behind opaque ones too.
fn crossings_to_the_end(surfaces: &Isosurfaces, ranks: [usize; 2], segment: &Segment) -> Vec<(usize, [f64; 3])> {
    let glass: Vec<_> = surfaces.as_slice().iter().map(|surface| Isosurface { opacity: 0.0, ..*surface }).collect();
    let glass = Isosurfaces::new(glass).unwrap();
    crossings(&glass, ranks, segment).into_iter().map(|(index, _, color)| (index, color)).collect()
}
