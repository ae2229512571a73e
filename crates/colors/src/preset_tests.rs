//! Files of presets: kinds, variants, and damage.

use crate::{ColorMap, ColorSpace, Presets, read_presets};

fn read(text: &str) -> Presets {
    read_presets("file", text.as_bytes()).unwrap()
}

fn message(text: &str) -> String {
    read_presets("the file", text.as_bytes()).unwrap_err().to_string()
}

const JSON: &str = r#"[
  {"Name": "first", "ColorSpace": "Lab", "Creator": "someone", "NanColor": [1, 1, 0],
   "RGBPoints": [-1, 0, 0, 0, 0, 1, 0.5, 0.25, 3, 1, 1, 1],
   "Points": [-1, 0, 0.5, 0, 3, 1, 0.25, 0.5]},
  {"Name": "second", "ColorSpace": "HSV", "HSVWrap": 1, "RGBPoints": [0, 0, 0, 1, 1, 1, 0, 0]}
]"#;

const XML: &str = r#"<?xml version="1.0"?>
<!-- maps -->
<ColorMaps>
  <ColorMap name="first" space="Lab" indexedLookup="false">
    <Point x="-1" o="0" r="0" g="0" b="0"/>
    <Point x="0" o="0.5" r="1" g="0.5" b="0.25"></Point>
    <Other r="7"/>
    <Point x="3" o="1" r="1" g="1" b="1"/>
    <NaN r="1" g="1" b="0"/>
  </ColorMap>
  <ColorMap space="Wrapped" name="a &lt; b &#x26; c"><Point x="0" r="0" g="0" b="1"/><Point x="1" r="1" g="0" b="0"/></ColorMap>
  <Point x="nothing"/>
</ColorMaps>"#;

#[test]
fn json_with_everything() {
    let presets = read(JSON);
    assert!(presets.warnings().is_empty());
    let [first, second] = presets.maps() else { panic!("{presets:?}") };
    assert_eq!((first.name(), first.space(), first.nan_color()), ("first", ColorSpace::Lab, Some([1.0, 1.0, 0.0])));
    assert_eq!(first.points().iter().map(|point| point.x).collect::<Vec<_>>(), [0.0, 0.25, 1.0]);
    let opacity = first.opacity().unwrap();
    assert_eq!((opacity.at(0.0), opacity.at(0.5), opacity.at(1.0)), (0.0, 0.5, 1.0));
    assert_eq!((second.space(), second.nan_color(), second.opacity()), (ColorSpace::Hsv { wrap: true }, None, None));
    // By way of magenta, since hue may cross red.
    let [r, g, b] = second.color_at(0.5);
    assert!((r - 1.0).abs() < 1e-9 && g.abs() < 1e-9 && (b - 1.0).abs() < 1e-9);

    let turned = first.reversed();
    assert_eq!((turned.opacity().unwrap().at(0.0), turned.opacity().unwrap().at(1.0)), (1.0, 0.0));
}

#[test]
fn xml_with_everything() {
    let presets = read(XML);
    assert!(presets.warnings().is_empty(), "{:?}", presets.warnings());
    let [first, second] = presets.maps() else { panic!("{presets:?}") };
    let json = read(JSON);
    assert_eq!((first.points(), first.space()), (json.maps()[0].points(), ColorSpace::Lab));
    assert_eq!(first.nan_color(), Some([1.0, 1.0, 0.0]));
    assert_eq!(first.opacity().unwrap().at(0.25), 0.5);
    assert_eq!((second.name(), second.space(), second.opacity()), ("a < b & c", ColorSpace::Hsv { wrap: true }, None));
    let single = read("<ColorMap name='m' space='NoChange'><Point x='0' o='1' r='0' g='0' b='1'/></ColorMap>");
    assert_eq!((single.maps()[0].space(), single.maps()[0].color_at(0.7)), (ColorSpace::Rgb, [0.0, 0.0, 1.0]));
    assert_eq!(single.maps()[0].opacity(), None);
}

#[test]
fn spaces_by_their_names() {
    for (name, space) in [
        ("RGB", ColorSpace::Rgb),
        ("HSV", ColorSpace::Hsv { wrap: false }),
        ("Lab", ColorSpace::Lab),
        ("CIELAB", ColorSpace::Lab),
        ("Diverging", ColorSpace::Diverging),
        ("Lab/CIEDE2000", ColorSpace::LabCiede2000),
        ("Prolab", ColorSpace::Prolab),
        ("step", ColorSpace::Step),
    ] {
        let text = format!(r#"{{"ColorSpace": "{name}", "RGBPoints": [0,0,0,0, 1,1,1,1]}}"#);
        assert_eq!(read(&text).maps()[0].space(), space);
        assert_eq!(read(&text).maps()[0].name(), "unnamed preset");
    }
    assert_eq!(read(r#"{"RGBPoints": [0,0,0,0]}"#).maps()[0].space(), ColorSpace::Rgb);
    let wrong = message(r#"{"Name": "n", "ColorSpace": "YUV", "RGBPoints": [0,0,0,0]}"#);
    assert_eq!(
        wrong,
        "the file: the color space \"YUV\" of preset \"n\" is not supported; save the preset in RGB, HSV, Lab, Diverging, Lab/CIEDE2000, \
         Prolab or Step"
    );
}

#[test]
fn a_logarithmic_scale_is_spread_evenly() {
    let text = r#"{"UseLogScale": true, "RGBPoints": [0.01,0,0,0, 1,0.5,0.5,0.5, 100,1,1,1], "Points": []}"#;
    assert_eq!(read(text).maps()[0].points()[1].x, 0.5);
    assert!(
        message(&text.replace("0.01", "0"))
            .contains("color point 1: its position is 0, and the preset's scale is logarithmic")
    );
}

#[test]
fn choosing() {
    let presets = read(JSON);
    assert_eq!(presets.choose(Some("second")).unwrap().name(), "second");
    assert_eq!(presets.choose(Some("FIRST")).unwrap().name(), "first");
    assert_eq!(presets.choose(Some("first_r")).unwrap().name(), "first_r");
    let error = presets.choose(None).unwrap_err().to_string();
    assert_eq!(
        error,
        "file: presets: the file has 2 color maps, and none was chosen; choose one of \"first\", \"second\""
    );
    let error = presets.choose(Some("third")).unwrap_err().to_string();
    assert_eq!(error, "no preset of file is called \"third\"; it has \"first\", \"second\"");
    assert_eq!(read(r#"{"Name": "m", "RGBPoints": [0,0,0,0]}"#).choose(None).unwrap().name(), "m");
}

#[test]
fn odd_presets_are_warnings_beside_good_ones() {
    let text = r#"[{"Name": "categories", "IndexedColors": [1, 0, 0]}, {"Name": "both", "IndexedColors": [1, 0, 0], "RGBPoints": [0,0,0,0]},
        {"Name": "odd", "RGBPoints": [0,0,0]}]"#;
    let presets = read(text);
    assert_eq!(presets.maps().iter().map(ColorMap::name).collect::<Vec<_>>(), ["both"]);
    assert_eq!(
        presets.warnings(),
        [
            "left out: file: preset \"categories\", which has colors for categories alone, is not supported; choose a preset with colors along a \
             range (RGBPoints)",
            "file: preset \"both\" has colors for categories too; those along its range are taken",
            "left out: file: preset \"odd\", RGBPoints: 3 numbers, which are no multiple of 4; save the preset again",
        ]
    );
    let many = format!("[{}{{\"RGBPoints\": [0,0,0,0]}}]", "{},".repeat(1000));
    let presets = read(&many);
    assert_eq!((presets.maps().len(), presets.warnings().len()), (1, 17));
    assert!(presets.warnings()[16].contains("984 more presets"));
}

#[test]
fn damaged_presets() {
    for (text, part) in [
        ("", "nothing in it"),
        ("  \n", "nothing in it"),
        ("hello", "neither JSON nor XML"),
        ("[]", "there is no color map in it"),
        ("<a/>", "there is no color map in it"),
        ("[{]", "line 1, column 3: not a preset in JSON: key must be a string; export"),
        (
            "[\n{\"RGBPoints\": [0, \"x\"]}]",
            "line 2, column 21: not a preset in JSON: invalid type: string \"x\", expected f64",
        ),
        ("{\"RGBPoints\": [1e999, 0, 0, 0]}", "number out of range"),
        ("{\"Name\": \"n\"}", "preset \"n\": it has no colors (RGBPoints)"),
        ("{\"RGBPoints\": []}", "it has no color point"),
        ("{\"Name\": \"n\", \"Points\": [0,0,0,0]}", "it has opacities alone"),
        ("{\"RGBPoints\": [0,0,0,0], \"NanColor\": [1]}", "NanColor: 1 numbers, not 3"),
        ("{\"RGBPoints\": [0,0,0,0], \"Points\": [0,2,0.5,0]}", "opacity point 1: the opacity is 2"),
        ("{\"RGBPoints\": [0,0,0,0], \"Points\": [0,0,-1,0]}", "opacity point 1: the midpoint is -1"),
        ("{\"RGBPoints\": [0,0,0,0, 0,1,1,1]}", "all 2 color points lie at 0"),
        ("<ColorMap><Point x='0' r='1' g='0'/></ColorMap>", "line 1: a color without the attribute `b`"),
        (
            "<ColorMap>\n<Point x='zero' r='1' g='0' b='0'/></ColorMap>",
            "line 2: the attribute `x` is \"zero\", not a number",
        ),
        ("<ColorMap>\n<Point x='nan' r='1' g='0' b='0'/></ColorMap>", "color point 1: its position is NaN"),
        ("<ColorMap>\n<Point x='0' r='1' g='0' b='0'/>", "ends inside of a ColorMap"),
        ("<ColorMap></Wrong>", "not well-formed XML"),
        ("<ColorMap name='&bomb;'/>", "an attribute cannot be read"),
        ("<ColorMap name='n' indexedLookup='true'><Point r='1' g='0' b='0'/></ColorMap>", "categories alone"),
        ("<ColorMap name='n'/>", "preset \"n\": it has no color point"),
    ] {
        assert!(message(text).starts_with("the file: "), "{text}: {}", message(text));
        assert!(message(text).contains(part), "{text}: {}", message(text));
        assert!(message(text).contains("; "), "{}", message(text));
    }
    let deep = "[".repeat(100_000);
    assert!(message(&deep).contains("not a preset in JSON"), "{}", message(&deep));
    let deep = format!("{{\"Groups\": {deep}");
    assert!(message(&deep).contains("not a preset in JSON"), "{}", message(&deep));
    assert!(message(&format!("{}x", "<a>".repeat(100_000))).contains("no color map in it"));
    let control = message("{\"Name\": \"\\u001b[31m\"}");
    assert!(control.contains('\u{fffd}') && !control.contains('\u{1b}'));
    let long = message(&format!("{{\"Name\": \"{}\"}}", "n".repeat(100_000)));
    assert!(long.len() < 500, "{long}");
    assert_eq!(read("{\"Name\": \"\\u001bx\", \"RGBPoints\": [0,0,0,0]}").maps()[0].name(), "\u{fffd}x");
}

#[test]
fn a_mark_before_the_text_is_skipped() {
    assert_eq!(read(&format!("\u{feff}{JSON}")), read(JSON));
    assert_eq!(read(&format!("\u{feff} \n{}", &XML[22..])), read(XML));
}

/// Whatever the bytes: a map that holds what it promises, or an error that names the file and a remedy.
fn check_any(bytes: &[u8]) -> bool {
    match read_presets("the file", bytes) {
        Ok(presets) => {
            for map in presets.maps() {
                let points = map.linear_points(0.0, 1.0, 0.01);
                assert!(!points.is_empty() && points.len() < 2000);
                assert!(points.iter().flatten().all(|value| value.is_finite()), "{presets:?}");
                assert!(points.is_sorted_by(|a, b| a[0] <= b[0]));
                let opacities = map.opacity().map(|opacity| opacity.points(0.0, 1.0, 0.01)).unwrap_or_default();
                assert!(opacities.iter().flatten().all(|value| (0.0..=1.0).contains(value)));
            }
            true
        }
        Err(error) => {
            assert!(error.to_string().starts_with("the file: ") && error.to_string().contains("; "), "{error}");
            false
        }
    }
}

#[test]
fn cut_anywhere() {
    for text in [JSON, XML] {
        for end in 0..text.len() {
            // A space behind a map's end is all that may be missing.
            let whole = check_any(&text.as_bytes()[..end]);
            assert!(
                !whole || text[..end].trim_end().ends_with("ColorMap>") || text[..end].contains("</ColorMap>"),
                "{end}"
            );
        }
    }
}

#[test]
fn changed_anywhere() {
    let mut random = fastrand::Rng::with_seed(11);
    let mut good = 0;
    for text in [JSON, XML] {
        for position in 0..text.len() {
            for _ in 0..12 {
                let mut bytes = text.as_bytes().to_vec();
                bytes[position] = match random.u8(0..4) {
                    0 => random.u8(..),
                    1 => b"0123456789-+.eE"[random.usize(..15)],
                    2 => b"[]{}<>/\"':,&; "[random.usize(..14)],
                    _ => bytes[position] ^ (1 << random.u8(0..8)),
                };
                if random.u8(0..4) == 0 {
                    bytes.drain(position..(position + random.usize(0..20)).min(bytes.len()));
                }
                good += usize::from(check_any(&bytes));
            }
        }
    }
    assert!(good > 100, "{good}");
}

#[test]
fn large_files_are_linear() {
    let numbers: Vec<_> = (0..20_000).map(|i| format!("{i},{},0.5,0", f64::from(i % 2))).collect();
    let map = read(&format!(r#"{{"ColorSpace": "Lab", "RGBPoints": [{}]}}"#, numbers.join(","))).choose(None).unwrap();
    assert_eq!(map.points().len(), 20_000);
    // Every one of them is a turn.
    assert!(map.linear_points(0.0, 1.0, 0.01).len() >= 20_000);
    assert!(
        message(&format!(r#"{{"ColorSpace": "Lab/CIEDE2000", "RGBPoints": [{}]}}"#, numbers.join(",")))
            .contains("more than 256")
    );
}
