//! `tetrascope convert`: a mesh of any format that is read, as VTK's XML file of an unstructured grid.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::{Args, ValueEnum};
use serde_json::{Map, Value, json};
use tetrascope::{
    DataArray, Dataset, FieldError, Loaded, Volume, VtuEncoding, VtuOptions, WrittenVtu, is_builtin, short,
    summarize_arrays, write_vtu_with,
};

use crate::Failure;
use crate::interrupt;
use crate::kinds::{kinds, name_of};
use crate::progress::Bar;
use crate::read_args::ReadArgs;
use crate::render::check_target;
use crate::report::{line, object, seconds, warning};

const EXAMPLES: &str = "\
Examples:
  tetrascope convert case.exo case.vtu                          for ParaView, PyVista, meshio
  tetrascope convert case.exo case.vtu --tetrahedra             what is drawn: every cell cut into tetrahedra
  tetrascope convert grid.xyz solution.q case.vtu --field Density --field Velocity
  tetrascope convert cavity/ end.vtu --time 0.5 --encoding zlib
  tetrascope convert scan.raw scan.vtu --raw 64x64x93:int16:big:spacing=3.2,3.2,1.5

Points, cells and arrays keep every bit, their types and their order. Grids become hexahedra that name their points; cells that the file hides are
left out. With --tetrahedra an array has the mean at points that are added, and cell arrays are repeated for each tetrahedron of a cell.

Exit codes: 0 good, 1 wrong input or no room, 2 wrong usage, 130 interrupted. OUT is written whole or not at all: interrupted, or with a full
disk, the old one stays as it was.";

/// Write a mesh file of any format that is read as a .vtu file.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, override_usage = "tetrascope convert [OPTIONS] <IN> [SOLUTION] <OUT.vtu>")]
pub(crate) struct ConvertArgs {
    /// A mesh file, a folder of OpenFOAM, or a PLOT3D grid and its solution; then the file to write, .vtu
    #[arg(required = true, num_args = 2..=3, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Write the tetrahedra that are drawn: cells of all kinds cut, inverted ones turned round, those of no volume left out
    #[arg(long)]
    pub(crate) tetrahedra: bool,
    /// Array to keep, of points or cells; may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    pub(crate) field: Vec<String>,
    /// How numbers are written: as bytes, as bytes that are compressed (half the size, ten times the time), or as text
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Encoding::Raw)]
    pub(crate) encoding: Encoding,
    #[command(flatten)]
    pub(crate) read: ReadArgs,
    /// Report on standard output as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
    /// Report nothing but warnings and errors
    #[arg(short, long, conflicts_with = "json", help_heading = "Report")]
    pub(crate) quiet: bool,
}

/// [`VtuEncoding`] on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "lower")]
pub(crate) enum Encoding {
    Raw,
    Zlib,
    Text,
}

impl Encoding {
    fn of_file(self) -> VtuEncoding {
        match self {
            Self::Raw => VtuEncoding::Raw,
            Self::Zlib => VtuEncoding::Zlib,
            Self::Text => VtuEncoding::Text,
        }
    }
}

pub(crate) fn run(args: &ConvertArgs) -> Result<(), Failure> {
    let (input, solution, output) = match args.files.as_slice() {
        [input, output] => (input, None, output),
        [input, solution, output] => (input, Some(solution.as_path()), output),
        _ => return Err(Failure::Usage("name a mesh file and the file to write".to_owned())),
    };
    check_target(output, &["vtu"], "meshes")?;
    for read in std::iter::once(input.as_path()).chain(solution) {
        if !is_builtin(read) && is_same_file(read, output) {
            let problem =
                format!("{}: it would be replaced by what is read from it; name another file", output.display());
            return Err(Failure::Usage(problem));
        }
    }
    interrupt::will_write(output);
    let bar = Bar::new(args.quiet);
    let done = convert(args, input, solution, output, &bar);
    bar.clear();
    let converted = done?;
    converted.warnings.iter().for_each(|text| warning(text));
    if args.json {
        object(&converted.as_json(args));
    } else if !args.quiet {
        converted.print();
    }
    Ok(())
}

/// What was read and written.
struct Converted {
    input: PathBuf,
    output: PathBuf,
    format: String,
    times: Vec<f64>,
    step: usize,
    cells: Vec<(String, usize)>,
    point_arrays: Vec<String>,
    cell_arrays: Vec<String>,
    written: WrittenVtu,
    notes: Vec<String>,
    warnings: Vec<String>,
    timings: [(&'static str, Duration); 2],
}

fn convert(
    args: &ConvertArgs,
    input: &Path,
    solution: Option<&Path>,
    output: &Path,
    bar: &Bar,
) -> Result<Converted, Failure> {
    bar.step("reading");
    let start = Instant::now();
    let Loaded { mut dataset, format, mut warnings, times, step } = args.read.read(input, solution, bar)?;
    keep_only(&mut dataset, &args.field).map_err(|error| Failure::Input(format!("{}: {error}", input.display())))?;
    let mut notes = Vec::new();
    if args.tetrahedra {
        interrupt::go_on()?;
        bar.step("cutting into tetrahedra");
        dataset = tetrahedra(dataset, input, &mut notes, &mut warnings)?;
    }
    let read_in = start.elapsed();
    interrupt::go_on()?;

    bar.step("writing");
    let start = Instant::now();
    let options = VtuOptions { encoding: args.encoding.of_file(), time: times.get(step).copied() };
    let written = write_vtu_with(output, &dataset, &options).map_err(tetrascope::Error::Io)?;
    interrupt::wrote(output);
    notes.extend(written.notes.iter().cloned());
    warnings.extend(written.warnings.iter().cloned());
    let names = |arrays: &[DataArray]| arrays.iter().map(|array| array.name.clone()).collect();
    Ok(Converted {
        input: input.to_owned(),
        output: output.to_owned(),
        format,
        times,
        step,
        cells: kinds(&dataset).into_iter().map(|(kind, count)| (name_of(kind), count)).collect(),
        point_arrays: names(&dataset.point_arrays),
        cell_arrays: names(&dataset.cell_arrays),
        written,
        notes,
        warnings,
        timings: [("read", read_in), ("write", start.elapsed())],
    })
}

/// Leaves the arrays of these names; all where there is none.
fn keep_only(dataset: &mut Dataset, names: &[String]) -> Result<(), FieldError> {
    let is_there =
        |name: &String| dataset.point_arrays.iter().chain(&dataset.cell_arrays).any(|array| array.name == *name);
    if let Some(name) = names.iter().find(|name| !is_there(name)) {
        return Err(FieldError::Unknown { name: name.clone(), known: summarize_arrays(dataset) });
    }
    if !names.is_empty() {
        dataset.point_arrays.retain(|array| names.contains(&array.name));
        dataset.cell_arrays.retain(|array| names.contains(&array.name));
    }
    Ok(())
}

fn tetrahedra(
    dataset: Dataset,
    input: &Path,
    notes: &mut Vec<String>,
    warnings: &mut Vec<String>,
) -> Result<Dataset, Failure> {
    let volume = Volume::from_dataset(dataset, &input.display().to_string())?;
    let cut = &volume.decomposition;
    warnings.extend(cut.counts.findings());
    notes.push(format!("{} cells were cut into tetrahedra", cut.counts.cell_count()));
    let added = cut.added_points.len();
    if added > 0 {
        notes.push(format!(
            "{added} points are added amid cells and faces; arrays have the weighted means of the cell's points there"
        ));
    }
    Ok(cut.to_dataset(&volume.dataset))
}

/// Whether both paths lead to one file that is there.
fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

impl Converted {
    fn print(&self) {
        let say = |subject: &str, text: &str| line(&format!("{subject:<11} {text}"));
        say("read", &format!("{} ({})", self.input.display(), self.format));
        if let Some(time) = self.times.get(self.step) {
            say("step", &format!("{} of {}, time {}", self.step, self.times.len(), short(*time)));
        }
        say("points", &self.written.points.to_string());
        let kinds: Vec<String> = self.cells.iter().map(|(name, count)| format!("{count} {name}")).collect();
        let kinds = if kinds.is_empty() { String::new() } else { format!(" ({})", kinds.join(", ")) };
        say("cells", &format!("{}{kinds}", self.written.cells));
        for (subject, arrays) in [("of points", &self.point_arrays), ("of cells", &self.cell_arrays)] {
            let names = if arrays.is_empty() { "no arrays".to_owned() } else { arrays.join(", ") };
            say(subject, &names);
        }
        self.notes.iter().for_each(|note| say("note", note));
        say("wrote", &format!("{} ({} bytes)", self.output.display(), self.written.bytes));
        let times: Vec<String> = self.timings.iter().map(|(step, time)| format!("{step} {}", seconds(*time))).collect();
        say("time", &times.join(", "));
    }

    fn as_json(&self, args: &ConvertArgs) -> Value {
        let cells: Map<String, Value> = self.cells.iter().map(|(name, count)| (name.clone(), json!(count))).collect();
        let timings: Map<String, Value> =
            self.timings.iter().map(|(step, time)| ((*step).to_owned(), json!(time.as_secs_f64()))).collect();
        json!({ "file": self.input.display().to_string(), "format": self.format, "times": self.times,
            "step": self.step, "time": self.times.get(self.step), "tetrahedra": args.tetrahedra,
            "points": self.written.points, "cells": self.written.cells, "kinds": cells,
            "point_arrays": self.point_arrays, "cell_arrays": self.cell_arrays,
            "encoding": args.encoding.to_possible_value().map(|value| value.get_name().to_owned()),
            "bytes": self.written.bytes, "written": [self.output.display().to_string()],
            "notes": self.notes, "warnings": self.warnings, "timings_secs": timings })
    }
}
