//! Each encoding and each odd form of a VTU file, written out here.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use tetrascope_mesh::CellKind;

use super::super::test_support::{assert_same, bits, cells, read, sanity_check};
use super::compression::{Compressor, Decompressor};
use crate::{IoError, Loaded};

fn good(file: &str) -> Loaded {
    let loaded = read("small.vtu", file.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    sanity_check(&loaded.dataset);
    loaded
}

fn message(file: &str) -> String {
    read("small.vtu", file.as_bytes()).err().unwrap_or_else(|| panic!("it loads: {file}")).to_string()
}

const XYZ: [f32; 15] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.25];

pub(super) fn array(kind: &str, name: &str, components: usize, text: &str) -> String {
    format!(
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">\n{text}\n</DataArray>\n"
    )
}

pub(super) fn cell_arrays(connectivity: &str, offsets: &str, types: &str, more: &str) -> String {
    array("Int64", "connectivity", 1, connectivity)
        + &array("Int32", "offsets", 1, offsets)
        + &array("UInt8", "types", 1, types)
        + more
}

fn points() -> String {
    array("Float32", "Points", 3, &XYZ.map(|x| x.to_string()).join(" "))
}

pub(super) fn piece(cell_count: usize, point_data: &str, cell_data: &str, cells: &str) -> String {
    format!(
        "<Piece NumberOfPoints=\"5\" NumberOfCells=\"{cell_count}\">\n<PointData>{point_data}</PointData>\n\
         <CellData>{cell_data}</CellData>\n<Points>{}</Points>\n<Cells>{cells}</Cells></Piece>\n",
        points()
    )
}

pub(super) fn file(pieces: &str) -> String {
    format!(
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid>{pieces}</UnstructuredGrid></VTKFile>\n"
    )
}

fn two_tets(point_data: &str, cell_data: &str) -> String {
    piece(2, point_data, cell_data, &cell_arrays("0 1 2 3 1 2 3 4", "4 8", "10 10", ""))
}

pub(in crate::vtk) fn ascii_file() -> String {
    file(&two_tets(&array("Float32", "s", 1, "0.5 nan -inf 3e2 -0"), &array("Int16", "c", 2, "1 2 3 -4")))
}

/// Encodings of one array's bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    InlineBase64,
    /// The length word padded on its own, as some writers do.
    InlineBase64Apart,
    AppendedBase64,
    AppendedRaw,
}

struct Writer {
    encoding: Encoding,
    big: bool,
    wide: bool,
    zlib: bool,
    appended: Vec<u8>,
}

impl Writer {
    fn word(&self, value: usize) -> Vec<u8> {
        let mut word =
            if self.wide { (value as u64).to_le_bytes().to_vec() } else { (value as u32).to_le_bytes().to_vec() };
        if self.big {
            word.reverse();
        }
        word
    }

    /// One `DataArray` element with these little-endian numbers of `size` bytes each.
    fn array(&mut self, kind: &str, name: &str, components: usize, size: usize, little: &[u8]) -> String {
        let mut data = little.to_vec();
        if self.big {
            data.chunks_mut(size).for_each(<[u8]>::reverse);
        }
        let (header, body) = if self.zlib {
            // Blocks of 24 bytes, so that there are several and a partial one.
            let blocks: Vec<Vec<u8>> = data
                .chunks(24)
                .map(|block| {
                    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
                    encoder.write_all(block).unwrap();
                    encoder.finish().unwrap()
                })
                .collect();
            let mut header = [blocks.len(), 24, data.len() % 24].map(|n| self.word(n)).concat();
            header.extend(blocks.iter().flat_map(|block| self.word(block.len())));
            (header, blocks.concat())
        } else {
            (self.word(data.len()), data)
        };
        let apart = self.zlib || self.encoding == Encoding::InlineBase64Apart;
        let text = if apart {
            STANDARD.encode(&header) + &STANDARD.encode(&body)
        } else {
            STANDARD.encode([header.clone(), body.clone()].concat())
        };
        let start = format!("<DataArray type='{kind}' NumberOfComponents='{components}' Name='{name}'");
        match self.encoding {
            Encoding::InlineBase64 | Encoding::InlineBase64Apart => {
                format!("{start} format='binary'>\n  {text}\n</DataArray>")
            }
            Encoding::AppendedBase64 | Encoding::AppendedRaw => {
                let offset = self.appended.len();
                if self.encoding == Encoding::AppendedRaw {
                    self.appended.extend([header, body].concat());
                } else {
                    self.appended.extend(text.as_bytes());
                }
                format!("{start} format='appended' offset='{offset}'/>")
            }
        }
    }
}

fn encoded_file(encoding: Encoding, big: bool, wide: bool, zlib: bool) -> Vec<u8> {
    let mut w = Writer { encoding, big, wide, zlib, appended: Vec::new() };
    let f32s = |v: &[f32]| v.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let s = w.array("Float32", "s", 1, 4, &f32s(&[0.5, f32::NAN, f32::NEG_INFINITY, 300.0, -0.0]));
    let c = w.array("Int16", "c", 2, 2, &[1, 0, 2, 0, 3, 0, 0xfc, 0xff]);
    let p = w.array("Float32", "Points", 3, 4, &f32s(&XYZ));
    let connectivity: Vec<u8> = [0_i64, 1, 2, 3, 1, 2, 3, 4].iter().flat_map(|x| x.to_le_bytes()).collect();
    let cells = w.array("Int64", "connectivity", 1, 8, &connectivity)
        + &w.array("Int32", "offsets", 1, 4, &[4, 0, 0, 0, 8, 0, 0, 0])
        + &w.array("UInt8", "types", 1, 1, &[10, 10]);
    let mut out = format!(
        "<?xml version='1.0'?>\n<!-- a comment with <AppendedData> in it -->\n<VTKFile {}{} byte_order='{}' version='0.1' type='UnstructuredGrid'>\
         <UnstructuredGrid><FieldData>{}</FieldData><Piece NumberOfCells='2' NumberOfPoints='5'><PointData>{s}</PointData><CellData>{c}</CellData>\
         <Points>{p}</Points><Cells>{cells}</Cells></Piece></UnstructuredGrid>",
        if wide { "header_type='UInt64'" } else { "" },
        if zlib { " compressor='vtkZLibDataCompressor'" } else { "" },
        if big { "BigEndian" } else { "LittleEndian" },
        array("String", "ignored", 1, "1 2 3"),
    )
    .into_bytes();
    if encoding == Encoding::AppendedRaw {
        // Nothing behind the tag is XML, as the bytes of numbers may be anything.
        out.extend(b"<AppendedData encoding='raw'>\n  _");
        out.extend(w.appended);
        out.extend(b"\n</AppendedData></VTKFile>");
    } else if encoding == Encoding::AppendedBase64 {
        out.extend(b"<AppendedData encoding='base64'>_");
        out.extend(w.appended);
        out.extend(b"\n</AppendedData></VTKFile>");
    } else {
        out.extend(b"</VTKFile>");
    }
    out
}

pub(in crate::vtk) fn raw_zlib_file() -> Vec<u8> {
    encoded_file(Encoding::AppendedRaw, false, true, true)
}

#[test]
fn vtu_all_encodings_equal_ascii() {
    let reference = good(&ascii_file()).dataset;
    for encoding in
        [Encoding::InlineBase64, Encoding::InlineBase64Apart, Encoding::AppendedBase64, Encoding::AppendedRaw]
    {
        for bits in 0..8 {
            let (big, wide, zlib) = (bits & 1 != 0, bits & 2 != 0, bits & 4 != 0);
            let what = format!("{encoding:?} big {big} wide {wide} zlib {zlib}");
            let loaded =
                read("e.vtu", &encoded_file(encoding, big, wide, zlib)).unwrap_or_else(|e| panic!("{what}: {e}"));
            // The sign and payload of NaN may differ between text and bytes; here they do not.
            assert_same(&loaded.dataset, &reference, &what);
            assert_eq!(loaded.format.contains("zlib"), zlib, "{}", loaded.format);
            assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        }
    }
}

#[test]
fn vtu_odd_xml() {
    let reference = good(&ascii_file()).dataset;
    let marked = [b"\xef\xbb\xbf".to_vec(), ascii_file().into_bytes()].concat();
    assert_same(&read("m.vtu", &marked).unwrap().dataset, &reference, "mark");
    // Comments and information keys inside an array, character data, an unknown element around nothing.
    let odd = ascii_file()
        .replace("0.5 nan", "0.5 <!-- 7 --><InformationKey name=\"R\"><Value>8 9</Value></InformationKey> nan")
        .replace("300 ", "<![CDATA[300]]> ")
        .replace("<UnstructuredGrid>", "<Extra><Piece/><DataArray>1 2</DataArray></Extra><UnstructuredGrid>");
    assert_same(&good(&odd).dataset, &reference, "odd");
    let named = good(&ascii_file().replace("Name=\"s\"", "Name=\"a&lt;b &#956;\"")).dataset;
    assert_eq!(named.point_arrays[0].name, "a<b μ");
}

#[test]
fn vtu_entities_and_depth_do_no_harm() {
    let bomb =
        format!("<!DOCTYPE VTKFile [<!ENTITY a \"1 1\"><!ENTITY b \"&a;&a;\">]>{}", ascii_file().replace("300", "&b;"));
    // The word is elsewhere in this file, so replace it where it stands.
    let bomb = bomb.replace("3e2", "&b;");
    let found = message(&bomb);
    assert!(found.contains("&b;") && found.contains("not expanded"), "{found}");
    assert!(message(&ascii_file().replace("Name=\"s\"", "Name=\"&b;\"")).contains("`Name`"));
    let deep = format!("<VTKFile type=\"UnstructuredGrid\">{}", "<a>".repeat(200_000));
    assert!(message(&deep).contains("ends inside"));
}

#[test]
fn vtu_pieces_are_joined() {
    let s = array("Float32", "s", 1, "1 2 3 4 5");
    let only_here = array("Float32", "t", 1, "1 2 3 4 5");
    let empty = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>";
    let other_type = array("Float64", "u", 1, "1 2 3 4 5");
    let u = array("Float32", "u", 1, "1 2 3 4 5");
    let loaded = good(&file(&format!(
        "{empty}{}{empty}{}",
        two_tets(&(s.clone() + &u), &array("Int8", "c", 1, "1 2")),
        two_tets(&(only_here + &other_type + &s), &array("Int8", "c", 1, "3 4"))
    )));
    let d = &loaded.dataset;
    assert_eq!(d.points.len(), 10);
    assert_eq!(cells(d).connectivity, [0, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 6, 7, 8, 9]);
    assert_eq!(d.point_arrays.len(), 1);
    assert_eq!(d.point_arrays[0].component(0), [1.0, 2.0, 3.0, 4.0, 5.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(bits(&d.cell_arrays[0].values), [1, 2, 3, 4]);
    assert_eq!(loaded.warnings.len(), 2, "{:?}", loaded.warnings);
    assert!(loaded.warnings.iter().any(|w| w.contains("`t`")) && loaded.warnings.iter().any(|w| w.contains("`u`")));
    // The second piece's cells count from its own points and from its own first cell.
    let broken = file(&(two_tets("", "") + &two_tets("", "").replace("1 2 3 4\n", "1 2 3 7\n")));
    let found = message(&broken);
    assert!(found.contains("piece 1") && found.contains("cell 1") && found.contains("point 7"), "{found}");
}

#[test]
fn vtu_polyhedra_of_both_layouts() {
    let cells_of = |more: &str| piece(2, "", "", &cell_arrays("1 2 3 4 0 1 2 3", "4 8", "10 42", more));
    let old =
        array("Int64", "faces", 1, "4 3 0 1 2 3 0 1 3 3 1 2 3 3 0 2 3") + &array("Int64", "faceoffsets", 1, "-1 17");
    let new = array("Int64", "face_connectivity", 1, "0 1 2 0 1 3 1 2 3 0 2 3")
        + &array("Int64", "face_offsets", 1, "3 6 9 12")
        + &array("Int64", "polyhedron_to_faces", 1, "0 1 2 3")
        + &array("Int64", "polyhedron_offsets", 1, "0 4");
    let both = file(&cells_of(&old).repeat(2));
    let loaded = good(&both);
    assert_eq!(cells(&loaded.dataset).kinds[1], CellKind::Polyhedron);
    assert_eq!(cells(&loaded.dataset).polyhedra[0], [vec![0, 1, 2], vec![0, 1, 3], vec![1, 2, 3], vec![0, 2, 3]]);
    assert_eq!(cells(&loaded.dataset).polyhedra[1][0], [5, 6, 7]);
    assert_same(&loaded.dataset, &good(&file(&cells_of(&new).repeat(2))).dataset, "layouts");
    for (broken, word) in [
        (cells_of(""), "no faces"),
        (cells_of(&old.replace("-1 17", "-1 16")), "16"),
        (cells_of(&old.replace("\n4 3 0", "\n4 99 0")), "99"),
        (cells_of(&old.replace("3 0 1 2", "3 0 1 8")), "point 8"),
        (cells_of(&new.replace("0 1 2 3\n", "0 1 2 4\n")), "face 4"),
        (cells_of(&new.replace("\n0 4\n", "\n0 9\n")), "from 0 to 9"),
        (
            cells_of(&new.replace("0 1 2 3\n", &format!("{}\n", "0 ".repeat(100))).replace("\n0 4\n", "\n0 100\n")),
            "share",
        ),
    ] {
        let found = message(&file(&broken));
        assert!(found.contains("cell 1") && found.contains(word), "{word}: {found}");
    }
}

#[test]
fn vtu_errors_name_array_and_value() {
    let header =
        |words: &[u64]| STANDARD.encode(words.iter().flat_map(|w| (*w as u32).to_le_bytes()).collect::<Vec<u8>>());
    let binary = |text: &str| {
        ascii_file().replace("format=\"ascii\">\n0.5 nan -inf 3e2 -0", &format!("format=\"binary\">{text}"))
    };
    let zlib = |text: &str| binary(text).replace("byte_order", "compressor=\"vtkZLibDataCompressor\" byte_order");
    for (file, words) in [
        (ascii_file().replace("3e2", "3x2"), &["`s`", "line 2", "value 3", "3x2"][..]),
        (ascii_file().replace("3e2", ""), &["`s`", "4 values", "5 were"]),
        (ascii_file().replace("4 8", "8 4"), &["cell 1", "from 8 to 4"]),
        (ascii_file().replace("4 8", "4 9"), &["cell 1", "from 4 to 9"]),
        (ascii_file().replace("4 8", "4"), &["offsets", "1 values", "2 were"]),
        (ascii_file().replace("10 10", "10 -1"), &["types", "-1"]),
        (ascii_file().replace("NumberOfCells=\"2\"", "NumberOfCells=\"x\""), &["NumberOfCells", "\"x\""]),
        (ascii_file().replace("NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""), &["Points", "3 components"]),
        (ascii_file().replace("NumberOfComponents=\"2\"", "NumberOfComponents=\"0\""), &["`c`", "\"0\" components"]),
        (ascii_file().replace("Name=\"types\"", "Name=\"kinds\""), &["`types`", "missing"]),
        (ascii_file().replace("\"Int64\"", "\"Float32\""), &["connectivity", "Float32"]),
        (ascii_file().replace("LittleEndian", "MiddleEndian"), &["byte_order", "MiddleEndian"]),
        (ascii_file().replace("format=\"ascii\"", "format=\"appended\" offset=\"0\""), &["no appended data"]),
        (ascii_file().replace("format=\"ascii\"", "format=\"morse\""), &["format", "morse"]),
        (ascii_file().replace("</Piece>", "</Peace>"), &["XML"]),
        (binary("!!!!!!!!"), &["`s`", "base64"]),
        (binary(&header(&[4_000_000_000])), &["`s`", "4000000000"]),
        (binary(&header(&[3, 0])), &["`s`", "3 bytes", "multiple"]),
        (zlib(&header(&[u64::MAX])), &["`s`", "4294967295 compressed blocks"]),
        (zlib(&(header(&[1, 20, 0, 900]) + "AAAA")), &["`s`", "900 bytes"]),
        (zlib(&(header(&[1, 20, 0, 6]) + "AAAAAAAA")), &["`s`", "block 0", "zlib"]),
    ] {
        let found = message(&file);
        assert!(found.starts_with("small.vtu: "), "{found}");
        for word in words {
            assert!(found.contains(word), "\"{word}\" is not in: {found}");
        }
    }
}

fn inflate(compressor: Compressor, block: &[u8], size: usize, out: &mut Vec<u8>) -> Result<(), String> {
    compressor.check(block, size)?;
    Decompressor::new(compressor).decompress(block, size, out)
}

#[test]
fn vtu_blocks_may_not_inflate_past_their_size() {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(&vec![0; 1 << 24]).unwrap();
    let bomb = encoder.finish().unwrap();
    let mut out = Vec::new();
    let error = inflate(Compressor::Zlib, &bomb, 20, &mut out).unwrap_err();
    assert!(error.contains("more than the 20 bytes"), "{error}");
    // Memory was taken for what is allowed, not for what the stream holds.
    assert!(out.is_empty() && out.capacity() < 1 << 16, "{}", out.capacity());
    let lz4 = inflate(Compressor::Lz4, &[0; 10], 1 << 40, &mut out).unwrap_err();
    assert!(lz4.contains("cannot hold"), "{lz4}");
    let mut xz = Vec::new();
    lzma_rs::xz_compress(&mut &[7_u8; 1000][..], &mut xz).unwrap();
    let lzma = Compressor::Lzma;
    assert!(inflate(lzma, &xz, 999, &mut out).unwrap_err().contains("1000 bytes"));
    inflate(lzma, &xz, 1000, &mut out).unwrap();
    assert_eq!(out, [7; 1000]);
    for cut in 0..xz.len() {
        // Cut within the chunks it must fail; the checksums behind them are not needed.
        let _ = inflate(lzma, &xz[..cut], 1000, &mut Vec::new());
    }
    assert!(inflate(lzma, &xz[..xz.len() / 2], 1000, &mut out).is_err());
}

#[test]
fn vtu_of_other_types_and_compressors_is_unsupported() {
    for (from, to) in [
        ("type=\"UnstructuredGrid\"", "type=\"PolyData\""),
        ("type=\"UnstructuredGrid\"", "type=\"Table\""),
        ("byte_order", "compressor=\"vtkBrotliDataCompressor\" byte_order"),
    ] {
        let error = read("x.vtu", ascii_file().replace(from, to).as_bytes()).unwrap_err();
        assert!(matches!(error, IoError::Unsupported { .. }), "{error}");
    }
}

#[test]
fn vtu_text_and_bit_arrays_are_left_out_with_a_warning() {
    let loaded = good(&file(&two_tets(&array("String", "words", 1, "104 105 0"), &array("Bit", "b", 1, "1"))));
    assert!(loaded.dataset.point_arrays.is_empty() && loaded.dataset.cell_arrays.is_empty());
    assert_eq!(loaded.warnings.len(), 2);
}

#[test]
fn vtu_more_points_than_32_bits_count_is_unsupported() {
    let source = crate::Source { path: "big.vtu".into(), bytes: Vec::new(), ..Default::default() };
    let mut builder = super::super::cells::CellBuilder::new(&source);
    assert!(builder.begin_piece("Cells", u32::MAX as usize - 5, 5).is_ok());
    let error = builder.begin_piece("Cells", u32::MAX as usize - 5, 6).unwrap_err();
    assert!(matches!(error, IoError::Unsupported { .. }), "{error}");
}

/// Runs all compressors on a block, as it is and behind the headers of an xz container.
pub(in crate::vtk) fn decompress_with_all(block: &[u8], size: usize) {
    let header = *b"\xfd7zXZ\0\0\x01\0\0\0\0\x02\0\x21\x01\x16\0\0\0\0\0\0\0";
    let container = [&header[..], &[0xe0, 0, 99, 0, 40, 0x5d], block].concat();
    for (compressor, block) in
        [(Compressor::Zlib, block), (Compressor::Lz4, block), (Compressor::Lzma, block), (Compressor::Lzma, &container)]
    {
        let mut out = Vec::new();
        if inflate(compressor, block, size, &mut out).is_ok() {
            assert_eq!(out.len(), size);
        }
    }
    // The same with the size and length that the chunk declares, so that the decoder itself is reached.
    let mut chunk = block.to_vec();
    chunk.resize(41, 0);
    let _ = inflate(Compressor::Lzma, &[&container[..30], &chunk, &[0]].concat(), 100, &mut Vec::new());
}

/// The lines of the whole file were counted once for each index array of each piece, which took time with the square of their number.
#[test]
fn vtu_many_pieces_are_not_looked_through_again_and_again() {
    super::attributes::LOOKED_THROUGH.set(0);
    good(&file(&two_tets("", "").repeat(200)));
    assert_eq!(super::attributes::LOOKED_THROUGH.get(), 0);
    let broken = file(&(two_tets("", "").repeat(200) + &two_tets("", "").replace("4 8", "4 8 8")));
    assert!(message(&broken).contains("it has 3 values"));
    let looked_through = super::attributes::LOOKED_THROUGH.get();
    assert!(looked_through > 0 && looked_through <= 2 * broken.len(), "{looked_through}");
}

/// Arrays that are compressed, or that share an offset, come to a stated number of numbers.
#[test]
fn vtu_arrays_have_a_limit_together() {
    let source = crate::Source { path: "a.vtu".into(), bytes: ascii_file().into_bytes(), ..Default::default() };
    let budget = super::super::grids::budget::Budget::new(super::super::grids::budget::Limit::NumbersAByte(16));
    let parsed = super::elements::parse(&source, None, super::Kind::Unstructured, &budget).unwrap();
    parsed.budget.spend(1 << 20, 4).unwrap();
    let error = parsed.budget.spend(1, 4).unwrap_err();
    assert!(error.contains("16 numbers a byte") && error.contains("limit"), "{error}");
}
