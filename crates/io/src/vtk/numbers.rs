//! Numbers of one type, from bytes in either order or from words of text, and what else is made of them on the way.

use std::str::FromStr;

use super::scalars::ByteOrder;

/// A word among numbers that is none of the declared type.
#[derive(Debug)]
pub(crate) struct BadWord {
    /// How many numbers were read before it.
    pub(crate) index: usize,
    /// The word, cut to a length that fits a message.
    pub(crate) word: String,
}

/// One number in either of the two forms that files have.
pub(crate) trait Scalar: FromStr + Copy + Default + Send {
    /// Turns the numbers in some bytes into something, as many as `made` has room for; false where one could not be, whose place is left as it was.
    fn turn_bytes<T>(bytes: &[u8], order: ByteOrder, made: &mut [T], turn: impl Fn(Self) -> Option<T>) -> bool;

    /// A whole number as it is used for an index; beyond `i64` its largest, which no index reaches. Nothing for floating-point types.
    fn to_index(self) -> Option<i64>;

    /// The number as f64; integers beyond 2⁵³ are rounded.
    fn to_f64(self) -> f64;

    /// Values that the standard parser does not know, as other programs print them.
    fn special(word: &str) -> Option<Self>;
}

macro_rules! turn_bytes {
    ($t:ident) => {
        fn turn_bytes<T>(bytes: &[u8], order: ByteOrder, made: &mut [T], turn: impl Fn(Self) -> Option<T>) -> bool {
            let (chunks, _) = bytes.as_chunks::<{ size_of::<$t>() }>();
            let mut all = true;
            let mut put = |place: &mut T, number: Self| match turn(number) {
                Some(value) => *place = value,
                None => all = false,
            };
            let pairs = made.iter_mut().zip(chunks);
            match order {
                ByteOrder::Little => pairs.for_each(|(place, &chunk)| put(place, Self::from_le_bytes(chunk))),
                ByteOrder::Big => pairs.for_each(|(place, &chunk)| put(place, Self::from_be_bytes(chunk))),
            }
            all
        }
    };
}

macro_rules! whole {
    ($($t:ident),*) => {$(
        impl Scalar for $t {
            turn_bytes!($t);

            fn to_index(self) -> Option<i64> {
                Some(i64::try_from(self).unwrap_or(i64::MAX))
            }

            fn to_f64(self) -> f64 {
                self as f64
            }

            fn special(_word: &str) -> Option<Self> {
                None
            }
        }
    )*};
}
whole!(i8, u8, i16, u16, i32, u32, i64, u64);

macro_rules! floating {
    ($($t:ident),*) => {$(
        impl Scalar for $t {
            turn_bytes!($t);

            fn to_index(self) -> Option<i64> {
                None
            }

            fn to_f64(self) -> f64 {
                self.into()
            }

            fn special(word: &str) -> Option<Self> {
                // Windows' C library prints 1.#QNAN, -1.#IND, 1.#INF; glibc and others nan(...) with a payload.
                let word = word.to_ascii_lowercase();
                let (negative, rest) = word.strip_prefix('-').map_or((false, word.as_str()), |rest| (true, rest));
                if rest.starts_with("nan(") || ["1.#qnan", "1.#snan", "1.#ind", "1.#nan"].iter().any(|w| rest.starts_with(w)) {
                    Some($t::NAN)
                } else if rest.starts_with("1.#inf") {
                    Some(if negative { $t::NEG_INFINITY } else { $t::INFINITY })
                } else {
                    None
                }
            }
        }
    )*};
}
floating!(f32, f64);

/// All numbers in some bytes; what is left over behind the last whole one is not read.
pub(super) fn from_bytes<S: Scalar>(bytes: &[u8], order: ByteOrder) -> Vec<S> {
    let mut numbers = vec![S::default(); bytes.len() / size_of::<S>()];
    S::turn_bytes(bytes, order, &mut numbers, Some);
    numbers
}

/// Numbers from words, at most `limit` of them; fewer where the words end before.
pub(super) fn from_words<S: Scalar>(words: &mut dyn Iterator<Item = &str>, limit: usize) -> Result<Vec<S>, BadWord> {
    let mut values = Vec::new();
    while values.len() < limit {
        let Some(word) = words.next() else { break };
        values.push(number(word).ok_or_else(|| BadWord::new(values.len(), word))?);
    }
    Ok(values)
}

/// Turns all numbers in a text into something, behind what is in `made` already; stops with false at the first that could not be.
///
/// # Errors
/// [`BadWord`] at the first word that is no number of this type.
pub(super) fn turn_words<S: Scalar, T>(
    text: &str,
    made: &mut Vec<T>,
    turn: impl Fn(S) -> Option<T>,
) -> Result<bool, BadWord> {
    let before = made.len();
    for word in text.split_ascii_whitespace() {
        let number = number(word).ok_or_else(|| BadWord::new(made.len() - before, word))?;
        match turn(number) {
            Some(value) => made.push(value),
            None => return Ok(false),
        }
    }
    Ok(true)
}

fn number<S: Scalar>(word: &str) -> Option<S> {
    word.parse().ok().or_else(|| S::special(word))
}

impl BadWord {
    fn new(index: usize, word: &str) -> Self {
        Self { index, word: word.chars().take(40).collect() }
    }
}
