//! What reading a large VTU costs: time against a copy and decompression of the same bytes, and memory against the file.
//!
//! Every measurement is a process of its own that does nothing else, so that its high-water mark is what it took; the kinds take turns, so that
//! a machine whose speed drifts slows all of them alike. Files are read from the system's cache: they were just written.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use flate2::{Decompress, FlushDecompress};
use rayon::prelude::*;
use tetrascope::{ArrayValues, Cells, DataArray, Dataset, ReadOptions, read_mesh};

use super::vtu_file::{Encoding, Widths, write};
use crate::Failure;

/// What to measure of reading.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Time and memory of reading large VTU files, which are made in the system's temporary folder (TMPDIR) and removed.
    #[arg(long, conflicts_with_all = ["isosurfaces", "interpolations", "orders", "effects"])]
    read: bool,
    /// With --read: about how many bytes each file has.
    #[arg(long, default_value_t = 1e8, requires = "read")]
    bytes: f64,
    /// With --read: encodings; raw and zlib without it.
    #[arg(long, value_enum, requires = "read")]
    encoding: Vec<Encoding>,
    /// With --read: Int32 in place of Int64 for indices.
    #[arg(long, requires = "read")]
    narrow_indices: bool,
    /// With --read: Float64 in place of Float32 for points and fields.
    #[arg(long, requires = "read")]
    wide_floats: bool,
    /// With --read: measurements of each kind.
    #[arg(long, default_value_t = 5, requires = "read")]
    runs: usize,
    /// One measurement, of this file, for the process that measures.
    #[arg(long, hide = true)]
    only_once: Option<PathBuf>,
    /// What that measures.
    #[arg(long, hide = true, value_enum, default_value = "read")]
    kind: Kind,
}

/// What one process measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Kind {
    /// The reader.
    Read,
    /// The file into memory and a copy of it; of compressed files also all blocks inflated, on one thread.
    Copy,
    /// The same, inflated on all threads.
    CopyParallel,
}

/// What one process found.
#[derive(Clone, Copy, Debug, Default)]
struct Measured {
    seconds: f64,
    /// Bytes at the high-water mark, beyond those of the process before it began.
    peak: f64,
    /// Bytes of what was read, for the reader.
    result: f64,
}

/// Bytes that stay free on the disk.
const KEPT_FREE: f64 = 1e10;

/// What a mesh and all that is made on the way to it may take, a byte of the file; compressed files come to most.
const MEMORY_PER_BYTE: f64 = 8.0;

impl Args {
    /// Whether these are to be measured, or one of them.
    pub(super) fn is_asked_for(&self) -> bool {
        self.read || self.only_once.is_some()
    }
}

/// Measures, and prints a line an encoding.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(path) = &args.only_once {
        let measured = measure(path, args.kind)?;
        println!("{} {} {}", measured.seconds, measured.peak, measured.result);
        return Ok(());
    }
    check_room(args.bytes)?;
    let folder = tempfile::tempdir()?;
    println!("{} threads; medians of {} (fastest to slowest)", rayon::current_num_threads(), args.runs);
    println!(
        "encoding | file, MB | M tetrahedra | read, s | against copy and inflating, one thread | all threads | peak/file | mesh/file | peak/mesh"
    );
    let both = [Encoding::Raw, Encoding::Zlib];
    for &encoding in if args.encoding.is_empty() { &both[..] } else { &args.encoding } {
        let path = folder.path().join("large.vtu");
        let widths = Widths { narrow_indices: args.narrow_indices, wide_floats: args.wide_floats };
        let tetrahedra = write(&path, encoding, args.bytes, widths)?;
        let length = std::fs::metadata(&path)?.len() as f64;
        let kinds = [Kind::Read, Kind::Copy, Kind::CopyParallel];
        let mut all = kinds.map(|_| Vec::new());
        for _ in 0..args.runs.max(1) {
            for (kind, measured) in kinds.into_iter().zip(&mut all) {
                measured.push(in_process(&path, kind)?);
            }
        }
        std::fs::remove_file(&path)?;
        let [read, copy, copy_parallel] = all;
        let times = |all: &[Measured]| {
            let mut times: Vec<f64> = all.iter().map(|measured| measured.seconds).collect();
            times.sort_by(f64::total_cmp);
            (times[times.len() / 2], times[0], times[times.len() - 1])
        };
        let most = |of: fn(&Measured) -> f64| read.iter().map(of).fold(0.0, f64::max);
        let (median, fastest, slowest) = times(&read);
        let (peak, result) = (most(|measured| measured.peak), most(|measured| measured.result));
        println!(
            "{encoding:?} | {:.0} | {:.2} | {median:.3} ({fastest:.3} to {slowest:.3}) | {:.2} | {:.2} | {:.2} | {:.2} | {:.2}",
            length / 1e6,
            tetrahedra as f64 / 1e6,
            median / times(&copy).0,
            median / times(&copy_parallel).0,
            peak / length,
            result / length,
            peak / result,
        );
    }
    Ok(())
}

/// That disk and memory have room for what is asked for.
fn check_room(bytes: f64) -> Result<(), Failure> {
    let mut system = sysinfo::System::new()?;
    system.refresh_memory();
    let memory = system.available_memory() as f64;
    if bytes * MEMORY_PER_BYTE > memory {
        return Err(format!(
            "{bytes:.0} bytes may take {MEMORY_PER_BYTE} times that in memory, and {memory:.0} are free"
        )
        .into());
    }
    // The folder's disk is asked by the one program that every Unix has; elsewhere writing says so if it is full.
    let asked = Command::new("df").arg("-Pk").arg(std::env::temp_dir()).output();
    let free = asked.ok().and_then(|output| {
        let text = String::from_utf8(output.stdout).ok()?;
        text.lines().nth(1)?.split_whitespace().nth(3)?.parse::<f64>().ok()
    });
    match free {
        Some(kilobytes) if kilobytes * 1024.0 < bytes + KEPT_FREE => Err(format!(
            "{bytes:.0} bytes leave less than {KEPT_FREE:.0} free on the disk, which has {:.0}",
            kilobytes * 1024.0
        )
        .into()),
        _ => Ok(()),
    }
}

/// A process that measures once.
fn in_process(path: &Path, kind: Kind) -> Result<Measured, Failure> {
    let kind = match kind {
        Kind::Read => "read",
        Kind::Copy => "copy",
        Kind::CopyParallel => "copy-parallel",
    };
    let output = Command::new(std::env::current_exe()?)
        .args(["bench", "--only-once"])
        .arg(path)
        .args(["--kind", kind])
        .output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match numbers[..] {
        [seconds, peak, result] if output.status.success() => Ok(Measured { seconds, peak, result }),
        _ => Err(format!("measuring {kind} failed: {text}{}", String::from_utf8_lossy(&output.stderr)).into()),
    }
}

fn measure(path: &Path, kind: Kind) -> Result<Measured, Failure> {
    // Threads are not what is measured.
    rayon::broadcast(|_| ());
    let before = high_water()?;
    let start = Instant::now();
    let measured = |result: usize| -> Result<Measured, Failure> {
        Ok(Measured { seconds: start.elapsed().as_secs_f64(), peak: high_water()? - before, result: result as f64 })
    };
    match kind {
        Kind::Read => {
            let loaded = read_mesh(path, &ReadOptions::default())?;
            measured(size_of_dataset(&loaded.dataset))
        }
        Kind::Copy | Kind::CopyParallel => {
            let bytes = std::fs::read(path)?;
            let copy = bytes.clone();
            let inflated = inflate_all(&copy, kind == Kind::CopyParallel)?;
            measured(inflated.iter().map(Vec::len).sum::<usize>() + copy.len() + bytes.len())
        }
    }
}

/// The high-water mark of this process, bytes; 0 where the system keeps none that is known here.
fn high_water() -> Result<f64, Failure> {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return Ok(0.0) };
    let line =
        status.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("there is no VmHWM in /proc/self/status")?;
    let kilobytes: f64 = line.split_whitespace().next().unwrap_or_default().parse()?;
    Ok(kilobytes * 1024.0)
}

/// Bytes of all arrays of a dataset of unstructured cells.
fn size_of_dataset(dataset: &Dataset) -> usize {
    macro_rules! size {
        ($values:expr, $($kind:ident)*) => {
            match $values {
                $(ArrayValues::$kind(values) => size_of_val(values.as_slice()),)*
            }
        };
    }
    let of_array = |array: &DataArray| size!(&array.values, I8 U8 I16 U16 I32 U32 I64 U64 F32 F64);
    let cells = match &dataset.cells {
        Cells::Unstructured(cells) => {
            size_of_val(cells.kinds.as_slice())
                + size_of_val(cells.offsets.as_slice())
                + size_of_val(cells.connectivity.as_slice())
        }
        Cells::Structured(_) => 0,
    };
    let arrays: usize = dataset.point_arrays.iter().chain(&dataset.cell_arrays).map(of_array).sum();
    size_of_val(dataset.points.as_slice()) + cells + arrays
}

/// Inflates the blocks of all arrays of a file that this program wrote, each array into memory of its own; nothing of files that are not compressed.
fn inflate_all(bytes: &[u8], parallel: bool) -> Result<Vec<Vec<u8>>, Failure> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 13)]);
    let Some(underscore) = head.find("\n_").filter(|_| head.contains("compressor=")) else { return Ok(Vec::new()) };
    let is_zlib = head.contains("ZLib");
    let appended = &bytes[underscore + 2..];
    let offsets =
        head.split("offset=\"").skip(1).map(|rest| rest.split('"').next().unwrap_or_default().trim().parse::<usize>());
    let mut arrays = Vec::new();
    for offset in offsets {
        let array = &appended[offset?..];
        let word =
            |number: usize| u64::from_le_bytes(array[8 * number..].first_chunk().copied().unwrap_or_default()) as usize;
        let (count, block, last) = (word(0), word(1), word(2));
        let mut inflated = vec![0; (count - 1) * block + if last == 0 { block } else { last }];
        let mut at = 8 * (count + 3);
        let blocks: Vec<(&[u8], &mut [u8])> = inflated
            .chunks_mut(block)
            .enumerate()
            .map(|(number, target)| {
                let stored = &array[at..at + word(3 + number)];
                at += stored.len();
                (stored, target)
            })
            .collect();
        let one = |zlib: &mut Decompress, (stored, target): (&[u8], &mut [u8])| {
            if is_zlib {
                zlib.reset(true);
                zlib.decompress(stored, target, FlushDecompress::Finish).map(drop).map_err(|e| e.to_string())
            } else {
                lz4_flex::block::decompress_into(stored, target).map(drop).map_err(|e| e.to_string())
            }
        };
        let make = || Decompress::new(true);
        let done: Result<(), String> = if parallel {
            blocks.into_par_iter().with_min_len(64).map_init(make, one).collect()
        } else {
            let mut zlib = make();
            blocks.into_iter().try_for_each(|block| one(&mut zlib, block))
        };
        done?;
        arrays.push(inflated);
    }
    Ok(arrays)
}
