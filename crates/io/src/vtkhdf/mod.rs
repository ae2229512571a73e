//! The reader of VTKHDF, VTK's files on HDF5: unstructured grids in one or several parts, images, collections of grids, time steps.
//!
//! Source: "VTKHDF File Format" in VTK's documentation, versions 1.0 to 2.3, and what VTK 9.7 writes.

mod arrays;
mod container;
mod image;
mod steps;
mod unstructured;

#[cfg(test)]
mod tests;

use glam::DVec3;
use hdf5_reader::group::Group;
use tetrascope_mesh::{Cells, Dataset};

use crate::vtk::cells::CellBuilder;
use crate::{IoError, Loaded, MeshReader, Source};
use arrays::Joined;
use container::Container;
use steps::Steps;

/// The reader of VTKHDF.
pub(crate) static VTKHDF: VtkHdfReader = VtkHdfReader;

/// Reads `.vtkhdf` files.
pub(crate) struct VtkHdfReader;

/// The group that holds everything.
const ROOT: &str = "VTKHDF";

impl MeshReader for VtkHdfReader {
    fn name(&self) -> &'static str {
        "VTKHDF"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vtkhdf", "hdf", "h5"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        // The name of the group stands somewhere in the file, with nothing that says where before it is parsed.
        bytes.starts_with(b"\x89HDF\r\n\x1a\n") && bytes.windows(ROOT.len()).any(|window| window == ROOT.as_bytes())
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let file = Container::open(source)?;
        let root = file.root(ROOT)?;
        let kind = file.text(&root, "Type").unwrap_or_default();
        let version = file.attribute(&root, "Version").unwrap_or_default();
        let version: Vec<String> = version.iter().map(f64::to_string).collect();
        let (steps, times, step) = Steps::choose(&file, &root)?;
        let mut warnings = Vec::new();
        let dataset = match kind.as_str() {
            "UnstructuredGrid" => collection(&file, vec![("the grid".to_owned(), root)], &steps, &mut warnings)?,
            "ImageData" => image::read_image(&file, &root, &steps, &mut warnings)?,
            "PartitionedDataSetCollection" | "MultiBlockDataSet" => {
                let blocks = blocks(&file, &root, &mut warnings)?;
                if blocks.is_empty() {
                    return Err(unsupported(source, &format!("VTKHDF with a {kind} that has no unstructured grid")));
                }
                collection(&file, blocks, &steps, &mut warnings)?
            }
            other => return Err(unsupported(source, &format!("VTKHDF with a dataset of the type `{other}`"))),
        };
        let format = format!("VTKHDF {}, {kind}", version.join("."));
        Ok(Loaded { dataset, format, warnings, times, step })
    }
}

fn unsupported(source: &Source, what: &str) -> IoError {
    source.unsupported(
        what,
        "unstructured grids, images and collections of grids are read; ParaView can save others as .vtu",
    )
}

/// The grids of a collection.
fn blocks(file: &Container<'_>, root: &Group, warnings: &mut Vec<String>) -> Result<Vec<(String, Group)>, IoError> {
    let mut blocks = Vec::new();
    for name in file.groups(root)? {
        let Some(block) = file.group(root, &name) else { continue };
        match file.text(&block, "Type").as_deref() {
            Some("UnstructuredGrid") => blocks.push((name, block)),
            Some(other) => {
                warnings.push(format!("the block `{name}` is left out: it is a {other}, not an unstructured grid"))
            }
            // The assembly names blocks that are here already, and `Steps` has no data.
            None => {}
        }
    }
    // Blocks come by their names otherwise.
    let index =
        |block: &Group| file.attribute(block, "Index").and_then(|index| index.first().copied()).unwrap_or(f64::MAX);
    blocks.sort_by(|(_, a), (_, b)| index(a).total_cmp(&index(b)));
    Ok(blocks)
}

/// One dataset of all grids.
fn collection(
    file: &Container<'_>,
    grids: Vec<(String, Group)>,
    steps: &Steps,
    warnings: &mut Vec<String>,
) -> Result<Dataset, IoError> {
    let mut points: Vec<DVec3> = Vec::new();
    let mut builder = CellBuilder::new(file.source);
    let (mut point_arrays, mut cell_arrays) = (Joined::new("point"), Joined::new("cell"));
    for (name, grid) in &grids {
        let label = if grids.len() == 1 { name.clone() } else { format!("block `{name}`") };
        let own_steps = steps.of_block(file, grid);
        let before = points.len();
        let (of_points, of_cells) =
            unstructured::read_grid(file, grid, &own_steps, &label, &mut points, &mut builder, warnings)?;
        // Blocks without points leave their arrays out.
        if points.len() > before {
            point_arrays.add(of_points, warnings);
            cell_arrays.add(of_cells, warnings);
        }
    }
    let cells = Cells::Unstructured(builder.finish(warnings));
    Ok(Dataset { points, cells, point_arrays: point_arrays.into_arrays(), cell_arrays: cell_arrays.into_arrays() })
}
