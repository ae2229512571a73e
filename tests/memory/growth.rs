//! Four times the file is four times the work: what a reader allocates for many of a thing against what it allocates for fewer.

use std::path::Path;

use tetrascope::{ReadOptions, SceneFile, read_heights, read_mesh, read_picture};
use tetrascope_tests::fuzz::corpus::{Compressor, png_chunks};

use crate::{alone, counted};

/// More than this times four for four times as many, and it is not linear. Vectors that double are twice too large at worst.
const LEEWAY: f64 = 2.2;

/// Bytes that reading takes whatever the file is.
const ALWAYS: f64 = 65536.0;

fn read(name: &str, bytes: &[u8]) -> (usize, bool) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let of_any_kind = |path: &Path| match path.extension().unwrap().to_str().unwrap() {
        "png" | "exr" => read_picture(path).is_ok(),
        "heights" => read_heights(path).is_ok(),
        "toml" | "json" => SceneFile::parse(str::from_utf8(bytes).unwrap(), path).is_ok(),
        _ => read_mesh(path, &ReadOptions::default()).is_ok(),
    };
    counted(|| of_any_kind(&path))
}

/// Files of many things, made for a number of them.
pub(crate) fn check(name: &str, few: usize, file: impl Fn(usize) -> Vec<u8>) {
    let (small, large) = (file(few), file(4 * few));
    let ((less, first), (more, second)) = (read(name, &small), read(name, &large));
    let growth = more as f64 / less as f64;
    println!(
        "{name}: {} and {} bytes, {less} and {more} allocated, {growth:.2} times, read: {first}",
        small.len(),
        large.len()
    );
    assert_eq!(first, second, "{name}: one is read, the other is not");
    let linear = LEEWAY * (large.len() as f64 / small.len() as f64) * (less as f64) + ALWAYS;
    assert!((more as f64) < linear, "{name}: {} bytes allocate {less}, {} allocate {more}", small.len(), large.len());
}

fn vtu(pieces: &str) -> Vec<u8> {
    format!("<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>{pieces}</UnstructuredGrid></VTKFile>").into_bytes()
}

fn piece(point_data: &str, cells: usize, more: &str) -> String {
    let many = |word: &str| word.repeat(cells);
    let ends: String = (1..=cells).map(|n| format!("{} ", 4 * n)).collect();
    format!(
        "<Piece NumberOfPoints=\"4\" NumberOfCells=\"{cells}\"><PointData>{point_data}</PointData><Points><DataArray type=\"Float32\">\
         0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\">{}</DataArray>\
         <DataArray type=\"Int32\" Name=\"offsets\">{ends}</DataArray>{more}</Cells></Piece>",
        many("0 1 2 3 ")
    )
}

fn tetrahedra(point_data: &str, cells: usize) -> String {
    let types = format!("<DataArray type=\"UInt8\" Name=\"types\">{}</DataArray>", "10 ".repeat(cells));
    piece(point_data, cells, &types)
}

fn array(name: &str) -> String {
    format!("<DataArray type=\"UInt8\" Name=\"{name}\">1 2 3 4</DataArray>")
}

pub(crate) fn many(count: usize, of: impl Fn(usize) -> String) -> String {
    (0..count).map(of).collect()
}

#[test]
fn work_on_vtu_grows_with_the_file() {
    let _alone = alone();
    check("cells.vtu", 2000, |n| vtu(&tetrahedra("", n)));
    check("arrays.vtu", 1000, |n| vtu(&tetrahedra(&many(n, |i| array(&format!("a{i}"))), 1)));
    check("equal-names.vtu", 1000, |n| vtu(&tetrahedra(&array("s").repeat(n), 1)));
    check("no-names.vtu", 1000, |n| vtu(&tetrahedra(&array("").repeat(n), 1)));
    // Names that stand where a free one is looked for.
    let taken = |n: usize| many(n, |i| array(&format!("s_{}", i + 2))) + &array("s").repeat(n);
    check("taken-names.vtu", 1000, |n| vtu(&tetrahedra(&taken(n), 1)));
    check("arrays-of-pieces.vtu", 500, |n| vtu(&tetrahedra(&many(n, |i| array(&format!("a{i}"))), 1).repeat(3)));
    check("pieces.vtu", 500, |n| vtu(&tetrahedra(&array("s"), 1).repeat(n)));
    check("empty-pieces.vtu", 2000, |n| vtu(&"<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>".repeat(n)));
    check("attributes.vtu", 2000, |n| {
        vtu(&tetrahedra("", 1).replacen("<Piece", &format!("<Piece {}", "a=\"1\" ".repeat(n)), 1))
    });
    check("comments.vtu", 2000, |n| {
        vtu(&tetrahedra("", 1).replacen("0 1 2 3 ", &format!("0 1 {}2 3", "<!-- 9 -->".repeat(n)), 1))
    });
    check("depth.vtu", 5000, |n| vtu(&format!("{}{}{}", "<a>".repeat(n), "</a>".repeat(n), tetrahedra("", 1))));
    check("long-name.vtu", 50_000, |n| vtu(&tetrahedra(&array(&"x".repeat(n)).repeat(2), 1)));
    check("long-word.vtu", 50_000, |n| vtu(&tetrahedra("", 1).replacen("0 1 2 3 ", &"9".repeat(n), 1)));
    let polyhedra = |n: usize| {
        let faces = "4 3 0 1 2 3 0 1 3 3 1 2 3 3 0 2 3 ".repeat(n);
        let ends = many(n, |i| format!("{} ", 17 * (i + 1)));
        let more = format!(
            "<DataArray type=\"UInt8\" Name=\"types\">{}</DataArray><DataArray type=\"Int64\" Name=\"faces\">{faces}</DataArray>\
             <DataArray type=\"Int64\" Name=\"faceoffsets\">{ends}</DataArray>",
            "42 ".repeat(n)
        );
        vtu(&piece("", n, &more))
    };
    check("polyhedra.vtu", 500, polyhedra);
}

#[test]
fn work_on_legacy_files_grows_with_the_file() {
    let _alone = alone();
    let with = |more: String| {
        format!(
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\n\
             CELL_TYPES 1\n10\nPOINT_DATA 4\n{more}"
        )
        .into_bytes()
    };
    check("scalars.vtk", 1000, |n| with(many(n, |i| format!("SCALARS s{i} int\n1 2 3 4\n"))));
    check("equal-names.vtk", 1000, |n| with("SCALARS s int\n1 2 3 4\n".repeat(n)));
    check("field.vtk", 1000, |n| with(format!("FIELD f {n}\n{}", many(n, |i| format!("a{i} 1 4 int\n1 2 3 4\n")))));
    check("nothing.vtk", 1000, |n| with(format!("FIELD f {n}\n{}", "NULL_ARRAY\n".repeat(n))));
    check("texts.vtk", 1000, |n| with(format!("FIELD f 1\nwords 1 {n} string\n{}", "word\n".repeat(n))));
    check("metadata.vtk", 1000, |n| with("METADATA\nINFORMATION 0\n\n".repeat(n)));
    check("sections.vtk", 1000, |n| with("POINT_DATA 4\n".repeat(n)));
    check("spaces.vtk", 50_000, |n| with(" ".repeat(n) + "SCALARS s int\n1 2 3 4\n"));
    check("long-name.vtk", 50_000, |n| with(format!("SCALARS {} int\n1 2 3 4\n", "x".repeat(n)).repeat(2)));
    check("points.vtk", 1000, |n| with("POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n".repeat(n)));
}

#[test]
fn work_on_other_files_grows_with_the_file() {
    let _alone = alone();
    let grids = |n: usize| format!("{n}\n{}{}", "2 2 2\n".repeat(n), many(24 * n, |i| format!("{}\n", i % 7)));
    check("grids.xyz", 200, |n| grids(n).into_bytes());
    let binary = |n: usize| {
        let header = (n as i32).to_le_bytes().into_iter().chain([2_i32; 3].map(i32::to_le_bytes).concat().repeat(n));
        header.chain((0..24 * n).flat_map(|i| (0.5 + i as f32).to_le_bytes())).collect()
    };
    check("grids.bin", 200, binary);
    check("numbers.xyz", 5000, |n| format!("{n} 2 2\n{}", "0.5 ".repeat(12 * n)).into_bytes());
    let heights = |n: usize| {
        let header = [&b"TETRASCOPE-HEIGHTS\n\x01"[..], &(n as u32).to_le_bytes()].concat();
        [header, vec![0; 8 * n]].concat()
    };
    check("a.heights", 5000, heights);
    let chunk = |name: &[u8; 4], body: &[u8]| (name.to_vec(), body.to_vec());
    let png = |n: usize| {
        let mut chunks = vec![chunk(b"IHDR", &[0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0])];
        chunks.extend((0..n).map(|_| chunk(b"tEXt", b"name\0a text of some length")));
        chunks.extend([chunk(b"IDAT", &Compressor::Zlib.block(&[0, 9])), chunk(b"IEND", b"")]);
        png_chunks(&chunks)
    };
    check("texts.png", 2000, png);
}

#[test]
fn work_on_scenes_grows_with_the_file() {
    let _alone = alone();
    let with = |more: String| format!("{more}\n[mesh]\npath = \"a.vtu\"\n").into_bytes();
    let behind = |more: String| format!("[mesh]\npath = \"a.vtu\"\n{more}").into_bytes();
    let points = |n: usize| many(n, |i| format!("[{i}.0, 1.0], "));
    check("points.toml", 2000, |n| behind(format!("[transfer]\nextinction = [{}]\n", points(n))));
    check("surfaces.toml", 500, |n| behind("[[isosurface]]\nvalue = 1\ncolor = [1, 1, 1]\n".repeat(n)));
    check("comments.toml", 2000, |n| with("# a comment\n".repeat(n)));
    check("keys.toml", 2000, |n| behind(many(n, |i| format!("k{i} = 1\n"))));
    check("equal-keys.toml", 2000, |n| behind("k = 1\n".repeat(n)));
    check("dots.toml", 2000, |n| behind(format!("a{} = 1\n", ".a".repeat(n))));
    check("lists.toml", 2000, |n| behind(format!("a = {}{}\n", "[".repeat(n), "]".repeat(n))));
    check("tables.toml", 2000, |n| behind(format!("a = {}1{}\n", "{a=".repeat(n), "}".repeat(n))));
    check("sections.toml", 1000, |n| behind(many(n, |i| format!("[s{i}]\na = 1\n"))));
    check("long.toml", 50_000, |n| behind(format!("field = \"{}\"\n", "x".repeat(n))));
    check("lists.json", 2000, |n| format!("{{\"mesh\": {}{}}}", "[".repeat(n), "]".repeat(n)).into_bytes());
    check("unknown.json", 50_000, |n| format!("{{\"mesh\": \"{}\"}}", "x".repeat(n)).into_bytes());
}
