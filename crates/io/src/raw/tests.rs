//! Raw volumes by what the user says and by their names.

use std::{fs, io::Write, path::Path};

use proptest::prelude::*;
use tetrascope_mesh::ArrayValues;

use super::*;
use crate::{ReadOptions, read_mesh, shared::shared};

fn options(word: &str) -> ReadOptions {
    ReadOptions { raw: Some(word.parse().unwrap()), ..ReadOptions::default() }
}

fn source(name: &str, bytes: &[u8], raw: Option<&str>) -> Source {
    let options = raw.map(options).unwrap_or_default();
    Source { path: name.into(), bytes: bytes.to_vec(), options }
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn words_of_the_command_line() {
    assert_eq!("64x32x16:uint8".parse(), Ok(RawVolume::new([64, 32, 16], SampleType::U8)));
    let all: RawVolume =
        "4X3X2 : f32 : big : skip=16 : components=3 : spacing=1,-2,.5 : origin=1e3,0,-1".parse().unwrap();
    let expected = RawVolume {
        size: [4, 3, 2],
        sample: SampleType::F32,
        order: ByteOrder::Big,
        components: 3,
        spacing: [1.0, -2.0, 0.5],
        origin: [1000.0, 0.0, -1.0],
        skip: 16,
    };
    assert_eq!(all, expected);
    for word in ["64x32x16:uint8", "4x3x2:float32:big:components=3:spacing=1.0,-2.0,0.5:origin=1000.0,0.0,-1.0:skip=16"]
    {
        assert_eq!(word.parse::<RawVolume>().unwrap().to_string(), word);
    }
    assert_eq!("103x94x161:u16:le".parse::<RawVolume>().unwrap().order, ByteOrder::Little);
    for (word, named) in [
        ("", "size"),
        ("64x64:u8", "size"),
        ("64x0x64:u8", "size"),
        ("64x+4x64:u8", "size"),
        ("4x4x4x4:u8", "size"),
        ("99999999999999999999x1x1:u8", "size"),
        ("4x4x4", "type"),
        ("4x4x4:char", "`char`"),
        ("4x4x4:u8:middle", "`middle`"),
        ("4x4x4:u8:components=0", "`components=0`"),
        ("4x4x4:u8:spacing=1,1", "`spacing=1,1`"),
        ("4x4x4:u8:spacing=1,1,0", "`spacing=1,1,0`"),
        ("4x4x4:u8:origin=1,1,inf", "`origin=1,1,inf`"),
        ("4x4x4:u8:skip=-1", "`skip=-1`"),
    ] {
        let error = word.parse::<RawVolume>().unwrap_err();
        assert!(error.contains(named) && error.contains("64x64x64:uint8"), "{error}");
    }
}

#[test]
fn names_that_tell() {
    let told = |name: &str| name::volume(Path::new(name));
    let u8s = RawVolume::new([64, 64, 64], SampleType::U8);
    assert_eq!(told("a/neghip_64x64x64_uint8.raw"), Some(u8s));
    assert_eq!(told("foot-256x256x128-UInt16-big.RAW").unwrap().order, ByteOrder::Big);
    assert_eq!(told("x.float32.9x8x7.dat").unwrap().sample, SampleType::F32);
    for name in ["neghip_64x64x64.raw", "neghip_uint8.raw", "64x64x64_uint8.png", "64x64x64_uint8", "0x1x2_uint8.raw"] {
        assert_eq!(told(name), None, "{name}");
    }
    assert_eq!(RawVolume::of_name(Path::new("n_2x3x4_u16.raw"), 48).unwrap().size, [2, 3, 4]);
    assert_eq!(RawVolume::of_name(Path::new("n_2x3x4_u16.raw"), 49), None);
    assert_eq!(RawVolume::of_name(Path::new("n_4294967296x4294967296x4_u16.raw"), 0), None);
}

#[test]
fn samples_points_and_components() {
    let bytes: Vec<u8> = (0..2 * 3 * 2 * 2).flat_map(|i: i16| (i - 5).to_be_bytes()).collect();
    let mut file = vec![0xff; 7];
    file.extend(&bytes);
    let word = "2x3x2:short:big:components=2:spacing=1,2,-3:origin=5,0,0:skip=7";
    let loaded = RAW.read(&source("anything", &file, Some(word))).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert_eq!(loaded.format, "raw volume, 2x3x2 samples of 2 int16, big-endian");
    assert_eq!(loaded.dataset.points[0], DVec3::new(5.0, 0.0, 0.0));
    assert_eq!(loaded.dataset.points[11], DVec3::new(6.0, 4.0, -3.0));
    let array = &loaded.dataset.point_arrays[0];
    assert_eq!((array.components, array.tuple_count()), (2, 12));
    assert!(matches!(&array.values, ArrayValues::I16(v) if *v == (-5..19).collect::<Vec<i16>>()));
}

#[test]
fn files_that_are_too_short_or_too_long() {
    let read = |bytes: usize, word: &str| RAW.read(&source("v.raw", &vec![1; bytes], Some(word)));
    for (bytes, word, named) in [
        (7, "2x2x2:u8", "the file has 7"),
        (8, "2x2x2:u8:skip=1", "9 bytes"),
        (8, "2x2x2:u8:skip=18446744073709551615", "18446744073709551615"),
        (8, "4294967295x4294967295x4294967295:f64", "4294967295"),
        (8, "2x2x2:f64:components=18446744073709551615", "counted"),
    ] {
        let error = read(bytes, word).unwrap_err().to_string();
        assert!(error.starts_with("v.raw: ") && error.contains(named) && error.contains("--raw"), "{error}");
    }
    let longer = read(10, "2x2x2:u8").unwrap();
    assert!(longer.warnings[0].contains("2 bytes behind") && longer.warnings[0].contains("skip=2"));
    assert!(read(4, "2x2x1:u8").unwrap().warnings[0].contains("one sample thick"));
}

#[test]
fn compressed_files() {
    let bytes: Vec<u8> = (0..125).collect();
    let loaded = RAW.read(&source("n_5x5x5_u8.raw.gz", &packed(&bytes), Some("5x5x5:u8"))).unwrap();
    assert_eq!(loaded.dataset.point_arrays[0].component(0)[124], 124.0);
    assert!(loaded.format.ends_with("gzip"));
    let wrong = RAW.read(&source("n.raw", &packed(&bytes), Some("5x5x6:u8"))).unwrap_err();
    assert!(wrong.to_string().contains("150 bytes"), "{wrong}");
    let bomb = RAW.read(&source("n.raw", &packed(&[0; 5000]), Some("1000x1000x1000:u8"))).unwrap_err();
    assert!(bomb.to_string().contains("4194304 samples"), "{bomb}");
}

#[test]
fn the_user_and_the_name_come_before_the_content() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    // Content of another format, but the user says what it is.
    let text = write("text.vtu", b"<VTKFile>0123456");
    let loaded = read_mesh(&text, &options("4x2x2:u8")).unwrap();
    assert_eq!(loaded.dataset.point_arrays[0].component(0)[0], f64::from(b'<'));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);

    let named = write("v_2x2x2_u8.dat", &[7; 8]);
    let loaded = read_mesh(&named, &ReadOptions::default()).unwrap();
    assert_eq!(loaded.warnings.len(), 1);
    assert!(loaded.warnings[0].contains("2x2x2 samples of uint8") && loaded.warnings[0].contains("name"));

    let compressed = write("v_2x2x2_u8.raw.gz", &packed(&[7; 8]));
    let loaded = read_mesh(&compressed, &ReadOptions::default()).unwrap();
    assert!(loaded.format.ends_with("gzip") && loaded.warnings.len() == 1, "{:?}", loaded.warnings);
    let other = read_mesh(&write("v_2x2x2_u8.vtu.gz", &packed(&[7; 8])), &ReadOptions::default()).unwrap_err();
    assert!(other.to_string().contains("gzip archive"), "{other}");

    // A name alone is not enough where the length says otherwise.
    let shorter = read_mesh(&write("v_2x2x3_u8.raw", &[7; 8]), &ReadOptions::default()).unwrap_err();
    assert!(shorter.to_string().contains("the file has 8"), "{shorter}");
    let unnamed = read_mesh(&write("v.raw", &[7; 8]), &ReadOptions::default()).unwrap_err();
    assert!(unnamed.to_string().contains("--raw 64x64x64:uint8"), "{unnamed}");
}

/// What the file holds is the crate's test of all shared files.
#[test]
fn shared_files_by_their_names() {
    for (file, word) in
        [("neghip_64x64x64_uint8.raw", "64x64x64:uint8"), ("tooth_103x94x161_uint8.raw", "103x94x161:u8")]
    {
        let Some(path) = shared(&format!("data/volume/{file}")) else { return };
        let by_name = read_mesh(&path, &ReadOptions::default()).unwrap();
        let said = read_mesh(&path, &options(word)).unwrap();
        assert!(by_name.warnings.len() == 1 && said.warnings.is_empty(), "{:?}", by_name.warnings);
        assert_eq!(by_name.dataset.points, said.dataset.points, "{file}");
        let samples = |loaded: &Loaded| loaded.dataset.point_arrays[0].values.to_f64();
        assert_eq!(samples(&by_name), samples(&said), "{file}");
    }
}

/// Words may come from scene files, and are shown.
#[test]
fn refused_words_can_be_shown() {
    let problem = format!("3x\0\u{1b}[2J{}", "x".repeat(9999)).parse::<RawVolume>().unwrap_err();
    assert!(!problem.contains(char::is_control) && problem.len() < 1000, "{problem}");
}

proptest! {
    #[test]
    fn any_word_is_a_volume_or_an_error(word in "[0-9x:a-z=,.]{0,40}", bytes in prop::collection::vec(any::<u8>(), 0..60)) {
        if let Ok(volume) = word.parse::<RawVolume>() {
            let options = ReadOptions { raw: Some(volume), ..ReadOptions::default() };
            let _ = RAW.read(&Source { path: "v".into(), bytes, options });
        }
    }

    #[test]
    fn sizes_that_nearly_fit(
        size in prop::array::uniform3(1..5_usize),
        skip in 0..4_usize,
        components in 1..4_usize,
        bytes in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let volume = RawVolume { skip, components, ..RawVolume::new(size, SampleType::I16) };
        let fits = bytes.len() >= skip + 2 * components * size.iter().product::<usize>();
        let options = ReadOptions { raw: Some(volume), ..ReadOptions::default() };
        prop_assert_eq!(RAW.read(&Source { path: "v".into(), bytes, options }).is_ok(), fits);
    }
}
