//! ParaView's presets, as JSON and XML.

use fastrand::Rng;

const SPACES: [&str; 7] = ["RGB", "HSV", "Lab", "CIELAB", "Diverging", "Lab/CIEDE2000", "Step"];

fn positions(rng: &mut Rng) -> Vec<f64> {
    let mut positions: Vec<f64> = (0..rng.usize(2..6)).map(|_| rng.f64() * 10.0 - 5.0).collect();
    positions.sort_by(f64::total_cmp);
    positions
}

pub(super) fn json(rng: &mut Rng) -> Vec<u8> {
    let preset = |rng: &mut Rng| {
        let positions = positions(rng);
        let words = |numbers: Vec<f64>| numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(",\n");
        let colors = positions.iter().flat_map(|&x| [x, rng.f64(), rng.f64(), rng.f64()]).collect();
        let opacities = positions.iter().flat_map(|&x| [x, 0.25, 0.5, 0.0]).collect();
        format!(
            "{{\n\"Name\" : \"a preset\",\n\"ColorSpace\" : \"{}\",\n\"HSVWrap\" : {},\n\"NanColor\" : [ 1, 1, 0 ],\n\
             \"RGBPoints\" : [\n{}\n],\n\"Points\" : [\n{}\n],\n\"UseLogScale\" : 0\n}}",
            SPACES[rng.usize(..6)],
            rng.u8(..2),
            words(colors),
            words(opacities)
        )
    };
    let presets: Vec<String> = (0..rng.usize(1..3)).map(|_| preset(rng)).collect();
    format!("[\n{}\n]\n", presets.join(",\n")).into_bytes()
}

pub(super) fn xml(rng: &mut Rng) -> Vec<u8> {
    let preset = |rng: &mut Rng| {
        let point = |x: f64, rng: &mut Rng| {
            format!(
                "<Point x=\"{x}\" o=\"{}\" r=\"{}\" g=\"{}\" b=\"{}\"/>\n",
                rng.f64(),
                rng.f64(),
                rng.f64(),
                rng.f64()
            )
        };
        let points: String = positions(rng).into_iter().map(|x| point(x, rng)).collect();
        let space = SPACES[rng.usize(..6)];
        format!("<ColorMap name=\"a preset\" space=\"{space}\">\n{points}<NaN r=\"1\" g=\"1\" b=\"0\"/>\n</ColorMap>\n")
    };
    let presets: String = (0..rng.usize(1..3)).map(|_| preset(rng)).collect();
    format!("<?xml version=\"1.0\"?>\n<ColorMaps>\n{presets}</ColorMaps>\n").into_bytes()
}
