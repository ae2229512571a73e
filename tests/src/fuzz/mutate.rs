//! What is done to a sound file: bytes as any fuzzer would, and words, elements, lines and chunks as the format has them.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fastrand::Rng;

use super::{Target, corpus};

/// Numbers that a reader may stumble over, as words.
pub const HOSTILE_WORDS: &[&str] = &[
    "-1",
    "0",
    "1",
    "-0",
    "2",
    "3",
    "4",
    "7",
    "255",
    "256",
    "65536",
    "1000000",
    "2147483647",
    "2147483648",
    "-2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "340282366920938463463374607431768211456",
    "1e400",
    "-1e400",
    "1e300",
    "-1e300",
    "1e-320",
    "3.4e38",
    "nan",
    "NaN",
    "inf",
    "-inf",
    "",
    "0x10",
    "1_000",
    "1e9",
    "3.5",
    "00001",
    "+5",
    "1.#QNAN",
    "true",
    "\"\"",
    "[]",
    "99999999*1.0",
    "4*0.5",
];

/// The same as integers of 64 bits, of which the lower half is taken for 32.
const HOSTILE_INTEGERS: &[u64] = &[
    0,
    1,
    2,
    3,
    4,
    5,
    7,
    8,
    16,
    255,
    256,
    1000,
    65535,
    65536,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x1_0000_0000,
    0x7fff_ffff_ffff_ffff,
    0x8000_0000_0000_0000,
    u64::MAX,
    u64::MAX - 7,
    // NaN, infinity and the largest finite number of both precisions.
    0x7fc0_0000,
    0x7f80_0000,
    0xff80_0000,
    0x7f7f_ffff,
    0x7ff8_0000_0000_0000,
    0x7ff0_0000_0000_0000,
    0x7fef_ffff_ffff_ffff,
];

/// Damages a file in one to five ways.
pub fn damaged(target: Target, mut file: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    if target == Target::Exr && rng.bool() {
        file = corpus::exr_of(rng.u8(..12), rng);
    }
    for _ in 0..1 + rng.u32(..5) * rng.u32(..2) {
        file = match target {
            Target::Plot3dSolution => {
                let (grid, solution) = corpus::split(&file);
                let (mut grid, mut solution) = (grid.to_vec(), solution.to_vec());
                match rng.u8(..8) {
                    // Another grid's solution, or none.
                    0 => grid = corpus::file(Target::Plot3dGrid, rng),
                    1 => std::mem::swap(&mut grid, &mut solution),
                    2..5 => grid = once(target, grid, rng),
                    _ => solution = once(target, solution, rng),
                }
                corpus::joined(&grid, &solution)
            }
            Target::Openfoam => {
                let mut files: Vec<Vec<u8>> = corpus::openfoam::files(&file).into_iter().map(<[u8]>::to_vec).collect();
                let (one, other) = (rng.usize(..files.len()), rng.usize(..files.len()));
                if rng.u8(..12) == 0 {
                    files.swap(one, other);
                } else {
                    files[one] = once(target, std::mem::take(&mut files[one]), rng);
                }
                corpus::openfoam::joined(&files)
            }
            Target::Png if rng.u8(..4) > 0 => png(&file, rng),
            _ => once(target, file, rng),
        };
    }
    file
}

fn once(target: Target, file: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    let is_grid = matches!(target, Target::Vti | Target::Vtr | Target::Vts);
    let is_xml = is_grid || target.extension() == "vtu" || matches!(target, Target::VtkNaming | Target::PresetXml);
    let has_base64 = is_grid || matches!(target, Target::VtuBase64 | Target::VtuCompressed);
    let is_scientific = matches!(target, Target::Exodus | Target::ExodusHdf5 | Target::Vtkhdf);
    let has_words = !is_scientific && !matches!(target, Target::Heights | Target::Png | Target::Exr);
    match rng.u8(..10) {
        0..3 if is_xml => xml(file, rng),
        3 if has_base64 => inside_base64(file, rng),
        0..6 if is_scientific => integer(file, rng),
        0..5 if has_words => word(file, rng),
        5 | 6 if has_words => line(file, rng),
        7 | 8 if target != Target::VtuText => integer(file, rng),
        _ => bytes(file, rng),
    }
}

/// Flips, cuts, repeats, moves and inserts bytes.
fn bytes(mut file: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    if file.is_empty() {
        return vec![rng.u8(..)];
    }
    let at = rng.usize(..file.len());
    let some = |rng: &mut Rng| at..file.len().min(at + 1 + rng.usize(..64));
    match rng.u8(..7) {
        0 => file[at] ^= 1 << rng.u8(..8),
        1 => file[at] = rng.u8(..),
        2 => file.truncate(at),
        3 => drop(file.drain(some(rng))),
        4 => {
            let chunk = file[some(rng)].to_vec();
            let to = rng.usize(..=file.len());
            let times = if rng.u8(..8) == 0 { 500 } else { 1 };
            drop(file.splice(to..to, chunk.repeat(times)));
        }
        5 => {
            let chunk: Vec<u8> = file.drain(some(rng)).collect();
            let to = rng.usize(..=file.len());
            drop(file.splice(to..to, chunk));
        }
        _ => drop(file.splice(at..at, std::iter::repeat_n(rng.u8(..), rng.usize(..40)))),
    }
    file
}

/// Writes a hostile integer of 4 or 8 bytes, in either order; headers are met more often than data.
fn integer(mut file: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    let reach = if rng.bool() { file.len().min(64) } else { file.len() };
    if reach < 8 {
        return bytes(file, rng);
    }
    let at = rng.usize(..=reach - 8);
    let at = if rng.bool() { at / 4 * 4 } else { at };
    let value = HOSTILE_INTEGERS[rng.usize(..HOSTILE_INTEGERS.len())];
    match (rng.bool(), rng.bool()) {
        (true, true) => file[at..at + 8].copy_from_slice(&value.to_le_bytes()),
        (true, false) => file[at..at + 8].copy_from_slice(&value.to_be_bytes()),
        (false, true) => file[at..at + 4].copy_from_slice(&(value as u32).to_le_bytes()),
        (false, false) => file[at..at + 4].copy_from_slice(&(value as u32).to_be_bytes()),
    }
    file
}

/// The places of words: runs of what may stand in a number or a name.
fn words(file: &[u8]) -> Vec<std::ops::Range<usize>> {
    let is_word = |b: &u8| b.is_ascii_alphanumeric() || b"+-._".contains(b);
    let mut words = Vec::new();
    let mut at = 0;
    while at < file.len() {
        let length = file[at..].iter().take_while(|b| is_word(b)).count();
        if length > 0 {
            words.push(at..at + length);
        }
        at += length + 1;
    }
    words
}

/// Puts a hostile number, or another word of the file, in a word's place; exchanges words; repeats one very often.
fn word(mut file: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    let words = words(&file);
    if words.is_empty() {
        return bytes(file, rng);
    }
    let mut pick = || words[rng.usize(..words.len())].clone();
    let (word, other) = (pick(), pick());
    match rng.u8(..8) {
        0..4 => drop(file.splice(word, HOSTILE_WORDS[rng.usize(..HOSTILE_WORDS.len())].bytes())),
        4 | 5 => {
            let other = file[other].to_vec();
            drop(file.splice(word, other));
        }
        6 => drop(file.drain(word)),
        _ => {
            let repeated = [&file[word.clone()], b" "].concat().repeat(1 + rng.usize(..200));
            drop(file.splice(word, repeated));
        }
    }
    file
}

/// Repeats, removes or exchanges lines.
fn line(file: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = file.split_inclusive(|&b| b == b'\n').collect();
    if lines.is_empty() {
        return file;
    }
    let (a, b) = (rng.usize(..lines.len()), rng.usize(..lines.len()));
    match rng.u8(..4) {
        0 => lines.swap(a, b),
        1 => drop(lines.remove(a)),
        2 => lines.insert(b, lines[a]),
        _ => drop(lines.splice(b..b, std::iter::repeat_n(lines[a], 100)).count()),
    }
    lines.concat()
}

/// What XML has: elements and attributes removed, repeated or exchanged, nesting, entities, comments.
fn xml(mut file: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    let tags: Vec<usize> = (0..file.len()).filter(|&at| file[at] == b'<').collect();
    if tags.is_empty() {
        return bytes(file, rng);
    }
    let at = tags[rng.usize(..tags.len())];
    let end = |from: usize| file[from..].iter().position(|&b| b == b'>').map_or(file.len(), |n| from + n + 1);
    let tag = at..end(at);
    // From the tag to the end of the element of the same name.
    let name: Vec<u8> = file[at + 1..].iter().take_while(|b| b.is_ascii_alphanumeric()).copied().collect();
    let closing = [b"</", &name[..], b">"].concat();
    let close = file[at..].windows(closing.len().max(1)).position(|w| w == closing);
    let element = at..close.map_or(tag.end, |n| at + n + closing.len()).max(tag.end);
    match rng.u8(..10) {
        0 => drop(file.drain(tag)),
        1 => drop(file.drain(element)),
        2 => {
            let copy = file[element].to_vec().repeat(1 + rng.usize(..3) * rng.usize(..20));
            drop(file.splice(at..at, copy));
        }
        3 => {
            let copy = file[element].to_vec();
            let to = tags[rng.usize(..tags.len())];
            drop(file.splice(to..to, copy));
        }
        4 => drop(file.splice(at..at, b"<a>".repeat(rng.usize(..3000)))),
        5 => drop(file.splice(tag.end..tag.end, b"&amp;&#48;&b;".iter().copied().skip(5 * rng.usize(..3)))),
        6 => {
            let entities = b"<!DOCTYPE VTKFile [<!ENTITY a \"1 1 1 1\"><!ENTITY b \"&a;&a;&a;&a;\">]>";
            drop(file.splice(at..at, entities.iter().copied()));
        }
        7 => drop(file.splice(at..at, b"<!-- 1 -- <DataArray> --><![CDATA[ 5 ]]>".iter().copied())),
        // An attribute: removed, repeated, or given the value of another.
        _ => {
            let quotes: Vec<usize> = tag.clone().filter(|&i| file[i] == b'"').collect();
            let Some(pair) = (!quotes.is_empty()).then(|| 2 * rng.usize(..quotes.len().div_ceil(2))) else {
                return file;
            };
            let (open, close) = (quotes[pair], quotes.get(pair + 1).copied().unwrap_or(tag.end - 1));
            let name = file[..open].iter().rposition(|&b| b == b' ').unwrap_or(open);
            match rng.u8(..3) {
                0 => drop(file.drain(name..=close)),
                1 => {
                    let copy = file[name..=close].to_vec().repeat(1 + rng.usize(..50));
                    drop(file.splice(name..name, copy));
                }
                _ => {
                    let value = HOSTILE_WORDS[rng.usize(..HOSTILE_WORDS.len())];
                    drop(file.splice(open + 1..close, value.bytes()));
                }
            }
        }
    }
    file
}

/// Damages what a run of base64 stands for, and encodes it again.
fn inside_base64(mut file: Vec<u8>, rng: &mut Rng) -> Vec<u8> {
    let is_base64 = |b: &u8| b.is_ascii_alphanumeric() || b"+/=".contains(b);
    let mut runs = Vec::new();
    let mut at = 0;
    while at < file.len() {
        let length = file[at..].iter().take_while(|b| is_base64(b)).count();
        if length >= 16 {
            runs.push(at..at + length);
        }
        at += length + 1;
    }
    if runs.is_empty() {
        return bytes(file, rng);
    }
    let run = runs[rng.usize(..runs.len())].clone();
    // Header and body may be encoded apart: up to the first padding, where there is any.
    let first = file[run.clone()].iter().position(|&b| b == b'=').map_or(run.len(), |n| (n / 4 + 1) * 4).min(run.len());
    let head = run.start..run.start + first;
    let Ok(inside) = STANDARD.decode(&file[head.clone()]) else { return bytes(file, rng) };
    let inside = if rng.bool() { integer(inside, rng) } else { bytes(inside, rng) };
    drop(file.splice(head, STANDARD.encode(inside).into_bytes()));
    file
}

/// Damages chunks, with checksums that fit.
fn png(file: &[u8], rng: &mut Rng) -> Vec<u8> {
    let mut chunks = Vec::new();
    let mut rest = file.get(8..).unwrap_or_default();
    while let Some((length, behind)) = rest.split_first_chunk::<4>() {
        let length = u32::from_be_bytes(*length) as usize;
        let Some((chunk, behind)) = behind.split_at_checked(length.saturating_add(4)) else { break };
        chunks.push((chunk[..4].to_vec(), chunk[4..].to_vec()));
        rest = behind.get(4..).unwrap_or_default();
    }
    if chunks.is_empty() {
        return bytes(file.to_vec(), rng);
    }
    let (a, b) = (rng.usize(..chunks.len()), rng.usize(..chunks.len()));
    match rng.u8(..9) {
        0 => chunks.swap(a, b),
        1 => drop(chunks.remove(a)),
        2 => chunks.insert(b, chunks[a].clone()),
        3 => {
            let name = [*b"IDAT", *b"fdAT", *b"PLTE", *b"tRNS", *b"acTL", *b"fcTL", *b"iCCP"][rng.usize(..7)];
            chunks[a].0 = name.to_vec();
        }
        4 => {
            let body: Vec<u8> = (0..rng.usize(..40)).map(|_| rng.u8(..)).collect();
            let name = [*b"acTL", *b"fcTL", *b"tRNS", *b"eXIf", *b"iTXt"][rng.usize(..5)];
            chunks.insert(b, (name.to_vec(), body));
        }
        // Width, height, bits and kind of color.
        5 | 6 => {
            let value = HOSTILE_INTEGERS[rng.usize(..HOSTILE_INTEGERS.len())] as u32;
            let body = &mut chunks[0].1;
            match rng.usize(..3) {
                field @ 0..2 if body.len() >= 8 => body[4 * field..4 * field + 4].copy_from_slice(&value.to_be_bytes()),
                _ if body.len() >= 13 => body[8 + rng.usize(..5)] = rng.u8(..18),
                _ => {}
            }
        }
        7 => chunks[a].1 = integer(std::mem::take(&mut chunks[a].1), rng),
        _ => chunks[a].1 = bytes(std::mem::take(&mut chunks[a].1), rng),
    }
    corpus::png_chunks(&chunks)
}
