//! Numbers as people read them in a table: two or three digits.

use std::time::Duration;

/// An error: `"0.021"`, `"3.1e-6"`, `"0"`.
pub fn error_text(error: f64) -> String {
    if error == 0.0 {
        "0".to_owned()
    } else if !error.is_finite() {
        "no number".to_owned()
    } else if error >= 1e-3 {
        let digits = (1.0 - error.log10().floor()).clamp(0.0, 5.0) as usize;
        format!("{error:.digits$}")
    } else {
        format!("{error:.1e}")
    }
}

/// A time in milliseconds, without its unit: `"0.42"`, `"13.1"`, `"1204"`.
pub fn ms_text(time: Duration) -> String {
    let ms = time.as_secs_f64() * 1e3;
    match ms {
        _ if ms < 1.0 => format!("{ms:.2}"),
        _ if ms < 100.0 => format!("{ms:.1}"),
        _ => format!("{ms:.0}"),
    }
}

/// Memory: `"1.5 MiB"`.
pub fn bytes_text(bytes: u64) -> String {
    let kib = bytes as f64 / 1024.0;
    match kib {
        _ if kib < 1.0 => format!("{bytes} B"),
        _ if kib < 1024.0 => format!("{kib:.1} KiB"),
        _ if kib < 1024.0 * 1024.0 => format!("{:.1} MiB", kib / 1024.0),
        _ => format!("{:.2} GiB", kib / (1024.0 * 1024.0)),
    }
}

/// A share, 0 to 1, in percent: `"12 %"`, `"0.03 %"`.
pub fn percent_text(share: f64) -> String {
    let percent = share * 100.0;
    match percent {
        _ if percent == 0.0 => "0 %".to_owned(),
        _ if percent < 0.1 => format!("{percent:.2} %"),
        _ if percent < 10.0 => format!("{percent:.1} %"),
        _ => format!("{percent:.0} %"),
    }
}

/// Text between the tags and in the attributes of a page.
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers() {
        for (error, text) in [(0.0, "0"), (0.5, "0.50"), (0.0213, "0.021"), (1.25, "1.2"), (3.14e-6, "3.1e-6")] {
            assert_eq!(error_text(error), text);
        }
        assert_eq!(error_text(f64::INFINITY), "no number");
        for (us, text) in [(420, "0.42"), (13_140, "13.1"), (1_204_000, "1204")] {
            assert_eq!(ms_text(Duration::from_micros(us)), text);
        }
        for (bytes, text) in [(12, "12 B"), (1536, "1.5 KiB"), (3 << 20, "3.0 MiB"), (5 << 29, "2.50 GiB")] {
            assert_eq!(bytes_text(bytes), text);
        }
        for (share, text) in [(0.0, "0 %"), (0.0003, "0.03 %"), (0.05, "5.0 %"), (1.0, "100 %")] {
            assert_eq!(percent_text(share), text);
        }
    }

    #[test]
    fn what_a_page_would_take_for_its_own() {
        assert_eq!(escaped("a < \"b\" & 'c'"), "a &lt; &quot;b&quot; &amp; &#39;c&#39;");
    }
}
