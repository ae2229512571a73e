//! Color map files drawn through the whole renderer, beside the colors that VTK computes of them.

use std::fmt::Write;
use std::path::Path;

use serde_json::Value;
use tetrascope::{
    ArrayValues, CellKind, Cells, ColorMap, DataArray, Dataset, LinearImage, SceneFile, Silent, UnstructuredCells,
    Volume, read_preset, read_presets, render_volume,
};

/// Colors of VTK at 41 places of each preset, kept with the color maps.
const KNOWN: &str = include_str!("../../crates/colors/data/known/spaces.json");

/// From one place to the next.
const PITCH: f64 = 1.0 / 40.0;

/// A preset as a file, drawn.
#[derive(Debug)]
pub struct DrawnPreset {
    /// The preset's name with its color space.
    pub name: String,
    /// The file's kind: json or xml.
    pub kind: &'static str,
    /// One scalar a column, 0 to 1 from the middle of the first place's columns to the middle of the last one's; opaque.
    pub picture: LinearImage,
    /// sRGB, 0 to 1, at 41 places.
    pub known: Vec<[f64; 3]>,
    /// How far VTK itself is from the colors that the file defines, sRGB: it rounds along one kind of paths to 8 bits.
    pub rounding: f64,
    /// Places where the preset steps: which side a pixel takes there rounding decides.
    pub steps: Vec<usize>,
}

/// Draws every preset of which VTK's colors are known: as JSON, and as XML what that can say.
///
/// - `columns`: of the picture for each of the 41 places; odd numbers have a column in the middle of each
/// - `folder`: where the files are written
pub fn draw_presets(folder: &Path, columns: u32, height: u32) -> Vec<DrawnPreset> {
    let known: Vec<Value> = serde_json::from_str(KNOWN).expect("the known colors are JSON");
    let volume = Volume::from_dataset(slab(), "a slab").expect("a slab has a volume");
    let mut drawn = Vec::new();
    for (number, entry) in known.iter().enumerate() {
        let preset = &entry["preset"];
        for kind in ["json", "xml"] {
            let text = match kind {
                "json" => Value::Array(vec![preset.clone()]).to_string(),
                // The old files have no word for hues that go the other way around.
                _ if preset["HSVWrap"] == 1 => continue,
                _ => xml(preset),
            };
            let path = folder.join(format!("preset-{number}.{kind}"));
            let map = read_presets(kind, text.as_bytes())
                .and_then(|presets| presets.choose(None))
                .expect("the preset is one");
            std::fs::write(&path, text).expect("the folder takes files");
            drawn.push(DrawnPreset {
                name: preset["Name"].as_str().unwrap_or_default().to_owned(),
                kind,
                picture: strip(&volume, &path, columns, height),
                known: numbers(&entry["colors"]).as_chunks::<3>().0.to_vec(),
                rounding: if preset["ColorSpace"] == "Lab/CIEDE2000" { 0.51 / 255.0 } else { 2e-6 },
                steps: steps(&map),
            });
        }
    }
    drawn
}

/// A box in which the field is x, half a pitch longer than 0 to 1 at both ends.
fn slab() -> Dataset {
    let ends = [-0.5 * PITCH, 1.0 + 0.5 * PITCH];
    let points: Vec<glam::DVec3> = (0..8_usize)
        .map(|corner| glam::DVec3::new(ends[corner & 1], (corner >> 1 & 1) as f64, (corner >> 2) as f64))
        .collect();
    let values = ArrayValues::F64(points.iter().map(|point| point.x).collect());
    let cells = UnstructuredCells {
        kinds: vec![CellKind::Voxel],
        offsets: vec![0, 8],
        connectivity: (0..8).collect(),
        polyhedra: Vec::new(),
    };
    let array = DataArray { name: "x".to_owned(), components: 1, values };
    Dataset { points, cells: Cells::Unstructured(cells), point_arrays: vec![array], cell_arrays: Vec::new() }
}

/// The slab seen along z, so dense that nothing shines through it.
fn strip(volume: &Volume, preset: &Path, columns: u32, height: u32) -> LinearImage {
    let view_height = (1.0 + PITCH) * f64::from(height) / f64::from(41 * columns);
    let text = format!(
        "[mesh]\npath = \"slab\"\n[image]\nwidth = {}\nheight = {height}\n[camera]\nprojection = \"orthographic\"\n\
         eye = [0.5, 0.5, 9.0]\ntarget = [0.5, 0.5, 0.5]\nup = [0.0, 1.0, 0.0]\nheight = {view_height:?}\n\
         [transfer]\nrange = [0.0, 1.0]\nextinction = [[0.0, 1e4]]\n",
        41 * columns
    );
    let mut scene = SceneFile::parse(&text, "strip.toml".as_ref()).expect("the scene is one");
    scene.transfer.preset = Some(preset.to_owned());
    read_preset(&mut scene, "".as_ref()).expect("the preset is one");
    render_volume(volume, &scene, &Silent).expect("the slab is drawn").image
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
}

/// The same preset as older programs save it.
fn xml(preset: &Value) -> String {
    let text = |key: &str| preset[key].as_str().unwrap_or_default().to_owned();
    let mut xml = format!("<ColorMaps><ColorMap name=\"{}\" space=\"{}\">", text("Name"), text("ColorSpace"));
    for [x, r, g, b] in numbers(&preset["RGBPoints"]).as_chunks::<4>().0 {
        // Writing into a string does not fail.
        let _ = write!(xml, "<Point x=\"{x:?}\" o=\"1\" r=\"{r:?}\" g=\"{g:?}\" b=\"{b:?}\"/>");
    }
    xml + "</ColorMap></ColorMaps>"
}

/// Places at which a map jumps: those of two points, those where a map of steps takes the next color, and ends that a path between colors does
/// not reach.
fn steps(map: &ColorMap) -> Vec<usize> {
    let differ = |a: [f64; 3], b: [f64; 3]| a.into_iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-3);
    let ends = [map.points().first(), map.points().last()].map(|point| point.map_or([0.0; 3], |point| point.rgb));
    let jumps = |place: &usize| {
        let x = *place as f64 * PITCH;
        // Beyond the ends there are the outermost colors.
        let below = if *place == 0 { ends[0] } else { map.color_at(x - 1e-9) };
        let above = if *place == 40 { ends[1] } else { map.color_at(x + 1e-9) };
        differ(below, above) || differ(below, map.color_at(x))
    };
    (0..=40).filter(jumps).collect()
}
