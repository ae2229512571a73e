//! The reader of Exodus II, the mesh format of Sandia's codes and of MOOSE, on NetCDF-3 and NetCDF-4.
//!
//! `netcdf` gives variables by name, whatever NetCDF's form; `blocks` makes the cells of all element blocks, `variables` their arrays at
//! one time step.
//!
//! Source: L. A. Schoof, V. R. Yarberry, "EXODUS II: A Finite Element Data Model", SAND92-2137, and for what came after it the names of
//! variables and dimensions in the header `exodusII_int.h` of the SEACAS library.

mod blocks;
mod elements;
mod faces;
mod netcdf;
mod numbered;
mod variables;
mod vectors;

#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod shared_tests;
#[cfg(test)]
mod tests;

use glam::DVec3;
use tetrascope_mesh::{Cells, Dataset};

use crate::{IoError, Loaded, MeshReader, Source};
use netcdf::Netcdf;

/// The reader of Exodus II.
pub(crate) static EXODUS: ExodusReader = ExodusReader;

/// Reads `.e`, `.exo`, `.ex2` files.
pub(crate) struct ExodusReader;

/// What to advise when a file is damaged rather than of an odd form.
const DAMAGED: &str = "the file is cut off or damaged; write it again, or open it in ParaView to see what is left";

/// What a file of HDF5 begins with.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

impl MeshReader for ExodusReader {
    fn name(&self) -> &'static str {
        "Exodus"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["e", "ex2", "exo", "exii", "exoii", "gen"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        [b"CDF\x01", b"CDF\x02", b"CDF\x05"].iter().any(|magic| bytes.starts_with(*magic)) || bytes.starts_with(HDF5)
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let file = Netcdf::open(source)?;
        if file.dimension("num_dim") == 0 || file.dimension("num_nodes") == 0 {
            return Err(source.unsupported(
                format!("{} that is not Exodus (it has no nodes)", file.form()),
                "name an Exodus file; others can be turned into .vtu by ParaView or meshio",
            ));
        }
        let times = variables::times(&file)?;
        let step = source.step(&times)?;
        let points = coordinates(&file)?;
        let mut warnings = Vec::new();
        let (cells, blocks) = blocks::read_blocks(&file, points.len(), &mut warnings)?;
        let values_at = (!times.is_empty()).then_some(step as u64);
        let point_arrays = variables::node_arrays(&file, points.len(), values_at, &mut warnings)?;
        let cell_arrays = variables::element_arrays(&file, &blocks, values_at, &mut warnings)?;
        let plural = if blocks.len() == 1 { "" } else { "s" };
        let format = format!("Exodus II, {}, {} element block{plural}", file.form(), blocks.len());
        let dataset = Dataset { points, cells: Cells::Unstructured(cells), point_arrays, cell_arrays };
        Ok(Loaded { dataset, format, warnings, times, step })
    }
}

/// The nodes: one variable for each coordinate, or in files of Exodus 2 one for all.
fn coordinates(file: &Netcdf<'_>) -> Result<Vec<DVec3>, IoError> {
    let dimensions = file.dimension("num_dim");
    if dimensions > 3 {
        let problem = format!("nodes have {dimensions} coordinates, where at most 3 are possible");
        return Err(file.source.invalid("dimension `num_dim`", problem, DAMAGED));
    }
    let in_one = file.shape("coord").is_some_and(|shape| shape.len() == 2);
    let mut axes = Vec::new();
    for (axis, name) in (0..dimensions).zip(["coordx", "coordy", "coordz"]) {
        let values = if in_one { file.numbers("coord", &[axis])? } else { file.numbers(name, &[])? };
        axes.push(values.to_f64());
    }
    let count = axes.first().map_or(0, Vec::len);
    if axes.iter().any(|axis| axis.len() != count) || count as u64 != file.dimension("num_nodes") {
        let problem = format!("there are not as many coordinates as nodes ({})", file.dimension("num_nodes"));
        return Err(file.source.invalid("the coordinates", problem, DAMAGED));
    }
    let coordinate =
        |axis: usize, index: usize| axes.get(axis).and_then(|values| values.get(index)).copied().unwrap_or(0.0);
    Ok((0..count).map(|index| DVec3::new(coordinate(0, index), coordinate(1, index), coordinate(2, index))).collect())
}
