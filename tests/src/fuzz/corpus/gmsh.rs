//! Gmsh's files of versions 2.2 and 4.1, as text and binary.

use fastrand::Rng;

/// Number, type, and nodes of each element: a hexahedron, a tetrahedron on it, a tetrahedron of second order, a triangle.
const ELEMENTS: &[(i32, i32, &[i32])] = &[
    (1, 5, &[1, 2, 3, 4, 5, 6, 7, 8]),
    (2, 4, &[2, 9, 3, 6]),
    (4, 11, &[2, 9, 3, 10, 11, 12, 13, 14, 15, 16]),
    (7, 2, &[1, 2, 3]),
];

const NODES: i32 = 16;

struct Writer {
    /// Nothing for text; else whether the highest byte is first.
    binary: Option<bool>,
    is_4: bool,
    bytes: Vec<u8>,
}

impl Writer {
    fn text(&mut self, text: &str) {
        self.bytes.extend(text.bytes());
    }

    fn number(&mut self, little: &[u8], word: &str) {
        match self.binary {
            None => self.bytes.extend(format!("{word} ").bytes()),
            Some(false) => self.bytes.extend(little),
            Some(true) => self.bytes.extend(little.iter().rev()),
        }
    }

    fn int(&mut self, value: i32) {
        self.number(&value.to_le_bytes(), &value.to_string());
    }

    /// A count or a tag of version 4.1; a number of 32 bits before.
    fn size(&mut self, value: i32) {
        if self.is_4 { self.number(&i64::from(value).to_le_bytes(), &value.to_string()) } else { self.int(value) }
    }

    fn real(&mut self, value: f64) {
        self.number(&value.to_le_bytes(), &format!("{value:?}"));
    }

    fn row(&mut self) {
        if self.binary.is_none() {
            self.text("\n");
        }
    }

    fn count(&mut self, value: usize) {
        self.text(&format!("{value}\n"));
    }

    fn end(&mut self, section: &str) {
        self.text(&format!("\n$End{section}\n"));
    }

    fn entities(&mut self) {
        self.text("$Entities\n");
        [0, 0, 1, 1].into_iter().for_each(|count| self.size(count));
        self.row();
        for physical in [8, 9] {
            self.int(1);
            (0..6).for_each(|_| self.real(0.5));
            self.size(1);
            self.int(physical);
            self.size(0);
            self.row();
        }
        self.end("Entities");
    }

    fn nodes(&mut self, rng: &mut Rng) {
        self.text("$Nodes\n");
        let corners = [
            [0, 0, 0],
            [1, 0, 0],
            [1, 1, 0],
            [0, 1, 0],
            [0, 0, 1],
            [1, 0, 1],
            [1, 1, 1],
            [0, 1, 1],
            [2, 0, 0],
            [2, 2, 2],
        ];
        let place = |node: i32, rng: &mut Rng| -> [f64; 3] {
            let corner = corners.get(node as usize - 1).map(|corner| corner.map(f64::from));
            corner.unwrap_or_else(|| [1.0 + rng.f64(), rng.f64(), rng.f64()])
        };
        if self.is_4 {
            [1, NODES, 1, NODES].into_iter().for_each(|value| self.size(value));
            self.row();
            [3, 1, 0].into_iter().for_each(|value| self.int(value));
            self.size(NODES);
            self.row();
            (1..=NODES).for_each(|node| self.size(node));
            self.row();
        } else {
            self.count(NODES as usize);
        }
        for node in 1..=NODES {
            if !self.is_4 {
                self.int(node);
            }
            place(node, rng).into_iter().for_each(|value| self.real(value));
            self.row();
        }
        self.end("Nodes");
    }

    fn elements(&mut self) {
        self.text("$Elements\n");
        if self.is_4 {
            [ELEMENTS.len() as i32, ELEMENTS.len() as i32, 1, 7].into_iter().for_each(|value| self.size(value));
            self.row();
        } else {
            self.count(ELEMENTS.len());
        }
        for &(number, kind, nodes) in ELEMENTS {
            let dimension = if kind == 2 { 2 } else { 3 };
            if self.is_4 {
                [dimension, 1, kind].into_iter().for_each(|value| self.int(value));
                self.size(1);
                self.row();
                self.size(number);
            } else if self.binary.is_some() {
                [kind, 1, 2, number, 9, 1].into_iter().for_each(|value| self.int(value));
            } else {
                [number, kind, 2, 9, 1].into_iter().for_each(|value| self.int(value));
            }
            nodes.iter().for_each(|&node| self.size(node));
            self.row();
        }
        self.end("Elements");
    }

    fn view(&mut self, section: &str, name: &str, step: usize, components: usize, rng: &mut Rng) {
        let numbers: Vec<i32> = match section {
            "NodeData" => (1..=NODES).collect(),
            _ => ELEMENTS.iter().map(|element| element.0).collect(),
        };
        let head = format!("${section}\n1\n\"{name}\"\n1\n{step}.5\n4\n{step}\n{components}\n{}\n0\n", numbers.len());
        self.text(&head);
        for number in numbers {
            self.int(number);
            let mut count = components;
            if section == "ElementNodeData" {
                let nodes = ELEMENTS.iter().find(|element| element.0 == number).map_or(0, |element| element.2.len());
                self.int(nodes as i32);
                count *= nodes;
            }
            (0..count).for_each(|_| self.real(rng.f64()));
            self.row();
        }
        self.end(section);
    }
}

pub(super) fn file(is_binary: bool, rng: &mut Rng) -> Vec<u8> {
    let binary = is_binary.then(|| rng.bool());
    let is_4 = rng.bool();
    let mut w = Writer { binary, is_4, bytes: Vec::new() };
    w.text(&format!("$MeshFormat\n{} {} 8\n", if is_4 { "4.1" } else { "2.2" }, u8::from(is_binary)));
    if is_binary {
        w.int(1);
        w.text("\n");
    }
    w.text("$EndMeshFormat\n$PhysicalNames\n1\n3 9 \"the solid\"\n$EndPhysicalNames\n");
    if is_4 {
        w.entities();
    }
    w.nodes(rng);
    w.elements();
    (0..rng.usize(1..3)).for_each(|step| w.view("NodeData", "s", step, 1, rng));
    if rng.bool() {
        w.view("ElementData", "v", 0, 3, rng);
    }
    if rng.bool() {
        w.view("ElementNodeData", "t", 0, 1, rng);
    }
    w.bytes
}
