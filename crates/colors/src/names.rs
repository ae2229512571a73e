//! The maps that have names: matplotlib's and ParaView's.

use std::sync::OnceLock;

use crate::error::shown;
use crate::map::ColorPoint;
use crate::preset_json::{self, Preset};
use crate::{ColorError, ColorMap, ColorSpace};

/// matplotlib's maps of a few points, as presets in ParaView's layout.
const MATPLOTLIB: &str = include_str!("../data/matplotlib.json");
/// matplotlib's maps of many: a line each, the name and four hexadecimal digits a channel, evenly spaced.
const MATPLOTLIB_TABLES: &str = include_str!("../data/matplotlib-tables.txt");
/// ParaView's maps of all ages, without those for categories and without those that are matplotlib's tables.
const PARAVIEW: &str = include_str!("../data/paraview.json");

/// ParaView's presets that are tables of matplotlib's: the name in ParaView, the table, the space. Names with parentheses are those of
/// versions before 6.
const SHARED: [(&str, &str, ColorSpace); 10] = [
    ("Viridis (matplotlib)", "viridis", ColorSpace::Diverging),
    ("Inferno (matplotlib)", "inferno", ColorSpace::Diverging),
    ("Magma (matplotlib)", "magma", ColorSpace::Diverging),
    ("Plasma (matplotlib)", "plasma", ColorSpace::Diverging),
    ("Viridis", "viridis", ColorSpace::Lab),
    ("Inferno", "inferno", ColorSpace::Lab),
    ("Magma", "magma", ColorSpace::Lab),
    ("Plasma", "plasma", ColorSpace::Lab),
    ("Cividis", "cividis", ColorSpace::Lab),
    ("Turbo", "turbo", ColorSpace::Rgb),
];

/// How near a name must be to one that is known to be proposed instead, from 0 to 1 (the same).
const NEAR: f64 = 0.75;

/// Proposals in a message.
const PROPOSALS: usize = 5;

/// Who gave a map its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapOrigin {
    /// matplotlib 3.11, without its maps for categories.
    Matplotlib,
    /// ParaView 6 and, where they are gone there, versions before, without the presets for categories.
    ParaView,
}

impl MapOrigin {
    /// What stands before a name, with a colon, to say that this origin is meant.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Matplotlib => "matplotlib",
            Self::ParaView => "paraview",
        }
    }
}

/// A name of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NamedMap {
    /// Whose map it is.
    pub origin: MapOrigin,
    /// The name as its origin writes it, without `_r`.
    pub name: &'static str,
}

impl NamedMap {
    /// The map, which is this one even where another origin has the same name.
    ///
    /// # Errors
    ///
    /// None: all maps are read in a test.
    pub fn map(self) -> Result<ColorMap, ColorError> {
        find(&format!("{}:{}", self.origin.prefix(), self.name))
    }
}

/// A map's colors, as they are kept.
#[derive(Debug)]
enum Colors {
    Preset(Preset),
    Table(&'static str, ColorSpace),
}

#[derive(Debug)]
struct Entry {
    named: NamedMap,
    colors: Colors,
}

/// All maps that have names: matplotlib's, then ParaView's, each in alphabetical order whatever the case. Every one is also known with
/// `_r`, backwards.
pub fn all_names() -> Vec<NamedMap> {
    entries().iter().map(|entry| entry.named).collect()
}

fn entries() -> &'static [Entry] {
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    ENTRIES.get_or_init(|| {
        let mut entries = Vec::new();
        for (origin, text) in [(MapOrigin::Matplotlib, MATPLOTLIB), (MapOrigin::ParaView, PARAVIEW)] {
            // What is compiled in is well-formed; a test reads every map.
            for preset in preset_json::parse(origin.prefix(), text.as_bytes()).unwrap_or_default() {
                let name = static_name(text, preset.name());
                entries.push(Entry { named: NamedMap { origin, name }, colors: Colors::Preset(preset) });
            }
        }
        for (name, digits) in MATPLOTLIB_TABLES.lines().filter_map(|line| line.split_once(' ')) {
            let named = NamedMap { origin: MapOrigin::Matplotlib, name };
            entries.push(Entry { named, colors: Colors::Table(digits, ColorSpace::Rgb) });
        }
        for (name, table, space) in SHARED {
            let digits =
                MATPLOTLIB_TABLES.lines().filter_map(|line| line.split_once(' ')).find(|(name, _)| *name == table);
            if let Some((_, digits)) = digits {
                let named = NamedMap { origin: MapOrigin::ParaView, name };
                entries.push(Entry { named, colors: Colors::Table(digits, space) });
            }
        }
        entries.sort_by_key(|Entry { named, .. }| {
            (named.origin == MapOrigin::ParaView, named.name.to_ascii_lowercase(), named.name)
        });
        entries
    })
}

/// The name where it stands in the text, which lives as long as the program.
fn static_name(text: &'static str, name: &str) -> &'static str {
    text.find(&format!("\"{name}\"")).and_then(|at| text.get(at + 1..at + 1 + name.len())).unwrap_or_default()
}

/// Looks a name up; see [`ColorMap::named`].
pub(crate) fn find(name: &str) -> Result<ColorMap, ColorError> {
    let wanted = name.trim();
    let exact = |wanted: &str, of: Option<MapOrigin>| entry(of, |known| known == wanted);
    let any_case = |wanted: &str, of: Option<MapOrigin>| entry(of, |known| known.eq_ignore_ascii_case(wanted));
    let (origin, wanted) = match wanted.split_once(':') {
        Some((prefix, rest)) if prefix.eq_ignore_ascii_case("matplotlib") => (Some(MapOrigin::Matplotlib), rest.trim()),
        Some((prefix, rest)) if prefix.eq_ignore_ascii_case("paraview") => (Some(MapOrigin::ParaView), rest.trim()),
        _ => (None, wanted),
    };
    let backwards = wanted.strip_suffix("_r").or_else(|| wanted.strip_suffix("_R"));
    if let Some(entry) = exact(wanted, origin) {
        return entry.map();
    }
    if let Some(entry) = backwards.and_then(|plain| exact(plain, origin)) {
        return entry.map().map(|map| map.reversed());
    }
    if let Some(entry) = any_case(wanted, origin) {
        return entry.map();
    }
    if let Some(entry) = backwards.and_then(|plain| any_case(plain, origin)) {
        return entry.map().map(|map| map.reversed());
    }
    Err(unknown(wanted))
}

fn entry(origin: Option<MapOrigin>, fits: impl Fn(&str) -> bool) -> Option<&'static Entry> {
    entries().iter().find(|entry| origin.is_none_or(|origin| entry.named.origin == origin) && fits(entry.named.name))
}

impl Entry {
    fn map(&self) -> Result<ColorMap, ColorError> {
        match &self.colors {
            Colors::Preset(preset) => preset.map(self.named.origin.prefix()).map(|(map, _)| map),
            Colors::Table(digits, space) => ColorMap::new(self.named.name, *space, &table(digits)),
        }
    }
}

/// Colors of a line of digits, evenly spaced.
#[expect(clippy::cast_precision_loss, reason = "a table has some hundred colors")]
fn table(digits: &str) -> Vec<ColorPoint> {
    let channel = |digits: Option<&str>| {
        f64::from(digits.and_then(|digits| u16::from_str_radix(digits, 16).ok()).unwrap_or_default())
            / f64::from(u16::MAX)
    };
    (0..digits.len() / 12)
        .map(|i| ColorPoint {
            x: i as f64,
            rgb: core::array::from_fn(|c| channel(digits.get(12 * i + 4 * c..12 * i + 4 * c + 4))),
        })
        .collect()
}

/// The error with names that are near, or that have the word in them.
fn unknown(name: &str) -> ColorError {
    let plain = name.to_ascii_lowercase();
    let plain = plain.strip_suffix("_r").unwrap_or(&plain);
    let mut near: Vec<(f64, &str)> = Vec::new();
    // Distances take time by the product of the lengths.
    if (3..=64).contains(&plain.len()) {
        for Entry { named, .. } in entries() {
            let known = named.name.to_ascii_lowercase();
            let nearness = if known.contains(plain) { 1.0 } else { strsim::jaro_winkler(&known, plain) };
            if nearness >= NEAR && !near.iter().any(|(_, seen)| seen.eq_ignore_ascii_case(named.name)) {
                near.push((nearness, named.name));
            }
        }
    }
    near.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let near: Vec<_> = near.iter().take(PROPOSALS).map(|(_, name)| format!("\"{name}\"")).collect();
    let remedy = if near.is_empty() {
        "the names are matplotlib's and ParaView's, with _r for backwards".to_owned()
    } else {
        format!("near it are {}", near.join(", "))
    };
    ColorError::UnknownName { what: "color map".to_owned(), name: shown(name), remedy }
}
