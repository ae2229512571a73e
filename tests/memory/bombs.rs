//! Files that are small and would be large, and what they cost.

use std::io::Write;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use tetrascope::{IoError, ReadOptions, read_exr, read_mesh, read_picture, read_png, readers};
use tetrascope_tests::fuzz::corpus::{Compressor, Encoding, Values, VtuWriter, exr_header, png_chunks};
use tetrascope_tests::fuzz::{Target, most_allocated};

use crate::{alone, counted};

/// How a file ends: in an error with these words, or with a mesh.
pub(crate) enum End<'a> {
    Refused(&'a [&'a str]),
    Read,
}
use End::{Read, Refused};

/// Reads a file of these bytes; what it allocates is below so many bytes.
pub(crate) fn read(name: &str, bytes: &[u8], end: End<'_>, most: usize) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let (allocated, result) = counted(|| of_any_kind(&path));
    println!(
        "{name}: {} bytes, {allocated} allocated, {}",
        bytes.len(),
        result.as_ref().err().unwrap_or(&String::new())
    );
    assert!(allocated < most, "{name}: {} bytes make {allocated}, {most} are allowed", bytes.len());
    match (end, result) {
        (Refused(words), Err(error)) => {
            let missing = words.iter().find(|word| !error.contains(**word));
            assert!(error.contains(name) && missing.is_none(), "{name}: {missing:?} is not in: {error}");
        }
        (Read, Ok(())) => {}
        (Read, Err(error)) => panic!("{name} is refused: {error}"),
        (Refused(_), Ok(())) => panic!("{name} is read"),
    }
}

fn of_any_kind(path: &Path) -> Result<(), String> {
    let extension = path.extension().unwrap().to_str().unwrap();
    let result: Result<(), IoError> = match extension {
        "png" => read_picture(path).and(read_png(path)).map(drop),
        "exr" => read_picture(path).and(read_exr(path)).map(drop),
        _ => read_mesh(path, &ReadOptions::default()).map(drop),
    };
    result.map_err(|error| error.to_string())
}

fn vtu(pieces: &str) -> Vec<u8> {
    VtuWriter::new(Encoding::Text, None).file(pieces)
}

fn text_piece(more: &str) -> String {
    format!(
        "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">{more}<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">\
         0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 3</DataArray>\
         <DataArray type=\"Int32\" Name=\"offsets\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\">10</DataArray></Cells></Piece>"
    )
}

/// A mebibyte of zeros as the XZ Utils compress it, which the encoder of the tests does not.
const ZEROS_XZ: &str = "/Td6WFoAAAFpIt42AgAhARwAAAAQz1jM7///ANldAABv/f//o7f/Rz5IFXI5YVG4kijmo4YH+e7kHoLTL8U6PAFLsX7JiopNL6MN2X+m44wj\
    EVPgWRjFdYrid/i2lH8MasDedElk4ulcU7IE2PdEDKtfDW1G6eXDdoi3llestk3haR1v+0uIEGxCy4g/XACP0E6vJiiUcR89jyThcJ6nI1/sKMuF0ZWYin4qkfIndfcZ\
    wAaYTZj92K/VkA/EJVP49ZE2MQWlsO5vwXBNRwzRkRGqrWAdus6xJxhcWYbpZlJYvul2rFnk5VsFCPnH2q38+1Iq9+SVJQAAAAAAHOo4pwAB8QGAgEAAb9Xu3D4wDYsCAAAA\
    AAFZWg==";

/// A hundred blocks of a mebibyte of zeros by every compressor, with sizes that the blocks have: 100 MiB in 30 to 400 kB.
#[test]
fn compressed_zeros_are_not_followed() {
    let _alone = alone();
    for compressor in Compressor::ALL {
        let block = match compressor {
            Compressor::Lzma => STANDARD.decode(ZEROS_XZ).unwrap(),
            other => other.block(&vec![0; 1 << 20]),
        };
        let mut file = format!(
            "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"{}\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" \
             NumberOfCells=\"0\"><PointData><DataArray type=\"Float32\" Name=\"s\" format=\"appended\" offset=\"0\"/></PointData><Points>\
             <DataArray type=\"Float32\">0 0 0 0 0 0 0 0 0 0 0 0</DataArray></Points></Piece></UnstructuredGrid>\
             <AppendedData encoding=\"raw\">_",
            compressor.name()
        )
        .into_bytes();
        [100, 1 << 20, 0].iter().for_each(|word: &u64| file.extend(word.to_le_bytes()));
        (0..100).for_each(|_| file.extend((block.len() as u64).to_le_bytes()));
        (0..100).for_each(|_| file.extend(&block));
        assert!(file.len() < 1 << 20, "{}", file.len());
        read("zeros.vtu", &file, Refused(&["`s`", "16 numbers a byte", "limit", "without compression"]), 8 << 20);
    }
}

/// A block that holds more than it says, and one that says more than it can hold.
#[test]
fn blocks_that_lie_are_not_followed() {
    let _alone = alone();
    let packed = Compressor::Zlib.block(&vec![0; 64 << 20]);
    for (declared, words) in [(16_u64, "more than the 16 bytes"), (1 << 32, "limit"), (1 << 63, "limit")] {
        let mut file = b"<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid>\
            <Piece NumberOfPoints=\"4\" NumberOfCells=\"0\"><PointData><DataArray type=\"Float32\" Name=\"s\" format=\"appended\" offset=\"0\"/>\
            </PointData><Points><DataArray type=\"Float32\">0 0 0 0 0 0 0 0 0 0 0 0</DataArray></Points></Piece></UnstructuredGrid>\
            <AppendedData encoding=\"raw\">_".to_vec();
        [1, declared, 0, packed.len() as u64].iter().for_each(|word| file.extend(word.to_le_bytes()));
        file.extend(&packed);
        read("liar.vtu", &file, Refused(&["`s`", words]), 8 << 20);
    }
}

/// A million blocks of nothing: each costs as much as its place in the header.
#[test]
fn many_empty_blocks_cost_little() {
    let _alone = alone();
    let blocks = 100_000_u64;
    let mut file = b"<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid>\
        <Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" \
        offset=\"0\"/></Points></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_".to_vec();
    let empty = Compressor::Zlib.block(&[]);
    [blocks, 0, 0].iter().for_each(|word| file.extend(word.to_le_bytes()));
    (0..blocks).for_each(|_| file.extend((empty.len() as u64).to_le_bytes()));
    (0..blocks).for_each(|_| file.extend(&empty));
    let length = file.len();
    read("empty-blocks.vtu", &file, Read, 8 * length);
}

/// Thousands of arrays, or of pieces, at one offset: a file as large as the square of its own length.
#[test]
fn arrays_that_share_their_bytes_are_counted() {
    let _alone = alone();
    let numbers = 1 << 18;
    let mut writer = VtuWriter::new(Encoding::AppendedRaw, None);
    let first = writer.array("s", 1, &Values::U8(vec![1; numbers]));
    let piece = format!(
        "<Piece NumberOfPoints=\"{numbers}\" NumberOfCells=\"0\"><PointData>{}</PointData><Points>{}</Points></Piece>",
        first.repeat(5000),
        "<DataArray type=\"Float32\" format=\"appended\" offset=\"0\" NumberOfComponents=\"3\"/>"
    );
    // A third array has the points, behind the first.
    let points = writer.array("p", 3, &Values::F32(vec![0.0; 3 * numbers]));
    let offset = points.split("offset=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    let piece = piece
        .replace("offset=\"0\" NumberOfComponents=\"3\"", &format!("offset=\"{offset}\" NumberOfComponents=\"3\""));
    let file = writer.file(&piece);
    let most = 80 * file.len();
    read("shared.vtu", &file, Refused(&["`s`", "16 numbers a byte"]), most);
}

/// One long face that a thousand polyhedra name.
#[test]
fn faces_that_are_named_again_are_counted() {
    let _alone = alone();
    let long: String = "0 1 2 3 ".repeat(5000);
    let cells = format!(
        "<DataArray type=\"Int64\" Name=\"connectivity\"></DataArray><DataArray type=\"Int64\" Name=\"offsets\">{0}</DataArray>\
         <DataArray type=\"UInt8\" Name=\"types\">{1}</DataArray><DataArray type=\"Int64\" Name=\"face_connectivity\">{long}</DataArray>\
         <DataArray type=\"Int64\" Name=\"face_offsets\">20000</DataArray><DataArray type=\"Int64\" Name=\"polyhedron_to_faces\">{0}</DataArray>\
         <DataArray type=\"Int64\" Name=\"polyhedron_offsets\">{2}</DataArray>",
        "0 ".repeat(10_000),
        "42 ".repeat(10_000),
        (1..=10_000).map(|n| n.to_string()).collect::<Vec<_>>().join(" "),
    );
    let file = vtu(&format!(
        "<Piece NumberOfPoints=\"4\" NumberOfCells=\"10000\"><Points><DataArray type=\"Float32\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray>\
         </Points><Cells>{cells}</Cells></Piece>"
    ));
    let most = 64 * file.len();
    read("faces.vtu", &file, Refused(&["share each face", "cell 4"]), most);
}

/// A polyhedron of as many faces as are always decoded, none of which has a point: what costs most memory a number.
#[test]
fn faces_without_points_stay_within_the_limit() {
    let _alone = alone();
    let faces = 1_000_000;
    let mut writer = VtuWriter::new(Encoding::AppendedRaw, Some(Compressor::Zlib));
    writer.block = 1 << 20;
    let mut stream = vec![0; faces + 1];
    stream[0] = faces as i32;
    let cells = writer.array("connectivity", 1, &Values::I64(vec![0, 1, 2, 3]))
        + &writer.array("offsets", 1, &Values::I64(vec![4]))
        + &writer.array("types", 1, &Values::U8(vec![42]))
        + &writer.array("faces", 1, &Values::I32(stream))
        + &writer.array("faceoffsets", 1, &Values::I64(vec![faces as i64 + 1]));
    let points = writer.array("Points", 3, &Values::F32(vec![0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.]));
    let file = writer.file(&format!(
        "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points>{points}</Points><Cells>{cells}</Cells></Piece>"
    ));
    let most = most_allocated(Target::VtuCompressed, file.len());
    read("no-points.vtu", &file, Read, most);
}

/// Counts, sizes and offsets that no file can hold: nothing is reserved for them.
#[test]
fn declared_numbers_reserve_nothing() {
    let _alone = alone();
    for number in ["-1", "4294967295", "4294967296", "9223372036854775807", "18446744073709551615", "1e400", "nan", ""]
    {
        let piece = text_piece("<PointData><DataArray type=\"Float32\" Name=\"s\">1 2 3 4</DataArray></PointData>");
        for (what, with) in [
            ("NumberOfPoints=\"4\"", format!("NumberOfPoints=\"{number}\"")),
            ("NumberOfCells=\"1\"", format!("NumberOfCells=\"{number}\"")),
            ("NumberOfComponents=\"3\"", format!("NumberOfComponents=\"{number}\"")),
            ("Name=\"s\"", format!("Name=\"s\" NumberOfComponents=\"{number}\"")),
            ("Name=\"s\"", format!("Name=\"s\" format=\"appended\" offset=\"{number}\"")),
            (">4<", format!(">{number}<")),
            (">10<", format!(">{number}<")),
            ("0 1 2 3<", format!("0 1 2 {number}<")),
        ] {
            read("declared.vtu", &vtu(&piece.replace(what, &with)), Refused(&["declared.vtu: "]), 1 << 20);
        }
        let legacy = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS P float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS C S\n\
            4 0 1 2 3\nCELL_TYPES T\n10\nPOINT_DATA D\nSCALARS s float N\nLOOKUP_TABLE default\n1 2 3 4\n";
        let sound = [("P", "4"), ("C", "1"), ("S", "5"), ("T", "1"), ("D", "4"), ("N", "1")];
        for (letter, _) in sound {
            // Nothing, as a number of components, is a default.
            if letter == "N" && number.is_empty() {
                continue;
            }
            let text = sound.iter().fold(legacy.to_owned(), |text, (other, good)| {
                let value = if *other == letter { number } else { good };
                text.replace(&format!(" {other} "), &format!(" {value} "))
                    .replace(&format!(" {other}\n"), &format!(" {value}\n"))
            });
            read("declared.vtk", text.as_bytes(), Refused(&[]), 1 << 20);
            let binary = text.replace("ASCII", "BINARY");
            read("binary.vtk", binary.as_bytes(), Refused(&[]), 1 << 20);
        }
        let grid = format!("{number} 2 2\n{}", "0.5 ".repeat(24));
        read("declared.xyz", grid.as_bytes(), Refused(&[]), 1 << 20);
    }
    for [a, b, c] in [[-1, 2, 2], [i32::MAX; 3], [i32::MIN; 3], [0, 2, 2], [1 << 16; 3], [1 << 30, 2, 2]] {
        for big in [false, true] {
            let mut grid: Vec<u8> =
                [a, b, c].iter().flat_map(|n| if big { n.to_be_bytes() } else { n.to_le_bytes() }).collect();
            grid.extend([0; 96]);
            read("binary.xyz", &grid, Refused(&["header and size"]), 1 << 20);
        }
    }
    read("repeated.xyz", b"2 2 2\n4000000000*1.0\n", Refused(&["line 2", "more often"]), 32 << 20);
}

/// What XML can do to a reader that trusts it.
#[test]
fn xml_is_not_trusted() {
    let _alone = alone();
    let sound = String::from_utf8(vtu(&text_piece(""))).unwrap();
    let lol = (1..20).fold(String::from("<!ENTITY a0 \"1 1 1 1 1 1 1 1\">"), |text, n| {
        text + &format!("<!ENTITY a{n} \"{}\">", format!("&a{};", n - 1).repeat(10))
    });
    let bomb = format!("<!DOCTYPE VTKFile [{lol}]>{}", sound.replace("0 1 2 3<", "&a19;<"));
    read("entities.vtu", bomb.as_bytes(), Refused(&["&a19;", "not expanded"]), 1 << 20);
    let outside = sound.replace("<VTKFile", "<!DOCTYPE VTKFile [<!ENTITY x SYSTEM \"file:///etc/passwd\">]><VTKFile");
    read("outside.vtu", outside.replace("0 1 2 3<", "&x;<").as_bytes(), Refused(&["&x;"]), 1 << 20);
    let deep = format!("<VTKFile type=\"UnstructuredGrid\">{}", "<a>".repeat(1_000_000));
    read("deep.vtu", deep.as_bytes(), Refused(&["ends inside"]), 64 << 20);
    let wide = sound.replacen("<Piece ", &format!("<Piece {}", "a=\"1\" ".repeat(500_000)), 1);
    read("attributes.vtu", wide.as_bytes(), Read, 64 << 20);
    let comments = sound.replace("0 1 2 3<", &format!("0 {} 1 2 3<", "<!-- 9 -->".repeat(200_000)));
    read("comments.vtu", comments.as_bytes(), Read, 64 << 20);
}

/// Pictures that declare more than they hold.
#[test]
fn pictures_of_nothing_are_refused() {
    let _alone = alone();
    let chunk = |name: &[u8; 4], body: &[u8]| (name.to_vec(), body.to_vec());
    let header = |width: u32, height: u32| {
        chunk(b"IHDR", &[&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 2, 0, 0, 0]].concat())
    };
    let data = chunk(b"IDAT", &Compressor::Zlib.block(&[0; 100]));
    let end = chunk(b"IEND", &[]);
    for (width, height) in [(u32::MAX, u32::MAX), (1 << 30, 1), (65_535, 65_535), (0, 1), (0x8000_0000, 2)] {
        let file = png_chunks(&[header(width, height), data.clone(), end.clone()]);
        read("huge.png", &file, Refused(&["PNG"]), 1 << 20);
    }
    // The decoder panics on these.
    for length in [1, 4, 767, 771, 2000] {
        let indexed = chunk(b"IHDR", &[0, 0, 0, 1, 0, 0, 0, 1, 8, 3, 0, 0, 0]);
        let line = chunk(b"IDAT", &Compressor::Zlib.block(&[0, 0]));
        let file = png_chunks(&[indexed, chunk(b"PLTE", &vec![9; length]), line, end.clone()]);
        read("palette.png", &file, Refused(&["palette"]), 1 << 20);
    }
    // As many pixels as are always read, of which there is no line.
    let file = png_chunks(&[header(2048, 2048), data.clone(), end.clone()]);
    read("empty.png", &file, Refused(&["PNG"]), 32 << 20);
    // A text and a profile of 500 MB each.
    let zeros = {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
        (0..500).for_each(|_| encoder.write_all(&vec![0; 1 << 20]).unwrap());
        encoder.finish().unwrap()
    };
    let line = chunk(b"IDAT", &Compressor::Zlib.block(&[0, 9, 9, 9]));
    for name in [b"zTXt", b"iCCP"] {
        let body = [b"name\0\0", &zeros[..]].concat();
        let file = png_chunks(&[header(1, 1), chunk(name, &body), line.clone(), end.clone()]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text.png");
        std::fs::write(&path, &file).unwrap();
        let (allocated, result) = counted(|| read_png(&path));
        println!("{name:?}: {} bytes, {allocated} allocated, {:?}", file.len(), result.as_ref().err());
        assert!(allocated < 160 << 20, "{allocated}");
    }
}

/// OpenEXR's headers that declare more than follows: pixels, and channels of them.
#[test]
fn exr_headers_reserve_nothing() {
    let _alone = alone();
    let file = |width: i32, height: i32, channels: usize| {
        let names: Vec<String> = (0..channels).map(|n| format!("c{n:05}")).collect();
        [exr_header([width, height], &names, 3), vec![0; 64]].concat()
    };
    for (width, height) in [(i32::MAX, i32::MAX), (1 << 20, 1 << 10), (i32::MIN, 4), (0, 0), (1 << 26, 1)] {
        read("huge.exr", &file(width, height, 4), Refused(&["OpenEXR"]), 4 << 20);
    }
    // One line of 4 million pixels, of 20000 channels: 320 GB a block.
    read("channels.exr", &file(1 << 22, 1, 20_000), Refused(&["20000 channels"]), 64 << 20);
}

/// Every reader on nothing, and on the beginnings of every other format.
#[test]
fn every_reader_stands_every_beginning() {
    let _alone = alone();
    let beginnings: [&[u8]; 8] = [
        b"",
        b"\0",
        b"<VTKFile",
        b"# vtk DataFile",
        b"# vtk DataFile Version 3.0\n\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 18446744073709551615 double\n",
        b"\x89PNG\r\n\x1a\n",
        b"\x76\x2f\x31\x01",
        b"2 2 2\n",
    ];
    for bytes in beginnings {
        let (allocated, ()) = counted(|| {
            for reader in readers() {
                let source =
                    tetrascope::io::Source { path: "beginning".into(), bytes: bytes.to_vec(), ..Default::default() };
                let error = reader.read(&source).unwrap_err().to_string();
                assert!(error.contains("beginning"), "{}: {error}", reader.name());
            }
        });
        assert!(allocated < 1 << 18, "{allocated}");
    }
}
