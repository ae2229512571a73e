//! PLOT3D: curvilinear grids, and the flow on them in a second file.
//!
//! Files carry no name of their own format, and are written with either byte order, 32- or 64-bit floats, with or without
//! Fortran record marks, with or without a count of grids and an integer a point, or as text. The reader tries all of these
//! and takes the one in which every size fits. Files written plane by plane, planar (2-D) grids, function files, record
//! marks of 64 bits and files with species are not read.
//!
//! Source: the file formats of [Walatka 1990], the manual of PLOT3D (NASA TM-101067).

mod blocks;
mod derived;
mod detect;
mod layout;
mod measure;
mod records;
mod text;

use glam::DVec3;
use tetrascope_mesh::{ArrayValues, Cells, DataArray, Dataset, StructuredBlock};

use self::{
    blocks::{Block, Real},
    detect::{NoFit, detect},
    layout::{Encoding, Kind, Precision, dims_text},
    measure::{Content, Fit},
    records::RecordError,
    text::BadToken,
};
use crate::{IoError, Loaded, MeshReader, Source, open::file_name, opened::read_whole};

/// The reader of PLOT3D.
pub(crate) static PLOT3D: Plot3d = Plot3d;

/// See [`PLOT3D`].
#[derive(Debug)]
pub(crate) struct Plot3d;

/// Numbers of a solution a point of its grid, with room for the header: what repeat counts in a text may lead to.
const SOLUTION_NUMBERS: usize = 8;

impl MeshReader for Plot3d {
    fn name(&self) -> &'static str {
        "PLOT3D"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["xyz", "q", "bin", "x", "g", "grd", "p3d"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        let fits = |content: &Content<'_>, kind| matches!(detect(content, kind), Ok(_) | Err(NoFit::Planar(_)));
        content_of(bytes, 0).is_ok_and(|content| fits(&content, Kind::Grid) || fits(&content, Kind::Solution))
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let main = open(source, 0)?;
        let grid = detect(&main, Kind::Grid);
        // A solution of zeros is also a small grid with zeros after it: the exact fit decides.
        let main_is_solution = grid.as_ref().map_or(true, |fit| fit.padding > 0)
            && detect(&main, Kind::Solution).is_ok_and(|fit| grid.is_err() || fit.padding == 0);

        let Some(second_path) = &source.options.solution else {
            if main_is_solution {
                return Err(no_coordinates(source));
            }
            let grid = grid.map_err(|no_fit| refusal(source, no_fit, Kind::Grid))?;
            let mut warnings =
                vec!["a PLOT3D grid alone has no arrays of flow; name its solution (q file) to have them".to_owned()];
            let (dataset, format) = grid_dataset(source, &main, &grid, &mut warnings)?;
            return Ok(Loaded::without_time(dataset, format!("PLOT3D, {format}"), warnings));
        };

        let second = Source {
            path: second_path.clone(),
            bytes: read_whole(second_path, &source.options)?,
            ..Default::default()
        };
        let allowed = grid.as_ref().map_or(0, |fit| fit.points().sum::<usize>().saturating_mul(SOLUTION_NUMBERS));
        let second_content = open(&second, allowed)?;
        let second_as_grid = if main_is_solution { detect(&second_content, Kind::Grid).ok() } else { None };
        let Some(second_as_grid) = second_as_grid else {
            let grid = grid.map_err(|no_fit| {
                if main_is_solution { no_coordinates(source) } else { refusal(source, no_fit, Kind::Grid) }
            })?;
            return join((source, &main, &grid), (&second, &second_content), Vec::new());
        };
        let swapped = format!(
            "{} is the solution and {} the grid; they were taken the other way round than named",
            file_name(&source.path),
            file_name(second_path)
        );
        join((&second, &second_content, &second_as_grid), (source, &main), vec![swapped])
    }
}

/// A grid and its solution as one dataset.
fn join(
    (grid_source, grid, grid_fit): (&Source, &Content<'_>, &Fit),
    (source, content): (&Source, &Content<'_>),
    mut warnings: Vec<String>,
) -> Result<Loaded, IoError> {
    let fit = detect(content, Kind::Solution).map_err(|no_fit| refusal(source, no_fit, Kind::Solution))?;
    if fit.dims != grid_fit.dims {
        return Err(source.invalid(
            "dimensions",
            format!(
                "the solution has {} points, its grid {} has {}",
                dims_text(&fit.dims),
                grid_source.path.display(),
                dims_text(&grid_fit.dims)
            ),
            "name the solution that belongs to this grid",
        ));
    }
    warn_of_padding(source, &fit, &mut warnings);
    let (mut dataset, format) = grid_dataset(grid_source, grid, grid_fit, &mut warnings)?;
    let (arrays, flow) = match fit.layout.encoding {
        Encoding::Binary { precision: Precision::Single, .. } => flow::<f32>(source, content, &fit, &mut warnings)?,
        Encoding::Binary { precision: Precision::Double, .. } | Encoding::Text => {
            flow::<f64>(source, content, &fit, &mut warnings)?
        }
    };
    // The flow goes before IBlank, so that the first scalar is the density.
    dataset.point_arrays.splice(0..0, arrays);
    let format = if fit.layout.encoding == grid_fit.layout.encoding {
        format!("PLOT3D, {format}; solution: {flow}")
    } else {
        format!("PLOT3D, {format}; solution: {}, {flow}", fit.layout)
    };
    Ok(Loaded::without_time(dataset, format, warnings))
}

/// The arrays of a solution and a few words on its reference values.
fn flow<T: Real>(
    source: &Source,
    content: &Content<'_>,
    fit: &Fit,
    warnings: &mut Vec<String>,
) -> Result<(Vec<DataArray>, String), IoError> {
    let blocks = blocks::read::<T>(content, fit).map_err(|error| broken(source, error))?;
    let reference: Vec<f64> = blocks.first().map_or(Vec::new(), |b| b.reference.iter().map(|&v| v.into()).collect());
    let names = ["Mach", "angle of attack", "Reynolds number", "time"];
    let words: Vec<_> = names.iter().zip(reference).map(|(name, value)| format!("{name} {}", value as f32)).collect();
    Ok((derived::solution_arrays(&blocks, warnings), words.join(", ")))
}

/// The points and blocks of a grid, and its layout in words.
fn grid_dataset(
    source: &Source,
    content: &Content<'_>,
    fit: &Fit,
    warnings: &mut Vec<String>,
) -> Result<(Dataset, String), IoError> {
    warn_of_padding(source, fit, warnings);
    let dataset = match fit.layout.encoding {
        Encoding::Binary { precision: Precision::Single, .. } => {
            blocks::read::<f32>(content, fit).map(|blocks| dataset(fit, &blocks, warnings))
        }
        Encoding::Binary { precision: Precision::Double, .. } | Encoding::Text => {
            blocks::read::<f64>(content, fit).map(|blocks| dataset(fit, &blocks, warnings))
        }
    };
    let dataset = dataset.map_err(|error| broken(source, error))?;
    Ok((dataset, format!("{}, {}", fit.layout, dims_text(&fit.dims))))
}

fn dataset<T: Real>(fit: &Fit, blocks: &[Block<T>], warnings: &mut Vec<String>) -> Dataset {
    let mut points = Vec::with_capacity(fit.points().sum());
    let mut structured = Vec::with_capacity(blocks.len());
    let mut iblank = Vec::new();
    for (dims, block) in fit.dims.iter().zip(blocks) {
        let first_point = points.len();
        let count = block.values.len() / 3;
        let coordinate = |axis: usize, point: usize| block.values[axis * count + point].into();
        points.extend((0..count).map(|p| DVec3::new(coordinate(0, p), coordinate(1, p), coordinate(2, p))));
        // Negative values mark points of overlapping grids, which are drawn; only 0 hides.
        let hidden: Vec<bool> = block.iblank.iter().map(|&value| value == 0).collect();
        let hidden_points = if hidden.contains(&true) { hidden } else { Vec::new() };
        iblank.extend_from_slice(&block.iblank);
        structured.push(StructuredBlock { dims: [dims[0], dims[1], dims[2]], first_point, hidden_points });
    }

    let not_finite = points.iter().filter(|point| !point.is_finite()).count();
    if not_finite > 0 {
        warnings.push(format!("{not_finite} of {} points have coordinates that are not finite", points.len()));
    }
    let flat = structured.iter().filter(|block| block.cell_count() == 0).count();
    if flat > 0 {
        warnings.push(format!("{flat} of {} grids are one point thick and have no volume", structured.len()));
    }
    if !iblank.is_empty() && iblank.iter().all(|&value| value == 0) {
        warnings.push("iblank is 0 at every point, which hides the whole grid".to_owned());
    }
    let array = DataArray { name: "IBlank".to_owned(), components: 1, values: ArrayValues::I32(iblank) };
    let point_arrays = if fit.layout.iblank { vec![array] } else { Vec::new() };
    Dataset { points, cells: Cells::Structured(structured), point_arrays, cell_arrays: Vec::new() }
}

fn warn_of_padding(source: &Source, fit: &Fit, warnings: &mut Vec<String>) {
    if fit.padding > 0 {
        let name = file_name(&source.path);
        warnings.push(format!("{} zero bytes after the data of {name} were taken for padding", fit.padding));
    }
}

fn content_of(bytes: &[u8], allowed: usize) -> Result<Content<'_>, BadToken> {
    if text::is_text(bytes) { text::numbers(bytes, allowed).map(Content::Text) } else { Ok(Content::Binary(bytes)) }
}

fn open(source: &Source, allowed: usize) -> Result<Content<'_>, IoError> {
    content_of(&source.bytes, allowed).map_err(|bad| {
        source.invalid(
            format!("line {}", bad.line),
            bad.problem,
            "a PLOT3D text file holds numbers alone; correct the line, or name the file by its true format",
        )
    })
}

fn no_coordinates(source: &Source) -> IoError {
    source.invalid(
        "the whole file",
        "it is a PLOT3D solution (q file) and has no coordinates",
        "name its grid (xyz file) as the mesh and this file as the solution",
    )
}

/// The file changed its mind between being measured and being read; cannot happen, but is no reason to panic.
fn broken(source: &Source, error: RecordError) -> IoError {
    source.invalid("the data", error.to_string(), "check that the file is complete")
}

fn refusal(source: &Source, no_fit: NoFit, kind: Kind) -> IoError {
    let what = match kind {
        Kind::Grid => "grid (xyz file)",
        Kind::Solution => "solution (q file)",
    };
    let nearest_remedy = "check that the file is complete and of this format, or convert it to .vtu with ParaView";
    match no_fit {
        NoFit::Planar(layout) => source.unsupported(
            format!("a planar PLOT3D file ({layout})"),
            "it has no volume; write the grid with three dimensions",
        ),
        NoFit::Nearest(misfit) => source.invalid(
            "header and size",
            format!("no layout of a PLOT3D {what} fits; the nearest is {}, but {}", misfit.layout, misfit.problem),
            nearest_remedy,
        ),
        NoFit::Ambiguous(fits) => {
            let each = |fit: &Fit| format!("{} of {}", fit.layout, dims_text(&fit.dims));
            let all: Vec<_> = fits.iter().map(each).collect();
            source.invalid(
                "header and size",
                format!("it fits several layouts of a PLOT3D {what} equally well: {}", all.join("; or ")),
                "convert it to .vtu with ParaView, where the layout can be said",
            )
        }
    }
}

#[cfg(test)]
mod file_tests;
#[cfg(test)]
mod synthetic;
#[cfg(test)]
mod tests;
