//! Writes an unstructured grid as VTK's XML file: arrays appended as raw bytes, to the last bit, in the order of this machine.

use std::fmt::Write as _;
use std::path::Path;

use tetrascope_mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset};

use super::cell_types::number_of;
use crate::IoError;
use crate::picture::write_whole;

/// Writes a dataset of unstructured cells to a `.vtu` file (version 1.0, appended raw data, 64-bit sizes), which
/// [`read_mesh`](crate::read_mesh) and VTK read back to the last bit. The file appears whole or not at all.
///
/// # Errors
/// [`IoError::Unsupported`] for structured blocks, polyhedra and kinds without a number of VTK's; [`IoError::Write`].
pub fn write_vtu(path: &Path, dataset: &Dataset) -> Result<(), IoError> {
    let refuse = |what: &str| IoError::Unsupported {
        path: path.to_owned(),
        what: format!("writing {what}"),
        remedy: "write the tetrahedra that it is cut into".to_owned(),
    };
    let Cells::Unstructured(cells) = &dataset.cells else { return Err(refuse("structured blocks")) };
    let number = |kind: &CellKind| number_of(*kind).ok_or_else(|| refuse(&format!("cells of kind {kind:?}")));
    let types: Vec<u8> = cells.kinds.iter().map(number).collect::<Result<_, _>>()?;

    let mut body = Appended::default();
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
    let _ = writeln!(
        text,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{order}\" header_type=\"UInt64\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
        dataset.points.len(),
        types.len()
    );
    for (section, arrays) in [("PointData", &dataset.point_arrays), ("CellData", &dataset.cell_arrays)] {
        let _ = writeln!(text, "<{section}>");
        arrays.iter().for_each(|array| body.add(&mut text, array));
        let _ = writeln!(text, "</{section}>");
    }
    let coordinates = dataset.points.iter().flat_map(glam::DVec3::to_array).collect();
    let array = |name: &str, components, values| DataArray { name: name.to_owned(), components, values };
    text.push_str("<Points>\n");
    body.add(&mut text, &array("Points", 3, ArrayValues::F64(coordinates)));
    text.push_str("</Points>\n<Cells>\n");
    body.add(&mut text, &array("connectivity", 1, ArrayValues::U32(cells.connectivity.clone())));
    let ends = cells.offsets.iter().skip(1).map(|&end| end as u64).collect();
    body.add(&mut text, &array("offsets", 1, ArrayValues::U64(ends)));
    body.add(&mut text, &array("types", 1, ArrayValues::U8(types)));
    text.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");

    let mut bytes = text.into_bytes();
    bytes.append(&mut body.bytes);
    bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
    write_whole(path, &bytes)
}

/// What stands behind the elements, array after array, each behind its size in bytes.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// Appends an array, and the element that tells of it.
    fn add(&mut self, text: &mut String, array: &DataArray) {
        let _ = writeln!(
            text,
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>",
            array.values.type_name(),
            quick_xml::escape::escape(&array.name),
            array.components,
            self.bytes.len()
        );
        let size_at = self.bytes.len();
        self.bytes.extend_from_slice(&[0; 8]);
        self.values(&array.values);
        let size = (self.bytes.len() - size_at - 8) as u64;
        self.bytes[size_at..size_at + 8].copy_from_slice(&size.to_ne_bytes());
    }

    fn values(&mut self, values: &ArrayValues) {
        macro_rules! all {
            ($($kind:ident),*) => {
                match values {
                    $(ArrayValues::$kind(v) => self.bytes.extend(v.iter().flat_map(|x| x.to_ne_bytes())),)*
                }
            };
        }
        all!(I8, U8, I16, U16, I32, U32, I64, U64, F32, F64);
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use tetrascope_mesh::UnstructuredCells;

    use super::*;
    use crate::{ReadOptions, read_mesh};

    #[test]
    fn what_is_written_is_read_back_to_the_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.vtu");
        let points =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [5e6 + 1e-3, -0.0, f64::MIN_POSITIVE]]
                .map(DVec3::from);
        let named = |name: &str, components, values| DataArray { name: name.to_owned(), components, values };
        let dataset = Dataset {
            points: points.to_vec(),
            cells: Cells::Unstructured(UnstructuredCells {
                kinds: vec![CellKind::Tetrahedron, CellKind::Pyramid],
                offsets: vec![0, 4, 9],
                connectivity: vec![0, 1, 2, 3, 0, 1, 2, 3, 4],
                polyhedra: Vec::new(),
            }),
            point_arrays: vec![
                named("a < \"b\" & ü", 1, ArrayValues::F64(vec![1e300, -1e-300, f64::NAN, 0.1, f64::INFINITY])),
                named("v", 2, ArrayValues::F32((0..10).map(|i| i as f32 / 3.0).collect())),
            ],
            cell_arrays: vec![named("c", 1, ArrayValues::I16(vec![-7, 9]))],
        };
        write_vtu(&path, &dataset).unwrap();
        let read = read_mesh(&path, &ReadOptions::default()).unwrap().dataset;
        let bits = |points: &[DVec3]| points.iter().flat_map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(&read.points), bits(&dataset.points));
        let (Cells::Unstructured(a), Cells::Unstructured(b)) = (&read.cells, &dataset.cells) else { panic!("blocks") };
        assert_eq!((&a.kinds, &a.offsets, &a.connectivity), (&b.kinds, &b.offsets, &b.connectivity));
        let tell = |array: &DataArray| {
            let bits: Vec<u64> = array.values.to_f64().into_iter().map(f64::to_bits).collect();
            (array.name.clone(), array.components, array.values.type_name(), bits)
        };
        let all = |d: &Dataset| d.point_arrays.iter().chain(&d.cell_arrays).map(tell).collect::<Vec<_>>();
        assert_eq!(all(&read), all(&dataset));
    }

    #[test]
    fn blocks_and_polyhedra_are_refused() {
        let refused = |cells| {
            let path = Path::new("never.vtu");
            let problem = write_vtu(path, &Dataset { cells, ..Dataset::default() }).unwrap_err().to_string();
            assert!(problem.contains("never.vtu") && problem.contains("tetrahedra"), "{problem}");
            assert!(!path.exists());
        };
        refused(Cells::Structured(Vec::new()));
        refused(Cells::Unstructured(UnstructuredCells {
            kinds: vec![CellKind::Polyhedron],
            offsets: vec![0, 0],
            ..UnstructuredCells::default()
        }));
    }
}
