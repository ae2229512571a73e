//! `tetrascope compare`: how far two pictures are apart.

use std::path::Path;

use serde_json::json;
use tetrascope::{
    ErrorFigures, LinearImage, PictureFile, PixelDifference, PngImage, read_picture, short, write_exr, write_png,
};

use crate::Failure;
use crate::args::{CompareArgs, Figure};
use crate::interrupt;
use crate::render::check_target;
use crate::report::{line, object};

/// How two pictures were made comparable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Compared {
    /// Both as linear floats.
    Linear,
    /// Both as encoded values, 0 to 1.
    Encoded,
    /// The one that was linear was laid over a background and encoded.
    LinearEncoded,
}

impl Compared {
    const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear floats",
            Self::Encoded => "encoded values, 0 to 1",
            Self::LinearEncoded => "encoded values, 0 to 1; the .exr over the background and encoded to 8-bit sRGB",
        }
    }
}

pub(crate) fn run(args: &CompareArgs) -> Result<(), Failure> {
    args.output.iter().try_for_each(|path| check_target(path, &["png", "exr"], "pictures"))?;
    if let Some(output) = &args.output
        && [&args.picture, &args.other].into_iter().any(|input| is_one_file(input, output))
    {
        return Err(Failure::Usage(format!(
            "{}: that is one of the two pictures; name another file",
            output.display()
        )));
    }
    args.output.iter().for_each(|path| interrupt::will_write(path));
    let read = |path: &Path| read_picture(path).map_err(tetrascope::Error::Io);
    let files = [read(&args.picture)?, read(&args.other)?];
    let background = args.background.unwrap_or_default().map(|channel| channel as f32);
    let ([picture, other], compared) = comparable(files, background);
    let figures = ErrorFigures::between(&picture, &other).ok_or_else(|| different_sizes(args, [&picture, &other]))?;

    let written = args.output.as_deref().map(|path| write_difference(path, &picture, &other)).transpose()?;
    let value = match args.figure {
        Figure::Largest => figures.largest,
        Figure::Rms => figures.root_mean_square,
        Figure::Percentile => figures.percentile_99_9,
    };
    let is_within = args.threshold.is_none_or(|threshold| value <= threshold);
    if args.json {
        let threshold = args.threshold.map(|threshold| {
            json!({ "figure": name_of(args.figure), "value": value, "threshold": threshold, "is_within": is_within })
        });
        object(&json!({
            "pictures": [args.picture.display().to_string(), args.other.display().to_string()],
            "compared": compared.name(),
            "image": { "width": picture.width(), "height": picture.height() },
            "largest": figures.largest,
            "at": [figures.at.0, figures.at.1],
            "rms": figures.root_mean_square,
            "p99.9": figures.percentile_99_9,
            "share_above_1/255": figures.share_above_step,
            "threshold": threshold,
            "written": written,
        }));
    } else {
        let say = |subject: &str, text: &str| line(&format!("{subject:<12}{text}"));
        say("pictures", &format!("{} and {}", args.picture.display(), args.other.display()));
        say("", &format!("{} x {} pixels, compared as {}", picture.width(), picture.height(), compared.name()));
        let (x, y) = figures.at;
        say("largest", &format!("{} at column {x}, row {y}", short(figures.largest)));
        say("rms", &short(figures.root_mean_square));
        say("p99.9", &short(figures.percentile_99_9));
        say("over 1/255", &format!("{} % of the pixels", short(100.0 * figures.share_above_step)));
        if let Some(threshold) = args.threshold {
            let side = if is_within { "within" } else { "above" };
            say("threshold", &format!("{} is {side} {}", name_of(args.figure), short(threshold)));
        }
        if let Some(written) = &written {
            say("wrote", written);
        }
    }
    if is_within { Ok(()) } else { Err(Failure::Differs) }
}

/// Whether two paths lead to one file that is there.
fn is_one_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

const fn name_of(figure: Figure) -> &'static str {
    match figure {
        Figure::Largest => "largest",
        Figure::Rms => "rms",
        Figure::Percentile => "p99.9",
    }
}

fn different_sizes(args: &CompareArgs, pictures: [&LinearImage; 2]) -> Failure {
    let [a, b] = pictures.map(|picture| format!("{} x {}", picture.width(), picture.height()));
    Failure::Input(format!(
        "the pictures differ in size: {} has {a} pixels, {} has {b}; draw both in one size",
        args.picture.display(),
        args.other.display()
    ))
}

/// Both pictures with values that mean the same.
fn comparable(files: [PictureFile; 2], background: [f32; 3]) -> ([LinearImage; 2], Compared) {
    match files {
        [PictureFile::Exr(a), PictureFile::Exr(b)] => ([a, b], Compared::Linear),
        [PictureFile::Png(a), PictureFile::Png(b)] => ([values_of(&a), values_of(&b)], Compared::Encoded),
        [PictureFile::Exr(a), PictureFile::Png(b)] => {
            ([values_of(&encode(&a, background)), values_of(&b)], Compared::LinearEncoded)
        }
        [PictureFile::Png(a), PictureFile::Exr(b)] => {
            ([values_of(&a), values_of(&encode(&b, background))], Compared::LinearEncoded)
        }
    }
}

/// What a .png of the picture would have.
fn encode(image: &LinearImage, background: [f32; 3]) -> PngImage {
    let bytes = image.to_srgb8(background);
    let sample = |byte: u8| u16::from(byte) * 257;
    let pixels = bytes.chunks_exact(3).map(|rgb| [sample(rgb[0]), sample(rgb[1]), sample(rgb[2]), u16::MAX]);
    PngImage { width: image.width(), height: image.height(), pixels: pixels.collect() }
}

/// The encoded samples as values from 0 to 1, which figures take as they take linear ones.
///
/// 24 bits of the sample over 65535: with these the difference of two samples is exact, so that one step of 8 bits is never above 1/255.
fn values_of(image: &PngImage) -> LinearImage {
    let value = |sample: u16| ((u32::from(sample) << 16 | u32::from(sample)) >> 8) as f32 / 16_777_216.0;
    let pixels = image.pixels.iter().map(|pixel| pixel.map(value)).collect();
    LinearImage::from_pixels(image.width, image.height, pixels)
        .unwrap_or_else(|| LinearImage::transparent(image.width, image.height))
}

/// Writes where the pictures differ; gives the path for the report.
pub(crate) fn write_difference(path: &Path, picture: &LinearImage, other: &LinearImage) -> Result<String, Failure> {
    interrupt::go_on()?;
    let is_linear = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"));
    let written = if is_linear {
        PixelDifference::channels(picture, other).map(|differences| write_exr(path, &differences))
    } else {
        let map = PixelDifference::between(picture, other).map(other.width());
        map.map(|map| write_png(path, &map, [0.0; 3]))
    };
    // Only pictures of different sizes have none, and those were refused.
    written.transpose().map_err(tetrascope::Error::Io)?;
    interrupt::wrote(path);
    Ok(path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_step_of_8_bits_is_never_above_one_255th() {
        for byte in 0..255_u8 {
            let pixel = |byte: u8| PngImage { width: 1, height: 1, pixels: vec![[u16::from(byte) * 257; 4]] };
            let [a, b] = [values_of(&pixel(byte)), values_of(&pixel(byte + 1))];
            let figures = ErrorFigures::between(&a, &b).unwrap();
            assert!(figures.largest <= 1.0 / 255.0 && figures.largest > 1.0 / 255.1, "{byte}: {figures:?}");
            assert_eq!(figures.share_above_step, 0.0, "{byte}");
            let two = ErrorFigures::between(&a, &values_of(&pixel(byte.saturating_add(2)))).unwrap();
            assert!(byte == 254 || two.share_above_step == 1.0, "{byte}");
        }
    }

    #[test]
    fn a_linear_picture_is_encoded_as_its_png_is() {
        let linear = LinearImage::from_pixels(2, 1, vec![[0.25, 0.0, 0.0, 0.5], [0.2, 0.4, 0.9, 1.0]]).unwrap();
        let background = [0.5, 1.0, 0.0];
        let bytes = linear.to_srgb8(background);
        let encoded = encode(&linear, background);
        for (pixel, rgb) in encoded.pixels.iter().zip(bytes.chunks_exact(3)) {
            assert_eq!(pixel[..3], [0, 1, 2].map(|c| u16::from(rgb[c]) * 257));
        }
    }
}
