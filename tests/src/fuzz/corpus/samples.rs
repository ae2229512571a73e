//! NRRD, and raw volumes.

use std::io::Write;

use fastrand::Rng;

/// The data of detached headers.
pub(super) const COMPANION: &str = "samples.bin";

/// Samples of the volumes here.
const SIZE: [usize; 3] = [3, 2, 4];

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(bytes).expect("memory takes bytes");
    encoder.finish().expect("memory takes bytes")
}

pub(super) fn companion() -> Vec<u8> {
    (0..96).collect()
}

pub(super) fn nrrd(rng: &mut Rng) -> Vec<u8> {
    let [x, y, z] = SIZE;
    let (kind, bytes) = [("uint8", 1), ("short", 2), ("float", 4), ("double", 8)][rng.usize(..4)];
    let (mut axes, mut count) = (format!("dimension: 3\nsizes: {x} {y} {z}\n"), x * y * z);
    match rng.u8(..5) {
        0 => axes += "spacings: 1 0.5 2\naxis mins: 1 2 3\n",
        1 => {
            axes +=
                "space: left-posterior-superior\nspace directions: (1,0,0) (0,2,0.5) (0,0,3)\nspace origin: (1,2,3)\n"
        }
        2 => {
            axes = format!(
                "dimension: 4\nsizes: 2 {x} {y} {z}\nkinds: vector domain domain domain\nspace dimension: 3\n\
                 space directions: none (1,0,0) (0,2,0.5) (0,0,3)\n"
            );
            count *= 2;
        }
        3 => {
            axes =
                format!("dimension: 4\nsizes: {x} {y} {z} 2\nkinds: domain domain domain time\nspacings: 1 1 1 0.5\n");
            count *= 2;
        }
        _ => {}
    }
    let data: Vec<u8> = (0..count * bytes).map(|_| rng.u8(..64)).collect();
    let skip = ["", "line skip: 0\n", "byte skip: 0\n"][rng.usize(..3)];
    let (encoding, more, data) = match rng.u8(..6) {
        0 | 1 => ("raw", skip, data),
        2 => ("gzip", skip, gzip(&data)),
        3 => ("hex", "", data.iter().flat_map(|byte| format!("{byte:02x}").into_bytes()).collect()),
        4 => ("text", "", (0..count).flat_map(|_| format!("{} ", rng.u8(..)).into_bytes()).collect()),
        // Of the companion's 96 bytes, those at the end.
        _ if kind == "uint8" => ("raw", "byte skip: -1\ndata file: samples.bin\n", Vec::new()),
        _ => ("raw", "", data),
    };
    let endian = ["little", "big"][rng.usize(..2)];
    let head = format!(
        "NRRD0005\n# a comment\ntype: {kind}\n{axes}endian: {endian}\nencoding: {encoding}\n{more}key:=value\n\n"
    );
    [head.into_bytes(), data].concat()
}

/// What a user says of a volume, a line feed, and its samples.
pub(super) fn raw(rng: &mut Rng) -> Vec<u8> {
    let [x, y, z] = SIZE;
    let (kind, bytes) = [("uint8", 1), ("int16:big", 2), ("float32", 4), ("float64:big", 8)][rng.usize(..4)];
    let (skip, components) = (rng.usize(..3), rng.usize(1..3));
    let word = format!("{x}x{y}x{z}:{kind}:spacing=1,0.5,2:origin=1,2,3:skip={skip}:components={components}\n");
    let data: Vec<u8> = (0..skip + x * y * z * bytes * components).map(|_| rng.u8(..64)).collect();
    let data = if skip == 0 && rng.bool() { gzip(&data) } else { data };
    [word.into_bytes(), data].concat()
}

/// The word and the samples of one input. Whatever the bytes are, both come out.
pub fn word_and_samples(file: &[u8]) -> (String, &[u8]) {
    let length = file.iter().position(|&byte| byte == b'\n').unwrap_or(file.len());
    let (word, rest) = file.split_at(length);
    (String::from_utf8_lossy(word).into_owned(), rest.get(1..).unwrap_or_default())
}
