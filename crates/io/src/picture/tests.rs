//! Pictures go out and come back.

use std::{fs, io, path::Path};

use super::{whole_file::try_write, *};

fn gradient(width: u32, height: u32) -> LinearImage {
    let pixels = (0..width * height)
        .map(|i| {
            let (x, y) = ((i % width) as f32 / width as f32, (i / width) as f32 / height as f32);
            [x, 2.5 * y, x * y, 0.25 + 0.5 * x]
        })
        .collect();
    LinearImage::from_pixels(width, height, pixels).unwrap()
}

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn exr_returns_every_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    // 37 rows are no multiple of the 16 rows of a ZIP block.
    let mut image = gradient(61, 37);
    image.pixels_mut()[3] = [f32::INFINITY, -0.0, 1e-40, f32::MAX];
    write_image(&path, &image, [0.5; 3]).unwrap();
    assert_eq!(read_exr(&path).unwrap(), image);
    assert_eq!(names_in(folder.path()), ["picture.exr"]);

    let meta = MetaDataOf::read(&path);
    assert_eq!(meta, MetaDataOf { channels: "A F32, B F32, G F32, R F32".into(), compression: "ZIP16".into() });
}

#[derive(Debug, PartialEq)]
struct MetaDataOf {
    channels: String,
    compression: String,
}

impl MetaDataOf {
    fn read(path: &Path) -> Self {
        let meta = exr::prelude::MetaData::read_from_file(path, true).unwrap();
        let header = &meta.headers[0];
        let channels = header.channels.list.iter().map(|c| format!("{} {:?}", c.name, c.sample_type));
        Self { channels: channels.collect::<Vec<_>>().join(", "), compression: format!("{:?}", header.compression) }
    }
}

/// Rows of noise take longer to compress than rows of one color, so that blocks are done in another order than they are begun in.
#[test]
fn exr_of_one_picture_is_always_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    let mut image = LinearImage::transparent(700, 640);
    let mut state = 1_u32;
    for (index, pixel) in image.pixels_mut().iter_mut().enumerate() {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let is_noise = (index / 700 / 16) % 3 == 0;
        *pixel = if is_noise { [state as f32, (state >> 8) as f32, (state >> 16) as f32, 1.0] } else { [0.5; 4] };
    }
    write_exr(&path, &image).unwrap();
    let once = fs::read(&path).unwrap();
    for _ in 0..12 {
        write_exr(&path, &image).unwrap();
        assert!(fs::read(&path).unwrap() == once);
    }
    let meta = exr::prelude::MetaData::read_from_file(&path, true).unwrap();
    assert_eq!(meta.headers[0].line_order, exr::prelude::LineOrder::Increasing);
}

#[test]
fn exr_of_half_floats_without_alpha() {
    use exr::prelude::{WritableImage, f16};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("half.exr");
    let channels = exr::prelude::SpecificChannels::rgb(|at: exr::prelude::Vec2<usize>| {
        (f16::from_f32(at.x() as f32), f16::from_f32(at.y() as f32), f16::from_f32(0.5))
    });
    exr::prelude::Image::from_channels((5, 3), channels).write().to_file(&path).unwrap();
    let image = read_exr(&path).unwrap();
    assert_eq!((image.width(), image.height()), (5, 3));
    assert_eq!(image.pixel(4, 2), [4.0, 2.0, 0.5, 1.0]);
}

#[test]
fn exr_broken_files_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    write_exr(&path, &gradient(32, 32)).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in [1, 8, 100, 300, whole.len() - 50] {
        fs::write(&path, &whole[..length.min(whole.len() - 1)]).unwrap();
        let message = read_exr(&path).unwrap_err().to_string();
        assert!(message.contains("picture.exr"), "{message}");
    }

    // The data window, and with it the size, is made 2^30 squared.
    let name = b"dataWindow\0box2i\0";
    let at = whole.windows(name.len()).position(|window| window == name).unwrap() + name.len() + 4;
    let mut huge = whole;
    huge[at + 8..at + 12].copy_from_slice(&(1_i32 << 30).to_le_bytes());
    huge[at + 12..at + 16].copy_from_slice(&(1_i32 << 30).to_le_bytes());
    fs::write(&path, &huge).unwrap();
    assert!(read_exr(&path).is_err());
}

#[test]
fn png_has_the_composited_bytes_and_says_srgb() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.PNG");
    let image = gradient(19, 7);
    let background = [0.1, 0.2, 0.3];
    write_image(&path, &image, background).unwrap();

    let mut reader = png::Decoder::new(io::BufReader::new(fs::File::open(&path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.width, info.height, info.color_type), (19, 7, png::ColorType::Rgb));
    assert_eq!(bytes, image.to_srgb8(background));
    assert!(reader.info().srgb.is_some());
    assert_eq!(names_in(folder.path()), ["picture.PNG"]);
}

#[test]
fn other_extensions_and_empty_pictures_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["picture.jpg", "picture"] {
        let error = write_image(&folder.path().join(name), &gradient(2, 2), [0.0; 3]).unwrap_err();
        assert!(matches!(error, IoError::Unsupported { .. }), "{error}");
    }
    for name in ["picture.png", "picture.exr"] {
        let error = write_image(&folder.path().join(name), &LinearImage::transparent(0, 4), [0.0; 3]).unwrap_err();
        assert!(error.to_string().contains("0 x 4"), "{error}");
    }
    assert!(names_in(folder.path()).is_empty());
}

#[test]
fn failure_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    fs::write(&path, "before").unwrap();
    let error = try_write(&path, |file| {
        io::Write::write_all(file, b"half a pict")?;
        Err(io::Error::other("disk full"))
    });
    assert_eq!(error.unwrap_err().to_string(), "disk full");
    assert_eq!(names_in(folder.path()), ["picture.png"]);
    assert_eq!(fs::read(&path).unwrap(), b"before");

    let missing = folder.path().join("missing/picture.png");
    assert!(matches!(write_png(&missing, &gradient(2, 2), [0.0; 3]), Err(IoError::Write { .. })));
    let directory = folder.path().join("folder.png");
    fs::create_dir(&directory).unwrap();
    assert!(matches!(write_png(&directory, &gradient(2, 2), [0.0; 3]), Err(IoError::Write { .. })));
    assert_eq!(names_in(folder.path()), ["folder.png", "picture.png"]);
}

#[cfg(unix)]
#[test]
fn permissions_are_those_of_a_new_file_and_links_are_followed() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (plain, picture) = (folder.path().join("plain"), folder.path().join("picture.png"));
    fs::File::create(&plain).unwrap();
    write_png(&picture, &gradient(2, 2), [0.0; 3]).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&picture), mode(&plain));

    let link = folder.path().join("link.png");
    std::os::unix::fs::symlink("picture.png", &link).unwrap();
    write_png(&link, &gradient(3, 3), [0.0; 3]).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&link).unwrap(), fs::read(&picture).unwrap());
}

proptest::proptest! {
    #[test]
    fn exr_damaged_files_never_panic(
        flips in proptest::collection::vec((proptest::prelude::any::<proptest::sample::Index>(), 0..=255_u8), 1..4),
        reach in proptest::prelude::prop_oneof![proptest::prelude::Just(330_usize), proptest::prelude::Just(usize::MAX)],
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        write_exr(&path, &gradient(9, 20)).unwrap();
        let mut bytes = fs::read(&path).unwrap();
        let reach = reach.min(bytes.len());
        for (at, byte) in flips {
            bytes[at.index(reach)] = byte;
        }
        fs::write(&path, &bytes).unwrap();
        let _ = read_exr(&path);
    }
}

/// A PNG of that kind, with what else it needs.
fn png_of(
    size: [u32; 2],
    color: png::ColorType,
    depth: png::BitDepth,
    palette: Option<[&[u8]; 2]>,
    data: &[u8],
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if let Some([colors, alphas]) = palette {
        encoder.set_palette(colors.to_vec());
        encoder.set_trns(alphas.to_vec());
    }
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

#[test]
fn png_of_every_kind_is_read() {
    use png::{BitDepth as Bits, ColorType as Color};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("named.exr");
    let check = |bytes: Vec<u8>, expected: &[[u16; 4]]| {
        fs::write(&path, bytes).unwrap();
        let found = read_png(&path).unwrap();
        assert_eq!((found.width, found.height, found.pixels.as_slice()), (2, 1, expected));
        // By its content, whatever it is called.
        assert_eq!(read_picture(&path).unwrap(), PictureFile::Png(found));
    };
    let (one, full) = (257, 65535);
    check(png_of([2, 1], Color::Grayscale, Bits::Eight, None, &[0, 1]), &[[0, 0, 0, full], [one, one, one, full]]);
    check(png_of([2, 1], Color::Grayscale, Bits::One, None, &[0b0100_0000]), &[[0, 0, 0, full], [full; 4]]);
    check(
        png_of([2, 1], Color::Rgb, Bits::Eight, None, &[1, 2, 3, 4, 5, 255]),
        &[[one, 2 * one, 3 * one, full], [4 * one, 5 * one, full, full]],
    );
    check(
        png_of([2, 1], Color::GrayscaleAlpha, Bits::Eight, None, &[1, 2, 3, 4]),
        &[[one, one, one, 2 * one], [3 * one, 3 * one, 3 * one, 4 * one]],
    );
    check(
        png_of([2, 1], Color::Rgba, Bits::Sixteen, None, &[1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 1, 0, 2, 255, 255]),
        &[[0x0102, 0x0304, 0x0506, 0x0708], [0, 1, 2, full]],
    );
    let palette = Some([&[9, 8, 7, 1, 2, 3][..], &[255, 16][..]]);
    check(
        png_of([2, 1], Color::Indexed, Bits::Eight, palette, &[1, 0]),
        &[[one, 2 * one, 3 * one, 16 * one], [9 * one, 8 * one, 7 * one, full]],
    );
}

#[test]
fn png_comes_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let image = gradient(33, 9);
    write_png(&path, &image, [0.5; 3]).unwrap();
    let bytes = image.to_srgb8([0.5; 3]);
    let found = read_png(&path).unwrap();
    let back: Vec<u8> = found.pixels.iter().flat_map(|pixel| [0, 1, 2].map(|c| (pixel[c] / 257) as u8)).collect();
    assert_eq!((found.width, found.height, back), (33, 9, bytes));
}

#[test]
fn png_broken_files_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    write_png(&path, &gradient(64, 64), [0.0; 3]).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in [1, 8, 20, 40, whole.len() / 2] {
        fs::write(&path, &whole[..length]).unwrap();
        let message = read_png(&path).unwrap_err().to_string();
        assert!(message.contains("picture.png"), "{message}");
    }
    // Every byte changed, one after the other: an error or a picture of its size, but no end of the program.
    for at in (0..whole.len()).step_by(3) {
        let mut changed = whole.clone();
        changed[at] ^= 0x41;
        fs::write(&path, &changed).unwrap();
        if let Ok(found) = read_png(&path) {
            assert_eq!(found.pixels.len(), (found.width * found.height) as usize);
        }
    }
    // Declares far more than its few bytes can hold.
    let mut oversized = whole;
    let sides = (1_u32 << 16).to_be_bytes();
    // Width and height follow the signature and the name of the chunk, whose check sum covers them.
    oversized[16..20].copy_from_slice(&sides);
    oversized[20..24].copy_from_slice(&sides);
    let mut sum = flate2::Crc::new();
    sum.update(&oversized[12..29]);
    oversized[29..33].copy_from_slice(&sum.sum().to_be_bytes());
    fs::write(&path, &oversized).unwrap();
    let message = read_png(&path).unwrap_err().to_string();
    assert!(message.contains("65536 x 65536 pixels are declared"), "{message}");
}

#[test]
fn pictures_of_other_kinds_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    fs::write(&path, "P6 2 2 255").unwrap();
    assert!(matches!(read_picture(&path), Err(IoError::Unsupported { .. })));
    write_exr(&folder.path().join("picture.exr"), &gradient(4, 4)).unwrap();
    fs::rename(folder.path().join("picture.exr"), &path).unwrap();
    assert_eq!(read_picture(&path).unwrap(), PictureFile::Exr(gradient(4, 4)));
}

#[test]
fn png_in_memory_is_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let (path, image) = (folder.path().join("picture.png"), gradient(13, 7));
    write_png(&path, &image, [0.1, 0.2, 0.3]).unwrap();
    assert_eq!(encode_png(&image, [0.1, 0.2, 0.3]).unwrap(), fs::read(&path).unwrap());
    assert_eq!(encode_png(&LinearImage::transparent(0, 4), [0.0; 3]), None);
}

#[test]
fn other_files_are_whole_too_and_folders_are_made() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join("a/b");
    make_folder(&deep).unwrap();
    make_folder(&deep).unwrap();
    for text in ["first", "second"] {
        write_bytes(&deep.join("table.csv"), text.as_bytes()).unwrap();
        assert_eq!(fs::read_to_string(deep.join("table.csv")).unwrap(), text);
    }
    assert_eq!(names_in(&deep), ["table.csv"]);
    let error = make_folder(&deep.join("table.csv/c")).unwrap_err().to_string();
    assert!(error.contains("table.csv") && error.contains("the folder was not made"), "{error}");
    assert!(write_bytes(&deep.join("none/table.csv"), b"x").is_err());
}
