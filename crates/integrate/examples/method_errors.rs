//! Prints the error table of the crate's README: each way to integrate against the exact one, for five transfer
//! functions.
//!
//! `cargo run --release -p tetrascope-integrate --example method_errors`

#![expect(clippy::print_stdout, reason = "printing is the purpose")]

mod families;

use tetrascope_integrate::{
    OpticalModel, RgbaAssoc, RunningIntegrals, Segment, TransferFunction, TransferFunctionError, average, exact,
    opacity_2d, partial,
};

const MODEL: OpticalModel = OpticalModel::DensityEmitter;

/// A way to integrate, with what it makes of a transfer function before.
enum Method {
    Function(fn(&TransferFunction, OpticalModel, &Segment) -> RgbaAssoc),
    Cumulative,
    WithoutCorrection,
}

fn main() -> Result<(), TransferFunctionError> {
    let functions = transfer_functions()?;
    for (range, widest) in [("coarse cells", 1.0), ("fine cells", 0.05)] {
        println!("{range}");
        let methods = [
            ("`average`", Method::Function(average)),
            ("`vertex`, `opacity-2d`", Method::Function(opacity_2d)),
            ("`partial`", Method::Function(partial)),
            ("`cumulative`", Method::Cumulative),
            ("... without correction", Method::WithoutCorrection),
            ("`exact`", Method::Function(exact)),
        ];
        for (name, method) in &methods {
            let errors = functions.iter().map(|(_, transfer)| {
                let (largest, mean) = errors(transfer, method, widest);
                format!("{largest:.2} / {mean:.4}")
            });
            println!("| {name} | {} |", errors.collect::<Vec<_>>().join(" | "));
        }
    }
    Ok(())
}

/// Largest and mean error over the four channels, of segments with scalars at most `widest` apart and lengths from 1/1000
/// to 1/2, evenly over their exponents.
fn errors(transfer: &TransferFunction, method: &Method, widest: f64) -> (f64, f64) {
    const SEGMENTS: u32 = 40_000;
    let integrals = RunningIntegrals::new(transfer);
    let light = |segment: &Segment| match method {
        Method::Function(function) => function(transfer, MODEL, segment),
        Method::Cumulative => integrals.integrate(MODEL, segment),
        Method::WithoutCorrection => integrals.without_correction(MODEL, segment),
    };
    let (mut largest, mut sum) = (0.0f64, 0.0);
    for i in 0..SEGMENTS {
        // Multiples of powers of an irrational number fill the cube evenly (Roberts 2018).
        let fraction = |step: f64| (0.5 + f64::from(i) * step).fract();
        let [first, second, third] = [0.819_172_513, 0.671_043_607, 0.549_700_478].map(fraction);
        let scalar_front = first;
        let scalar_back = if widest < 1.0 { (first + widest * (2.0 * second - 1.0)).clamp(0.0, 1.0) } else { second };
        let chord_length = 1e-3 * 500f64.powf(third);
        let segment = Segment { scalar_front, scalar_back, chord_length };
        let (known, got) = (exact(transfer, MODEL, &segment), light(&segment));
        let light = known.rgb.iter().zip(got.rgb).map(|(known, got)| (known - got).abs());
        let error = light.fold((known.opacity - got.opacity).abs(), f64::max);
        largest = largest.max(error);
        sum += error;
    }
    (largest, sum / f64::from(SEGMENTS))
}

fn transfer_functions() -> Result<Vec<(&'static str, TransferFunction)>, TransferFunctionError> {
    families::extinctions()
        .into_iter()
        .map(|(name, extinction)| Ok((name, TransferFunction::new(&families::COLOR, &extinction)?)))
        .collect()
}
