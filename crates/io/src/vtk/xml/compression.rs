//! The three compressors of VTK's XML files, each bound to the size that a block declares.

use flate2::{Decompress, FlushDecompress, Status};

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
}

/// Reads the blocks of one array, one after another.
pub(super) struct Decompressor {
    compressor: Compressor,
    /// Kept from block to block: a file may have one for every few bytes, and its window alone takes 32 KiB.
    zlib: Decompress,
}

/// Bytes that a byte of a zlib stream can stand for (RFC 1951: 258 bytes for two codes of one bit).
const ZLIB_RATIO: usize = 1032;

/// Bytes that a byte of LZ4 can stand for (LZ4 block format: lengths of 255 a byte).
const LZ4_RATIO: usize = 255;

impl Compressor {
    /// Whether a block can hold `size` bytes. Memory may be taken for them then, and not before.
    pub(super) fn check(self, block: &[u8], size: usize) -> Result<(), String> {
        let ratio = match self {
            Self::Zlib => ZLIB_RATIO,
            Self::Lz4 => LZ4_RATIO,
            Self::Lzma => return xz::check(block, size),
        };
        if size > block.len().saturating_add(1).saturating_mul(ratio) {
            return Err(format!(
                "{} bytes of {} cannot hold the {size} bytes that are declared",
                block.len(),
                self.label()
            ));
        }
        Ok(())
    }
}

impl Decompressor {
    pub(super) fn new(compressor: Compressor) -> Self {
        Self { compressor, zlib: Decompress::new(true) }
    }

    /// Appends the content of one block, which can hold as much ([`Compressor::check`]), to `out`. Never more than `size` bytes are written.
    ///
    /// The error says what is wrong, for the caller to add the place.
    pub(super) fn decompress(&mut self, block: &[u8], size: usize, out: &mut Vec<u8>) -> Result<(), String> {
        let start = out.len();
        match self.compressor {
            Compressor::Zlib => {
                // One byte more than declared: enough to see that a block inflates further, without following it.
                out.reserve(size + 1);
                self.zlib.reset(true);
                let status = self
                    .zlib
                    .decompress_vec(block, out, FlushDecompress::Finish)
                    .map_err(|e| format!("its zlib stream is damaged ({e})"))?;
                if status != Status::StreamEnd && out.len() - start <= size {
                    return Err("its zlib stream is damaged (it ends early)".to_owned());
                }
            }
            Compressor::Lz4 => {
                out.resize(start + size, 0);
                let written = lz4_flex::block::decompress_into(block, &mut out[start..])
                    .map_err(|e| format!("its LZ4 block is damaged ({e})"))?;
                out.truncate(start + written);
            }
            Compressor::Lzma => xz::decompress(block, out)?,
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
