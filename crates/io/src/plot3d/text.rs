//! Numbers written as Fortran's list-directed output writes them.

/// Numbers that repeat counts may make of any file, however short: 8 MiB.
const EXPANDED_ALWAYS: usize = 1 << 20;

/// Numbers a byte of text that repeat counts may make of a longer file. Without them it is at most one in two bytes.
const EXPANDED_PER_BYTE: usize = 16;

/// Characters of a bad token that a message shows.
const SHOWN: usize = 40;

/// A token that is no number.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct BadToken {
    /// Its line, counted from 1.
    pub(super) line: usize,
    /// What is wrong with it.
    pub(super) problem: String,
}

/// Whether the bytes are text that starts like a number.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    let starts = bytes.trim_ascii_start().first().is_some_and(|b| b.is_ascii_digit() || b"+-.".contains(b));
    starts && bytes.iter().all(|b| b.is_ascii_graphic() || b.is_ascii_whitespace())
}

/// All numbers of a text: between white space or commas, `3*1.0` for three of them, exponents with E or D.
///
/// `allowed` is a number of values that the caller has reason to expect; counts that lead far beyond it and the length of
/// the text are refused before anything is reserved for them.
pub(super) fn numbers(bytes: &[u8], allowed: usize) -> Result<Vec<f64>, BadToken> {
    let limit = EXPANDED_ALWAYS.max(bytes.len().saturating_mul(EXPANDED_PER_BYTE)).max(allowed);
    let mut values = Vec::new();
    for (line, text) in bytes.split(|&b| b == b'\n').enumerate() {
        for token in text.split(|&b| b.is_ascii_whitespace() || b == b',').filter(|token| !token.is_empty()) {
            let token = String::from_utf8_lossy(token);
            let bad = |what: &str| {
                let shown: String = token.chars().take(SHOWN).collect();
                BadToken { line: line + 1, problem: format!("\"{shown}\" {what}") }
            };
            let (count, number) = match token.split_once('*') {
                None => (1, &*token),
                Some((count, number)) => (count.parse().map_err(|_| bad("has no repeat count before its *"))?, number),
            };
            let value: f64 = number.replace(['d', 'D'], "e").parse().map_err(|_| bad("is not a number"))?;
            if count > limit - values.len() {
                return Err(bad("repeats a number more often than a file of this length should"));
            }
            values.extend(std::iter::repeat_n(value, count));
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_that_fortran_writes() {
        let text = b"2\r\n 3*1.5 -1.0D+02,1d-1\t+7 2*3\n\n1.E5 .5";
        assert!(is_text(text));
        assert_eq!(numbers(text, 0), Ok(vec![2.0, 1.5, 1.5, 1.5, -100.0, 0.1, 7.0, 3.0, 3.0, 1e5, 0.5]));
        assert!(numbers(b"NaN -Infinity", 0).unwrap()[0].is_nan());
    }

    #[test]
    fn bad_tokens_name_their_line() {
        for (text, line, part) in [
            (&b"1 2\n3 x4"[..], 2, "\"x4\" is not a number"),
            (b"1\n\n*3", 3, "repeat count"),
            (b"-1*3", 1, "repeat count"),
            (b"3*", 1, "not a number"),
            (b"2000000000*1.0", 1, "more often"),
            (b"99999999999999999999999*1.0", 1, "repeat count"),
        ] {
            let bad = numbers(text, 0).unwrap_err();
            assert_eq!(bad.line, line);
            assert!(bad.problem.contains(part), "{}", bad.problem);
        }
    }

    #[test]
    fn what_is_text() {
        assert!(!is_text(b"# vtk DataFile"));
        assert!(!is_text(b"\0\0\0\x28"));
        assert!(!is_text(b"12 \x80"));
        assert!(!is_text(b""));
    }
}
