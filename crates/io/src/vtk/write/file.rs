//! The file itself: elements of XML, and behind them the bytes.
//!
//! Where an array begins is known only when those before it are written, as they may be compressed. The elements leave room for that number,
//! and are written once more at the end.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};

use flate2::{Compression, write::ZlibEncoder};
use tetrascope_mesh::ArrayValues;

use super::VtuEncoding;
use super::numbers::{Numbers, for_parts, write_text};

/// Bytes that are compressed together: more than this packs no better, and readers take any number.
const BLOCK: usize = 1 << 20;
/// What raw bytes go out in.
const PART: usize = 1 << 16;
/// Digits of the largest offset.
const DIGITS: usize = 20;
/// Where the bytes begin.
const APPENDED: &str = "<AppendedData encoding=\"raw\">\n_";
/// What stands behind them.
const APPENDED_END: &str = "\n</AppendedData>\n";

/// A file to be written.
pub(super) struct Grid<'a> {
    pub(super) points: usize,
    pub(super) cells: usize,
    pub(super) time: Option<f64>,
    pub(super) sections: [Section<'a>; 4],
}

/// Arrays of one purpose.
pub(super) struct Section<'a> {
    pub(super) tag: &'static str,
    pub(super) elements: Vec<Element<'a>>,
}

/// An array under its name.
pub(super) struct Element<'a> {
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) numbers: Numbers<'a>,
}

impl Element<'_> {
    /// All of the tag but its end.
    fn tag(&self) -> String {
        format!(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"",
            self.numbers.type_name,
            quick_xml::escape::escape(&self.name),
            self.components
        )
    }
}

impl Grid<'_> {
    /// Writes it; gives its length, and how many numbers all arrays have.
    pub(super) fn write(&self, file: &mut File, encoding: VtuEncoding) -> io::Result<[u64; 2]> {
        let mut out = BufWriter::with_capacity(PART, file);
        let numbers = match encoding {
            VtuEncoding::Text => self.write_as_text(&mut out)?,
            VtuEncoding::Raw | VtuEncoding::Zlib => self.write_appended(&mut out, encoding == VtuEncoding::Zlib)?,
        };
        out.write_all(b"</VTKFile>\n")?;
        out.flush()?;
        Ok([out.stream_position()?, numbers])
    }

    /// All before the first section.
    fn head(&self, is_compressed: bool) -> String {
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        let compressor = if is_compressed { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
        let mut text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{order}\" \
             header_type=\"UInt64\"{compressor}>\n<UnstructuredGrid>\n"
        );
        if let Some(time) = self.time.filter(|time| time.is_finite()) {
            // Writing into a string cannot fail.
            let _ = writeln!(
                text,
                "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">\n{time:?}\n\
                 </DataArray>\n</FieldData>"
            );
        }
        let _ = writeln!(text, "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", self.points, self.cells);
        text
    }

    fn write_as_text(&self, out: &mut impl Write) -> io::Result<u64> {
        let mut numbers = 0;
        out.write_all(self.head(false).as_bytes())?;
        for section in &self.sections {
            writeln!(out, "<{}>", section.tag)?;
            for element in &section.elements {
                writeln!(out, "{} format=\"ascii\">", element.tag())?;
                let values = element.numbers.values();
                numbers += values.len() as u64;
                write_text(&values, out)?;
                writeln!(out, "\n</DataArray>")?;
            }
            writeln!(out, "</{}>", section.tag)?;
        }
        out.write_all(b"</Piece>\n</UnstructuredGrid>\n")?;
        Ok(numbers)
    }

    /// Everything before the bytes, as long whatever the offsets are.
    fn elements(&self, is_compressed: bool, offsets: &[u64]) -> String {
        let mut text = self.head(is_compressed);
        let mut offsets = offsets.iter();
        for section in &self.sections {
            let _ = writeln!(text, "<{}>", section.tag);
            for element in &section.elements {
                let offset = offsets.next().copied().unwrap_or_default().to_string();
                let room = DIGITS.saturating_sub(offset.len());
                let _ = writeln!(text, "{} format=\"appended\" offset=\"{offset}\"{:room$}/>", element.tag(), "");
            }
            let _ = writeln!(text, "</{}>", section.tag);
        }
        text.push_str("</Piece>\n</UnstructuredGrid>\n");
        text.push_str(APPENDED);
        text
    }

    fn write_appended(&self, out: &mut (impl Write + Seek), is_compressed: bool) -> io::Result<u64> {
        let mut numbers = 0;
        let mut offsets = Vec::new();
        out.write_all(self.elements(is_compressed, &offsets).as_bytes())?;
        let mut at = 0;
        for element in self.sections.iter().flat_map(|section| &section.elements) {
            offsets.push(at);
            let values = element.numbers.values();
            numbers += values.len() as u64;
            at += if is_compressed { write_compressed(&values, out)? } else { write_raw(&values, out)? };
        }
        out.write_all(APPENDED_END.as_bytes())?;
        let end = out.stream_position()?;
        out.rewind()?;
        out.write_all(self.elements(is_compressed, &offsets).as_bytes())?;
        out.seek(SeekFrom::Start(end))?;
        Ok(numbers)
    }
}

/// The number of bytes and the bytes; gives how many were written.
fn write_raw(values: &ArrayValues, out: &mut impl Write) -> io::Result<u64> {
    let length = (values.len() * super::numbers::size(values)) as u64;
    out.write_all(&length.to_ne_bytes())?;
    for_parts(values, PART, |bytes| out.write_all(bytes))?;
    Ok(8 + length)
}

/// The number of blocks, the length of each and of the last one if that is shorter, the lengths of all when compressed, and the blocks; gives
/// how many bytes were written.
fn write_compressed(values: &ArrayValues, out: &mut impl Write) -> io::Result<u64> {
    let mut packed = Vec::new();
    let mut ends = Vec::new();
    for_parts(values, BLOCK, |bytes| {
        let mut encoder = ZlibEncoder::new(&mut packed, Compression::default());
        encoder.write_all(bytes)?;
        encoder.finish()?;
        ends.push(packed.len() as u64);
        Ok(())
    })?;
    let length = values.len() * super::numbers::size(values);
    let mut header = vec![ends.len() as u64, BLOCK as u64, (length % BLOCK) as u64];
    header.extend(std::iter::once(&0).chain(&ends).zip(&ends).map(|(start, end)| end - start));
    for number in &header {
        out.write_all(&number.to_ne_bytes())?;
    }
    out.write_all(&packed)?;
    Ok((8 * header.len() + packed.len()) as u64)
}
