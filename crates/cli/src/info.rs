//! `tetrascope info`: what is in a mesh file, and what is wrong with it.

mod drawn;
mod histogram;
mod said;

use std::path::PathBuf;

use clap::Args;
use console::Term;
use tetrascope::mesh::{FaceAdjacency, MeshReport, check};
use tetrascope::{
    ArraySummary, Association, Dataset, Field, FieldError, Loaded, decompose, select_cell_field, select_field,
    summarize_arrays,
};

use crate::progress::Bar;
use crate::read_args::ReadArgs;
use crate::report::{line, object};
use crate::{Failure, interrupt};
use histogram::Histogram;

const EXAMPLES: &str = "\
Examples:
  tetrascope info case.vtu
  tetrascope info case.exo --step 0 --field Velocity:mag
  tetrascope info grid.xyz solution.q --field Density --bins 20 --log
  tetrascope info cavity/ --time 0.5                   the folder of an OpenFOAM case
  tetrascope info scan.bin --raw 64x64x93:int16:big
  tetrascope info case.vtu --json

The histogram counts the points of an array of points, the cells of one of cells, each once whatever its size: all of them that have a finite value.

Exit codes: 0 good, 1 wrong input or nothing in it that can be drawn, 2 wrong usage.";

/// Say what is in a mesh file and what is wrong with it.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct InfoArgs {
    /// A mesh file, a folder of OpenFOAM, or a PLOT3D grid and its solution
    #[arg(required = true, num_args = 1..=2, value_name = "FILE")]
    pub(crate) input: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) read: ReadArgs,
    /// Array of the histogram: a name, or NAME:0, NAME:x, NAME:mag of a vector [default: what `render` would show]
    #[arg(long, value_name = "NAME", help_heading = "Histogram")]
    pub(crate) field: Option<String>,
    /// Number of its bins [default: what fits the terminal; 64 with --json]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096), help_heading = "Histogram")]
    pub(crate) bins: Option<u16>,
    /// Draw it by the logarithm of the counts
    #[arg(long, help_heading = "Histogram")]
    pub(crate) log: bool,
    /// Report on standard output as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
}

/// Columns where nobody says how many there are.
const COLUMNS: usize = 80;
/// Columns that a line begins with.
const MARGIN: usize = 12;
/// Bins for machines.
const BINS: usize = 64;

/// All that is known of a file.
struct Facts {
    path: PathBuf,
    loaded: Loaded,
    arrays: Vec<ArraySummary>,
    /// Of the tetrahedra; else why there is none.
    report: Result<MeshReport, String>,
    /// Of the field; else why there is none. `None` where there is no array.
    histogram: Option<Result<Histogram, String>>,
}

pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let [path, rest @ ..] = args.input.as_slice() else {
        return Err(Failure::Usage("name a file".to_owned()));
    };
    let bar = Bar::new(false);
    let loaded = args.read.read(path, rest.first().map(PathBuf::as_path), &bar);
    bar.clear();
    let loaded = loaded?;
    interrupt::go_on()?;
    let width = columns().saturating_sub(MARGIN).max(1);
    let bins = args.bins.map_or(if args.json { BINS } else { width }, usize::from);
    let histogram = match histogram_of(&loaded.dataset, args.field.as_deref(), bins) {
        Ok(histogram) => Some(Ok(histogram)),
        // Whoever names a field has to hear that it is not there; a mesh alone is worth telling of.
        Err(error) if args.field.is_some() => return Err(Failure::Input(format!("{}: {error}", path.display()))),
        Err(FieldError::NoArrays) => None,
        Err(error) => Some(Err(error.to_string())),
    };
    // What was read is worth telling even where nothing can be drawn.
    let report = decompose(&loaded.dataset)
        .map(|decomposition| check(&decomposition, &FaceAdjacency::new(decomposition.mesh.tetrahedra())))
        .map_err(|error| error.to_string());
    let facts = Facts { path: path.clone(), arrays: summarize_arrays(&loaded.dataset), loaded, report, histogram };
    if args.json {
        object(&facts.as_json());
    } else {
        facts.lines(width, args.log).iter().for_each(|text| line(text));
    }
    facts.report.map(|_| ()).map_err(|error| Failure::Input(format!("{}: {error}", path.display())))
}

/// Columns of the terminal that standard output is.
fn columns() -> usize {
    Term::stdout().size_checked().map_or(COLUMNS, |(_, columns)| usize::from(columns))
}

/// The histogram of the field of a name, or of the one that is shown without one.
fn histogram_of(dataset: &Dataset, name: Option<&str>, bins: usize) -> Result<Histogram, FieldError> {
    let field = select_field(dataset, name)?;
    // The field of a cell array has its means at points; what the file has is told here.
    let field = match field.association {
        Association::Point => field,
        Association::Cell => select_cell_field(dataset, Some(&field.name))?,
    };
    let Field { name, association, values, .. } = field;
    Ok(Histogram::new(name, association, &values, bins))
}
