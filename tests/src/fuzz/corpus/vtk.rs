//! VTK's legacy files, as text and binary.

use fastrand::Rng;

/// The parts of a file: lines, each followed by numbers of a type.
enum Part {
    Line(String),
    Floats(Vec<f32>),
    Doubles(Vec<f64>),
    Ints(Vec<i32>),
    Longs(Vec<i64>),
    Bytes(Vec<u8>),
}
use Part::{Bytes, Doubles, Floats, Ints, Line, Longs};

fn parts(rng: &mut Rng) -> Vec<Part> {
    let version = ["2.0", "3.0", "4.2", "5.1"][rng.usize(..4)];
    let mut unit = |count: usize| (0..count).map(|_| rng.f32()).collect::<Vec<_>>();
    let (s, v, f) = (unit(5), unit(15), unit(4));
    let line = |text: &str| Line(text.to_owned());
    let mut parts = vec![
        Line(format!("# vtk DataFile Version {version}")),
        line("a title"),
        line("ENCODING"),
        line("DATASET UNSTRUCTURED_GRID"),
        line("POINTS 5 float"),
        Floats(vec![0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 1., 1., 1.]),
        line("METADATA\nINFORMATION 1\nNAME x LOCATION y\nDATA 1 2\n"),
    ];
    let stream = [4, 3, 0, 1, 2, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 2, 3];
    if version == "5.1" {
        parts.extend([line("CELLS 3 21"), line("OFFSETS vtktypeint64"), Longs(vec![0, 17, 21])]);
        let points = stream.iter().copied().chain([1, 2, 3, 4]).map(i64::from).collect();
        parts.extend([line("CONNECTIVITY vtktypeint64"), Longs(points)]);
    } else {
        let rows = [&[17][..], &stream, &[4, 1, 2, 3, 4]].concat();
        parts.extend([line("CELLS 2 23"), Ints(rows)]);
    }
    parts.extend([line("CELL_TYPES 2"), Ints(vec![42, 10]), line("POINT_DATA 5")]);
    parts.extend([line("SCALARS s%20x float 1\nLOOKUP_TABLE default"), Floats(s)]);
    parts.extend([line("VECTORS v float"), Floats(v)]);
    parts.extend([line("COLOR_SCALARS c 2"), Bytes(vec![0, 1, 0, 1, 0, 1, 1, 1, 0, 0])]);
    parts.extend([line("LOOKUP_TABLE mine 2"), Bytes(vec![0, 0, 0, 1, 1, 1, 1, 1])]);
    parts.extend([line("FIELD FieldData 3"), line("f 2 5 double"), Doubles((0..10).map(f64::from).collect())]);
    parts.extend([line("NULL_ARRAY"), line("id 1 5 vtktypeint64"), Longs(vec![1, 2, -3, 4, 1 << 40])]);
    parts.extend([line("CELL_DATA 2"), line("SCALARS d float 2\nLOOKUP_TABLE default"), Floats(f)]);
    parts
}

/// A grid of another kind: structured points, rectilinear or structured, with what hides points.
fn grid_parts(rng: &mut Rng) -> Vec<Part> {
    let line = |text: &str| Line(text.to_owned());
    let mut parts = vec![line("# vtk DataFile Version 3.0"), line("a title"), line("ENCODING")];
    match rng.u8(..3) {
        0 => {
            let spacing = ["SPACING", "ASPECT_RATIO"][rng.usize(..2)];
            parts.extend([
                line("DATASET STRUCTURED_POINTS"),
                line("DIMENSIONS 3 2 2"),
                Line(format!("{spacing} 1 0.5 2")),
                line("ORIGIN 1 2 3"),
            ]);
        }
        1 => {
            parts.extend([line("DATASET RECTILINEAR_GRID"), line("DIMENSIONS 3 2 2")]);
            parts.extend([line("X_COORDINATES 3 float"), Floats(vec![0.0, 1.0, 4.0])]);
            parts.extend([line("Y_COORDINATES 2 double"), Doubles(vec![0.0, 1.5])]);
            parts.extend([line("Z_COORDINATES 2 int"), Ints(vec![-1, 1])]);
        }
        _ => {
            parts.extend([line("DATASET STRUCTURED_GRID"), line("DIMENSIONS 3 2 2")]);
            if rng.bool() {
                let flags = (0..12).map(|_| u8::from(rng.u8(..8) > 0)).collect();
                parts.extend([line("BLANKING 12 unsigned_char"), Bytes(flags)]);
            }
            let place = |n: usize| [(n % 3) as f32, (n / 3 % 2) as f32 + 0.1 * (n % 3) as f32, (n / 6) as f32];
            parts.extend([line("POINTS 12 float"), Floats((0..12).flat_map(place).collect())]);
        }
    }
    parts.extend([line("POINT_DATA 12"), line("SCALARS s float 1\nLOOKUP_TABLE default")]);
    parts.push(Floats((0..12).map(|_| rng.f32()).collect()));
    parts.extend([line("CELL_DATA 2"), line("FIELD FieldData 1"), line("vtkGhostType 1 2 unsigned_char")]);
    parts.push(Bytes(vec![0, 32 * rng.u8(..2)]));
    parts
}

pub(super) fn grid(rng: &mut Rng) -> Vec<u8> {
    let parts = grid_parts(rng);
    if rng.bool() { text_of(&parts) } else { binary_of(parts) }
}

pub(super) fn text(rng: &mut Rng) -> Vec<u8> {
    text_of(&parts(rng))
}

fn text_of(parts: &[Part]) -> Vec<u8> {
    fn words<T: ToString>(values: &[T]) -> String {
        values.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
    }
    let lines = parts.iter().map(|part| match part {
        Line(text) => text.replace("ENCODING", "ASCII"),
        Floats(v) => words(v),
        Doubles(v) => words(v),
        Ints(v) => words(v),
        Longs(v) => words(v),
        Bytes(v) => words(v),
    });
    (lines.collect::<Vec<_>>().join("\n") + "\n").into_bytes()
}

pub(super) fn binary(rng: &mut Rng) -> Vec<u8> {
    let mut file = binary_of(parts(rng));
    // Texts of one, two and four bytes of length, which text files have a line each for.
    file.extend(b"FIELD more 1\nwords 1 2 string\n\xc2hi\x80\x02ho\n");
    file
}

fn binary_of(parts: Vec<Part>) -> Vec<u8> {
    let mut file = Vec::new();
    for part in parts {
        match part {
            Line(text) => file.extend(text.replace("ENCODING", "BINARY").bytes()),
            Floats(v) => v.iter().for_each(|x| file.extend(x.to_be_bytes())),
            Doubles(v) => v.iter().for_each(|x| file.extend(x.to_be_bytes())),
            Ints(v) => v.iter().for_each(|x| file.extend(x.to_be_bytes())),
            Longs(v) => v.iter().for_each(|x| file.extend(x.to_be_bytes())),
            Bytes(v) => file.extend(v),
        }
        file.push(b'\n');
    }
    file
}
