//! Pictures: PNG chunk by chunk, so that damage can lie behind the checksums, and OpenEXR as it is written here.

use std::io::Write;

use fastrand::Rng;
use flate2::Crc;

/// The first bytes of a PNG.
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// A PNG of these chunks, each with the checksum that belongs to it.
pub fn png_chunks(chunks: &[(Vec<u8>, Vec<u8>)]) -> Vec<u8> {
    let mut out = SIGNATURE.to_vec();
    for (name, body) in chunks {
        out.extend((body.len() as u32).to_be_bytes());
        out.extend(name);
        out.extend(body);
        let mut crc = Crc::new();
        crc.update(name);
        crc.update(body);
        out.extend(crc.sum().to_be_bytes());
    }
    out
}

/// A PNG of any kind of pixels, with texts, profile and animation around it.
///
/// # Panics
/// Never: memory takes all bytes.
pub fn png(rng: &mut Rng) -> Vec<u8> {
    // Color type, its bits, channels.
    let kinds: [(u8, &[u8], usize); 5] =
        [(0, &[1, 2, 4, 8, 16], 1), (2, &[8, 16], 3), (3, &[1, 2, 4, 8], 1), (4, &[8, 16], 2), (6, &[8, 16], 4)];
    let (color, depths, channels) = kinds[rng.usize(..5)];
    let depth = depths[rng.usize(..depths.len())];
    let (width, height) = (rng.u32(1..9), rng.u32(1..9));
    let interlaced = rng.u8(..4) == 0;
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    header.extend([depth, color, 0, 0, u8::from(interlaced)]);
    // The first pixel, the step and so on of the seven passes; one pass of all pixels without interlacing.
    let passes: &[[u32; 4]] = if interlaced {
        &[[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]]
    } else {
        &[[0, 0, 1, 1]]
    };
    let mut raw = Vec::new();
    for &[x, y, dx, dy] in passes {
        let columns = width.saturating_sub(x).div_ceil(dx) as usize;
        for _ in 0..if columns == 0 { 0 } else { height.saturating_sub(y).div_ceil(dy) } {
            raw.push(rng.u8(..5));
            // Below every palette's length whatever the bits.
            (0..(columns * channels * usize::from(depth)).div_ceil(8)).for_each(|_| raw.push(rng.u8(..) & 0x11));
        }
    }
    let deflate = |bytes: &[u8]| {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(bytes).expect("memory takes bytes");
        encoder.finish().expect("memory takes bytes")
    };
    let mut chunks = vec![(b"IHDR".to_vec(), header)];
    if rng.bool() {
        chunks.push((b"tEXt".to_vec(), b"Title\0a picture".to_vec()));
        chunks.push((b"zTXt".to_vec(), [b"More\0\0", &deflate(b"of a text")[..]].concat()));
        chunks.push((b"iCCP".to_vec(), [b"profile\0\0", &deflate(&[7; 200])[..]].concat()));
        chunks.push((b"gAMA".to_vec(), 45455_u32.to_be_bytes().to_vec()));
    }
    if color == 3 {
        let entries = 1 << depth.min(6);
        chunks.push((b"PLTE".to_vec(), (0..3 * entries).map(|_| rng.u8(..)).collect()));
        chunks.push((b"tRNS".to_vec(), vec![0, 128]));
    }
    let data = deflate(&raw);
    let half = rng.usize(..=data.len());
    chunks.extend([(b"IDAT".to_vec(), data[..half].to_vec()), (b"IDAT".to_vec(), data[half..].to_vec())]);
    chunks.push((b"IEND".to_vec(), Vec::new()));
    png_chunks(&chunks)
}

/// The header of a flat OpenEXR picture of floats, written attribute by attribute; the end of the header is there, no block is.
///
/// - `size`: width and height, also such as no picture has
/// - `names`: of the channels, in the order of the alphabet
/// - `compression`: by number
pub fn exr_header<N: AsRef<str>>([width, height]: [i32; 2], names: &[N], compression: u8) -> Vec<u8> {
    let mut out = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        out.extend(
            [name.as_bytes(), b"\0", kind.as_bytes(), b"\0", &(value.len() as u32).to_le_bytes(), value].concat(),
        );
    };
    let mut channels = Vec::new();
    for name in names {
        let pixel_type = [2_i32, 0, 1, 1];
        channels.extend([name.as_ref().as_bytes(), b"\0", &pixel_type.map(i32::to_le_bytes).concat()].concat());
    }
    channels.push(0);
    let window = [0, 0, width.wrapping_sub(1), height.wrapping_sub(1)].map(i32::to_le_bytes).concat();
    attribute("channels", "chlist", &channels);
    attribute("compression", "compression", &[compression]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1_f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1_f32.to_le_bytes());
    out.push(0);
    out
}

/// A flat OpenEXR picture, written attribute by attribute: R, G, B and A or one more, floats, uncompressed.
pub fn exr(rng: &mut Rng) -> Vec<u8> {
    exr_of(0, rng)
}

/// The same with another compression in its header, by number: its decoder then sees bytes that are none of its.
pub fn exr_of(compression: u8, rng: &mut Rng) -> Vec<u8> {
    let (width, height) = (rng.i32(1..9), rng.i32(1..40));
    let names: &[&str] = if rng.bool() { &["A", "B", "G", "R"] } else { &["B", "G", "R", "Z.extra"] };
    // Lines a block, of each compression.
    let lines = [1, 1, 1, 16, 32, 16, 32, 32, 32, 256];
    let mut out = exr_header([width, height], names, compression);
    let step = lines[usize::from(compression % 10)];
    let blocks: Vec<(i32, Vec<u8>)> = (0..height)
        .step_by(step)
        .map(|y| {
            let rows = (height - y).min(step as i32);
            let mut body: Vec<u8> =
                (0..rows * width * names.len() as i32).flat_map(|_| rng.f32().to_le_bytes()).collect();
            // As long as the samples means stored as they are; otherwise the decoder is asked.
            if compression > 0 && rng.bool() {
                body.truncate(rng.usize(..=body.len()));
            }
            (y, body)
        })
        .collect();
    let mut at = out.len() + 8 * blocks.len();
    for (_, body) in &blocks {
        out.extend((at as u64).to_le_bytes());
        at += 8 + body.len();
    }
    for (y, body) in blocks {
        out.extend(y.to_le_bytes());
        out.extend((body.len() as u32).to_le_bytes());
        out.extend(body);
    }
    out
}
