//! The names of physical groups.

use super::numbers::Numbers;
use super::sections::Section;
use super::views::unquoted;
use crate::Source;

/// What stands behind the format's name: "; physical groups: 1 `solid` (volumes), 2 `wall` (surfaces)"; nothing where there are none.
///
/// Lines that are none of `dimension tag "name"` are passed over: nothing hangs on them.
pub(super) fn described(source: &Source, sections: &[Section<'_>]) -> String {
    let mut groups = Vec::new();
    for &section in sections {
        let mut numbers = Numbers::new(source, section, 0);
        while !numbers.rest().is_empty() {
            let line = numbers.line();
            let Some((tags, _)) = line.split_once('"') else { continue };
            let tags: Vec<i64> = tags.split_ascii_whitespace().filter_map(|word| word.parse().ok()).collect();
            let (dimension, tag) = match *tags.as_slice() {
                [dimension, tag] => (dimension, tag),
                // Version 2.0 has no dimension.
                [tag] => (-1, tag),
                _ => continue,
            };
            let of = match dimension {
                0 => " (points)",
                1 => " (curves)",
                2 => " (surfaces)",
                3 => " (volumes)",
                _ => "",
            };
            groups.push((-dimension, tag, format!("{tag} `{}`{of}", unquoted(&line))));
        }
    }
    if groups.is_empty() {
        return String::new();
    }
    groups.sort();
    let names: Vec<String> = groups.into_iter().map(|(_, _, text)| text).collect();
    format!("; physical groups: {}", names.join(", "))
}
