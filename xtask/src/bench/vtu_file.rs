//! Large files for the measurement of reading: tetrahedra of a jittered grid as VTK writes them, piece by piece.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use crate::Failure;

/// How the numbers stand in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Encoding {
    /// Appended bytes.
    Raw,
    /// Appended blocks, compressed by zlib.
    Zlib,
    /// Appended blocks, compressed by LZ4.
    Lz4,
    /// Base64 inside the elements.
    Base64,
    /// Text.
    Ascii,
}

/// The widths of numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Widths {
    /// Int32 in place of Int64 for indices.
    pub(super) narrow_indices: bool,
    /// Float64 in place of Float32 for points and fields.
    pub(super) wide_floats: bool,
}

/// Bytes that VTK compresses together.
const BLOCK: usize = 1 << 15;

/// Bytes that are encoded together where nothing is compressed: whole numbers, and whole groups of base64.
const PIECE: usize = 3 << 15;

/// Characters of an offset, which is known only when what stands before is compressed.
const OFFSET_WIDTH: usize = 20;

/// The six tetrahedra of a cube by its diagonal, as corners whose bits are x, y and z.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// A grid of cubes.
struct Grid {
    cubes: usize,
    widths: Widths,
}

/// One array: the name of its type, numbers a tuple, how many numbers, and these as bytes or words.
struct Array {
    section: &'static str,
    name: &'static str,
    kind: Kind,
    components: usize,
    count: usize,
}

#[derive(Clone, Copy)]
enum Kind {
    Index(fn(&Grid, usize) -> usize),
    Byte(u8),
    Float(fn(&Grid, usize) -> f64),
}

impl Grid {
    fn side(&self) -> usize {
        self.cubes + 1
    }

    /// A number between 0 and 1 that looks random.
    fn noise(at: usize) -> f64 {
        let mut x = (at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (x >> 40) as f64 / (1_u64 << 24) as f64
    }

    fn coordinate(&self, at: usize) -> f64 {
        let (point, axis) = (at / 3, at % 3);
        let index = point / self.side().pow(axis as u32) % self.side();
        index as f64 + 0.3 * Self::noise(at)
    }

    fn temperature(&self, point: usize) -> f64 {
        let wave = |axis: usize| (self.coordinate(3 * point + axis) * 0.1).sin();
        300.0 + 50.0 * wave(0) * wave(1) + 20.0 * wave(2)
    }

    fn quality(&self, cell: usize) -> f64 {
        0.5 + 0.5 * Self::noise(cell)
    }

    fn corner(&self, at: usize) -> usize {
        let (cell, corner) = (at / 4, at % 4);
        let (cube, side) = (cell / 6, self.side());
        let bits = TETRAHEDRA[cell % 6][corner];
        let (i, j, k) = (cube % self.cubes, cube / self.cubes % self.cubes, cube / self.cubes / self.cubes);
        i + (bits & 1) + (j + (bits >> 1 & 1)) * side + (k + (bits >> 2)) * side * side
    }

    fn arrays(&self) -> [Array; 6] {
        let (points, cells) = (self.side().pow(3), 6 * self.cubes.pow(3));
        let array = |section, name, kind, components, count| Array { section, name, kind, components, count };
        [
            array("PointData", "temperature", Kind::Float(Self::temperature), 1, points),
            array("CellData", "quality", Kind::Float(Self::quality), 1, cells),
            array("Points", "Points", Kind::Float(Self::coordinate), 3, 3 * points),
            array("Cells", "connectivity", Kind::Index(Self::corner), 1, 4 * cells),
            array("Cells", "offsets", Kind::Index(|_, cell| 4 * (cell + 1)), 1, cells),
            array("Cells", "types", Kind::Byte(10), 1, cells),
        ]
    }

    /// The type of an array's numbers and their size.
    fn scalar(&self, array: &Array) -> (&'static str, usize) {
        match array.kind {
            Kind::Index(_) if self.widths.narrow_indices => ("Int32", 4),
            Kind::Index(_) => ("Int64", 8),
            Kind::Byte(_) => ("UInt8", 1),
            Kind::Float(_) if self.widths.wide_floats => ("Float64", 8),
            Kind::Float(_) => ("Float32", 4),
        }
    }

    fn bytes(&self, array: &Array, numbers: Range<usize>) -> Vec<u8> {
        let size = self.scalar(array).1;
        let mut bytes = Vec::with_capacity(numbers.len() * size);
        for at in numbers {
            match (array.kind, size) {
                (Kind::Byte(byte), _) => bytes.push(byte),
                (Kind::Index(index), _) => bytes.extend_from_slice(&(index(self, at) as u64).to_le_bytes()[..size]),
                (Kind::Float(value), 4) => bytes.extend_from_slice(&(value(self, at) as f32).to_le_bytes()),
                (Kind::Float(value), _) => bytes.extend_from_slice(&value(self, at).to_le_bytes()),
            }
        }
        bytes
    }

    fn words(&self, array: &Array, numbers: Range<usize>) -> Vec<u8> {
        let word = |at: usize| match array.kind {
            Kind::Byte(byte) => format!("{byte} "),
            Kind::Index(index) => format!("{} ", index(self, at)),
            Kind::Float(value) if self.widths.wide_floats => format!("{} ", value(self, at)),
            Kind::Float(value) => format!("{} ", value(self, at) as f32),
        };
        numbers.map(word).collect::<String>().into_bytes()
    }
}

/// Writes a file of about so many bytes; gives the number of its tetrahedra.
pub(super) fn write(path: &Path, encoding: Encoding, bytes: f64, widths: Widths) -> Result<usize, Failure> {
    // What a cube takes is found with a small file of the same kind.
    let per_cube = Grid { cubes: 24, widths }.write(path, encoding)? as f64 / 24_f64.powi(3);
    let grid = Grid { cubes: (bytes / per_cube).cbrt().round().max(2.0) as usize, widths };
    grid.write(path, encoding)?;
    Ok(6 * grid.cubes.pow(3))
}

impl Grid {
    fn write(&self, path: &Path, encoding: Encoding) -> Result<u64, Failure> {
        let mut file = BufWriter::with_capacity(1 << 20, File::create(path)?);
        let compressor = match encoding {
            Encoding::Zlib => " compressor=\"vtkZLibDataCompressor\"",
            Encoding::Lz4 => " compressor=\"vtkLZ4DataCompressor\"",
            _ => "",
        };
        let arrays = self.arrays();
        write!(
            file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\"{compressor}>\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
            self.side().pow(3),
            6 * self.cubes.pow(3)
        )?;
        let mut offsets_at = Vec::new();
        for section in ["PointData", "CellData", "Points", "Cells"] {
            writeln!(file, "<{section}>")?;
            for array in arrays.iter().filter(|array| array.section == section) {
                write!(
                    file,
                    "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" ",
                    self.scalar(array).0,
                    array.name,
                    array.components
                )?;
                match encoding {
                    Encoding::Ascii | Encoding::Base64 => {
                        let format = if encoding == Encoding::Ascii { "ascii" } else { "binary" };
                        writeln!(file, "format=\"{format}\">")?;
                        self.write_inline(&mut file, array, encoding)?;
                        writeln!(file, "\n</DataArray>")?;
                    }
                    _ => {
                        write!(file, "format=\"appended\" offset=\"")?;
                        offsets_at.push(file.stream_position()?);
                        writeln!(file, "{:OFFSET_WIDTH$}\"/>", "")?;
                    }
                }
            }
            writeln!(file, "</{section}>")?;
        }
        write!(file, "</Piece>\n</UnstructuredGrid>\n")?;
        if !offsets_at.is_empty() {
            write!(file, "<AppendedData encoding=\"raw\">\n_")?;
            let start = file.stream_position()?;
            // The elements stand in the order of the arrays.
            for (array, at) in arrays.iter().zip(offsets_at) {
                let offset = file.stream_position()? - start;
                file.seek(SeekFrom::Start(at))?;
                write!(file, "{offset:OFFSET_WIDTH$}")?;
                file.seek(SeekFrom::End(0))?;
                self.write_appended(&mut file, array, encoding)?;
            }
            write!(file, "\n</AppendedData>\n")?;
        }
        writeln!(file, "</VTKFile>")?;
        let length = file.stream_position()?;
        file.flush()?;
        Ok(length)
    }

    fn write_inline(&self, file: &mut impl Write, array: &Array, encoding: Encoding) -> Result<(), Failure> {
        let size = self.scalar(array).1;
        let mut first = 0;
        if encoding == Encoding::Base64 {
            // The size is encoded together with the numbers; with so many of them the groups of three bytes are whole.
            first = (16 / size).min(array.count);
            let mut bytes = ((array.count * size) as u64).to_le_bytes().to_vec();
            bytes.extend(self.bytes(array, 0..first));
            file.write_all(STANDARD.encode(bytes).as_bytes())?;
        }
        self.each_piece(array, first, PIECE, file, |numbers| match encoding {
            Encoding::Base64 => Ok(STANDARD.encode(self.bytes(array, numbers)).into_bytes()),
            _ => Ok(self.words(array, numbers)),
        })?;
        Ok(())
    }

    fn write_appended(&self, file: &mut (impl Write + Seek), array: &Array, encoding: Encoding) -> Result<(), Failure> {
        let total = array.count * self.scalar(array).1;
        if encoding == Encoding::Raw {
            file.write_all(&(total as u64).to_le_bytes())?;
            self.each_piece(array, 0, PIECE, file, |numbers| Ok(self.bytes(array, numbers)))?;
            return Ok(());
        }
        let blocks = total.div_ceil(BLOCK);
        let start = file.stream_position()?;
        file.write_all(&vec![0; 8 * (blocks + 3)])?;
        let lengths = self.each_piece(array, 0, BLOCK, file, |numbers| {
            let bytes = self.bytes(array, numbers);
            if encoding == Encoding::Lz4 { Ok(lz4_flex::block::compress(&bytes)) } else { deflated(&bytes) }
        })?;
        file.seek(SeekFrom::Start(start))?;
        for word in [blocks, BLOCK, total % BLOCK].into_iter().chain(lengths) {
            file.write_all(&(word as u64).to_le_bytes())?;
        }
        file.seek(SeekFrom::End(0))?;
        Ok(())
    }

    /// Writes an array from a number on in pieces, each encoded by itself, and gives their lengths.
    fn each_piece(
        &self,
        array: &Array,
        first: usize,
        piece: usize,
        file: &mut impl Write,
        encode: impl Fn(Range<usize>) -> io::Result<Vec<u8>> + Sync,
    ) -> Result<Vec<usize>, Failure> {
        let step = piece / self.scalar(array).1;
        let starts: Vec<usize> = (first..array.count).step_by(step).collect();
        let mut lengths = Vec::new();
        for some in starts.chunks(256) {
            let encoded: io::Result<Vec<Vec<u8>>> =
                some.par_iter().map(|&start| encode(start..(start + step).min(array.count))).collect();
            for bytes in encoded? {
                file.write_all(&bytes)?;
                lengths.push(bytes.len());
            }
        }
        Ok(lengths)
    }
}

/// At the level that VTK takes if nobody says one.
fn deflated(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(5));
    encoder.write_all(bytes)?;
    encoder.finish()
}
