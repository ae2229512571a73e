//! Color map files through the whole renderer: every column of the picture has the color that the file defines there.

use tetrascope::colors::{HALF_GRAY_LEVEL, srgb_from_linear};
use tetrascope_tests::presets::draw_presets;

#[test]
fn presets_of_every_kind_are_drawn_within_half_a_gray_level() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = draw_presets(folder.path(), 1, 1);
    assert_eq!(drawn.len(), 64 + 56);
    let (mut largest, mut compared) = (0.0_f64, 0);
    for preset in &drawn {
        assert_eq!((preset.picture.width(), preset.known.len()), (41, 41));
        for (place, (pixel, known)) in preset.picture.pixels().iter().zip(&preset.known).enumerate() {
            if preset.steps.contains(&place) {
                continue;
            }
            compared += 1;
            for (linear, known) in pixel.iter().zip(known) {
                let error = (srgb_from_linear(f64::from(*linear)) - known).abs() - preset.rounding;
                largest = largest.max(error);
                assert!(error <= HALF_GRAY_LEVEL, "{} ({}) at {place}: {error}", preset.name, preset.kind);
            }
        }
    }
    println!("{} presets, {compared} places: at most {:.3} gray levels off", drawn.len(), largest * 255.0);
    assert!(compared > 110 * 41);
}
