//! Prints the error tables in the documentation of the pre-integration tables: their look-ups against the exact
//! integral, for five transfer functions and several sizes.
//!
//! `cargo run --release -p tetrascope-integrate --example table_errors`

#![expect(clippy::print_stdout, reason = "printing is the purpose")]

mod families;

use std::error::Error;

use tetrascope_integrate::{
    Deviation, LengthAxis, OpticalModel, Table2d, Table3d, TableDomain, TableSettings, TransferFunction,
    TransferFunctionError, deviation,
};

/// The mean length is that of lengths from 1/1000 to 1/2, as many in each octave.
const DOMAIN: TableDomain = TableDomain { scalars: [0.0, 1.0], mean_length: 0.08, max_length: 0.5 };
const SEGMENTS: u32 = 40_000;

fn main() -> Result<(), Box<dyn Error>> {
    let functions = transfer_functions()?;
    let model = OpticalModel::DensityEmitter;
    let quiet = |_, _| ();
    let sizes = [
        (64, 64, LengthAxis::Linear),
        (128, 128, LengthAxis::Linear),
        (256, 32, LengthAxis::Linear),
        (64, 64, LengthAxis::Logarithmic),
        (256, 32, LengthAxis::Logarithmic),
    ];
    for (cells, widest) in [("coarse cells", 1.0), ("fine cells", 0.05)] {
        println!("{cells}");
        for (scalars, lengths, length_axis) in sizes {
            let size = TableSettings { scalars, lengths, length_axis };
            let mut columns = Vec::new();
            for transfer in &functions {
                let table = Table3d::build(transfer, model, &DOMAIN, &size, None, &quiet)?;
                columns.push(column(deviation(transfer, model, &DOMAIN, widest, SEGMENTS, |s| table.look_up(s))));
            }
            println!("| {scalars}² | {lengths} {length_axis:?} | {} |", columns.join(" | "));
        }
        for scalars in [64, 256] {
            let size = TableSettings { scalars, lengths: 2, length_axis: LengthAxis::Linear };
            let mut columns = Vec::new();
            for transfer in &functions {
                let table = Table2d::build(transfer, model, &DOMAIN, &size, None, &quiet)?;
                columns.push(column(deviation(transfer, model, &DOMAIN, widest, SEGMENTS, |s| table.look_up(s))));
            }
            println!("| {scalars}² | {} |", columns.join(" | "));
        }
    }
    Ok(())
}

fn column(deviation: Deviation) -> String {
    format!("{:.3} / {:.4}", deviation.largest, deviation.mean)
}

/// Those of the README's error tables, see the example `method_errors`.
fn transfer_functions() -> Result<Vec<TransferFunction>, TransferFunctionError> {
    families::extinctions().iter().map(|(_, extinction)| TransferFunction::new(&families::COLOR, extinction)).collect()
}
