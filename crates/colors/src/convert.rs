//! Colors in the spaces that maps are mixed in, by the constants that VTK takes, since it is its colors that a preset was made with.

use crate::{linear_from_srgb, srgb_from_linear};

/// The white point, CIE 1931 with 2 degrees and illuminant D65, as VTK rounds it.
const WHITE: [f64; 3] = [0.9505, 1.0, 1.089];

/// Below this share of the white point CIE Lab is linear, with [`LAB_SLOPE`].
const LAB_JOINT: f64 = 0.008_856;
const LAB_SLOPE: f64 = 7.787;
const LAB_OFFSET: f64 = 16.0 / 116.0;

/// ProLab's projection of XYZ over white, rows; source: [Konovalenko 2021], eq. (4) there, scaled by 100.
const PROLAB: [[f64; 3]; 3] = [[75.54, 486.66, 167.39], [617.72, -595.45, -22.27], [48.34, 194.94, -243.28]];
/// Its denominator, to which 1 is added.
const PROLAB_BELOW: [f64; 3] = [0.7554, 3.8666, 1.6739];

/// XYZ of an sRGB color.
fn xyz(rgb: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = rgb.map(linear_from_srgb);
    [r * 0.4124 + g * 0.3576 + b * 0.1805, r * 0.2126 + g * 0.7152 + b * 0.0722, r * 0.0193 + g * 0.1192 + b * 0.9505]
}

/// The sRGB color of an XYZ. One that no screen shows is darkened as a whole until its largest channel is 1, and loses what is below 0:
/// not the nearest color, but the one that ParaView shows.
fn rgb_from_xyz([x, y, z]: [f64; 3]) -> [f64; 3] {
    let linear = [
        x * 3.2406 + y * -1.5372 + z * -0.4986,
        x * -0.9689 + y * 1.8758 + z * 0.0415,
        x * 0.0557 + y * -0.2040 + z * 1.0570,
    ];
    let encoded = linear.map(srgb_from_linear);
    let largest = encoded.into_iter().fold(1.0, f64::max);
    encoded.map(|channel| (channel / largest).max(0.0))
}

/// CIE Lab (L from 0 to 100) of an sRGB color.
pub(crate) fn lab(rgb: [f64; 3]) -> [f64; 3] {
    let xyz = xyz(rgb);
    let [x, y, z] = core::array::from_fn(|i| {
        let share = xyz[i] / WHITE[i];
        if share > LAB_JOINT { share.cbrt() } else { LAB_SLOPE * share + LAB_OFFSET }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The sRGB color of a CIE Lab color; see [`rgb_from_xyz`] for those that no screen shows.
pub(crate) fn rgb_from_lab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let y = (l + 16.0) / 116.0;
    let roots = [y + a / 500.0, y, y - b / 200.0];
    rgb_from_xyz(core::array::from_fn(|i| {
        let cube = roots[i].powi(3);
        WHITE[i] * if cube > LAB_JOINT { cube } else { (roots[i] - LAB_OFFSET) / LAB_SLOPE }
    }))
}

/// Magnitude, saturation and hue: Lab in polar coordinates about black, angles in radians; source: [Moreland 2009].
pub(crate) fn msh(rgb: [f64; 3]) -> [f64; 3] {
    let [l, a, b] = lab(rgb);
    let magnitude = (l * l + a * a + b * b).sqrt();
    // Black has no saturation, grays have no hue.
    let saturation = if magnitude > 0.001 { (l / magnitude).clamp(-1.0, 1.0).acos() } else { 0.0 };
    let hue = if saturation > 0.001 { b.atan2(a) } else { 0.0 };
    [magnitude, saturation, hue]
}

/// The sRGB color of magnitude, saturation and hue.
pub(crate) fn rgb_from_msh([magnitude, saturation, hue]: [f64; 3]) -> [f64; 3] {
    let chroma = magnitude * saturation.sin();
    rgb_from_lab([magnitude * saturation.cos(), chroma * hue.cos(), chroma * hue.sin()])
}

/// ProLab of an sRGB color.
pub(crate) fn prolab(rgb: [f64; 3]) -> [f64; 3] {
    let xyz = xyz(rgb);
    let share: [f64; 3] = core::array::from_fn(|i| xyz[i] / WHITE[i]);
    let below = 1.0 + dot(PROLAB_BELOW, share);
    PROLAB.map(|row| dot(row, share) / below)
}

/// The sRGB color of a ProLab color: the three equations of [`prolab`] solved for XYZ.
pub(crate) fn rgb_from_prolab(prolab: [f64; 3]) -> [f64; 3] {
    // Row by row: (PROLAB - prolab * PROLAB_BELOW) · share = prolab.
    let rows: [[f64; 3]; 3] =
        core::array::from_fn(|i| core::array::from_fn(|j| PROLAB[i][j] - prolab[i] * PROLAB_BELOW[j]));
    let whole = determinant(rows);
    let share: [f64; 3] = core::array::from_fn(|j| {
        let replaced: [[f64; 3]; 3] =
            core::array::from_fn(|i| core::array::from_fn(|k| if k == j { prolab[i] } else { rows[i][k] }));
        determinant(replaced) / whole
    });
    rgb_from_xyz(core::array::from_fn(|i| share[i] * WHITE[i]))
}

/// Hue, saturation and value, 0 to 1 each; hue and saturation of a gray are 0.
pub(crate) fn hsv(rgb: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = rgb;
    let value = r.max(g).max(b);
    let chroma = value - r.min(g).min(b);
    if value <= 0.0 || chroma <= 0.0 {
        return [0.0, 0.0, value];
    }
    let sextant = if value == r {
        (g - b) / chroma
    } else if value == g {
        2.0 + (b - r) / chroma
    } else {
        4.0 + (r - g) / chroma
    };
    let hue = sextant / 6.0;
    [if hue < 0.0 { hue + 1.0 } else { hue }, chroma / value, value]
}

/// The sRGB color of hue, saturation and value; hues repeat with period 1.
pub(crate) fn rgb_from_hsv([hue, saturation, value]: [f64; 3]) -> [f64; 3] {
    // Each channel is full over a third of the circle and has ramps of a sixth at both ends.
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|peak| {
        let turn = (hue - peak).rem_euclid(1.0);
        let away = 6.0 * turn.min(1.0 - turn);
        let share = (2.0 - away).clamp(0.0, 1.0);
        value * (1.0 - saturation * (1.0 - share))
    })
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}
