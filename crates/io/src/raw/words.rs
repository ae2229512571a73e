//! A raw volume in one word of a command line.

use std::fmt;
use std::str::FromStr;

use super::RawVolume;
use crate::{SampleType, bytes::ByteOrder, read::printable};

/// What a word may be, for messages.
const FORM: &str = "a raw volume is SIZE:TYPE and more, as in 64x64x64:uint8 or 64x64x93:int16:big:spacing=3.2,3.2,1.5; after the \
                    type may follow little or big, components=N, spacing=X,Y,Z, origin=X,Y,Z and skip=BYTES";

impl FromStr for RawVolume {
    type Err = String;

    /// From `SIZE:TYPE`, and behind these in any order `little` or `big` (little where neither is), `components=3`, `spacing=1,1,2.5`
    /// (world length), `origin=0,0,0`, `skip=512` (bytes).
    ///
    /// SIZE is the number of samples along x, y and z, `256x256x93`; TYPE is `uint8`, `u8`, `int16`, `float32`, `float`, `double` and other names
    /// that C, numpy and Rust have for numbers of 8 to 64 bits.
    ///
    /// # Errors
    /// A sentence that names the part and what it may be.
    fn from_str(word: &str) -> Result<Self, String> {
        Self::of_word(word).map_err(printable)
    }
}

impl fmt::Display for RawVolume {
    /// The word that [`FromStr`] takes: size and type, and what differs from [`RawVolume::new`].
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.size;
        write!(f, "{x}x{y}x{z}:{}", self.sample)?;
        if self.order == ByteOrder::Big {
            f.write_str(":big")?;
        }
        if self.components != 1 {
            write!(f, ":components={}", self.components)?;
        }
        for (name, [x, y, z], usual) in [("spacing", self.spacing, 1.0), ("origin", self.origin, 0.0)] {
            if [x, y, z] != [usual; 3] {
                write!(f, ":{name}={x:?},{y:?},{z:?}")?;
            }
        }
        if self.skip != 0 { write!(f, ":skip={}", self.skip) } else { Ok(()) }
    }
}

impl RawVolume {
    fn of_word(word: &str) -> Result<Self, String> {
        let mut parts = word.split(':').map(str::trim);
        let size = parts.next().and_then(size).ok_or_else(|| format!("`{word}` does not begin with a size; {FORM}"))?;
        let name = parts.next().ok_or_else(|| format!("`{word}` names no type; {FORM}"))?;
        let sample = SampleType::of_name(name).ok_or_else(|| format!("`{name}` is no type of samples; {FORM}"))?;
        let mut volume = Self::new(size, sample);
        for part in parts {
            volume.add(part).ok_or_else(|| format!("`{part}` is not known or has no such value; {FORM}"))?;
        }
        Ok(volume)
    }

    fn add(&mut self, part: &str) -> Option<()> {
        if let Some(order) = byte_order(part) {
            self.order = order;
            return Some(());
        }
        let (key, value) = part.split_once('=')?;
        match key.trim() {
            "components" => self.components = value.trim().parse().ok().filter(|&count| count > 0)?,
            "spacing" => self.spacing = three(value).filter(|spacing| !spacing.contains(&0.0))?,
            "origin" => self.origin = three(value)?,
            "skip" => self.skip = value.trim().parse().ok()?,
            _ => return None,
        }
        Some(())
    }
}

/// The names of the two byte orders.
pub(super) fn byte_order(word: &str) -> Option<ByteOrder> {
    Some(match word.to_ascii_lowercase().as_str() {
        "little" | "le" | "littleendian" | "little-endian" | "lsb" => ByteOrder::Little,
        "big" | "be" | "bigendian" | "big-endian" | "msb" => ByteOrder::Big,
        _ => return None,
    })
}

/// Three numbers above 0 with an `x` between them.
pub(super) fn size(text: &str) -> Option<[usize; 3]> {
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten();
    let counts: Vec<usize> = text.split(['x', 'X']).map(digits).collect::<Option<_>>()?;
    <[usize; 3]>::try_from(counts).ok().filter(|counts| !counts.contains(&0))
}

fn three(text: &str) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = text.split(',').map(|word| word.trim().parse().ok()).collect::<Option<_>>()?;
    <[f64; 3]>::try_from(numbers).ok().filter(|numbers| numbers.iter().all(|number| number.is_finite()))
}
