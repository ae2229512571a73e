//! `tetrascope colormaps`: the color maps and opacity curves that have names, and those of a preset's file.

mod swatch;

use std::path::Path;

use clap::Args;
use serde_json::{Value, json};
use tetrascope_colors::{ColorMap, MapOrigin, Opacity, all_names, opacity_names, read_presets};

use crate::Failure;
use crate::report::{line, object, warning};
use swatch::{Paint, curve, hexadecimal};

const EXAMPLES: &str = "\
Examples:
  tetrascope colormaps                     all of them, with swatches where the terminal has colors
  tetrascope colormaps blue                those with this in their name
  tetrascope colormaps saved.json          those in a file that ParaView saved, .json or .xml
  tetrascope colormaps --json > maps.json  names and colors for other programs

Each is also known with _r behind its name, backwards. A name that matplotlib and ParaView both have is matplotlib's; paraview:NAME and
matplotlib:NAME say which is meant. Colors are shown as COLORTERM, NO_COLOR, CLICOLOR and CLICOLOR_FORCE ask for.

Exit codes: 0 good, 1 wrong input, or no such name, 2 wrong usage.";

/// List the color maps and opacity curves that have names, with swatches.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ColormapsArgs {
    /// Part of a name, in any case; or a file of ParaView's presets (.json, .xml), whose maps are listed
    #[arg(value_name = "PATTERN|FILE")]
    pub(crate) wanted: Option<String>,
    /// Report on standard output as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Where colors and opacities are told for machines.
const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Maps of one origin.
struct Group {
    /// What stands above them, for people.
    title: String,
    /// What machines hear.
    origin: String,
    maps: Vec<Named>,
}

/// A map under the name that it is asked for with.
struct Named {
    name: String,
    map: ColorMap,
}

pub(crate) fn run(args: &ColormapsArgs) -> Result<(), Failure> {
    let (groups, opacities) = match &args.wanted {
        Some(file) if is_preset(file) => (vec![of_file(Path::new(file))?], Vec::new()),
        pattern => of_names(pattern.as_deref())?,
    };
    if args.json {
        object(&as_json(&groups, &opacities));
        return Ok(());
    }
    let paint = Paint::of_standard_output();
    let width = groups.iter().flat_map(|group| &group.maps).map(|named| named.name.chars().count());
    let width = width.chain(opacities.iter().map(|opacity| opacity.name().chars().count())).max().unwrap_or_default();
    let mut is_first = true;
    let mut title = |text: &str| {
        if !std::mem::take(&mut is_first) {
            line("");
        }
        line(text);
    };
    for group in groups.iter().filter(|group| !group.maps.is_empty()) {
        title(&group.title);
        for Named { name, map } in &group.maps {
            match paint.swatch(map) {
                Some(swatch) => line(&format!("  {name:<width$}  {swatch}")),
                None => line(&format!("  {name}")),
            }
        }
    }
    if !opacities.is_empty() {
        title("opacity (PyVista's names)");
        for opacity in &opacities {
            line(&format!("  {:<width$}  {}", opacity.name(), curve(opacity)));
        }
    }
    Ok(())
}

/// Whether a word names a file of presets, by its extension.
fn is_preset(word: &str) -> bool {
    Path::new(word).extension().is_some_and(|e| e.eq_ignore_ascii_case("json") || e.eq_ignore_ascii_case("xml"))
}

fn of_file(path: &Path) -> Result<Group, Failure> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path)
        .map_err(|error| Failure::Input(format!("{name}: cannot be read: {error}; check the path")))?;
    let presets = read_presets(&name, &bytes).map_err(|error| Failure::Input(error.to_string()))?;
    presets.warnings().iter().for_each(|text| warning(text));
    let named = |map: &ColorMap| Named { name: map.name().to_owned(), map: map.clone() };
    Ok(Group { title: name.clone(), origin: name, maps: presets.maps().iter().map(named).collect() })
}

/// All that have names, or those with `pattern` in it.
fn of_names(pattern: Option<&str>) -> Result<(Vec<Group>, Vec<Opacity>), Failure> {
    let pattern = pattern.map(str::to_lowercase);
    let is_wanted = |name: &str| pattern.as_ref().is_none_or(|pattern| name.to_lowercase().contains(pattern));
    let failed = |error: tetrascope_colors::ColorError| Failure::Input(error.to_string());
    let mut groups = Vec::new();
    for (origin, title) in [(MapOrigin::Matplotlib, "matplotlib"), (MapOrigin::ParaView, "ParaView")] {
        let mut maps = Vec::new();
        for named in all_names().into_iter().filter(|named| named.origin == origin && is_wanted(named.name)) {
            maps.push(Named { name: named.name.to_owned(), map: named.map().map_err(failed)? });
        }
        groups.push(Group { title: title.to_owned(), origin: origin.prefix().to_owned(), maps });
    }
    let mut opacities = Vec::new();
    for name in opacity_names().into_iter().filter(|name| is_wanted(name)) {
        opacities.push(Opacity::named(&name).map_err(failed)?);
    }
    let count = groups.iter().map(|group| group.maps.len()).sum::<usize>() + opacities.len();
    match pattern {
        Some(pattern) if count == 0 => Err(Failure::Input(format!(
            "no color map has `{pattern}` in its name; `tetrascope colormaps` lists all, and a file of presets ends in .json or .xml"
        ))),
        _ => Ok((groups, opacities)),
    }
}

fn as_json(groups: &[Group], opacities: &[Opacity]) -> Value {
    let map = |group: &Group, named: &Named| {
        let map = &named.map;
        json!({ "name": named.name, "origin": group.origin,
            "colors": PLACES.map(|place| hexadecimal(map.color_at(place))),
            "nan_color": map.nan_color().map(hexadecimal),
            "opacity": map.opacity().map(|opacity| PLACES.map(|place| opacity.at(place))) })
    };
    let maps: Vec<Value> =
        groups.iter().flat_map(|group| group.maps.iter().map(move |named| map(group, named))).collect();
    let opacity =
        |opacity: &Opacity| json!({ "name": opacity.name(), "values": PLACES.map(|place| opacity.at(place)) });
    json!({ "places": PLACES, "colormaps": maps, "opacities": opacities.iter().map(opacity).collect::<Vec<_>>() })
}
