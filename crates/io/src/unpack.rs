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

/// Streams of bzip2 that may follow each other without much in them: a table of 3.6 MB is made for each.
const SHORT_STREAMS: usize = 1024;

/// Bytes that every further one must hold, on the average; bzip2 fills 100 000 before it begins another.
const STREAM_BYTES: usize = 1 << 16;

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
        let mut left_to_skip = skip;
        let mut bytes = Vec::new();
        for streams in 0_usize.. {
            let inflated = skip - left_to_skip + bytes.len();
            if self == Self::Bzip2 && streams > SHORT_STREAMS + inflated / STREAM_BYTES {
                return Err(format!(
                    "it is cut into {streams} streams or more, which hold {inflated} bytes; at most {SHORT_STREAMS} may be short"
                ));
            }
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
                    let ended = take(&mut decoder, &mut left_to_skip, wanted, &mut bytes).map_err(damaged)?;
                    (ended, decoder.into_inner())
                }
                Self::Bzip2 => {
                    let mut decoder = BzDecoder::new(rest);
                    let ended = take(&mut decoder, &mut left_to_skip, wanted, &mut bytes).map_err(damaged)?;
                    (ended, decoder.into_inner())
                }
            };
            if !member_ended {
                return Ok(Unpacked { bytes, more: true });
            }
            rest = behind;
        }
        Ok(Unpacked { bytes, more: true })
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
    fn many_short_streams() {
        let stream = packed(Packing::Bzip2, b"a");
        let streams = |count: usize| Packing::Bzip2.inflate(&stream.repeat(count), 5, 9999);
        assert_eq!(streams(1000).unwrap().bytes.len(), 995);
        assert!(streams(1100).unwrap_err().contains("1025 streams"));
        let gzip = packed(Packing::Gzip, b"a").repeat(1100);
        assert_eq!(Packing::Gzip.inflate(&gzip, 5, 9999).unwrap().bytes.len(), 1095);
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
