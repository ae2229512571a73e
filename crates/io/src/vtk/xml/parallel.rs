//! Files that name the pieces of one dataset: `.pvtu`, `.pvti`, `.pvtr`, `.pvts`.

use super::super::DAMAGED;
use super::super::grids::budget::Budget;
use super::super::grids::{dims_of, merge};
use super::super::join::join;
use super::list::{each_once, names};
use super::{Kind, describe, distinct, elements, root_type, structured, times, unstructured};
use crate::{IoError, Loaded, MeshReader, Source};

/// Reads files that name pieces of one kind.
pub(crate) struct ParallelReader {
    pub(in crate::vtk) kind: Kind,
}

impl Kind {
    /// The name of the kind in files that name pieces.
    fn parallel_type_name(self) -> &'static str {
        match self {
            Self::Unstructured => "PUnstructuredGrid",
            Self::Image => "PImageData",
            Self::Rectilinear => "PRectilinearGrid",
            Self::Structured => "PStructuredGrid",
        }
    }
}

impl MeshReader for ParallelReader {
    fn name(&self) -> &'static str {
        match self.kind {
            Kind::Unstructured => "VTK XML parallel unstructured grid",
            Kind::Image => "VTK XML parallel image data",
            Kind::Rectilinear => "VTK XML parallel rectilinear grid",
            Kind::Structured => "VTK XML parallel structured grid",
        }
    }

    fn extensions(&self) -> &'static [&'static str] {
        match self.kind {
            Kind::Unstructured => &["pvtu"],
            Kind::Image => &["pvti"],
            Kind::Rectilinear => &["pvtr"],
            Kind::Structured => &["pvts"],
        }
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        root_type(bytes) == Some(self.kind.parallel_type_name())
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let mut warnings = Vec::new();
        let named = names(source, &[self.kind.parallel_type_name()], "Piece", "Source", &[])?;
        let named = each_once(source, named, &mut warnings)?;
        let budget = Budget::new(self.kind.limit());
        let (mut parts, mut pieces) = (Vec::new(), Vec::new());
        let (mut format, mut known_times) = (String::new(), (Vec::new(), 0));
        for one in &named {
            let (mut own, opened) = one.open(source)?;
            let is_enough = elements::is_enough(&own, &opened, self.kind);
            if !is_enough {
                opened.read_rest(&mut own.bytes)?;
            }
            let file = elements::parse(&own, is_enough.then_some(&opened), self.kind, &budget)?;
            match self.kind {
                Kind::Unstructured => parts.push(unstructured::assemble(&own, &file, &mut warnings)?),
                _ => pieces.extend(structured::read_pieces(&own, &file, &mut warnings)?),
            }
            if format.is_empty() {
                format = describe(&file);
                known_times = times(&own, &file);
            }
            file.finish()?;
        }
        let joined = match self.kind {
            Kind::Unstructured => join(parts, &mut warnings),
            _ => merge::assemble(pieces, &mut warnings),
        };
        let dataset = joined.map_err(|problem| source.invalid("the pieces together", problem, DAMAGED))?;
        let plural = if named.len() == 1 { "piece" } else { "pieces" };
        let format = format!("{} of {} {plural}: {format}{}", self.name(), named.len(), dims_of(&dataset));
        Ok(Loaded { dataset, format, warnings: distinct(warnings), times: known_times.0, step: known_times.1 })
    }
}
