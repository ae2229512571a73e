//! Color map files of every kind as they are drawn, above the colors that VTK computes of them.

use tetrascope::LinearImage;
use tetrascope::colors::linear_from_srgb;
use tetrascope_tests::presets::{DrawnPreset, draw_presets};

use super::sheet::grid;
use crate::Failure;

/// Columns of a place: odd, so that one is in the middle.
const COLUMNS: u32 = 7;

/// Rows of a strip.
const HEIGHT: u32 = 14;

/// The first preset of each color space, as JSON on the left and as XML on the right.
pub(super) fn sheet() -> Result<LinearImage, Failure> {
    let folder = tempfile::tempdir()?;
    let drawn = draw_presets(folder.path(), COLUMNS, HEIGHT);
    let mut rows = Vec::new();
    for shown in ["primaries", "random 1"] {
        for json in drawn.iter().filter(|preset| preset.kind == "json" && preset.name.starts_with(shown)) {
            let xml = drawn.iter().find(|preset| preset.kind == "xml" && preset.name == json.name);
            let pair: Vec<&DrawnPreset> = [json].into_iter().chain(xml).collect();
            rows.push(pair.iter().map(|preset| preset.picture.clone()).collect());
            rows.push(pair.iter().map(|preset| known(preset)).collect());
        }
    }
    Ok(grid(&rows))
}

/// A block of VTK's color for each place.
fn known(preset: &DrawnPreset) -> LinearImage {
    let mut strip = LinearImage::transparent(preset.picture.width(), HEIGHT);
    for (index, pixel) in strip.pixels_mut().iter_mut().enumerate() {
        let column = index as u32 % preset.picture.width();
        let color = preset.known.get((column / COLUMNS) as usize).copied().unwrap_or_default();
        let [r, g, b] = color.map(|channel| linear_from_srgb(channel) as f32);
        *pixel = [r, g, b, 1.0];
    }
    strip
}
