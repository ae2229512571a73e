//! The LZMA2 stream inside an `.xz` container of one block, as VTK's LZMA compressor writes it.
//!
//! The decoder keeps all output until the end and knows no limit, so the sizes that the chunks declare are added up
//! before it is asked to do anything. Source: The .xz File Format 1.2.1, sections 2.1.1 (stream header) and 3.1 (block
//! header), and the chunk headers of LZMA2 as the XZ Utils document them.

/// Length of the header at the start of a stream: magic bytes, flags and their checksum.
const STREAM_HEADER: usize = 12;

/// Whether the content has `size` bytes by what its chunks declare. The error says what is wrong.
pub(super) fn check(container: &[u8], size: usize) -> Result<(), String> {
    let chunks = chunks_of(container)?;
    let declared = declared_size(chunks).ok_or("its LZMA2 chunks are damaged")?;
    if declared != size {
        return Err(format!("its LZMA2 chunks declare {declared} bytes, where {size} are declared for the block"));
    }
    Ok(())
}

/// Appends the content, whose size was [checked](check). The error says what is wrong.
pub(super) fn decompress(container: &[u8], out: &mut Vec<u8>) -> Result<(), String> {
    let chunks = chunks_of(container)?;
    lzma_rs::lzma2_decompress(&mut &*chunks, out).map_err(|e| format!("its LZMA2 stream is damaged ({e:?})"))
}

fn chunks_of(container: &[u8]) -> Result<&[u8], String> {
    lzma2_chunks(container).ok_or_else(|| "its xz container is damaged".to_owned())
}

/// What follows the headers of the stream and of its first block.
fn lzma2_chunks(container: &[u8]) -> Option<&[u8]> {
    container.strip_prefix(b"\xfd7zXZ\0")?;
    let block = container.get(STREAM_HEADER..)?;
    // The first byte gives the header's length in units of four bytes, less one; 0 would start the index.
    let units = usize::from(*block.first()?);
    if units == 0 { None } else { block.get((units + 1) * 4..) }
}

/// The sum of the uncompressed sizes of all chunks up to the end mark.
fn declared_size(mut chunks: &[u8]) -> Option<usize> {
    let word = |high: u8, low: u8| usize::from(u16::from_be_bytes([high, low])) + 1;
    let mut total = 0;
    loop {
        let (uncompressed, stored) = match *chunks {
            [0, ..] => return Some(total),
            // Stored as it is.
            [1 | 2, high, low, ..] => (word(high, low), 3 + word(high, low)),
            // Compressed; from 0xc0 on a byte of properties follows.
            [control @ 0x80..=0xff, high, low, packed_high, packed_low, ..] => (
                (usize::from(control & 0x1f) << 16) + word(high, low),
                5 + usize::from(control >= 0xc0) + word(packed_high, packed_low),
            ),
            _ => return None,
        };
        total += uncompressed;
        chunks = chunks.get(stored..)?;
    }
}
