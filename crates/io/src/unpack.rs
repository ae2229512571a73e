//! Compressed streams that hold one thing: gzip and bzip2, with as many members as there are.
//!
//! Only as much is inflated as is asked for, so that what a stream could become costs nothing.

use std::io::{self, Read};

use bzip2::bufread::BzDecoder;
use flate2::bufread::GzDecoder;

/// How bytes are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Packing {
    /// RFC 1952.
    Gzip,
    /// The format of bzip2.
    Bzip2,
}

/// What was asked for of a stream.
#[derive(Debug)]
pub(crate) struct Unpacked {
    /// As many bytes as were asked for, or fewer where it ends before.
    pub(crate) bytes: Vec<u8>,
    /// Whether there is more behind them, or anything behind the stream.
    pub(crate) more: bool,
}

impl Packing {
    /// What its streams begin with.
    pub(crate) fn magic(self) -> &'static [u8] {
        match self {
            Self::Gzip => b"\x1f\x8b\x08",
            Self::Bzip2 => b"BZh",
        }
    }

    /// Its name for users.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Gzip => "gzip",
            Self::Bzip2 => "bzip2",
        }
    }

    /// Inflates `wanted` bytes behind the first `skip`. Memory grows with what comes out; that it may come to `wanted` is the caller's to
    /// have judged.
    ///
    /// # Errors
    /// In words, where the stream is damaged; its end is none.
    pub(crate) fn inflate(self, packed: &[u8], skip: usize, wanted: usize) -> Result<Unpacked, String> {
        let damaged = |error: io::Error| format!("its {} stream is damaged ({error})", self.label());
        let mut rest = packed;
        let mut skip = skip;
        let mut bytes = Vec::new();
        loop {
            // What follows the last member and is none is padding: the programs that unpack files let it be, too.
            if !rest.starts_with(self.magic()) {
                let nothing_yet = rest.len() == packed.len();
                if nothing_yet {
                    return Err(format!("it does not begin as a {} stream does", self.label()));
                }
                return Ok(Unpacked { bytes, more: !rest.is_empty() });
            }
            let (member_ended, behind) = match self {
                Self::Gzip => {
                    let mut decoder = GzDecoder::new(rest);
                    let ended = take(&mut decoder, &mut skip, wanted, &mut bytes).map_err(damaged)?;
                    (ended, decoder.into_inner())
                }
                Self::Bzip2 => {
                    let mut decoder = BzDecoder::new(rest);
                    let ended = take(&mut decoder, &mut skip, wanted, &mut bytes).map_err(damaged)?;
                    (ended, decoder.into_inner())
                }
            };
            if !member_ended {
                return Ok(Unpacked { bytes, more: true });
            }
            rest = behind;
        }
    }
}

/// Skips and takes what there is; true where the stream ends, and with it its checksum is right.
fn take(stream: &mut impl Read, skip: &mut usize, wanted: usize, bytes: &mut Vec<u8>) -> io::Result<bool> {
    let skipped = io::copy(&mut stream.by_ref().take(*skip as u64), &mut io::sink())?;
    *skip -= usize::try_from(skipped).unwrap_or(*skip);
    let missing = wanted - bytes.len();
    stream.by_ref().take(missing as u64).read_to_end(bytes)?;
    Ok(stream.read(&mut [0])? == 0)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use bzip2::write::BzEncoder;
    use flate2::write::GzEncoder;

    use super::*;

    fn packed(packing: Packing, bytes: &[u8]) -> Vec<u8> {
        match packing {
            Packing::Gzip => {
                let mut encoder = GzEncoder::new(Vec::new(), flate2::Compression::default());
                encoder.write_all(bytes).unwrap();
                encoder.finish().unwrap()
            }
            Packing::Bzip2 => {
                let mut encoder = BzEncoder::new(Vec::new(), bzip2::Compression::default());
                encoder.write_all(bytes).unwrap();
                encoder.finish().unwrap()
            }
        }
    }

    #[test]
    fn several_members_and_what_follows() {
        for packing in [Packing::Gzip, Packing::Bzip2] {
            let mut stream = packed(packing, b"abcde");
            stream.extend(packed(packing, b"fgh"));
            for (skip, wanted, bytes, more) in
                [(0, 8, &b"abcdefgh"[..], false), (0, 3, b"abc", true), (6, 2, b"gh", false), (6, 9, b"gh", false)]
            {
                let unpacked = packing.inflate(&stream, skip, wanted).unwrap();
                assert_eq!((&unpacked.bytes[..], unpacked.more), (bytes, more), "{packing:?} {skip} {wanted}");
            }
            stream.extend([0; 7]);
            let padded = packing.inflate(&stream, 0, 8).unwrap();
            assert!(padded.bytes == b"abcdefgh" && padded.more);
        }
    }

    #[test]
    fn damaged_streams() {
        for packing in [Packing::Gzip, Packing::Bzip2] {
            let whole = packed(packing, b"some text that is a little longer");
            for length in 0..whole.len() {
                let error = packing.inflate(&whole[..length], 0, 33).unwrap_err();
                assert!(error.contains(packing.label()), "{error}");
            }
            for at in 0..whole.len() {
                let mut damaged = whole.clone();
                damaged[at] ^= 0x20;
                let _ = packing.inflate(&damaged, 0, 33);
            }
            // The checksum is at the end of either.
            let mut wrong_sum = whole.clone();
            let at = wrong_sum.len() - 6;
            wrong_sum[at] ^= 1;
            assert!(packing.inflate(&wrong_sum, 0, 33).is_err());
        }
    }

    #[test]
    fn much_out_of_little_is_not_followed() {
        for packing in [Packing::Gzip, Packing::Bzip2] {
            let bomb = packed(packing, &vec![0; 1 << 22]);
            assert!(bomb.len() < 5000);
            let unpacked = packing.inflate(&bomb, 10, 1000).unwrap();
            assert!(unpacked.bytes.len() == 1000 && unpacked.bytes.capacity() < 10_000 && unpacked.more);
        }
    }
}
