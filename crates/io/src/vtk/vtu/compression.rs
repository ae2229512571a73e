//! The three compressors of VTK's XML files, each bound to the size that a block declares.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::xz;

/// Which library compressed the blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compressor {
    Zlib,
    Lz4,
    Lzma,
}

impl Compressor {
    /// The compressor that a file names.
    pub(super) fn named(name: &str) -> Option<Self> {
        match name {
            "vtkZLibDataCompressor" => Some(Self::Zlib),
            "vtkLZ4DataCompressor" => Some(Self::Lz4),
            "vtkLZMADataCompressor" => Some(Self::Lzma),
            _ => None,
        }
    }

    /// Its name for users.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Zlib => "zlib",
            Self::Lz4 => "LZ4",
            Self::Lzma => "LZMA",
        }
    }

    /// Appends one block's content to `out`. Never more than `size` bytes are written, and memory is taken as the content
    /// comes, or after `size` was found to be within what the block can hold.
    ///
    /// The error says what is wrong, for the caller to add the place.
    pub(super) fn decompress(self, block: &[u8], size: usize, out: &mut Vec<u8>) -> Result<(), String> {
        let start = out.len();
        match self {
            Self::Zlib => {
                // One byte more than declared: enough to see that a block inflates further, without following it.
                let limit = u64::try_from(size).unwrap_or(u64::MAX).saturating_add(1);
                ZlibDecoder::new(block)
                    .take(limit)
                    .read_to_end(out)
                    .map_err(|e| format!("its zlib stream is damaged ({e})"))?;
            }
            Self::Lz4 => {
                // A byte of input stands for at most 255 bytes of output (LZ4 block format, lengths of 255 a byte).
                const LARGEST_RATIO: usize = 255;
                if size > block.len().saturating_mul(LARGEST_RATIO).saturating_add(LARGEST_RATIO) {
                    return Err(format!("{} bytes of LZ4 cannot hold the {size} bytes that are declared", block.len()));
                }
                out.resize(start + size, 0);
                let written = lz4_flex::block::decompress_into(block, &mut out[start..])
                    .map_err(|e| format!("its LZ4 block is damaged ({e})"))?;
                out.truncate(start + written);
            }
            Self::Lzma => xz::decompress(block, size, out)?,
        }
        let found = out.len() - start;
        if found > size {
            out.truncate(start);
            return Err(format!("it inflates to more than the {size} bytes that are declared"));
        }
        if found < size {
            return Err(format!("it inflates to {found} bytes, where {size} are declared"));
        }
        Ok(())
    }
}
