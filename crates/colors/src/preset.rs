//! Files of presets.

use crate::error::shown;
use crate::{ColorError, ColorMap, preset_json, preset_xml};

/// Names of a file that a message lists.
const LISTED: usize = 12;

/// Warnings about a file that are kept; the rest is counted.
const WARNINGS: usize = 16;

/// The color maps of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Presets {
    file: String,
    maps: Vec<ColorMap>,
    warnings: Vec<String>,
}

impl Presets {
    /// The maps in the order of the file; at least one.
    pub fn maps(&self) -> &[ColorMap] {
        &self.maps
    }

    /// A sentence on everything that is odd, and on presets that were left out.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The map of a name, with `_r` at its end backwards, in any case where no name is exactly so; without a name the only map of the file.
    ///
    /// # Errors
    ///
    /// A name that the file does not have, or none where it has several maps; the error lists those that are there.
    pub fn choose(&self, name: Option<&str>) -> Result<ColorMap, ColorError> {
        let Some(name) = name else {
            return match self.maps.as_slice() {
                [map] => Ok(map.clone()),
                maps => Err(ColorError::Invalid {
                    file: self.file.clone(),
                    place: "presets".to_owned(),
                    problem: format!("the file has {} color maps, and none was chosen", maps.len()),
                    remedy: format!("choose one of {}", self.names()),
                }),
            };
        };
        let exact = |name: &str| self.maps.iter().find(|map| map.name() == name);
        let any_case = |name: &str| self.maps.iter().find(|map| map.name().eq_ignore_ascii_case(name));
        let backwards = name.strip_suffix("_r");
        exact(name)
            .cloned()
            .or_else(|| backwards.and_then(exact).map(ColorMap::reversed))
            .or_else(|| any_case(name).cloned())
            .or_else(|| backwards.and_then(any_case).map(ColorMap::reversed))
            .ok_or_else(|| ColorError::UnknownName {
                what: format!("preset of {}", self.file),
                name: shown(name),
                remedy: format!("it has {}", self.names()),
            })
    }

    /// The names for a message.
    fn names(&self) -> String {
        let mut names: Vec<_> = self.maps.iter().take(LISTED).map(|map| format!("\"{}\"", shown(map.name()))).collect();
        if self.maps.len() > LISTED {
            names.push(format!("{} more", self.maps.len() - LISTED));
        }
        names.join(", ")
    }
}

/// The color maps of a file that ParaView saved: JSON, or XML of older versions.
///
/// - `file`: what messages call the file
/// - `bytes`: the whole file
///
/// What memory it takes is a small multiple of the file, whatever it says.
///
/// # Errors
///
/// What is neither, or is damaged, with line and remedy; no map that can be used, which is the error of the first. Maps that cannot be
/// used, beside others that can, are warnings.
pub fn read_presets(file: &str, bytes: &[u8]) -> Result<Presets, ColorError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let presets = match bytes.iter().find(|byte| !byte.is_ascii_whitespace()) {
        Some(b'<') => preset_xml::parse(file, bytes)?,
        Some(b'[' | b'{') => preset_json::parse(file, bytes)?,
        first => {
            return Err(ColorError::Unsupported {
                file: file.to_owned(),
                what: match first {
                    None => "a file with nothing in it".to_owned(),
                    Some(_) => "a file that is neither JSON nor XML".to_owned(),
                },
                remedy: "export the color map from ParaView as .json".to_owned(),
            });
        }
    };
    let (mut maps, mut warnings, mut first_error, mut untold) = (Vec::new(), Vec::new(), None, 0);
    for preset in &presets {
        let warning = match preset.map(file) {
            Ok((map, odd)) => {
                maps.push(map);
                odd.map(|odd| format!("{file}: {odd}"))
            }
            Err(error) => {
                let warning = format!("left out: {error}");
                first_error = first_error.or(Some(error));
                Some(warning)
            }
        };
        untold += usize::from(warning.is_some() && warnings.len() >= WARNINGS);
        warnings.extend(warning.filter(|_| warnings.len() < WARNINGS));
    }
    if untold > 0 {
        warnings.push(format!("{file}: {untold} more presets are odd or left out"));
    }
    if maps.is_empty() {
        return Err(first_error.unwrap_or_else(|| ColorError::Invalid {
            file: file.to_owned(),
            place: "the whole file".to_owned(),
            problem: "there is no color map in it".to_owned(),
            remedy: "export the color map from ParaView as .json".to_owned(),
        }));
    }
    Ok(Presets { file: file.to_owned(), maps, warnings })
}
