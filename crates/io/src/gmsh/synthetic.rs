//! Files of every version and form, written for the tests.

use std::fmt::Write as _;

use super::sections::Version;
use crate::bytes::ByteOrder;
use crate::{IoError, Loaded, MeshReader, ReadOptions, Source};

/// How a file is written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) version: Version,
    /// Nothing for text; else the order of bytes and the size of a tag.
    pub(super) binary: Option<(ByteOrder, usize)>,
}

/// Every version as text and, but for the first, in either order of bytes; version 4.1 with short tags too.
pub(super) fn styles() -> Vec<Style> {
    let mut styles = vec![Style { version: Version::V1, binary: None }];
    for version in [Version::V2, Version::V40, Version::V41] {
        styles.push(Style { version, binary: None });
        for order in [ByteOrder::Little, ByteOrder::Big] {
            styles.push(Style { version, binary: Some((order, 8)) });
            if version == Version::V41 {
                styles.push(Style { version, binary: Some((order, 4)) });
            }
        }
    }
    styles
}

/// Elements of one type and entity: dimension, tag, physical group, type, and of each its number and nodes.
pub(super) type Block = (i64, i64, i64, i64, Vec<(i64, Vec<i64>)>);

/// A mesh as files have it.
#[derive(Clone, Default)]
pub(super) struct Mesh {
    pub(super) nodes: Vec<(i64, [f64; 3])>,
    pub(super) blocks: Vec<Block>,
}

/// What a data section holds: its kind, name, step, time, components, and of each tuple its number, the number of nodes where the kind
/// has it, and the values.
pub(super) struct View {
    pub(super) kind: &'static str,
    pub(super) name: &'static str,
    pub(super) step: i64,
    pub(super) time: f64,
    pub(super) components: usize,
    pub(super) tuples: Vec<(i64, Option<i64>, Vec<f64>)>,
}

struct Writer {
    style: Style,
    bytes: Vec<u8>,
}

impl Writer {
    fn text(&mut self, text: &str) {
        self.bytes.extend_from_slice(text.as_bytes());
    }

    fn put(&mut self, little: &[u8], order: ByteOrder) {
        let mut bytes = little.to_vec();
        if order == ByteOrder::Big {
            bytes.reverse();
        }
        self.bytes.extend(bytes);
    }

    fn int(&mut self, value: i64) {
        match self.style.binary {
            None => self.text(&format!("{value} ")),
            Some((order, _)) => self.put(&i32::try_from(value).unwrap().to_le_bytes(), order),
        }
    }

    fn size(&mut self, value: i64) {
        match self.style.binary {
            None => self.text(&format!("{value} ")),
            Some((order, size)) => self.put(&value.to_le_bytes()[..size], order),
        }
    }

    fn tag(&mut self, value: i64) {
        if self.style.version == Version::V41 { self.size(value) } else { self.int(value) }
    }

    fn real(&mut self, value: f64) {
        match self.style.binary {
            None => self.text(&format!("{value:?} ")),
            Some((order, _)) => self.put(&value.to_le_bytes(), order),
        }
    }

    fn end_row(&mut self) {
        if self.style.binary.is_none() {
            self.text("\n");
        }
    }

    fn entity(&mut self, dimension: i64, tag: i64) {
        let (first, second) = if self.style.version == Version::V41 { (dimension, tag) } else { (tag, dimension) };
        self.int(first);
        self.int(second);
    }
}

/// The bytes of a file.
pub(super) fn file(style: Style, mesh: &Mesh, views: &[View]) -> Vec<u8> {
    let mut w = Writer { style, bytes: Vec::new() };
    let version = match style.version {
        Version::V1 => "",
        Version::V2 => "2.2",
        Version::V40 => "4",
        Version::V41 => "4.1",
    };
    if style.version != Version::V1 {
        let size = style.binary.map_or(8, |(_, size)| size);
        w.text(&format!("$MeshFormat\n{version} {} {size}\n", u8::from(style.binary.is_some())));
        if style.binary.is_some() {
            w.int(1);
            w.text("\n");
        }
        w.text("$EndMeshFormat\n$Comments\nmade for a test: $Nodes\n$EndComments\n");
        w.text("$PhysicalNames\n1\n3 9 \"the solid\"\n$EndPhysicalNames\n");
    }
    let is_blocks = matches!(style.version, Version::V40 | Version::V41);
    if is_blocks {
        write_entities(&mut w, mesh);
    }
    write_nodes(&mut w, mesh, is_blocks);
    match style.version {
        Version::V1 | Version::V2 => write_list(&mut w, mesh),
        _ => write_blocks(&mut w, mesh),
    }
    for view in views {
        write_view(&mut w, view);
    }
    w.bytes
}

fn write_entities(w: &mut Writer, mesh: &Mesh) {
    w.text("$Entities\n");
    let mut known: Vec<(i64, i64, i64)> = mesh.blocks.iter().map(|block| (block.0, block.1, block.2)).collect();
    known.sort_unstable();
    known.dedup();
    for dimension in 0..4 {
        w.size(known.iter().filter(|entity| entity.0 == dimension).count().try_into().unwrap());
    }
    for (dimension, tag, physical) in known {
        w.int(tag);
        let bounds = if dimension == 0 && w.style.version == Version::V41 { 3 } else { 6 };
        (0..bounds).for_each(|_| w.real(0.5));
        w.size(i64::from(physical != 0));
        if physical != 0 {
            w.int(physical);
        }
        if dimension > 0 {
            w.size(1);
            w.int(-1);
        }
        w.end_row();
    }
    w.text("\n$EndEntities\n");
}

fn write_nodes(w: &mut Writer, mesh: &Mesh, is_blocks: bool) {
    let count = i64::try_from(mesh.nodes.len()).unwrap();
    if !is_blocks {
        let name = if w.style.version == Version::V1 { "NOD" } else { "Nodes" };
        w.text(&format!("${name}\n{count}\n"));
        for (number, place) in &mesh.nodes {
            w.int(*number);
            place.iter().for_each(|&x| w.real(x));
            w.end_row();
        }
        w.text(if name == "NOD" { "$ENDNOD\n" } else { "$EndNodes\n" });
        return;
    }
    w.text("$Nodes\n");
    let is_41 = w.style.version == Version::V41;
    // The first node in a block of a curve, with a parameter.
    let (first, rest) = mesh.nodes.split_at(1);
    w.size(2);
    w.size(count);
    if is_41 {
        w.size(1);
        w.size(count);
    }
    for (nodes, dimension, parametric) in [(first, 1, 1), (rest, 3, 0)] {
        w.entity(dimension, 1);
        w.int(parametric);
        w.size(nodes.len().try_into().unwrap());
        w.end_row();
        if is_41 {
            nodes.iter().for_each(|node| w.tag(node.0));
            w.end_row();
        }
        for (number, place) in nodes {
            if !is_41 {
                w.tag(*number);
            }
            place.iter().for_each(|&x| w.real(x));
            (0..parametric).for_each(|_| w.real(0.25));
            w.end_row();
        }
    }
    w.text("\n$EndNodes\n");
}

fn write_list(w: &mut Writer, mesh: &Mesh) {
    let is_first = w.style.version == Version::V1;
    let name = if is_first { "ELM" } else { "Elements" };
    let count: usize = mesh.blocks.iter().map(|block| block.4.len()).sum();
    w.text(&format!("${name}\n{count}\n"));
    for (_, tag, physical, kind, elements) in &mesh.blocks {
        if w.style.binary.is_some() {
            [*kind, elements.len().try_into().unwrap(), 2].into_iter().for_each(|x| w.int(x));
        }
        for (number, nodes) in elements {
            w.int(*number);
            if is_first {
                [*kind, *physical, *tag, nodes.len().try_into().unwrap()].into_iter().for_each(|x| w.int(x));
            } else {
                if w.style.binary.is_none() {
                    w.int(*kind);
                    w.int(2);
                }
                w.int(*physical);
                w.int(*tag);
            }
            nodes.iter().for_each(|&node| w.int(node));
            w.end_row();
        }
    }
    w.text(if is_first { "$ENDELM\n" } else { "\n$EndElements\n" });
}

fn write_blocks(w: &mut Writer, mesh: &Mesh) {
    w.text("$Elements\n");
    w.size(mesh.blocks.len().try_into().unwrap());
    w.size(mesh.blocks.iter().map(|block| i64::try_from(block.4.len()).unwrap()).sum());
    if w.style.version == Version::V41 {
        w.size(1);
        w.size(99);
    }
    for (dimension, tag, _, kind, elements) in &mesh.blocks {
        w.entity(*dimension, *tag);
        w.int(*kind);
        w.size(elements.len().try_into().unwrap());
        w.end_row();
        for (number, nodes) in elements {
            w.tag(*number);
            nodes.iter().for_each(|&node| w.tag(node));
            w.end_row();
        }
    }
    w.text("\n$EndElements\n");
}

fn write_view(w: &mut Writer, view: &View) {
    let mut head = String::new();
    write!(head, "${}\n1\n\"{}\"\n1\n{:?}\n", view.kind, view.name, view.time).unwrap();
    write!(head, "4\n{}\n{}\n{}\n0\n", view.step, view.components, view.tuples.len()).unwrap();
    w.text(&head);
    for (number, nodes, values) in &view.tuples {
        w.int(*number);
        nodes.iter().for_each(|&nodes| w.int(nodes));
        values.iter().for_each(|&value| w.real(value));
        w.end_row();
    }
    w.text(&format!("\n$End{}\n", view.kind));
}

/// Reads bytes as a file of this name.
pub(super) fn read(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Loaded, IoError> {
    super::GMSH.read(&Source { path: name.into(), bytes: bytes.to_vec(), options: options.clone() })
}
