//! Polyhedra: elements that name faces, and the blocks of faces that they name.

use super::DAMAGED;
use super::netcdf::Netcdf;
use super::numbered::numbered;
use crate::IoError;
use crate::vtk::cells::{CellBuilder, Faces};
use crate::vtk::scalars::to_indices;

/// In a mesh two elements share a face; the rest is leeway. Without a bound, one long face that is named again and again would make a
/// small file take any amount of memory.
const ELEMENTS_SHARING_A_FACE: usize = 4;

/// The faces of all face blocks, one behind the other.
pub(super) struct FaceTable {
    nodes: Vec<i64>,
    /// Where each face ends in `nodes`.
    ends: Vec<usize>,
    /// How many nodes may still be copied.
    copies_left: usize,
}

impl FaceTable {
    /// Reads all face blocks.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where the numbers of nodes do not fit the nodes.
    pub(super) fn read(file: &Netcdf<'_>) -> Result<Self, IoError> {
        let mut table = Self { nodes: Vec::new(), ends: Vec::new(), copies_left: 0 };
        for number in numbered(file, "fbconn") {
            let variable = format!("fbconn{number}");
            let invalid = |problem: &str| file.source.invalid(format!("variable `{variable}`"), problem, DAMAGED);
            let nodes =
                to_indices(&file.numbers(&variable, &[])?).ok_or_else(|| invalid("it holds no whole numbers"))?;
            let start = table.nodes.len();
            table.nodes.extend(nodes.iter().map(|node| node.saturating_sub(1)));
            let counts = format!("fbepecnt{number}");
            match file.shape(&variable).unwrap_or_default().as_slice() {
                // All with the same number of nodes.
                &[_, nodes] => {
                    let nodes = usize::try_from(nodes)
                        .ok()
                        .filter(|&nodes| nodes > 0)
                        .ok_or_else(|| invalid("its faces have no nodes"))?;
                    table.ends.extend((start..table.nodes.len()).step_by(nodes).map(|begin| begin + nodes));
                }
                _ => {
                    let mut end = start;
                    for count in to_indices(&file.numbers(&counts, &[])?).unwrap_or_default() {
                        let next = usize::try_from(count).ok().and_then(|count| end.checked_add(count));
                        end = next
                            .filter(|&next| next <= table.nodes.len())
                            .ok_or_else(|| invalid(&format!("`{counts}` has more nodes than there are")))?;
                        table.ends.push(end);
                    }
                    table.nodes.truncate(end);
                }
            }
        }
        table.copies_left = table.nodes.len().saturating_mul(ELEMENTS_SHARING_A_FACE);
        Ok(table)
    }

    /// Adds the polyhedra of a block; how many they are.
    pub(super) fn push_block(
        &mut self,
        file: &Netcdf<'_>,
        number: u64,
        builder: &mut CellBuilder<'_>,
    ) -> Result<usize, IoError> {
        let faces = to_indices(&file.numbers(&format!("facconn{number}"), &[])?).unwrap_or_default();
        let counts = to_indices(&file.numbers(&format!("ebepecnt{number}"), &[])?).unwrap_or_default();
        let mut at = 0_usize;
        for &count in &counts {
            let own = usize::try_from(count).ok().and_then(|count| faces.get(at..at.checked_add(count)?));
            let own = own.ok_or_else(|| builder.invalid(format!("it has {count} faces, more than are listed")))?;
            at += own.len();
            let faces = self.faces(own).map_err(|problem| builder.invalid(problem))?;
            builder.push_polyhedron(&[], &faces)?;
        }
        Ok(counts.len())
    }

    fn faces(&mut self, numbers: &[i64]) -> Result<Faces, String> {
        let mut faces = Faces::with_capacity(numbers.len());
        for &number in numbers {
            let index = usize::try_from(number).ok().and_then(|number| number.checked_sub(1));
            let face = index.and_then(|index| {
                let start = if index == 0 { 0 } else { *self.ends.get(index - 1)? };
                self.nodes.get(start..*self.ends.get(index)?)
            });
            let face = face.ok_or_else(|| format!("it names face {number}, but there are {}", self.ends.len()))?;
            let left = self.copies_left.checked_sub(face.len());
            self.copies_left =
                left.ok_or_else(|| format!("more than {ELEMENTS_SHARING_A_FACE} elements share each face"))?;
            faces.push(face.to_vec());
        }
        Ok(faces)
    }
}
