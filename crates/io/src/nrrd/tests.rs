//! NRRD files made here: every type, encoding, order and layout of axes.

use std::io::Write;

use glam::DVec3;
use tetrascope_mesh::{Cells, Dataset, decompose};

use super::*;
use crate::{ReadOptions, StepChoice};

/// A header of the newest version with these lines, and data behind it.
pub(super) fn file(lines: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = format!("NRRD0005\n# made by a test\n{lines}\n\n").into_bytes();
    bytes.extend_from_slice(data);
    bytes
}

pub(super) fn read_with(bytes: Vec<u8>, step: StepChoice) -> Result<Loaded, IoError> {
    let options = ReadOptions { step, ..ReadOptions::default() };
    NRRD.read(&Source { path: "v.nrrd".into(), bytes, options })
}

pub(super) fn read(lines: &str, data: &[u8]) -> Loaded {
    read_with(file(lines, data), StepChoice::Last).unwrap_or_else(|error| panic!("{error}"))
}

pub(super) fn fails(lines: &str, data: &[u8], words: &[&str]) {
    let error = read_with(file(lines, data), StepChoice::Last).expect_err(lines).to_string();
    let (_, remedy) = error.rsplit_once("; ").unwrap_or_default();
    assert!(error.starts_with("v.nrrd: ") && !remedy.is_empty(), "{error}");
    for word in words {
        assert!(error.contains(word), "`{word}` is not in: {error}");
    }
}

/// Fails unless the dataset keeps what its type promises.
pub(super) fn sanity_check(dataset: &Dataset) {
    let Cells::Structured(blocks) = &dataset.cells else { panic!("a volume is a block") };
    assert_eq!(blocks.len(), 1);
    assert_eq!(blocks[0].point_count(), dataset.points.len());
    for array in &dataset.point_arrays {
        assert!(array.components > 0);
        assert_eq!(array.values.len(), array.components * dataset.points.len());
    }
}

pub(super) fn samples(loaded: &Loaded) -> Vec<f64> {
    sanity_check(&loaded.dataset);
    loaded.dataset.point_arrays[0].values.to_f64()
}

pub(super) fn packed(bytes: &[u8], bzip2: bool) -> Vec<u8> {
    if bzip2 {
        let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::default());
        encoder.write_all(bytes).unwrap();
        return encoder.finish().unwrap();
    }
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

const SMALL: &str = "dimension: 3\nsizes: 2 3 2\n";

#[test]
fn every_type_in_both_orders_and_all_encodings() {
    macro_rules! check {
        ($($type:ty: $name:literal),*) => {$(
            let numbers: Vec<$type> = (0..12).map(|i| (i * 9) as $type).collect();
            let expected: Vec<f64> = (0..12).map(|i| f64::from(i * 9)).collect();
            for big in [false, true] {
                let bytes: Vec<u8> = numbers
                    .iter()
                    .flat_map(|number| if big { number.to_be_bytes() } else { number.to_le_bytes() })
                    .collect();
                let hex: String = bytes.iter().map(|byte| format!("{byte:02x}\n")).collect();
                let text: Vec<String> = numbers.iter().map(|number| number.to_string()).collect();
                let encodings = [
                    ("raw", bytes.clone()),
                    ("gzip", packed(&bytes, false)),
                    ("bz2", packed(&bytes, true)),
                    ("hex", hex.to_ascii_uppercase().into_bytes()),
                    ("ascii", text.join(", ").into_bytes()),
                ];
                for (encoding, data) in encodings {
                    let order = if big { "big" } else { "little" };
                    let lines = format!("{SMALL}type: {}\nendian: {order}\nencoding: {encoding}", $name);
                    let loaded = read(&lines, &data);
                    assert_eq!(samples(&loaded), expected, "{lines}");
                    assert_eq!(loaded.warnings, [""; 0], "{lines}");
                    let mut longer = data.clone();
                    longer.extend(b" 17 ");
                    assert!(read(&lines, &longer).warnings[0].contains("more data"), "{lines}");
                    let mut shorter = data.clone();
                    shorter.truncate(data.len() - 3);
                    fails(&lines, &shorter, &["the data"]);
                }
            }
        )*};
    }
    check!(i8: "signed char", u8: "uchar", i16: "int16", u16: "unsigned short", i32: "int", u32: "uint32_t");
    check!(i64: "longlong", u64: "unsigned long long int", f32: "float", f64: "double");
}

#[test]
fn text_with_numbers_that_are_none() {
    let loaded = read("dimension: 3\ntype: float\nencoding: txt\nsizes: 2 2 1\nendian: big", b"1e3,NaN\n-inf\t+.5 ");
    let found = samples(&loaded);
    assert!(found[0] == 1000.0 && found[1].is_nan() && found[2] == f64::NEG_INFINITY && found[3] == 0.5);
    assert!(loaded.warnings[0].contains("one sample thick"));
    fails("dimension: 3\ntype: uint8\nencoding: txt\nsizes: 2 2 1", b"1 2 300 4", &["sample 2", "`300`", "uint8"]);
    fails("dimension: 3\ntype: uint8\nencoding: hex\nsizes: 2 2 1", b"00 01 0g 04", &["byte 2", "`g`"]);
}

#[test]
fn lines_and_bytes_before_the_data() {
    let lines = |encoding: &str, skips: &str| format!("{SMALL}type: uint8\nencoding: {encoding}\n{skips}");
    let data: Vec<u8> = (0..12).collect();
    let expected: Vec<f64> = (0..12).map(f64::from).collect();
    let behind = |before: &[u8], data: &[u8], after: &[u8]| [before, data, after].concat();
    for (skips, file) in [
        ("line skip: 2\nbyte skip: 3", behind(b"P5\n# x\nabc", &data, b"")),
        ("byteskip: -1", behind(b"any number of bytes", &data, b"")),
        ("line skip: 1\nbyte skip: -4", behind(b"\nabc", &data, b"end")),
    ] {
        let loaded = read(&lines("raw", skips), &file);
        assert_eq!(samples(&loaded), expected, "{skips}");
        assert_eq!(loaded.warnings, [""; 0]);
    }
    // Of compressed data the lines are skipped before it is unpacked, and the bytes after.
    let inside = packed(&behind(b"abc", &data, b"end"), false);
    for skips in ["line skip: 1\nbyte skip: 3", "line skip: 1\nbyte skip: -4"] {
        assert_eq!(samples(&read(&lines("gz", skips), &behind(b"one\n", &inside, b""))), expected, "{skips}");
    }
    assert_eq!(samples(&read(&lines("text", "byte skip: 4"), b"xxxx0 1 2 3 4 5 6 7 8 9 10 11")), expected);
    for (encoding, skips, words) in [
        ("raw", "byte skip: -2", &["the data", "12 bytes are needed"][..]),
        ("raw", "byte skip: -9223372036854775808", &["12 bytes are needed"]),
        ("raw", "byte skip: 9223372036854775807", &["12 bytes are needed"]),
        ("raw", "byte skip: 1", &["12 bytes are needed", "there are 12"]),
        ("raw", "line skip: 9", &["fewer than the 9 lines"]),
        ("raw", "line skip: -1", &["line skip"]),
        ("raw", "line skip: x", &["line 7", "`x`"]),
        ("text", "byte skip: -1", &["byte skip"]),
    ] {
        fails(&lines(encoding, skips), &data, words);
    }
    fails(&lines("gzip", "byte skip: 9223372036854775807"), &packed(&data, false), &["stands for more than"]);
    fails(&lines("gzip", "byte skip: -9223372036854775807"), &packed(&data, false), &["unpacks to 12 bytes"]);
    fails(&lines("gzip", ""), &[7; 99], &["does not begin as a gzip stream"]);
}

#[test]
fn positions_by_directions() {
    let oblique =
        "space: left-posterior-superior\nspace directions: (1, 0.5,0) (0,2,0)  (0,0,-3)\nspace origin: (10,20,30)";
    let loaded = read(&format!("{SMALL}type: uint8\nencoding: raw\n{oblique}"), &[0; 12]);
    assert!(loaded.format.ends_with("raw, space left-posterior-superior"), "{}", loaded.format);
    let points = &loaded.dataset.points;
    assert_eq!(points[0], DVec3::new(10.0, 20.0, 30.0));
    assert_eq!(points[1], DVec3::new(11.0, 20.5, 30.0));
    assert_eq!(points[11], DVec3::new(11.0, 24.5, 27.0));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    // Turned over, cells still have the volume of the box.
    let cut = decompose(&loaded.dataset).unwrap();
    assert_eq!(cut.mesh.tetrahedra().len(), 2 * 5);
    assert!(points.len() == 12 && cut.counts.no_volume == 0);

    let left = read(&format!("{SMALL}type: uint8\nencoding: raw\nspace: 3D-left-handed\nspacings: 1 2 nan"), &[0; 12]);
    assert_eq!(left.dataset.points[11], DVec3::new(1.0, 4.0, 1.0));
    assert!(left.warnings[0].contains("left-handed"), "{:?}", left.warnings);
}

#[test]
fn positions_by_mins_and_spacings() {
    let at = |more: &str| {
        let loaded = read(&format!("{SMALL}type: uint8\nencoding: raw\n{more}"), &[0; 12]);
        (loaded.dataset.points[0], loaded.dataset.points[11])
    };
    let nodes = "centers: node node node\naxis mins: 0 0 -1\naxis maxs: 1 4 1";
    assert_eq!(at(nodes), (DVec3::new(0.0, 0.0, -1.0), DVec3::new(1.0, 4.0, 1.0)));
    let cells = "centerings: cell cell cell\naxismins: 0 0 0\naxismaxs: 2 6 4";
    assert_eq!(at(cells), (DVec3::new(0.5, 1.0, 1.0), DVec3::new(1.5, 5.0, 3.0)));
    let spaced = "spacings: 1 -2 .5\nspace dimension: 3\nspace origin: (1,2,3)";
    assert_eq!(at(spaced), (DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, -2.0, 3.5)));
    assert_eq!(at(""), (DVec3::ZERO, DVec3::new(1.0, 2.0, 1.0)));
}

#[test]
fn spaces_that_are_none() {
    for (more, words) in [
        ("space directions: (1,0,0) (0,1,0) (1,1,0)", &["no grid in space"][..]),
        ("space directions: (1,0,0) (0,1,0) (0,0,inf)", &["no grid in space"]),
        ("space directions: (1,0,0) (0,1,0)", &["line 7", "2 vectors"]),
        ("space directions: (1,0) (0,1) (1,1)", &["no vector of three"]),
        ("space directions: (1,0,0) (0,1,0) (0,1)", &["differ in length"]),
        ("space directions: (1,0,0) (0,1,0) (0,a,1)", &["line 7", "(0,a,1)"]),
        ("space directions: (1,0,0) (0,1,0) (0,0,1", &["line 7"]),
        ("space directions: (1,0,0) (0,1,0) none", &["2 axes of space"]),
        ("space origin: (1,0)", &["line 7", "three numbers"]),
        ("space origin: (1,0,1e999)", &["no grid in space"]),
        ("spacings: 1 0 1", &["no grid in space"]),
        ("spacings: 1 1", &["line 7", "2 words"]),
        ("axis mins: 1 x 1", &["line 7", "`x`"]),
    ] {
        fails(&format!("{SMALL}type: uint8\nencoding: raw\n{more}"), &[0; 12], words);
    }
    // The product of these lengths is no number, but the grid is one.
    read(&format!("{SMALL}type: uint8\nencoding: raw\nspacings: 1e-200 1e-200 1e-200"), &[0; 12]);
}

#[test]
fn components_first_and_last() {
    let data: Vec<u8> = (0..24).collect();
    let beside = "type: uint8\nencoding: raw\ndimension: 4\nsizes: 2 2 3 2\nkinds: 2-vector domain domain domain";
    let loaded = read(beside, &data);
    assert_eq!(loaded.dataset.point_arrays[0].components, 2);
    assert_eq!(samples(&loaded), (0..24).map(f64::from).collect::<Vec<_>>());
    let planes = "type: uint8\nencoding: raw\ndimension: 4\nsizes: 2 3 2 2\nkinds: space space space complex";
    let loaded = read(planes, &data);
    assert_eq!(loaded.dataset.points.len(), 12);
    assert_eq!(loaded.dataset.point_arrays[0].component(1), (12..24).map(f64::from).collect::<Vec<_>>());
    assert!(loaded.warnings.is_empty() && loaded.times.is_empty());
    // Between axes of space, and two of them: six numbers a point.
    let between =
        "type: uint8\nencoding: raw\ndimension: 5\nsizes: 3 2 2 2 1\nkinds: RGB-color domain 2-vector domain domain";
    let loaded = read(between, &data);
    assert_eq!(loaded.dataset.point_arrays[0].components, 6);
    assert_eq!(samples(&loaded)[..12], [0., 1., 2., 6., 7., 8., 3., 4., 5., 9., 10., 11.]);
    let by_direction =
        "type: uint8\nencoding: raw\ndimension: 4\nsizes: 2 2 3 2\nspace directions: none (1,0,0) (0,1,0) (0,0,1)";
    assert_eq!(read(by_direction, &data).dataset.point_arrays[0].components, 2);
    let untold = read("type: uint8\nencoding: raw\ndimension: 4\nsizes: 2 2 3 2", &data);
    assert!(
        untold.dataset.point_arrays[0].components == 2 && untold.warnings[0].contains("fastest"),
        "{:?}",
        untold.warnings
    );
    let frame = format!("{beside}\nspace dimension: 3\nmeasurement frame: (0,1,0) (1,0,0) (0,0,1)");
    assert!(read(&frame, &data).warnings[0].contains("measurement frame"));
    let identity = format!("{beside}\nmeasurement frame: (1,0,0) (0,1.0,0) (0,0,1)");
    assert!(read(&identity, &data).warnings.is_empty());
}

#[test]
fn steps_of_time() {
    let data: Vec<u8> = (0..36).collect();
    let lines = |more: &str| format!("type: uint8\ndimension: 4\nsizes: 2 3 2 3\nencoding: raw\n{more}");
    let step = |lines: &str, data: &[u8], step: StepChoice| {
        let loaded = read_with(file(lines, data), step).unwrap_or_else(|error| panic!("{error}"));
        (samples(&loaded)[0], loaded.times, loaded.step)
    };
    let timed = lines("kinds: domain domain domain time\nspacings: 1 1 1 0.5\naxis mins: nan nan nan 2");
    let times = vec![2.0, 2.5, 3.0];
    assert_eq!(step(&timed, &data, StepChoice::Last), (24.0, times.clone(), 2));
    assert_eq!(step(&timed, &data, StepChoice::Number(0)), (0.0, times.clone(), 0));
    assert_eq!(step(&timed, &data, StepChoice::Time(2.6)), (12.0, times, 1));
    for more in [
        "kinds: domain domain domain list",
        "kinds: domain domain domain domain",
        "space directions: (1,0,0) (0,1,0) (0,0,1) none",
    ] {
        assert_eq!(step(&lines(more), &data, StepChoice::Number(1)), (12.0, vec![0.0, 1.0, 2.0], 1), "{more}");
    }
    let four =
        "space: scanner-xyz-time\nspace directions: (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,5)\nspace origin: (0,0,0,7)";
    assert_eq!(step(&lines(four), &data, StepChoice::Last), (24.0, vec![7.0, 12.0, 17.0], 2));
    // The fastest axis may be time, too.
    let fastest = "type: uint8\ndimension: 4\nsizes: 3 2 3 2\nencoding: raw\nkinds: time domain domain domain";
    let loaded = read_with(file(fastest, &data), StepChoice::Number(1)).unwrap();
    assert_eq!(samples(&loaded), (0..12).map(|i| f64::from(3 * i + 1)).collect::<Vec<_>>());
    // Of text and of compressed data, too.
    let text: String = data.iter().map(|sample| format!("{sample} ")).collect();
    for (encoding, data) in
        [("text", text.into_bytes()), ("gzip", packed(&data, false)), ("bzip2", packed(&data, true))]
    {
        let lines = timed.replace("encoding: raw", &format!("encoding: {encoding}"));
        assert_eq!(step(&lines, &data, StepChoice::Number(1)).0, 12.0, "{encoding}");
    }
    let error = read_with(file(&timed, &data), StepChoice::Number(3)).unwrap_err().to_string();
    assert!(error.contains("no step 3"), "{error}");
}

#[test]
fn headers_that_are_odd_or_wrong() {
    let odd = "Type: UINT8\r\nENCODING:RAW\r\nsizes:  2   3 2\r\ndimension: 3\r\nwhatever: 1\r\nkey:=a: b\r\nmy key:=1\r\nlabels: \"x\" \"y\" \"z: w\"\r\nspace units: \"mm\" \"mm\" \"mm\"\r";
    let mut bytes = format!("NRRD0009\r\n{odd}\n\r\n").into_bytes();
    bytes.extend([5; 12]);
    let loaded = read_with(bytes, StepChoice::Last).unwrap();
    assert_eq!(samples(&loaded), [5.0; 12]);
    assert!(loaded.warnings.iter().any(|warning| warning.contains("version 9")), "{:?}", loaded.warnings);
    assert!(loaded.warnings.iter().any(|warning| warning.contains("1 lines") && warning.contains("`whatever`")));
    let no_order = read(&format!("{SMALL}type: short\nencoding: raw\nold min: 0\nold max: 1"), &[0; 24]);
    assert!(no_order.warnings[0].contains("little-endian") && no_order.warnings[1].contains("quantized"));

    let good = format!("{SMALL}type: uint8\nencoding: raw");
    for (from, to, words) in [
        ("dimension: 3", "", &["no field `dimension`"][..]),
        ("dimension: 3", "dimension: 17", &["line 3", "`17`"]),
        ("dimension: 3", "dimension: 2", &["line 4", "3 sizes are given for 2"]),
        ("dimension: 3\nsizes: 2 3 2", "dimension: 2\nsizes: 2 3", &["2x3", "2 axes of space"]),
        (
            "dimension: 3\nsizes: 2 3 2",
            "dimension: 5\nsizes: 2 3 2 1 1\nkinds: space space space space space",
            &["5 axes of space"],
        ),
        ("sizes: 2 3 2", "sizes: 2 0 2", &["line 4", "`0`"]),
        ("sizes: 2 3 2", "sizes: 2 -3 2", &["`-3`"]),
        ("sizes: 2 3 2", "sizes: 2 3 2\nsizes: 2 3 2", &["line 5", "stands in line 4"]),
        ("sizes: 2 3 2", "sizes: 2 3 99999999999", &["more than the"]),
        ("sizes: 2 3 2", "sizes: 2 3 999", &["5994 samples", "12 bytes"]),
        ("type: uint8", "", &["no field `type`"]),
        ("type: uint8", "type: char", &["line 5", "`char`"]),
        ("type: uint8", "type: block\nblock size: 3", &["blocks is not supported"]),
        ("type: uint8", "type: uint8\nendian: middle\nno colon", &["line 7", "`no colon`"]),
        ("type: uint8", "type: uint8\nendian: middle", &["line 6", "`middle`"]),
        ("encoding: raw", "encoding: zrl", &["`zrl` is not supported"]),
        ("encoding: raw", "", &["no field `encoding`"]),
    ] {
        // A field that is not there must leave no empty line, which would end the header.
        fails(&good.replace(from, if to.is_empty() { "# nothing" } else { to }), &[0; 12], words);
    }
    let error =
        read_with(b"NRRD0004\ntype: uint8\nencoding: raw\ndimension: 3\nsizes: 1 1 1".to_vec(), StepChoice::Last);
    assert!(error.unwrap_err().to_string().contains("no empty line ends the header"));
    let error = read_with(b"NRRD00x1\n\n".to_vec(), StepChoice::Last).unwrap_err().to_string();
    assert!(error.contains("line 1") && error.contains("`NRRD00x1`"), "{error}");
}

#[test]
fn little_that_would_be_much() {
    let lines = "type: uint8\nencoding: gzip\ndimension: 3\nsizes: 2000 2000 1000";
    fails(lines, &packed(&[0; 1 << 20], false), &["4000000000 samples", "4194304 at most", "encoding raw"]);
    let steps = "type: uint8\nencoding: raw\ndimension: 4\nsizes: 1 1 1 9999999999999\nkinds: space space space time";
    fails(steps, &[0; 99], &["9999999999999 samples"]);
    // Up to the limit what is not there is an error as well.
    fails(&lines.replace("2000 2000 1000", "100 100 100"), &packed(&[0; 999], false), &["999 bytes", "1000000 bytes"]);
}
