//! Look-ups in eight lanes against those in 64 bits, at every level at hand.

use fearless_simd::{Level, dispatch, prelude::*};

use crate::table_tests::{difference, quiet, settings, steps_and_peaks, table_2d, table_3d};
use crate::{LengthAxis, OpticalModel, RgbaAssoc, Segment, Table2d, Table3d, TableDomain, TransferFunction};

/// What eight lanes look up at coordinates, at every level at hand.
macro_rules! in_lanes {
    ($table:expr, $level:expr, $points:expr) => {{
        let [front, back, length]: [[f32; 8]; 3] = core::array::from_fn(|axis| $points.map(|point| point[axis]));
        let (table, level) = (&$table, $level);
        let [red, green, blue, opacity] = dispatch!(level, simd => {
            let light =
                table.look_up_lanes(simd, front.simd_into(simd), back.simd_into(simd), length.simd_into(simd));
            let [red, green, blue] = light.rgb;
            [red, green, blue, light.opacity].map(|channel| <[f32; 8]>::from(channel))
        });
        core::array::from_fn::<_, 8, _>(|lane| RgbaAssoc {
            rgb: [red[lane], green[lane], blue[lane]].map(f64::from),
            opacity: f64::from(opacity[lane]),
        })
    }};
}

fn levels() -> [Level; 2] {
    [Level::new(), Level::baseline()]
}

/// Points of a table over scalars 0 to `last`, where coordinates are scalars, so that no rounding tells them apart.
fn lane_points(last: f32, longest: f32) -> Vec<[[f32; 3]; 8]> {
    let fraction = |i: u32, step: f32| (0.5 + i as f32 * step).fract();
    let scalar = |share: f32| (1.2 * share - 0.1) * last;
    let inside = (0..4000u32).map(|i| {
        let length = longest * 1.1 * 2000f32.powf(fraction(i, 0.549_700_5) - 1.0);
        [scalar(fraction(i, 0.819_172_5)), scalar(fraction(i, 0.671_043_6)), length]
    });
    // Samples, ends, and beyond them.
    let special = [0.0, 1.0, last - 1.0, last, last + 0.5, -7.0, 1e30, -1e30];
    let corners = special.iter().flat_map(|&front| {
        special.iter().flat_map(move |&back| {
            [0.0, 1e-30, longest / 1024.0, longest * 0.25, longest, 3.0 * longest, 1e30, longest / 2000.0]
                .map(|length| [front, back, length])
        })
    });
    let all: Vec<_> = inside.chain(corners).collect();
    all.chunks_exact(8).map(|chunk| chunk.try_into().unwrap()).collect()
}

#[test]
fn lanes_agree_with_the_look_up() {
    let color = [[0.0, 0.1, 0.9, 0.0], [6.0, 1.0, 0.2, 0.3], [6.0, 0.0, 0.0, 0.8], [12.0, 0.4, 0.4, 0.4]];
    let extinction = [[1.0, 0.0], [2.0, 9.0], [7.5, 1.0], [8.0, 0.0], [8.0, 30.0], [16.0, 2.0]];
    let transfer = TransferFunction::new(&color, &extinction).unwrap();
    let domain = TableDomain { scalars: [0.0, 16.0], mean_length: 0.06, max_length: 0.4 };
    let mut worst = [0.0f64; 2];
    for model in OpticalModel::ALL {
        for (lengths, length_axis) in [
            (2, LengthAxis::Linear),
            (33, LengthAxis::Linear),
            (2, LengthAxis::Logarithmic),
            (31, LengthAxis::Logarithmic),
        ] {
            let settings = settings(17, lengths, length_axis);
            let of_3d = Table3d::build(&transfer, model, &domain, &settings, None, &quiet).unwrap();
            let of_2d = Table2d::build(&transfer, model, &domain, &settings, None, &quiet).unwrap();
            for level in levels() {
                for points in lane_points(16.0, 0.4) {
                    let (from_3d, from_2d) = (in_lanes!(of_3d, level, points), in_lanes!(of_2d, level, points));
                    for (lane, point) in points.iter().enumerate() {
                        let [scalar_front, scalar_back, chord_length] = point.map(f64::from);
                        let segment = Segment { scalar_front, scalar_back, chord_length };
                        // Entries up to 1.
                        let error = difference(from_3d[lane], of_3d.look_up(&segment));
                        assert!(error < 1e-6, "{model} {length_axis:?} {segment:?}: {error:e}");
                        assert!(
                            (0.0..=1.0).contains(&from_3d[lane].opacity)
                                && (0.0..=1.0).contains(&from_2d[lane].opacity)
                        );
                        worst[0] = worst[0].max(error);
                        // The emission's light grows with the length without end.
                        let largest = (chord_length / 0.06).max(1.0);
                        let error = difference(from_2d[lane], of_2d.look_up(&segment)) / largest;
                        assert!(error < 1e-6, "{model} {segment:?}: {error:e}");
                        worst[1] = worst[1].max(error);
                    }
                }
            }
        }
    }
    println!("largest difference of the lanes: three-dimensional {:.1e}, two-dimensional {:.1e}", worst[0], worst[1]);
}

#[test]
fn lanes_survive_what_is_no_number() {
    let transfer = steps_and_peaks();
    for axis in [LengthAxis::Linear, LengthAxis::Logarithmic] {
        let table = table_3d(&transfer, OpticalModel::DensityEmitter, settings(3, 5, axis));
        let other = table_2d(&transfer, OpticalModel::DensityEmitter, 3);
        for level in levels() {
            let good = [1.25, 0.5, 0.2];
            let mut points = [good; 8];
            for (lane, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().enumerate() {
                points[lane] = [bad, 0.5, 0.2];
                points[lane + 3] = [1.0, bad, 0.2];
            }
            points[6] = [1.0, 1.0, f32::NAN];
            let (from_3d, from_2d) = (in_lanes!(table, level, points), in_lanes!(other, level, points));
            let (known_3d, known_2d) = (in_lanes!(table, level, [good; 8]), in_lanes!(other, level, [good; 8]));
            assert_eq!((from_3d[7], from_2d[7]), (known_3d[7], known_2d[7]));
            let ends = in_lanes!(table, level, [[2.0, 0.5, 0.2]; 8]);
            assert_eq!(from_3d[1], ends[1], "infinity is beyond the axis");
        }
    }
}
