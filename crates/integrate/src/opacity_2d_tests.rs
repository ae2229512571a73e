//! The table of opacities against the closed form, and the closed form against the thick vertex.

use super::*;

#[test]
fn every_ray_has_the_formula_of_the_thick_vertex() {
    let transfer =
        TransferFunction::new(&[[0.0, 0.2, 0.4, 0.6], [1.0, 0.8, 0.0, 1.0]], &[[0.0, 1.0], [1.0, 7.0]]).unwrap();
    let segment = Segment { scalar_front: 0.25, scalar_back: 0.75, chord_length: 0.5 };
    let (tau, color) = (2.0f64, [0.5, 0.2, 0.8]);
    let opacity = 1.0 - (-tau).exp();
    for (model, factor, alpha) in [
        (OpticalModel::DensityEmitter, opacity, opacity),
        (OpticalModel::Emitter, 0.5 * opacity / tau, opacity),
        (OpticalModel::Absorption, 0.0, opacity),
        (OpticalModel::Emission, 0.5, 0.0),
    ] {
        let light = opacity_2d(&transfer, model, &segment);
        assert!((light.opacity - alpha).abs() < 1e-15, "{model}");
        assert!(light.rgb.iter().zip(color).all(|(got, color)| (got - factor * color).abs() < 1e-15), "{model}");
        assert_eq!(light, thick_vertex(&transfer, model, &segment));
    }
}

#[test]
fn samples_are_exact_and_errors_fall_with_the_square_of_the_size() {
    let mut before = f64::INFINITY;
    for size in [16u32, 64, 256] {
        let table = OpacityTable::new(4.0, 2.0, [size; 2]).unwrap();
        for (row, column) in [(0, 3), (1, 1), (size / 2, size - 2), (size - 1, size - 1)] {
            let at = |index: u32, largest: f64| largest * f64::from(index) / f64::from(size - 1);
            let (extinction, length) = (at(row, 4.0), at(column, 2.0));
            let known = -(-extinction * length).exp_m1();
            assert!((table.look_up(extinction, length) - known).abs() < 1e-6, "{size} {row} {column}");
        }
        let error = table.largest_error();
        println!("{size} x {size}, depths up to 8: {error:.1e}");
        // Four times finer: sixteen times better, once the curve is resolved.
        assert!(error < before / 9.0, "{error} after {before}");
        before = error;
    }
    assert!(before < 2e-3, "{before}");
}

#[test]
fn the_stated_error_holds_everywhere() {
    let table = OpacityTable::new(30.0, 0.5, [24, 48]).unwrap();
    let error = table.largest_error();
    for i in 0..=300 {
        for j in 0..=300 {
            let (extinction, length) = (0.1 * f64::from(i), 0.5 / 300.0 * f64::from(j));
            let difference = (table.look_up(extinction, length) + (-extinction * length).exp_m1()).abs();
            // Places between those that were tried: the error is flat around its maximum.
            assert!(difference <= 1.02 * error + 1e-7, "{extinction} {length}: {difference:e}, stated {error:e}");
        }
    }
}

#[test]
fn what_is_out_of_range_is_moved_to_the_end() {
    let table = OpacityTable::new(2.0, 3.0, [8, 8]).unwrap();
    let most = table.look_up(2.0, 3.0);
    for (extinction, length) in [(5.0, 3.0), (2.0, 1e300), (f64::INFINITY, f64::INFINITY)] {
        assert_eq!(table.look_up(extinction, length), most);
    }
    for (extinction, length) in [(-1.0, 3.0), (2.0, 0.0), (f64::NAN, 3.0)] {
        assert_eq!(table.look_up(extinction, length), 0.0);
    }
}

#[test]
fn sizes_out_of_range_are_refused() {
    for size in [[1, 8], [8, 1025], [0, 0]] {
        let message = OpacityTable::new(1.0, 1.0, size).unwrap_err().to_string();
        assert!(message.contains("2 to 1024"), "{message}");
    }
}
