//! VTK's XML files in every encoding.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fastrand::Rng;

use super::super::Target;

/// How the numbers of arrays stand in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// As words.
    Text,
    /// As base64 inside the elements.
    Base64,
    /// As base64 behind the elements.
    AppendedBase64,
    /// As bytes behind the elements.
    AppendedRaw,
}

/// What makes bytes fewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compressor {
    /// `vtkZLibDataCompressor`
    Zlib,
    /// `vtkLZ4DataCompressor`
    Lz4,
    /// `vtkLZMADataCompressor`
    Lzma,
}

impl Compressor {
    /// Every one.
    pub const ALL: [Self; 3] = [Self::Zlib, Self::Lz4, Self::Lzma];

    /// The name in a file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Zlib => "vtkZLibDataCompressor",
            Self::Lz4 => "vtkLZ4DataCompressor",
            Self::Lzma => "vtkLZMADataCompressor",
        }
    }

    /// One block.
    ///
    /// # Panics
    /// Never: memory takes all bytes.
    pub fn block(self, bytes: &[u8]) -> Vec<u8> {
        match self {
            Self::Zlib => {
                let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
                encoder.write_all(bytes).expect("memory takes bytes");
                encoder.finish().expect("memory takes bytes")
            }
            Self::Lz4 => lz4_flex::block::compress(bytes),
            Self::Lzma => {
                let mut packed = Vec::new();
                lzma_rs::xz_compress(&mut &bytes[..], &mut packed).expect("memory takes bytes");
                packed
            }
        }
    }
}

/// Numbers of one type.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names are the definitions")]
pub enum Values {
    F32(Vec<f32>),
    F64(Vec<f64>),
    I8(Vec<i8>),
    U8(Vec<u8>),
    I32(Vec<i32>),
    I64(Vec<i64>),
}

impl Values {
    fn type_name(&self) -> &'static str {
        match self {
            Self::F32(_) => "Float32",
            Self::F64(_) => "Float64",
            Self::I8(_) => "Int8",
            Self::U8(_) => "UInt8",
            Self::I32(_) => "Int32",
            Self::I64(_) => "Int64",
        }
    }

    fn words(&self) -> String {
        macro_rules! words {
            ($($kind:ident),*) => {
                match self {
                    $(Self::$kind(v) => v.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "),)*
                }
            };
        }
        words!(F32, F64, I8, U8, I32, I64)
    }

    fn bytes(&self, big: bool) -> Vec<u8> {
        macro_rules! bytes {
            ($($kind:ident),*) => {
                match self {
                    $(Self::$kind(v) => v.iter().flat_map(|x| if big { x.to_be_bytes() } else { x.to_le_bytes() }).collect(),)*
                }
            };
        }
        bytes!(F32, F64, I8, U8, I32, I64)
    }
}

/// Writes arrays into a file.
#[derive(Clone, Debug)]
pub struct VtuWriter {
    /// Of all arrays.
    pub encoding: Encoding,
    /// Of all arrays that are no text.
    pub compressor: Option<Compressor>,
    /// Whether the highest byte is first.
    pub big: bool,
    /// Whether header words have 64 bits.
    pub wide: bool,
    /// Bytes of a compressed block.
    pub block: usize,
    appended: Vec<u8>,
}

impl VtuWriter {
    /// A writer of little-endian files with header words of 64 bits.
    pub fn new(encoding: Encoding, compressor: Option<Compressor>) -> Self {
        Self { encoding, compressor, big: false, wide: true, block: 64, appended: Vec::new() }
    }

    fn word(&self, value: usize) -> Vec<u8> {
        match (self.wide, self.big) {
            (true, false) => (value as u64).to_le_bytes().to_vec(),
            (true, true) => (value as u64).to_be_bytes().to_vec(),
            (false, false) => (value as u32).to_le_bytes().to_vec(),
            (false, true) => (value as u32).to_be_bytes().to_vec(),
        }
    }

    /// Bytes with the words before them.
    pub fn packed(&self, data: &[u8]) -> (Vec<u8>, Vec<u8>) {
        let Some(compressor) = self.compressor else { return (self.word(data.len()), data.to_vec()) };
        let blocks: Vec<Vec<u8>> = data.chunks(self.block).map(|chunk| compressor.block(chunk)).collect();
        let mut header = [blocks.len(), self.block, data.len() % self.block].map(|n| self.word(n)).concat();
        header.extend(blocks.iter().flat_map(|block| self.word(block.len())));
        (header, blocks.concat())
    }

    /// One `DataArray` element.
    pub fn array(&mut self, name: &str, components: usize, values: &Values) -> String {
        let start =
            format!("<DataArray type=\"{}\" Name=\"{name}\" NumberOfComponents=\"{components}\"", values.type_name());
        if self.encoding == Encoding::Text {
            return format!("{start} format=\"ascii\">\n{}\n</DataArray>\n", values.words());
        }
        let (header, body) = self.packed(&values.bytes(self.big));
        let text = || {
            if self.compressor.is_some() {
                STANDARD.encode(&header) + &STANDARD.encode(&body)
            } else {
                STANDARD.encode([&header[..], &body].concat())
            }
        };
        if self.encoding == Encoding::Base64 {
            return format!("{start} format=\"binary\">\n{}\n</DataArray>\n", text());
        }
        let more = if self.encoding == Encoding::AppendedRaw { [header, body].concat() } else { text().into_bytes() };
        let offset = self.appended.len();
        self.appended.extend(more);
        format!("{start} format=\"appended\" offset=\"{offset}\"/>\n")
    }

    /// The file of an unstructured grid around pieces.
    pub fn file(self, pieces: &str) -> Vec<u8> {
        self.file_of("UnstructuredGrid", "", pieces)
    }

    /// The file of another kind of grid, whose element has these attributes.
    pub fn file_of(self, kind: &str, attributes: &str, pieces: &str) -> Vec<u8> {
        let mut file = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{}>\n\
             <{kind} {attributes}>\n{pieces}</{kind}>\n",
            if self.big { "BigEndian" } else { "LittleEndian" },
            if self.wide { "UInt64" } else { "UInt32" },
            self.compressor.map_or_else(String::new, |c| format!(" compressor=\"{}\"", c.name())),
        )
        .into_bytes();
        if matches!(self.encoding, Encoding::AppendedRaw | Encoding::AppendedBase64) {
            let name = if self.encoding == Encoding::AppendedRaw { "raw" } else { "base64" };
            file.extend(format!("<AppendedData encoding=\"{name}\">\n_").bytes());
            file.extend(self.appended);
            file.extend(b"\n</AppendedData>\n");
        }
        file.extend(b"</VTKFile>\n");
        file
    }
}

/// A piece with a hexahedron, a pyramid, a tetrahedron and a polyhedron, two point arrays and a cell array.
pub(super) fn piece(w: &mut VtuWriter, rng: &mut Rng) -> String {
    let points =
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [0, 0, 2], [2, 2, 2]];
    let flat: Vec<f64> = points.iter().flatten().map(|&x| f64::from(x) + 0.01 * rng.f64()).collect();
    let coordinates =
        if rng.bool() { Values::F32(flat.iter().map(|&x| x as f32).collect()) } else { Values::F64(flat) };
    let connectivity = vec![0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8, 6, 5, 9, 8, 5, 6, 8, 9];
    let connectivity = match rng.u8(..3) {
        0 => Values::I8(connectivity),
        1 => Values::I32(connectivity.iter().map(|&x| x.into()).collect()),
        _ => Values::I64(connectivity.iter().map(|&x| x.into()).collect()),
    };
    let s = w.array("s", 1, &Values::F32((0..10).map(|_| rng.f32()).collect()));
    let v = w.array("v &lt;&#956;", 3, &Values::F64((0..30).map(|_| rng.f64()).collect()));
    let c = w.array("c", 1, &Values::U8(vec![1, 2, 3, 4]));
    let p = w.array("Points", 3, &coordinates);
    let mut cells = w.array("connectivity", 1, &connectivity)
        + &w.array("offsets", 1, &Values::I64(vec![8, 13, 17, 21]))
        + &w.array("types", 1, &Values::U8(vec![12, 14, 10, 42]));
    let faces = [[5, 6, 8], [5, 6, 9], [6, 8, 9], [5, 8, 9]];
    if rng.bool() {
        let stream = faces.iter().fold(vec![4], |stream, face| [&stream[..], &[3], face].concat());
        cells += &w.array("faces", 1, &Values::I64(stream));
        cells += &w.array("faceoffsets", 1, &Values::I64(vec![-1, -1, -1, 17]));
    } else {
        cells += &w.array("face_connectivity", 1, &Values::I64(faces.concat()));
        cells += &w.array("face_offsets", 1, &Values::I64(vec![3, 6, 9, 12]));
        cells += &w.array("polyhedron_to_faces", 1, &Values::I64(vec![0, 1, 2, 3]));
        cells += &w.array("polyhedron_offsets", 1, &Values::I64(vec![0, 0, 0, 4]));
    }
    format!(
        "<Piece NumberOfPoints=\"10\" NumberOfCells=\"4\">\n<PointData Scalars=\"s\">\n{s}{v}</PointData>\n<CellData>\n{c}</CellData>\n\
         <Points>\n{p}</Points>\n<Cells>\n{cells}</Cells>\n</Piece>\n"
    )
}

pub(super) fn file(target: Target, rng: &mut Rng) -> Vec<u8> {
    let pick = |rng: &mut Rng, all: &[Encoding]| all[rng.usize(..all.len())];
    let (encoding, compressor) = match target {
        Target::VtuText => (Encoding::Text, None),
        Target::VtuRaw => (Encoding::AppendedRaw, None),
        Target::VtuCompressed => (pick(rng, &BINARY), Some(Compressor::ALL[rng.usize(..3)])),
        _ => (pick(rng, &BINARY[..2]), None),
    };
    let mut writer = writer_of(encoding, compressor, rng);
    let pieces: String = (0..rng.usize(1..3)).map(|_| piece(&mut writer, rng)).collect();
    writer.file(&pieces)
}

const BINARY: [Encoding; 3] = [Encoding::Base64, Encoding::AppendedBase64, Encoding::AppendedRaw];

fn writer_of(encoding: Encoding, compressor: Option<Compressor>, rng: &mut Rng) -> VtuWriter {
    let mut writer = VtuWriter::new(encoding, compressor);
    (writer.big, writer.wide, writer.block) = (rng.bool(), rng.bool(), [16, 64, 32768][rng.usize(..3)]);
    writer
}

/// A writer of any encoding.
pub(super) fn writer(rng: &mut Rng) -> VtuWriter {
    match rng.usize(..6) {
        at @ 0..3 => writer_of(BINARY[at], rng.bool().then(|| Compressor::ALL[rng.usize(..3)]), rng),
        _ => writer_of(Encoding::Text, None, rng),
    }
}
