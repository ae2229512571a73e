//! A color map as a strip of colors, and an opacity as a curve, in a line of a terminal.

use tetrascope_colors::{ColorMap, Opacity};

/// Characters of a strip, each of two colors.
const STRIP: usize = 32;
/// Characters of a curve.
const CURVE: usize = 32;
/// The block that fills the left half of its place.
const LEFT_HALF: char = '▌';
const BLOCKS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// Which colors a terminal has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Paint {
    /// None, or nobody looks.
    Nothing,
    /// The 216 colors of the cube of six levels a channel.
    Cube,
    /// All of 24 bits.
    True,
}

impl Paint {
    /// What standard output has, as the environment says: `NO_COLOR`, `CLICOLOR`, `CLICOLOR_FORCE`, and `COLORTERM` for 24 bits.
    pub(super) fn of_standard_output() -> Self {
        let is_true = console::true_colors_enabled()
            // Who forces colors onto what is no terminal may say how many there are.
            || std::env::var("COLORTERM").is_ok_and(|term| term == "truecolor" || term == "24bit");
        match (console::colors_enabled(), is_true) {
            (false, _) => Self::Nothing,
            (true, false) => Self::Cube,
            (true, true) => Self::True,
        }
    }

    /// The map from left to right; nothing without colors.
    pub(super) fn swatch(self, map: &ColorMap) -> Option<String> {
        if self == Self::Nothing {
            return None;
        }
        let place = |half: usize| (half as f64 + 0.5) / (2 * STRIP) as f64;
        let code = |half: usize| self.code(map.color_at(place(half)));
        let one = |at: usize| format!("\x1b[38;{};48;{}m{LEFT_HALF}", code(2 * at), code(2 * at + 1));
        let strip: String = (0..STRIP).map(one).collect();
        Some(format!("{strip}\x1b[0m"))
    }

    /// A color in the words of ECMA-48 and xterm.
    fn code(self, color: [f64; 3]) -> String {
        let [r, g, b] = bytes(color);
        if self == Self::True {
            return format!("2;{r};{g};{b}");
        }
        let [r, g, b] = [r, g, b].map(nearest_level);
        format!("5;{}", 16 + 36 * r + 6 * g + b)
    }
}

/// The number of the level of the cube that is nearest.
fn nearest_level(channel: u8) -> usize {
    const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    (0..LEVELS.len()).min_by_key(|&level| LEVELS[level].abs_diff(channel)).unwrap_or_default()
}

fn bytes(color: [f64; 3]) -> [u8; 3] {
    color.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// A color of sRGB from 0 to 1 as `#rrggbb`.
pub(super) fn hexadecimal(color: [f64; 3]) -> String {
    let [r, g, b] = bytes(color);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The curve from left to right, from nothing to a full block.
pub(super) fn curve(opacity: &Opacity) -> String {
    let block = |at: usize| {
        let height = opacity.at((at as f64 + 0.5) / CURVE as f64);
        BLOCKS[((height * 8.0).round() as usize).min(8)]
    };
    (0..CURVE).map(block).collect::<String>().trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use tetrascope_colors::{ColorPoint, ColorSpace};

    use super::*;

    #[test]
    fn strips_have_the_colors_of_the_map() {
        let point = |x, rgb| ColorPoint { x, rgb };
        let map = ColorMap::new("mine", ColorSpace::Rgb, &[point(0.0, [0.0; 3]), point(1.0, [1.0, 0.5, 0.0])]).unwrap();
        assert_eq!(Paint::Nothing.swatch(&map), None);
        let strip = Paint::True.swatch(&map).unwrap();
        // A 128th along, and 3.
        assert!(strip.starts_with("\x1b[38;2;2;1;0;48;2;6;3;0m▌"), "{strip:?}");
        assert!(strip.ends_with("48;2;253;127;0m▌\x1b[0m"), "{strip:?}");
        assert_eq!(strip.matches(LEFT_HALF).count(), STRIP);
        let cube = Paint::Cube.swatch(&map).unwrap();
        assert!(cube.starts_with("\x1b[38;5;16;48;5;16m▌") && cube.ends_with("48;5;208m▌\x1b[0m"), "{cube:?}");
    }

    #[test]
    fn curves_rise() {
        let linear = curve(&Opacity::named("linear").unwrap());
        assert!(linear.starts_with("  ▁▁") && linear.ends_with("▇▇██"), "{linear}");
        assert_eq!(curve(&Opacity::named("linear_r").unwrap()).chars().next(), Some('█'));
        assert_eq!(hexadecimal([1.0, 0.5, 0.0]), "#ff8000");
    }
}
