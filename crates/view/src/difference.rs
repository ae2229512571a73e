//! How far a picture is from the one that it should be.

use crate::LinearImage;

/// How far a picture is from the exact one.
///
/// Errors are absolute differences in the units of the picture, over red, green, blue and alpha alike; a channel that is no number
/// counts as infinitely wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorFigures {
    /// Largest error of any channel of any pixel.
    pub largest: f64,
    /// Column and row of the first pixel that has it.
    pub at: (u32, u32),
    /// Square root of the mean square over all channels of all pixels.
    pub root_mean_square: f64,
    /// What 999 of 1000 pixels do not exceed: a pixel's error is that of its worst channel.
    pub percentile_99_9: f64,
    /// Share of the pixels, 0 to 1, with an error above [`PixelDifference::STEP`].
    pub share_above_step: f64,
}

impl ErrorFigures {
    /// The figures of two pictures; `None` if they differ in size or have no pixel.
    pub fn between(picture: &LinearImage, exact: &LinearImage) -> Option<Self> {
        if (picture.width(), picture.height()) != (exact.width(), exact.height()) || exact.pixels().is_empty() {
            return None;
        }
        let by_pixel = PixelDifference::between(picture, exact).by_pixel;
        let (mut largest, mut place) = (0.0, 0);
        for (index, &error) in by_pixel.iter().enumerate() {
            if error > largest {
                (largest, place) = (error, index as u32);
            }
        }
        let channels = picture.pixels().iter().flatten().zip(exact.pixels().iter().flatten());
        let squares: f64 = channels.map(|(a, b)| square_of(f64::from(*a) - f64::from(*b))).sum();
        let mut ascending = by_pixel;
        ascending.sort_unstable_by(f32::total_cmp);
        let count = ascending.len();
        // The least error that at least 999 of 1000 pixels do not exceed.
        let rank = (count * 999).div_ceil(1000).max(1);
        let above = count - ascending.partition_point(|&error| error <= PixelDifference::STEP);
        Some(Self {
            largest: f64::from(largest),
            at: (place % exact.width(), place / exact.width()),
            root_mean_square: (squares / (4 * count) as f64).sqrt(),
            percentile_99_9: f64::from(ascending[rank - 1]),
            share_above_step: above as f64 / count as f64,
        })
    }
}

fn square_of(difference: f64) -> f64 {
    if difference.is_nan() { f64::INFINITY } else { difference * difference }
}

/// Where two pictures differ.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelDifference {
    /// For every pixel, in rows from the top, the largest difference in any of its four channels; infinite where a channel is no number.
    pub by_pixel: Vec<f32>,
}

impl PixelDifference {
    /// What rounding may leave between two pictures in f32 that blend the same cells in the same order.
    pub const ROUNDING: f32 = 1e-5;
    /// One step of an 8-bit channel.
    pub const STEP: f32 = 1.0 / 255.0;

    /// Where two pictures of one size differ; pixels that only one of them has count as infinitely different.
    pub fn between(picture: &LinearImage, exact: &LinearImage) -> Self {
        let difference = |(a, b): (&[f32; 4], &[f32; 4])| {
            let channels = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            channels.fold(0.0, |largest: f32, d| if d.is_nan() { f32::INFINITY } else { largest.max(d) })
        };
        let mut by_pixel: Vec<f32> = picture.pixels().iter().zip(exact.pixels()).map(difference).collect();
        by_pixel.resize(picture.pixels().len().max(exact.pixels().len()), f32::INFINITY);
        Self { by_pixel }
    }

    /// The absolute differences of all channels as a picture; `None` if the two differ in size.
    pub fn channels(picture: &LinearImage, exact: &LinearImage) -> Option<LinearImage> {
        if (picture.width(), picture.height()) != (exact.width(), exact.height()) {
            return None;
        }
        let pixels = picture.pixels().iter().zip(exact.pixels());
        let pixels = pixels.map(|(a, b)| std::array::from_fn(|channel| (a[channel] - b[channel]).abs())).collect();
        LinearImage::from_pixels(picture.width(), picture.height(), pixels)
    }

    /// Pixels with a difference above a limit.
    pub fn above(&self, limit: f32) -> usize {
        self.by_pixel.iter().filter(|difference| **difference > limit).count()
    }

    /// The largest difference; 0 for a picture without pixels.
    pub fn largest(&self) -> f32 {
        self.by_pixel.iter().copied().fold(0.0, f32::max)
    }

    /// A picture of it: black up to [`Self::ROUNDING`], then brighter with the logarithm, white from 1 on.
    ///
    /// - `width`: pixels a row
    pub fn map(&self, width: u32) -> Option<LinearImage> {
        let brightness = |difference: f32| {
            let decades = (difference / Self::ROUNDING).max(1.0).log10() / -Self::ROUNDING.log10();
            // A .png stores about the square root of it.
            let linear = decades.min(1.0).powi(2);
            [linear, linear, linear, 1.0]
        };
        let height = self.by_pixel.len() as u32 / width.max(1);
        LinearImage::from_pixels(width, height, self.by_pixel.iter().map(|&d| brightness(d)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, values: &[f32]) -> LinearImage {
        let pixels: Vec<[f32; 4]> = values.iter().map(|&v| [0.5, v, 0.25, 1.0]).collect();
        LinearImage::from_pixels(width, values.len() as u32 / width, pixels).unwrap()
    }

    #[test]
    fn known_figures() {
        // 2000 pixels: one off by a half, two by 0.01, the rest right.
        let exact = picture(50, &[0.25; 2000]);
        let mut values = [0.25; 2000];
        (values[123], values[7], values[1999]) = (0.75, 0.26, 0.24);
        let figures = ErrorFigures::between(&picture(50, &values), &exact).unwrap();
        assert_eq!((figures.largest, figures.at), (0.5, (23, 2)));
        assert!((figures.root_mean_square - ((0.25_f64 + 2e-4) / 8000.0).sqrt()).abs() < 1e-8, "{figures:?}");
        // 1998 of 2000 do not exceed the second largest error.
        assert!((figures.percentile_99_9 - 0.01).abs() < 1e-7, "{figures:?}");
        assert_eq!(figures.share_above_step, 3.0 / 2000.0);
        let none = ErrorFigures::between(&exact, &exact).unwrap();
        assert_eq!((none.largest, none.root_mean_square, none.share_above_step), (0.0, 0.0, 0.0));
    }

    #[test]
    fn what_is_no_number_is_infinitely_wrong() {
        let exact = picture(2, &[0.0, 0.0]);
        let figures = ErrorFigures::between(&picture(2, &[0.0, f32::NAN]), &exact).unwrap();
        assert_eq!((figures.largest, figures.at), (f64::INFINITY, (1, 0)));
        assert_eq!(figures.root_mean_square, f64::INFINITY);
        assert_eq!(ErrorFigures::between(&exact, &picture(1, &[0.0, 0.0])), None);
    }
}
