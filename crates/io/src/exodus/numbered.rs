//! Variables that a file has many of, told apart by the numbers in their names.

use super::netcdf::Netcdf;

/// The numbers behind a prefix, of the variables that there are; from 1, in order.
///
/// By the variables and not by the dimension that counts them, which is a mere declaration.
pub(super) fn numbered(file: &Netcdf<'_>, prefix: &str) -> Vec<u64> {
    let mut numbers: Vec<u64> = file.names().filter_map(|name| number(name.strip_prefix(prefix)?)).collect();
    numbers.sort_unstable();
    numbers
}

/// The pairs of numbers behind a prefix and a word between them, in order: `vals_elem_var3eb2` is (3, 2).
pub(super) fn numbered_pairs(file: &Netcdf<'_>, prefix: &str, between: &str) -> Vec<(u64, u64)> {
    let pair = |name: &str| {
        let (first, second) = name.strip_prefix(prefix)?.split_once(between)?;
        Some((number(first)?, number(second)?))
    };
    let mut pairs: Vec<(u64, u64)> = file.names().filter_map(pair).collect();
    pairs.sort_unstable();
    pairs
}

/// A number as the format writes it: from 1, without a sign or zeros before it, so that each has one name.
fn number(text: &str) -> Option<u64> {
    let is_plain = text.bytes().all(|byte| byte.is_ascii_digit()) && !text.starts_with('0');
    if is_plain { text.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_one_name_each() {
        assert_eq!(number("12"), Some(12));
        for text in ["", "0", "01", "+1", "1a", "99999999999999999999"] {
            assert_eq!(number(text), None, "{text}");
        }
    }
}
