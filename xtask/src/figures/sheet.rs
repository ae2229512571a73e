//! Several pictures on one sheet, and lines on them.

use tetrascope::LinearImage;

/// Pixels between pictures.
const GAP: u32 = 4;

/// What is between them.
const PAPER: [f32; 4] = [1.0; 4];

/// A picture over a background: opaque.
pub(crate) fn over(image: &LinearImage, background: [f32; 3]) -> LinearImage {
    let mut opaque = image.clone();
    for pixel in opaque.pixels_mut() {
        let through = 1.0 - pixel[3];
        for (channel, behind) in pixel.iter_mut().zip(background) {
            *channel += through * behind;
        }
        pixel[3] = 1.0;
    }
    opaque
}

/// Pictures in rows, one row below the other, on white.
pub(crate) fn grid(rows: &[Vec<LinearImage>]) -> LinearImage {
    let sum = |sides: &mut dyn Iterator<Item = u32>| sides.map(|side| side + GAP).sum::<u32>().saturating_sub(GAP);
    let tallest = |row: &Vec<LinearImage>| row.iter().map(LinearImage::height).max().unwrap_or(0);
    let width = rows.iter().map(|row| sum(&mut row.iter().map(LinearImage::width))).max().unwrap_or(0);
    let height = sum(&mut rows.iter().map(tallest));
    let mut sheet = LinearImage::transparent(width, height);
    sheet.pixels_mut().fill(PAPER);
    let mut top = 0;
    for row in rows {
        let mut left = 0;
        for image in row {
            for y in 0..image.height() {
                let at = (top + y) as usize * width as usize + left as usize;
                let from = y as usize * image.width() as usize;
                let count = image.width() as usize;
                sheet.pixels_mut()[at..at + count].copy_from_slice(&image.pixels()[from..from + count]);
            }
            left += image.width() + GAP;
        }
        top += tallest(row) + GAP;
    }
    sheet
}

/// Draws a straight line of about one pixel's width over an opaque picture, both ends in pixels from the upper left corner.
pub(super) fn line(image: &mut LinearImage, from: [f64; 2], to: [f64; 2], color: [f32; 3]) {
    let (width, height) = (image.width(), image.height());
    let along = [to[0] - from[0], to[1] - from[1]];
    let squared = along[0] * along[0] + along[1] * along[1];
    for y in 0..height {
        for x in 0..width {
            let at = [f64::from(x) + 0.5 - from[0], f64::from(y) + 0.5 - from[1]];
            let dot = at[0] * along[0] + at[1] * along[1];
            let share = if squared > 0.0 { (dot / squared).clamp(0.0, 1.0) } else { 0.0 };
            let distance = (at[0] - share * along[0]).hypot(at[1] - share * along[1]);
            let cover = (1.2 - distance).clamp(0.0, 1.0) as f32;
            if cover > 0.0 {
                let pixel = &mut image.pixels_mut()[y as usize * width as usize + x as usize];
                for (channel, ink) in pixel.iter_mut().zip(color) {
                    *channel += cover * (ink - *channel);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_keep_every_pixel_in_its_place() {
        let image = |width: u32, height: u32, value: f32| {
            let mut image = LinearImage::transparent(width, height);
            image.pixels_mut().fill([value, value, value, 1.0]);
            image
        };
        let sheet = grid(&[vec![image(3, 2, 0.1), image(2, 5, 0.2)], vec![image(4, 1, 0.3)]]);
        assert_eq!((sheet.width(), sheet.height()), (3 + GAP + 2, 5 + GAP + 1));
        assert_eq!(sheet.pixel(2, 1)[0], 0.1);
        assert_eq!(sheet.pixel(2, 2), PAPER);
        assert_eq!(sheet.pixel(3 + GAP, 4)[0], 0.2);
        assert_eq!(sheet.pixel(3, 5 + GAP)[0], 0.3);
        assert_eq!(sheet.pixel(4, 5 + GAP), PAPER);
    }

    #[test]
    fn lines_touch_their_pixels_alone() {
        let mut image = over(&LinearImage::transparent(9, 9), [0.0; 3]);
        line(&mut image, [0.0, 4.5], [9.0, 4.5], [1.0, 0.5, 0.0]);
        assert_eq!(image.pixel(4, 4), [1.0, 0.5, 0.0, 1.0]);
        assert_eq!(image.pixel(4, 1), [0.0, 0.0, 0.0, 1.0]);
    }
}
