//! Presets as ParaView saved them before version 4.4, and as many collections of color maps still have them: `ColorMap` elements in XML.
//!
//! Elements are pulled one after another and nothing recurses. Entities beyond those of XML itself are not expanded, and no other file is
//! opened.

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;
use serde::de::IgnoredAny;

use crate::ColorError;
use crate::error::shown;
use crate::preset_json::Preset;

/// What can be done about a file that is not XML.
const DAMAGED: &str = "export the preset again";

/// The presets of a file, none of them checked.
///
/// # Errors
///
/// What is not well-formed, a point without a channel, an attribute that is not a number; with the line.
pub(crate) fn parse(file: &str, bytes: &[u8]) -> Result<Vec<Preset>, ColorError> {
    let mut reader = Reader::from_reader(bytes);
    // An empty element then looks like one with nothing in it.
    reader.config_mut().expand_empty_elements = true;
    let mut presets: Vec<Drawn> = Vec::new();
    // Whether points that come now belong to the last preset.
    let mut inside = false;
    loop {
        let start = usize::try_from(reader.buffer_position()).unwrap_or(bytes.len());
        let place = Place { file, bytes, start };
        let event = reader.read_event().map_err(|error| {
            let start = usize::try_from(reader.error_position()).unwrap_or(start);
            Place { start, ..place }.invalid(&format!("not well-formed XML: {error}"))
        })?;
        match event {
            Event::Start(element) if element.name().as_ref() == "ColorMap" => {
                presets.push(Drawn::begin(place, &element)?);
                inside = true;
            }
            Event::Start(element) if inside => {
                if let Some(preset) = presets.last_mut() {
                    preset.add(place, &element)?;
                }
            }
            Event::End(element) if element.name().as_ref() == "ColorMap" => inside = false,
            Event::Eof if inside => return Err(place.invalid("the file ends inside of a ColorMap")),
            Event::Eof => break,
            _ => {}
        }
    }
    Ok(presets.into_iter().map(Drawn::preset).collect())
}

/// A preset while its points come.
#[derive(Debug, Default)]
struct Drawn {
    preset: Preset,
    categories: bool,
    colors: Vec<f64>,
    opacities: Vec<f64>,
    /// Whether any point is not opaque: a file without opacities of its own has 1 everywhere.
    has_opacity: bool,
}

impl Drawn {
    fn begin(place: Place<'_>, element: &BytesStart<'_>) -> Result<Self, ColorError> {
        let mut drawn = Self::default();
        for (key, value) in place.attributes(element)? {
            match key.as_str() {
                "name" => drawn.preset.name = Some(value),
                // ParaView keeps the space that it has where a file says nothing; here that is RGB.
                "space" if value != "NoChange" => drawn.preset.color_space = Some(value),
                "indexedLookup" => drawn.categories = matches!(value.trim(), "1" | "true"),
                _ => {}
            }
        }
        Ok(drawn)
    }

    fn add(&mut self, place: Place<'_>, element: &BytesStart<'_>) -> Result<(), ColorError> {
        let name = element.name();
        let (is_point, is_nan) = (name.as_ref() == "Point", name.as_ref() == "NaN");
        if !is_point && !is_nan {
            return Ok(());
        }
        let [mut x, mut o, mut r, mut g, mut b] = [None; 5];
        for (key, value) in place.attributes(element)? {
            let number = match key.as_str() {
                "x" => &mut x,
                "o" => &mut o,
                "r" => &mut r,
                "g" => &mut g,
                "b" => &mut b,
                _ => continue,
            };
            *number = Some(value.trim().parse::<f64>().map_err(|_| {
                place.invalid(&format!("the attribute `{key}` is \"{}\", not a number", shown(&value)))
            })?);
        }
        let channel = |value: Option<f64>, key: &str| {
            value.ok_or_else(|| place.invalid(&format!("a color without the attribute `{key}`")))
        };
        let rgb = [channel(r, "r")?, channel(g, "g")?, channel(b, "b")?];
        if is_nan {
            self.preset.nan_color = Some(rgb.to_vec());
        } else if !self.categories {
            let x = channel(x, "x")?;
            let opacity = o.unwrap_or(1.0);
            self.colors.extend([x, rgb[0], rgb[1], rgb[2]]);
            self.opacities.extend([x, opacity, 0.5, 0.0]);
            self.has_opacity |= opacity != 1.0;
        }
        Ok(())
    }

    fn preset(self) -> Preset {
        let mut preset = self.preset;
        if self.categories {
            preset.indexed_colors = Some(IgnoredAny);
        } else {
            preset.rgb_points = Some(self.colors);
            preset.points = self.has_opacity.then_some(self.opacities);
        }
        preset
    }
}

/// A place in a file, for messages.
#[derive(Clone, Copy)]
struct Place<'a> {
    file: &'a str,
    bytes: &'a [u8],
    start: usize,
}

impl Place<'_> {
    /// The error at this place. It counts lines, so that it is for errors alone.
    fn invalid(self, problem: &str) -> ColorError {
        let before = self.bytes.get(..self.start).unwrap_or(self.bytes);
        ColorError::Invalid {
            file: self.file.to_owned(),
            place: format!("line {}", 1 + before.iter().filter(|&&byte| byte == b'\n').count()),
            problem: shown(problem),
            remedy: DAMAGED.to_owned(),
        }
    }

    /// Names and values; the last one of a name counts.
    fn attributes(self, element: &BytesStart<'_>) -> Result<Vec<(String, String)>, ColorError> {
        let mut attributes = Vec::new();
        // Without the check for repeated names, whose time grows with the square of their number.
        for attribute in element.attributes().with_checks(false) {
            let attribute = attribute.map_err(|error| self.invalid(&format!("broken attribute: {error}")))?;
            let value = attribute
                .normalized_value(XmlVersion::Implicit1_0)
                .map_err(|error| self.invalid(&format!("an attribute cannot be read: {error}")))?;
            attributes.push((attribute.key.as_ref().to_owned(), value.into_owned()));
        }
        Ok(attributes)
    }
}
