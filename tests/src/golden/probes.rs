//! Some pixels of a picture as text, so that a change can be read without an image viewer.

use std::fmt::Write;

use tetrascope::LinearImage;

/// One pixel by its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Column.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Linear, premultiplied.
    pub rgba: [f32; 4],
}

/// The middle of the picture and eight places around it.
pub fn probe(image: &LinearImage) -> Vec<Probe> {
    let places = |side: u32| [side / 4, side / 2, side * 3 / 4];
    let mut probes = Vec::new();
    for y in places(image.height()) {
        for x in places(image.width()) {
            probes.push(Probe { x, y, rgba: image.pixel(x, y) });
        }
    }
    probes
}

/// Those pixels as text; every number reads back to the same float.
pub fn print_probes(image: &LinearImage) -> String {
    let mut text = String::from("# column row   R G B A, linear, premultiplied\n");
    for Probe { x, y, rgba: [r, g, b, a] } in probe(image) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{x} {y}   {r:?} {g:?} {b:?} {a:?}");
    }
    text
}

/// Reads what [`print_probes`] writes.
///
/// # Errors
/// In words, with the line that is no probe.
pub fn parse_probes(text: &str) -> Result<Vec<Probe>, String> {
    let mut probes = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.trim_start().starts_with('#') || line.trim().is_empty() {
            continue;
        }
        let wrong = || format!("line {}: \"{line}\" is not a column, a row and four numbers", index + 1);
        let words: Vec<&str> = line.split_whitespace().collect();
        let [x, y, channels @ ..] = words.as_slice() else { return Err(wrong()) };
        let channels: Vec<f32> = channels.iter().filter_map(|word| word.parse().ok()).collect();
        let rgba = <[f32; 4]>::try_from(channels).map_err(|_| wrong())?;
        if words.len() != 6 {
            return Err(wrong());
        }
        probes.push(Probe { x: x.parse().map_err(|_| wrong())?, y: y.parse().map_err(|_| wrong())?, rgba });
    }
    Ok(probes)
}
