//! The reader of Gmsh's mesh files (`.msh`).
//!
//! A file is a list of [`sections`], each of text or of bytes ([`numbers`]). From them come [`nodes`], [`elements`] with the groups
//! that their [`entities`] belong to, and [`views`], of which those of the chosen step become arrays ([`values`]).
//!
//! Source: the Gmsh reference manual, sections "MSH file format" and "Legacy formats".

use std::collections::HashSet;

use tetrascope_mesh::{ArrayValues, Cells, Dataset};

use crate::vtk::named::NamedArrays;
use crate::{IoError, Loaded, MeshReader, Source};
use elements::Elements;
use entities::Entities;
use nodes::Nodes;
use number_map::NumberMap;
use numbers::Numbers;
use sections::{Form, Section, Version};
use values::Mesh;
use views::{Owner, View};

mod element_types;
mod elements;
mod entities;
mod groups;
mod middles;
mod nodes;
mod number_map;
mod numbers;
mod sections;
mod values;
mod views;

#[cfg(test)]
mod damaged_tests;
#[cfg(test)]
mod element_tests;
#[cfg(test)]
mod shared_tests;
#[cfg(test)]
mod synthetic;
#[cfg(test)]
mod tests;

/// The reader of Gmsh's files.
pub(crate) static GMSH: GmshReader = GmshReader;

/// What to advise when a file is damaged.
const REWRITE: &str = "the file is cut off or damaged; write it again, or open it in Gmsh to see what is left";

/// Sections that say nothing of the mesh or its values.
const WITHOUT_USE: [&[u8]; 7] = [
    b"Comments",
    b"Periodic",
    b"GhostElements",
    b"Parametrizations",
    b"InterpolationScheme",
    b"NodePeriodic",
    b"Partitions",
];

/// Reads all versions of the format, as text or binary.
pub(crate) struct GmshReader;

impl MeshReader for GmshReader {
    fn name(&self) -> &'static str {
        "Gmsh"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["msh"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        let head = text.get(..text.len().min(LONGEST_HEAD)).unwrap_or_default();
        let has_header = || memchr::memmem::find(head, b"$MeshFormat").is_some();
        text.starts_with(b"$NOD\n") || text.starts_with(b"$NOD\r") || text.starts_with(b"$") && has_header()
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let sections = sections::sections(source)?;
        if sections.is_empty() {
            return Err(source.invalid(
                "the whole file",
                "it has none of the sections ($Nodes, $Elements) of a Gmsh file",
                "other programs give their files the extension .msh too (Fluent, FreeFEM): convert it to .vtu or save it from Gmsh",
            ));
        }
        Parts::of(source, &sections)?.load(source)
    }
}

/// How far into a file its header may stand, behind sections with comments.
const LONGEST_HEAD: usize = 1 << 16;

/// The sections of a file by what they are for.
struct Parts<'a> {
    version: Version,
    form: Form,
    nodes: Vec<Section<'a>>,
    elements: Vec<Section<'a>>,
    entities: Vec<Section<'a>>,
    names: Vec<Section<'a>>,
    views: Vec<View<'a>>,
    warnings: Vec<String>,
}

impl<'a> Parts<'a> {
    fn of(source: &'a Source, sections: &[Section<'a>]) -> Result<Self, IoError> {
        let (version, form) = sections.first().map_or((Version::V1, Form::Text), |first| (first.version, first.form));
        let mut parts = Self {
            version,
            form,
            nodes: Vec::new(),
            elements: Vec::new(),
            entities: Vec::new(),
            names: Vec::new(),
            views: Vec::new(),
            warnings: Vec::new(),
        };
        let mut unknown = HashSet::new();
        for &section in sections {
            match section.name {
                b"Nodes" | b"ParametricNodes" | b"NOD" => add(&mut parts.nodes, section),
                b"Elements" | b"ELM" => add(&mut parts.elements, section),
                b"Entities" | b"PartitionedEntities" => parts.entities.push(section),
                b"PhysicalNames" => add(&mut parts.names, section),
                name => match Owner::of(name) {
                    Some(owner) => parts.views.push(views::view(source, section, owner)?),
                    None if WITHOUT_USE.contains(&name) => {}
                    None if unknown.insert(name) => {
                        parts
                            .warnings
                            .push(format!("the section {} is not known and was passed over", section.title()));
                    }
                    None => {}
                },
            }
        }
        Ok(parts)
    }

    fn load(mut self, source: &Source) -> Result<Loaded, IoError> {
        let mut warnings = std::mem::take(&mut self.warnings);
        for (sections, what) in [(&self.nodes, "$Nodes"), (&self.elements, "$Elements")] {
            if sections.is_empty() {
                return Err(source.invalid(
                    "the whole file",
                    format!("it has no section {what}, and so no mesh"),
                    "a file that holds only views needs its mesh: merge both in Gmsh and save them as one file",
                ));
            }
        }
        let mut nodes = Nodes::default();
        for &section in &self.nodes {
            let mut numbers = Numbers::new(source, section, 0);
            nodes.read(&mut numbers)?;
            warn_of_rest(&numbers, &mut warnings);
        }
        let map = nodes.map(source, &mut warnings)?;
        let mut entities = Entities::new();
        for &section in &self.entities {
            let is_partitioned = section.name == b"PartitionedEntities";
            entities::read(&mut Numbers::new(source, section, 0), is_partitioned, &mut entities)?;
        }
        let several = entities.values().filter(|entity| entity.has_more_groups).count();
        if several > 0 {
            warnings.push(format!("{several} entities lie in several physical groups; their cells count to the first"));
        }
        let mut elements = Elements::new(source, &map);
        for &section in &self.elements {
            let mut numbers = Numbers::new(source, section, 0);
            elements.read(&mut numbers, &entities)?;
            warn_of_rest(&numbers, &mut warnings);
        }
        elements.warn(&mut warnings);

        let chosen = views::choose(source, &self.views, &mut warnings)?;
        let chosen_views = || chosen.views.iter().filter_map(|&view| self.views.get(view));
        let needs_elements = chosen_views().any(|view| view.owner != Owner::Nodes);
        let numbers_of_elements = if needs_elements { elements.map() } else { NumberMap::none() };
        let mesh = Mesh {
            cells: &elements.cells,
            types: &elements.types,
            nodes: &map,
            elements: &numbers_of_elements,
            point_count: nodes.points.len(),
        };
        let columns = values::columns(source, &mesh, chosen_views())?;
        let is_used = points_of_volumes(&elements, nodes.points.len());
        let (mut point_arrays, mut cell_arrays) = (NamedArrays::default(), NamedArrays::default());
        for column in columns {
            let (name, components, owner) = (column.name.clone(), column.components, column.owner);
            let values = column.finish(&is_used, &elements.cells, &mut warnings);
            let (arrays, owner) =
                if owner == Owner::Elements { (&mut cell_arrays, "cell") } else { (&mut point_arrays, "point") };
            arrays.add(owner, &name, components, values, &mut warnings);
        }
        for (name, tags) in [("gmsh:physical", elements.physical), ("gmsh:geometrical", elements.geometrical)] {
            if tags.iter().any(|&tag| tag != 0) {
                cell_arrays.add("cell", name, 1, ArrayValues::I32(tags), &mut warnings);
            }
        }
        let dataset = Dataset {
            points: nodes.points,
            cells: Cells::Unstructured(elements.cells),
            point_arrays: point_arrays.into_arrays(),
            cell_arrays: cell_arrays.into_arrays(),
        };
        let groups = groups::described(source, &self.names);
        let format = format!("Gmsh {}{groups}", written(self.version, self.form));
        Ok(Loaded { dataset, format, warnings, times: chosen.times, step: chosen.step })
    }
}

/// Adds a section unless it repeats the first one: with every view that is appended to a file Gmsh writes the mesh anew.
fn add<'a>(sections: &mut Vec<Section<'a>>, section: Section<'a>) {
    let is_first = |first: &Section<'_>| {
        (first.name, first.version, first.form, first.body)
            == (section.name, section.version, section.form, section.body)
    };
    if !sections.first().is_some_and(is_first) {
        sections.push(section);
    }
}

fn warn_of_rest(numbers: &Numbers<'_>, warnings: &mut Vec<String>) {
    if !numbers.is_at_end() {
        let title = numbers.section.title();
        warnings.push(format!("the section {title} holds more than it declares; what is beyond was left out"));
    }
}

/// One flag a point: whether a cell with a volume has it.
fn points_of_volumes(elements: &Elements<'_>, count: usize) -> Vec<bool> {
    let cells = &elements.cells;
    let mut is_used = vec![false; count];
    for (kind, ends) in cells.kinds.iter().zip(cells.offsets.windows(2)) {
        let &[start, end] = ends else { continue };
        if kind.is_flat() {
            continue;
        }
        for &point in cells.connectivity.get(start..end).unwrap_or_default() {
            if let Some(flag) = is_used.get_mut(point as usize) {
                *flag = true;
            }
        }
    }
    is_used
}

/// "MSH 4.1, binary, little-endian".
fn written(version: Version, form: Form) -> String {
    let version = match version {
        Version::V1 => "1",
        Version::V2 => "2",
        Version::V40 => "4.0",
        Version::V41 => "4.1",
    };
    match form {
        Form::Text => format!("MSH {version}, text"),
        Form::Binary { order, .. } => format!("MSH {version}, binary, {order}"),
    }
}
