//! Files of several batches, in every encoding, in memory and not; who watches and stops their reading.

use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use tetrascope_mesh::{CellKind, Dataset};

use super::super::test_support::{cells, sanity_check};
use crate::{IoError, Loaded, ReadOptions, ReadProgress, ReadStage, read_mesh};

const POINTS: usize = 60_000;
const CELLS: usize = 90_000;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Raw,
    /// Blocks of so many bytes.
    Zlib(usize),
    AppendedBase64,
    InlineBase64,
    InlineBase64Apart,
    Ascii,
}

struct Writer {
    encoding: Encoding,
    wide_header: bool,
    appended: Vec<u8>,
}

impl Writer {
    fn word(&self, value: usize) -> Vec<u8> {
        let word = (value as u64).to_le_bytes();
        word[..if self.wide_header { 8 } else { 4 }].to_vec()
    }

    fn array<T: ToString + Copy>(&mut self, kind: &str, name: &str, values: &[T], bytes: fn(T) -> Vec<u8>) -> String {
        let components = if name == "Points" { 3 } else { 1 };
        let start = format!("<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"");
        let data: Vec<u8> = values.iter().flat_map(|&value| bytes(value)).collect();
        let header = self.word(data.len());
        let offset = self.appended.len();
        match self.encoding {
            Encoding::Raw => self.appended.extend([header, data].concat()),
            Encoding::Zlib(block) => {
                let deflated = |bytes: &[u8]| {
                    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
                    encoder.write_all(bytes).unwrap();
                    encoder.finish().unwrap()
                };
                let blocks: Vec<Vec<u8>> = data.chunks(block).map(deflated).collect();
                let mut all = [blocks.len(), block, data.len() % block].map(|n| self.word(n)).concat();
                all.extend(blocks.iter().flat_map(|block| self.word(block.len())));
                self.appended.extend([all, blocks.concat()].concat());
            }
            Encoding::AppendedBase64 => self.appended.extend(STANDARD.encode([header, data].concat()).into_bytes()),
            Encoding::InlineBase64 => {
                let text = STANDARD.encode([header, data].concat());
                return format!("{start} format=\"binary\">\n  {text}\n</DataArray>");
            }
            Encoding::InlineBase64Apart => {
                let text = STANDARD.encode(header) + &STANDARD.encode(data);
                let (one, two) = text.split_at(text.len() / 2);
                return format!("{start} format=\"binary\">\n  {one}\n{two}\n</DataArray>");
            }
            Encoding::Ascii => {
                let words: Vec<String> = values.iter().map(ToString::to_string).collect();
                return format!("{start} format=\"ascii\">\n{}\n</DataArray>", words.join(" \n"));
            }
        }
        format!("{start} format=\"appended\" offset=\"{offset}\"/>")
    }
}

fn coordinates() -> Vec<f32> {
    (0..3 * POINTS).map(|at| (at as f32 * 0.7).sin() * 1e3 + at as f32).collect()
}

fn corners() -> Vec<i64> {
    (0..4 * CELLS).map(|at| ((at * 7919) % POINTS) as i64).collect()
}

/// A file of tetrahedra, some of whose corners may be others.
fn file(encoding: Encoding, wide_header: bool, corners: &[i64]) -> Vec<u8> {
    let mut writer = Writer { encoding, wide_header, appended: Vec::new() };
    let field: Vec<f64> = (0..POINTS).map(|point| point as f64 / 7.0).collect();
    let ends: Vec<i32> = (1..=CELLS).map(|cell| 4 * cell as i32).collect();
    let field = writer.array("Float64", "s", &field, |x| x.to_le_bytes().to_vec());
    let points = writer.array("Float32", "Points", &coordinates(), |x| x.to_le_bytes().to_vec());
    let connectivity = writer.array("Int64", "connectivity", corners, |x| x.to_le_bytes().to_vec());
    let offsets = writer.array("Int32", "offsets", &ends, |x| x.to_le_bytes().to_vec());
    let types = writer.array("UInt8", "types", &[10_u8; CELLS], |x| vec![x]);
    let mut text = String::new();
    write!(
        text,
        "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" header_type=\"{}\"{}>\n<!-- no <AppendedData yet -->\n\
         <UnstructuredGrid>\n<Piece NumberOfPoints=\"{POINTS}\" NumberOfCells=\"{CELLS}\">\n<PointData>{field}</PointData>\n\
         <Points>{points}</Points>\n<Cells>{connectivity}{offsets}{types}</Cells>\n</Piece>\n</UnstructuredGrid>\n",
        if wide_header { "UInt64" } else { "UInt32" },
        if matches!(encoding, Encoding::Zlib(_)) { " compressor=\"vtkZLibDataCompressor\"" } else { "" },
    )
    .unwrap();
    // A comment that looks like the section holds the search up, no more.
    let text = text.replace(
        "<!-- no <AppendedData yet -->\n",
        if encoding == Encoding::Zlib(32768) { "<!-- <AppendedData -->" } else { "" },
    );
    let mut bytes = text.into_bytes();
    if !writer.appended.is_empty() {
        let kind = if encoding == Encoding::AppendedBase64 { "base64" } else { "raw" };
        bytes.extend(format!("<AppendedData encoding=\"{kind}\">\n   _").into_bytes());
        bytes.append(&mut writer.appended);
        bytes.extend(b"\n</AppendedData>\n");
    }
    bytes.extend(b"</VTKFile>\n");
    bytes
}

fn read(bytes: &[u8], options: &ReadOptions) -> Result<Loaded, IoError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.vtu");
    std::fs::write(&path, bytes).unwrap();
    read_mesh(&path, options)
}

fn assert_is_whole(dataset: &Dataset, corners: &[i64]) {
    sanity_check(dataset);
    let flat: Vec<f64> = dataset.points.iter().flat_map(|point| point.to_array()).collect();
    assert!(flat.iter().copied().eq(coordinates().into_iter().map(f64::from)));
    let cells = cells(dataset);
    assert!(cells.connectivity.iter().map(|&point| i64::from(point)).eq(corners.iter().copied()));
    assert!(cells.offsets.iter().copied().eq((0..=CELLS).map(|cell| 4 * cell)));
    assert!(cells.kinds.iter().all(|&kind| kind == CellKind::Tetrahedron));
    assert!(dataset.point_arrays[0].component(0).into_iter().eq((0..POINTS).map(|point| point as f64 / 7.0)));
}

#[test]
fn every_encoding_of_a_large_file() {
    let corners = corners();
    for (encoding, wide_header) in [
        (Encoding::Raw, true),
        (Encoding::Raw, false),
        (Encoding::Zlib(32_768), true),
        // Numbers lie across the ends of such blocks.
        (Encoding::Zlib(10_001), false),
        (Encoding::AppendedBase64, true),
        (Encoding::InlineBase64, true),
        (Encoding::InlineBase64, false),
        (Encoding::InlineBase64Apart, true),
        (Encoding::Ascii, false),
    ] {
        let bytes = file(encoding, wide_header, &corners);
        let loaded = read(&bytes, &ReadOptions::default()).unwrap_or_else(|e| panic!("{encoding:?}: {e}"));
        assert_is_whole(&loaded.dataset, &corners);
        let in_memory = super::super::test_support::read("large.vtu", &bytes).unwrap();
        assert_is_whole(&in_memory.dataset, &corners);
        assert_eq!(loaded.format, in_memory.format);
    }
}

#[test]
fn what_is_wrong_with_a_large_file_is_said_as_of_a_small_one() {
    let mut wrong = corners();
    wrong[4 * 80_000 + 2] = POINTS as i64;
    for encoding in [Encoding::Raw, Encoding::Zlib(32_768), Encoding::InlineBase64, Encoding::Ascii] {
        let message = read(&file(encoding, true, &wrong), &ReadOptions::default()).unwrap_err().to_string();
        assert!(message.contains("cell 80000") && message.contains("names point 60000"), "{message}");
    }
    for encoding in [Encoding::Raw, Encoding::Zlib(32_768), Encoding::Zlib(10_001), Encoding::AppendedBase64] {
        let whole = file(encoding, true, &corners());
        let message = read(&whole[..whole.len() - 100_000], &ReadOptions::default()).unwrap_err().to_string();
        assert!(message.contains("are left in the file"), "{encoding:?}: {message}");
    }
    let mut damaged = file(Encoding::Zlib(32_768), true, &corners());
    let middle = damaged.len() / 2;
    damaged[middle..middle + 64].fill(0xa5);
    let message = read(&damaged, &ReadOptions::default()).unwrap_err().to_string();
    assert!(message.contains("compressed block ") && message.contains("line "), "{message}");
    let mut damaged = file(Encoding::InlineBase64, true, &corners());
    let middle = damaged.len() / 2;
    damaged[middle] = b'=';
    let message = read(&damaged, &ReadOptions::default()).unwrap_err().to_string();
    assert!(message.contains("base64 is damaged"), "{message}");
}

/// Remembers what it is told, and stops after so many reports.
#[derive(Debug)]
struct Watch {
    told: Mutex<Vec<Report>>,
    left: AtomicUsize,
}

/// A report, as it came.
type Report = (ReadStage, u64, u64);

fn watched(bytes: &[u8], reports: usize) -> (Result<Loaded, IoError>, Vec<Report>) {
    let watch = Arc::new(Watch { told: Mutex::default(), left: reports.into() });
    let result = read(bytes, &ReadOptions { progress: Some(watch.clone()), ..ReadOptions::default() });
    let told = watch.told.lock().unwrap().clone();
    (result, told)
}

impl ReadProgress for Watch {
    fn report(&self, stage: ReadStage, done: u64, total: u64) {
        self.told.lock().unwrap().push((stage, done, total));
        self.left.store(self.left.load(Ordering::Relaxed).saturating_sub(1), Ordering::Relaxed);
    }

    fn is_stopped(&self) -> bool {
        self.left.load(Ordering::Relaxed) == 0
    }
}

#[test]
fn bytes_only_grow_up_to_the_total_and_reading_stops_when_told() {
    for (encoding, stages) in [
        (Encoding::Raw, &[ReadStage::Reading][..]),
        (Encoding::Zlib(32_768), &[ReadStage::Reading]),
        (Encoding::InlineBase64, &[ReadStage::Reading, ReadStage::Decoding]),
        (Encoding::Ascii, &[ReadStage::Reading, ReadStage::Decoding]),
    ] {
        let bytes = file(encoding, true, &corners());
        let (result, told) = watched(&bytes, usize::MAX);
        assert!(result.is_ok() && told.len() > 3, "{encoding:?}: {told:?}");
        assert!(told.iter().all(|&(_, done, total)| done <= total && total == bytes.len() as u64));
        let mut seen: Vec<ReadStage> = told.iter().map(|&(stage, _, _)| stage).collect();
        seen.dedup();
        assert_eq!(seen, stages, "{encoding:?}");
        for stage in stages {
            let done: Vec<u64> = told.iter().filter(|told| told.0 == *stage).map(|told| told.1).collect();
            assert!(done.is_sorted() && done.last() == Some(&(bytes.len() as u64)), "{encoding:?}: {done:?}");
        }
        for reports in [1, 2, told.len() - 1] {
            let (result, told) = watched(&bytes, reports);
            let error = result.unwrap_err();
            assert!(matches!(error, IoError::Interrupted { .. }), "{encoding:?}: {error}");
            assert!(error.to_string().contains("large.vtu") && told.len() == reports);
        }
    }
}
