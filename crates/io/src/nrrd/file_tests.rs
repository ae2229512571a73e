//! Data in files of their own.

use std::{fs, path::Path};

use super::tests::{packed, samples};
use crate::{IoError, Loaded, ReadOptions, read_mesh};

fn in_folder(write: impl Fn(&Path), header: &str) -> Result<Loaded, IoError> {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    let path = folder.path().join("v.nhdr");
    fs::write(&path, format!("NRRD0004\n{header}")).unwrap();
    read_mesh(&path, &ReadOptions::default())
}

#[test]
fn data_files_by_name_pattern_and_list() {
    let bytes: Vec<u8> = (0..24).collect();
    let expected: Vec<f64> = (0..24).map(f64::from).collect();
    let write = |folder: &Path| {
        fs::create_dir(folder.join("sub")).unwrap();
        fs::write(folder.join("sub/all of it.raw"), &bytes).unwrap();
        for (index, slice) in bytes.chunks(6).enumerate() {
            fs::write(folder.join(format!("slice{:03}.raw", 10 - 2 * index)), slice).unwrap();
            let gzipped = packed(slice, false);
            fs::write(folder.join(format!("slice{index}.gz")), gzipped).unwrap();
            let text: String = slice.iter().map(|sample| format!("{sample}\n")).collect();
            fs::write(folder.join(format!("slice{index}.txt")), format!("skip me\n{text}")).unwrap();
        }
        fs::write(folder.join("half0"), &bytes[..12]).unwrap();
        fs::write(folder.join("half1"), &bytes[12..]).unwrap();
        for (index, row) in bytes.chunks(3).enumerate() {
            fs::write(folder.join(format!("row{index}")), row).unwrap();
        }
    };
    let header =
        |encoding: &str, files: &str| format!("type: uint8\ndimension: 3\nsizes: 3 2 4\nencoding: {encoding}\n{files}");
    for (encoding, files) in [
        ("raw", "data file: sub/all of it.raw"),
        ("raw", "datafile: ./sub/all of it.raw\n\nthis is no part of the header"),
        ("raw", "data file: slice%03d.raw 10 4 -2"),
        ("gzip", "data file: slice%d.gz 0 3 1 2"),
        ("text", "line skip: 1\ndata file: slice%u.txt 0 3 1"),
        ("raw", "data file: row%i 0 7 1 1"),
        ("raw", "data file: half%d 0 1 1 3"),
        ("raw", "data file: LIST\nslice010.raw\n# a comment\nslice008.raw\r\nslice006.raw\nslice004.raw\n"),
        ("raw", "data file: LIST 3\nhalf0\nhalf1"),
    ] {
        let loaded = in_folder(write, &header(encoding, files)).unwrap_or_else(|error| panic!("{files}: {error}"));
        assert_eq!(samples(&loaded), expected, "{files}");
        assert!(loaded.warnings.is_empty(), "{files}: {:?}", loaded.warnings);
    }
    for (encoding, files, words) in [
        ("raw", "data file: nowhere.raw", &["line 6", "`nowhere.raw` cannot be read"][..]),
        ("raw", "data file: sub", &["no regular file"]),
        ("raw", "data file:", &["names no file"]),
        ("raw", "data file: https://example.org/a.raw", &["at an address", "not supported"]),
        ("raw", "data file: slice%03d.raw 10 6 -2", &["3 data files of 2 axes", "ask for 4"]),
        ("raw", "data file: slice%03d.raw 10 4 2", &["0 data files"]),
        ("raw", "data file: slice%03d.raw 10 4", &["no step number"]),
        ("raw", "data file: slice%d.raw 1 4 1", &["`slice1.raw` cannot be read"]),
        ("raw", "data file: slice%d.raw 1 4 1 9", &["`9` is no number of axes"]),
        ("raw", "data file: LIST 3\nhalf0\nhalf1\nslice010.raw", &["3 data files cannot share the 4 places"]),
        ("raw", "data file: LIST 3\nhalf0\n./sub/../half0", &["named twice"]),
        ("raw", "data file: LIST 3\nhalf0\nrow0", &["15 bytes hold 15"]),
        ("raw", "data file: LIST 3\nsub/all of it.raw\nrow0", &["the data file `row0`", "12 samples", "3 bytes"]),
        ("gzip", "data file: slice%03d.raw 10 4 -2", &["`slice010.raw`", "gzip"]),
        ("text", "data file: slice%d.txt 0 3 1", &["`slice0.txt`", "`skip`"]),
    ] {
        let error = in_folder(write, &header(encoding, files)).expect_err(files).to_string();
        assert!(error.contains("v.nhdr: "), "{error}");
        for word in words {
            assert!(error.contains(word), "{files}: `{word}` is not in: {error}");
        }
    }
    let longer = in_folder(write, &header("raw", "data file: LIST 3\nsub/all of it.raw\nhalf1")).unwrap();
    assert!(longer.warnings[0].contains("more data"), "{:?}", longer.warnings);
}

/// Only the files of the step are read.
#[test]
fn steps_in_files_of_their_own() {
    let header = "type: uint8\ndimension: 4\nsizes: 1 2 2 3\nencoding: text\nkinds: space space space time\ndata file: t%d.txt 0 2 1\n";
    let write = |folder: &Path| {
        fs::write(folder.join("t0.txt"), "no numbers").unwrap();
        fs::write(folder.join("t1.txt"), "nor here").unwrap();
        fs::write(folder.join("t2.txt"), "1 2 3 4").unwrap();
    };
    let loaded = in_folder(write, header).unwrap();
    assert_eq!(samples(&loaded), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!((loaded.times, loaded.step), (vec![0.0, 1.0, 2.0], 2));
    assert!(loaded.format.contains("3 data files"));
}
