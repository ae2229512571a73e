//! `cargo xtask accuracy`: the error of every integration method against the exact one, with the time that an evaluation takes; and the
//! pixels that every visibility order gets wrong.
//!
//! Errors of integration are those of single segments, the largest of the four channels; scalars run from 0 to 1 and lengths from 1/1000 to 1/2, evenly
//! over their exponents. Coarse cells have any two scalars at their ends, fine ones such that lie at most 1/20 apart. Times are
//! of the f64 functions along a ray; the renderers have others.

mod estimates;
mod families;
mod methods;
mod orders;
mod table;

use std::fs;
use std::hint::black_box;
use std::time::Instant;

use tetrascope::OpticalModel;
use tetrascope::integrate::{RgbaAssoc, Segment, TableDomain, deviation};

use crate::Failure;
use families::{Family, families};
use methods::{Method, methods};
use table::{Cell, Row, Table};

/// What to measure.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Segments for each number.
    #[arg(long, default_value_t = 40_000, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    samples: u32,
    /// Only methods, or with --part orders meshes, whose names contain this, such as "table-3d" or "fin".
    #[arg(long, default_value = "")]
    only: String,
    /// Integration methods or visibility orders alone.
    #[arg(long)]
    part: Option<Part>,
    /// Put the tables into docs/accuracy.md and docs/orders.md, between their marks.
    #[arg(long)]
    write: bool,
}

/// One half of what is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Part {
    Integration,
    Orders,
    Estimates,
}

/// Sizes of cells: a name, and how far apart the scalars at the ends of a segment are at most.
const CELLS: [(&str, f64); 2] = [("coarse cells", 1.0), ("fine cells", 0.05)];

/// What tables cover: lengths up to 1/2. The mean is that of lengths from 1/1000 on, spread evenly over their exponents:
/// (1/2 - 1/1000) / ln 500.
const DOMAIN: TableDomain = TableDomain { scalars: [0.0, 1.0], mean_length: 0.0803, max_length: 0.5 };

/// Segments in a time.
const TIMED_SEGMENTS: u32 = 2_000;

/// Times of which the median is taken.
const REPEATS: usize = 5;

/// Where the tables go, and the marks between which.
const INTEGRATION_TEXT: &str = "docs/accuracy.md";
const ORDERS_TEXT: &str = "docs/orders.md";
const BEGIN: &str = "<!-- tables: begin -->\n";
const END: &str = "<!-- tables: end -->";

/// Prints a table for every optical model and size of cells, and two for the visibility orders.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.write && !args.only.is_empty() {
        return Err("--write needs all methods and meshes; leave out --only".into());
    }
    if args.part == Some(Part::Estimates) {
        return estimates::run(u64::from(args.samples), true);
    }

    if args.part != Some(Part::Orders) {
        let mut text = String::new();
        for model in OpticalModel::ALL {
            for table in tables(model, args)? {
                let table = table.to_string();
                println!("{table}");
                text.push_str(&table);
                text.push('\n');
            }
        }
        if args.write {
            put_into(INTEGRATION_TEXT, &text)?;
        }
    }
    if args.part != Some(Part::Integration) {
        let data = crate::root().join("../shared/data");
        let data = data.is_dir().then_some(data);
        if data.is_none() {
            println!("the folder ../shared is not there: the built-in sample alone");
        }
        if args.write && data.is_none() {
            return Err("--write needs the meshes of ../shared, which is not there".into());
        }
        let text = orders::tables(data.as_deref(), &args.only)?;
        println!("{text}");
        if args.write {
            put_into(ORDERS_TEXT, &text)?;
        }
    }
    Ok(())
}

/// Replaces what a text has between its marks.
fn put_into(name: &str, tables: &str) -> Result<(), Failure> {
    let path = crate::root().join(name);
    let old = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let new = replaced(&old, tables).ok_or_else(|| format!("{name} lacks the marks {} and {END}", BEGIN.trim()))?;
    fs::write(&path, new)?;
    println!("written: {name}");
    Ok(())
}

/// The text with other tables between its marks; `None` if it has no marks.
fn replaced(text: &str, tables: &str) -> Option<String> {
    let (before, rest) = text.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}\n{tables}{END}{after}"))
}

/// The errors of all methods for a model: coarse cells, then fine ones.
fn tables(model: OpticalModel, args: &Args) -> Result<Vec<Table>, Failure> {
    let families = families(model)?;
    let mut tables = CELLS.map(|(cells, _)| Table {
        title: format!("`{model}`, {cells}"),
        columns: families.iter().map(|family| family.name).collect(),
        rows: Vec::new(),
    });
    for family in &families {
        // One family at a time, so that no more tables than its own are in memory.
        let found = methods(&family.transfer, model, &DOMAIN, &args.only)?;
        if found.is_empty() {
            println!("{model}: no method that covers it has \"{}\" in its name", args.only);
            return Ok(Vec::new());
        }
        for ((_, widest), table) in CELLS.iter().zip(&mut tables) {
            for (method, cell) in found.iter().zip(measure(family, model, &found, *widest, args.samples)) {
                let row = match table.rows.iter_mut().find(|row| row.method == method.name && row.size == method.size) {
                    Some(row) => row,
                    None => {
                        let empty = Row { method: method.name, size: method.size.clone(), cells: Vec::new() };
                        table.rows.push(empty);
                        let last = table.rows.len() - 1;
                        &mut table.rows[last]
                    }
                };
                row.cells.push(cell);
            }
        }
    }
    Ok(tables.into())
}

/// Errors and times of all methods for one transfer function.
fn measure(family: &Family, model: OpticalModel, methods: &[Method<'_>], widest: f64, samples: u32) -> Vec<Cell> {
    // Methods take turns, so that a machine whose speed drifts slows all of them alike.
    let segments = segments(widest);
    let mut times = vec![Vec::new(); methods.len()];
    for _ in 0..REPEATS {
        for (method, times) in methods.iter().zip(&mut times) {
            let start = Instant::now();
            for segment in &segments {
                let _: RgbaAssoc = black_box((method.evaluate)(black_box(segment)));
            }
            times.push(start.elapsed().as_secs_f64() * 1e9 / f64::from(TIMED_SEGMENTS));
        }
    }
    let cell = |(method, mut times): (&Method<'_>, Vec<f64>)| {
        times.sort_by(f64::total_cmp);
        let error = deviation(&family.transfer, model, &DOMAIN, widest, samples, |segment| (method.evaluate)(segment));
        Cell {
            largest: error.largest,
            root_mean_square: error.root_mean_square,
            mean: error.mean,
            nanoseconds: times[times.len() / 2],
        }
    };
    methods.iter().zip(times).map(cell).collect()
}

/// The segments that are timed, of the kind that errors are measured on.
fn segments(widest: f64) -> Vec<Segment> {
    let segment = |i: u32| {
        // Multiples of powers of an irrational number fill the cube evenly (Roberts 2018).
        let fraction = |step: f64| (0.5 + f64::from(i) * step).fract();
        let [scalar_front, second, third] = [0.819_172_513, 0.671_043_607, 0.549_700_478].map(fraction);
        let nearby = (scalar_front + widest * (2.0 * second - 1.0)).clamp(0.0, 1.0);
        let scalar_back = if widest < 1.0 { nearby } else { second };
        Segment { scalar_front, scalar_back, chord_length: 1e-3 * 500f64.powf(third) }
    };
    (0..TIMED_SEGMENTS).map(segment).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_go_between_the_marks() {
        let text = format!("before\n{BEGIN}old\n{END}\nafter\n");
        assert_eq!(replaced(&text, "new\n").unwrap(), format!("before\n{BEGIN}\nnew\n{END}\nafter\n"));
        assert!(replaced("no marks", "new").is_none());
    }

    #[test]
    fn every_method_is_measured_for_every_family() {
        let args = Args { samples: 50, only: "average".to_owned(), part: None, write: false };
        for table in tables(OpticalModel::DensityEmitter, &args).unwrap() {
            assert_eq!(table.columns.len(), 5);
            assert_eq!(table.rows.len(), 1, "{}", table.title);
            assert!(table.rows[0].cells.iter().all(|cell| cell.largest > 0.0 && cell.largest < 2.0));
        }
    }
}
