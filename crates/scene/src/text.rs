//! Numbers in messages.

/// An error with two digits, for messages: more would say more than is known.
pub fn rough(error: f64) -> String {
    if error == 0.0 {
        "0".to_owned()
    } else if (1e-3..10.0).contains(&error) {
        let digits = (1.0 - error.log10().floor()) as usize;
        format!("{error:.digits$}")
    } else {
        format!("{error:.1e}")
    }
}

/// A number with five digits, for messages.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e6).contains(&size) {
        let digits = (4.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else if value.is_finite() {
        let text = format!("{value:.4e}");
        match text.split_once('e') {
            Some((mantissa, exponent)) => {
                format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
            }
            None => text,
        }
    } else {
        value.to_string()
    }
}

/// Memory in GiB or MiB with one decimal, for messages: `"1.5 GiB"`.
pub fn memory_text(bytes: u64) -> String {
    const MIB: f64 = 1048576.0;
    let (number, unit) =
        if bytes >= 1 << 30 { (bytes as f64 / (1024.0 * MIB), "GiB") } else { (bytes as f64 / MIB, "MiB") };
    format!("{} {unit}", short((number * 10.0).round() / 10.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_told_in_the_unit_that_people_read() {
        for (bytes, text) in [(0, "0 MiB"), (3 << 19, "1.5 MiB"), (1 << 30, "1 GiB"), (17 << 30, "17 GiB")] {
            assert_eq!(memory_text(bytes), text);
        }
    }

    #[test]
    fn errors_have_two_digits() {
        for (error, text) in
            [(0.0, "0"), (0.0039216, "0.0039"), (1.0, "1.0"), (0.25, "0.25"), (6e-8, "6.0e-8"), (123.0, "1.2e2")]
        {
            assert_eq!(rough(error), text);
        }
        assert_eq!(rough(f64::INFINITY), "inf");
    }
}
