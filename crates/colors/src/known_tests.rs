//! Colors that other programs compute: VTK 9.7 for ParaView's presets and spaces, matplotlib 3.11 and PyVista 0.49 for their names.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::preset_json::Preset;
use crate::{ColorMap, ColorSpace, MapOrigin, NamedMap, Opacity, OpacityPoint, all_names, opacity_names};

/// Half of what six digits keep, and what differs between the orders of operations.
const DIGITS: f64 = 2e-6;

type Table = BTreeMap<String, Vec<f64>>;

fn largest_difference(map: &ColorMap, places: impl Iterator<Item = f64>, known: &[f64]) -> f64 {
    let colors = known.as_chunks::<3>().0;
    let places: Vec<_> = places.collect();
    assert_eq!(places.len(), colors.len());
    (places.iter().zip(colors))
        .flat_map(|(&x, color)| map.color_at(x).into_iter().zip(*color))
        .fold(0.0, |largest, (ours, theirs)| f64::max(largest, (ours - theirs).abs()))
}

#[derive(Deserialize)]
struct Known {
    preset: Preset,
    colors: Vec<f64>,
}

#[test]
fn spaces_are_mixed_as_vtk_mixes_them() {
    let known: Vec<Known> = serde_json::from_str(include_str!("../data/known/spaces.json")).unwrap();
    assert_eq!(known.len(), 64);
    for Known { preset, colors } in known {
        let (map, _) = preset.map("known").unwrap();
        let places = (0..=40).map(|i| f64::from(i) / 40.0);
        let difference = largest_difference(&map, places, &colors);
        // VTK rounds colors along these paths to 8 bits.
        let limit = if map.space() == ColorSpace::LabCiede2000 { 0.51 / 255.0 } else { DIGITS };
        assert!(difference <= limit, "{}: {difference} ({} gray levels)", map.name(), difference * 255.0);
    }
}

#[test]
fn presets_of_paraview_are_those_of_vtk() {
    let mut known: Table = serde_json::from_str(include_str!("../data/known/paraview.json")).unwrap();
    let places = known.remove("x").unwrap();
    assert_eq!(known.len(), 141);
    for (name, colors) in known {
        let map = ColorMap::named(&format!("ParaView:{name}")).unwrap();
        assert_eq!(map.name(), name);
        let difference = largest_difference(&map, places.iter().copied(), &colors);
        assert!(difference <= DIGITS, "{name}: {difference}");
    }
}

#[test]
fn maps_of_matplotlib_are_its_entries() {
    let mut known: Table = serde_json::from_str(include_str!("../data/known/matplotlib.json")).unwrap();
    let entries = known.remove("index").unwrap();
    let names: Vec<_> = all_names().into_iter().filter(|named| named.origin == MapOrigin::Matplotlib).collect();
    assert_eq!(names.len(), 78);
    for NamedMap { name, .. } in names {
        let map = ColorMap::named(name).unwrap();
        // The tables of 510 colors were asked for every other entry.
        let place =
            |entry: &f64| if name.starts_with("twilight") { (2.0 * entry).min(509.0) / 509.0 } else { entry / 255.0 };
        let difference = largest_difference(&map, entries.iter().map(place), &known[name]);
        // Tables are kept with 16 bits.
        assert!(difference <= 1e-5, "{name}: {difference}");
        let backwards = ColorMap::named(&format!("{name}_r")).unwrap();
        let difference = largest_difference(&backwards, entries.iter().map(|entry| 1.0 - place(entry)), &known[name]);
        assert!(difference <= 1e-5 || name == "gist_stern" || name == "gist_ncar", "{name}_r: {difference}");
    }
}

#[test]
fn opacity_points_are_led_as_vtk_leads_them() {
    #[derive(Deserialize)]
    struct Known {
        #[serde(rename = "Points")]
        points: Vec<f64>,
        opacity: Vec<f64>,
    }
    let known: Vec<Known> = serde_json::from_str(include_str!("../data/known/opacity.json")).unwrap();
    for (number, Known { points, opacity }) in known.into_iter().enumerate() {
        let points = points.as_chunks::<4>().0.iter();
        let points: Vec<_> =
            points.map(|&[x, opacity, midpoint, sharpness]| OpacityPoint { x, opacity, midpoint, sharpness }).collect();
        let curve = Opacity::new(&points).unwrap();
        assert_eq!(opacity.len(), 41);
        for (i, known) in (0..=40).zip(opacity) {
            let ours = curve.at(f64::from(i) / 40.0);
            assert!((ours - known).abs() <= DIGITS, "curve {number} at {i}/40: {ours}, not {known}");
        }
    }
}

#[test]
fn opacities_of_pyvista_are_its_bytes() {
    let mut known: Table = serde_json::from_str(include_str!("../data/known/pyvista.json")).unwrap();
    let entries = known.remove("index").unwrap();
    assert!(known.len() > 20);
    for (name, bytes) in known {
        let curve = Opacity::named(&name).unwrap();
        assert_eq!(curve.name(), name);
        for (entry, byte) in entries.iter().zip(bytes) {
            // PyVista cuts the fraction off.
            let ours = 255.0 * curve.at(entry / 255.0);
            assert!((byte - 1e-6..=byte + 1.0 + 1e-6).contains(&ours), "{name}, entry {entry}: {ours}, not {byte}");
        }
    }
    for name in opacity_names() {
        assert_eq!(Opacity::named(&name).unwrap().name(), name);
    }
}
