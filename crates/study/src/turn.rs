//! A small turn of the eye about the mesh, so that no two frames are alike, and pictures that fit a page.

use tetrascope::{LinearImage, View};

/// The view turned by `degrees` about the line through `center` that is up in the picture.
///
/// - `center`: world coordinates, as the view's
pub(crate) fn turned(view: &View, center: [f64; 3], degrees: f64) -> View {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let axis = view.up;
    let mut turned = *view;
    let mut offset = view.eye;
    (offset.x, offset.y, offset.z) = (view.eye.x - center[0], view.eye.y - center[1], view.eye.z - center[2]);
    // Rodrigues' formula.
    let turn = |v: &mut _| {
        let from = std::mem::take(v);
        *v = from * cos + axis.cross(from) * sin + axis * (axis.dot(from) * (1.0 - cos));
    };
    turn(&mut offset);
    turn(&mut turned.right);
    turn(&mut turned.forward);
    (turned.eye.x, turned.eye.y, turned.eye.z) = (offset.x + center[0], offset.y + center[1], offset.z + center[2]);
    turned
}

/// Angles of `count` frames from one end of the turn to the other, degrees; of an odd number the middle one is 0.
pub(crate) fn angles(count: usize, turn_degrees: f64) -> Vec<f64> {
    let middle = (count.max(1) - 1) as f64 / 2.0;
    let step = if count > 1 { turn_degrees / (count - 1) as f64 } else { 0.0 };
    (0..count).map(|index| (index as f64 - middle) * step).collect()
}

/// The same view with no side longer than `side` pixels.
pub(crate) fn shrunk(view: &View, side: u32) -> View {
    let longest = view.width.max(view.height);
    if longest <= side {
        return *view;
    }
    let scaled = |length: u32| (u64::from(length) * u64::from(side) / u64::from(longest)).max(1) as u32;
    let (width, height) = (scaled(view.width), scaled(view.height));
    // Pixels stay square, as they were.
    let half_width = view.half_height * f64::from(width) / f64::from(height);
    View { width, height, half_width, ..*view }
}

/// How pixels become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pooling {
    /// Their mean, for pictures.
    Mean,
    /// The largest of each channel, for errors: none gets lost.
    Largest,
}

/// A picture with no side longer than `side`: whole squares of pixels become one.
pub(crate) fn reduced(image: &LinearImage, side: u32, pooling: Pooling) -> LinearImage {
    let factor = image.width().max(image.height()).div_ceil(side.max(1)).max(1);
    if factor == 1 {
        return image.clone();
    }
    let (width, height) = (image.width().div_ceil(factor), image.height().div_ceil(factor));
    let mut small = LinearImage::transparent(width, height);
    for (index, pixel) in small.pixels_mut().iter_mut().enumerate() {
        let (x, y) = (index as u32 % width * factor, index as u32 / width * factor);
        let (right, bottom) = ((x + factor).min(image.width()), (y + factor).min(image.height()));
        let count = ((right - x) * (bottom - y)) as f32;
        for (from_x, from_y) in (y..bottom).flat_map(|from_y| (x..right).map(move |from_x| (from_x, from_y))) {
            for (channel, value) in pixel.iter_mut().zip(image.pixel(from_x, from_y)) {
                *channel = match pooling {
                    Pooling::Mean => *channel + value / count,
                    Pooling::Largest => channel.max(value),
                };
            }
        }
    }
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> View {
        let mut scene = tetrascope::SceneFile::of_mesh(tetrascope::SAMPLE);
        scene.camera.eye = Some([0.0, 0.0, 5.0]);
        scene.camera.target = Some([0.0; 3]);
        (scene.image.width, scene.image.height) = (300, 200);
        let volume = tetrascope::Volume::sample().unwrap();
        let field = volume.field(None).unwrap();
        scene.complete(&field.facts).unwrap().scene.plan().unwrap().view
    }

    #[test]
    fn a_quarter_turn() {
        let turned = turned(&view(), [0.0, 0.0, 1.0], 90.0);
        for (found, expected) in [
            (turned.eye.to_array(), [4.0, 0.0, 1.0]),
            (turned.forward.to_array(), [-1.0, 0.0, 0.0]),
            (turned.right.to_array(), [0.0, 0.0, -1.0]),
            (turned.up.to_array(), [0.0, 1.0, 0.0]),
        ] {
            for (a, b) in found.iter().zip(expected) {
                assert!((a - b).abs() < 1e-14, "{found:?} is not {expected:?}");
            }
        }
    }

    #[test]
    fn the_middle_of_the_turn_is_the_view_itself() {
        assert_eq!(angles(5, 4.0), [-2.0, -1.0, 0.0, 1.0, 2.0]);
        assert_eq!(angles(1, 4.0), [0.0]);
        assert_eq!(turned(&view(), [0.1, 0.2, 0.3], 0.0).right, view().right);
    }

    #[test]
    fn shrinking_keeps_the_shape() {
        let small = shrunk(&view(), 160);
        assert_eq!((small.width, small.height), (160, 106));
        assert!((small.half_width / small.half_height - 160.0 / 106.0).abs() < 1e-12);
        assert_eq!(shrunk(&view(), 300), view());
    }

    #[test]
    fn reducing_takes_the_mean_or_the_largest() {
        let pixels = (0..6).map(|value| [value as f32, 0.0, 0.0, 1.0]).collect();
        let image = LinearImage::from_pixels(3, 2, pixels).unwrap();
        let mean = reduced(&image, 2, Pooling::Mean);
        assert_eq!((mean.width(), mean.height()), (2, 1));
        // Columns 0 and 1 of both rows; column 2 of both rows.
        assert_eq!(mean.pixels(), [[2.0, 0.0, 0.0, 1.0], [3.5, 0.0, 0.0, 1.0]]);
        assert_eq!(reduced(&image, 2, Pooling::Largest).pixels(), [[4.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0, 1.0]]);
        assert_eq!(reduced(&image, 3, Pooling::Mean), image);
    }
}
