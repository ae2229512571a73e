//! `tetrascope compare` as a user runs it, on pictures whose difference is known.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;
use tetrascope::{LinearImage, read_exr, read_png, write_image};

struct Run {
    folder: tempfile::TempDir,
}

impl Run {
    /// Two pictures of 20 x 5 pixels, as .png and .exr: `b` has one pixel, column 3 of row 2, that is darker in green.
    fn new() -> Self {
        let run = Self { folder: tempfile::tempdir().unwrap() };
        let mut image = LinearImage::from_pixels(20, 5, vec![[0.25, 0.5, 0.125, 0.5]; 100]).unwrap();
        run.write("a", &image);
        image.pixels_mut()[2 * 20 + 3][1] = 0.375;
        run.write("b", &image);
        run
    }

    fn write(&self, name: &str, image: &LinearImage) {
        for extension in ["png", "exr"] {
            write_image(&self.path(&format!("{name}.{extension}")), image, [0.0; 3]).unwrap();
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn compare(&self, code: i32, args: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tetrascope"));
        let output = command.arg("compare").args(args).current_dir(self.folder.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        output
    }

    fn json(&self, code: i32, args: &[&str]) -> Value {
        serde_json::from_slice(&self.compare(code, &[args, &["--json"]].concat()).stdout).unwrap()
    }
}

#[test]
fn linear_pictures_by_known_figures() {
    let run = Run::new();
    let said = run.json(0, &["a.exr", "b.exr"]);
    assert_eq!(said["compared"], "linear floats");
    assert_eq!((&said["largest"], &said["at"]), (&0.125.into(), &serde_json::json!([3, 2])));
    // One channel of 400 is off by an eighth.
    assert_eq!(said["rms"], 0.125 / 20.0);
    assert_eq!((&said["p99.9"], &said["share_above_1/255"]), (&0.125.into(), &0.01.into()));
    let same = run.json(0, &["a.exr", "a.exr", "--threshold", "0"]);
    assert_eq!((&same["largest"], &same["threshold"]["is_within"]), (&0.0.into(), &true.into()));
    let text = String::from_utf8(run.compare(0, &["a.exr", "b.exr"]).stdout).unwrap();
    assert!(text.contains("0.125 at column 3, row 2") && text.contains("1 % of the pixels"), "{text}");
}

#[test]
fn the_exit_code_is_3_above_the_threshold() {
    let run = Run::new();
    for (code, threshold, figure) in [
        (3, "0.1249", "largest"),
        (0, "1/8", "largest"),
        (3, "1/255", "largest"),
        (0, "1/160", "rms"),
        (3, "1/161", "rms"),
        (0, "0.125", "p99.9"),
        (3, "0", "p99.9"),
    ] {
        let said = run.json(code, &["a.exr", "b.exr", "--threshold", threshold, "--figure", figure]);
        assert_eq!(said["threshold"]["is_within"], code == 0, "{threshold} {figure}");
        assert_eq!(said["threshold"]["figure"], figure);
    }
    // Without a threshold nothing is too much.
    run.compare(0, &["a.exr", "b.exr"]);
}

/// An .exr beside a .png is encoded as the .png was, so that pictures of one run are the same.
#[test]
fn encoded_pictures() {
    let run = Run::new();
    for pair in [["a.png", "a.exr"], ["a.exr", "a.png"]] {
        let said = run.json(0, &[pair[0], pair[1], "--threshold", "0"]);
        assert!(said["compared"].as_str().unwrap().contains("8-bit sRGB"), "{said}");
    }
    // Over another background it is another picture.
    run.compare(3, &["a.png", "a.exr", "--background", "1,1,1", "--threshold", "1/255"]);
    let [a, b] = ["a.png", "b.png"].map(|name| read_png(&run.path(name)).unwrap().pixels[43][1] / 257);
    let said = run.json(0, &["a.png", "b.png"]);
    assert!((said["largest"].as_f64().unwrap() - f64::from(a - b) / 255.0).abs() < 1e-6, "{said}");
    assert_eq!(said["at"], serde_json::json!([3, 2]));
}

#[test]
fn the_difference_is_a_picture() {
    let run = Run::new();
    run.compare(0, &["a.exr", "b.exr", "-o", "d.exr"]);
    let difference = read_exr(&run.path("d.exr")).unwrap();
    assert_eq!(difference.pixel(3, 2), [0.0, 0.125, 0.0, 0.0]);
    assert_eq!(difference.pixel(4, 2), [0.0; 4]);
    // It is written also where the pictures differ by too much.
    let said = run.json(3, &["a.exr", "b.exr", "--output", "d.png", "--threshold", "0"]);
    assert_eq!(said["written"], "d.png");
    let map = read_png(&run.path("d.png")).unwrap();
    assert!(map.pixels[43][0] > 50_000 && map.pixels[44][0] == 0, "{:?}", &map.pixels[43..45]);
}

#[test]
fn what_cannot_be_compared_is_said() {
    let run = Run::new();
    run.write("small", &LinearImage::transparent(4, 3));
    for (code, args, parts) in [
        (1, &["a.exr", "small.exr"][..], &["20 x 5", "4 x 3", "a.exr", "small.exr"][..]),
        (1, &["a.png", "small.exr"], &["20 x 5", "4 x 3"]),
        (1, &["a.png", "none.png"], &["none.png", "cannot be read"]),
        (2, &["a.png"], &["<B>"]),
        (2, &["a.png", "b.png", "-o", "d.jpg"], &["d.jpg", ".png and .exr"]),
        (1, &["a.png", "b.png", "-o", "none/d.png"], &["no folder none"]),
        (2, &["a.png", "b.png", "--threshold", "-1"], &["--threshold"]),
        (2, &["a.png", "b.png", "--threshold", "1/0"], &["finite"]),
        (2, &["a.png", "b.png", "--figure", "rms"], &["--threshold"]),
    ] {
        let output = run.compare(code, args);
        let text = String::from_utf8(output.stderr).unwrap();
        for part in parts {
            assert!(text.contains(part), "{args:?}: {text}");
        }
    }
    // A mesh is no picture.
    std::fs::write(run.path("mesh.png"), "<VTKFile/>").unwrap();
    run.compare(1, &["a.png", "mesh.png"]);
}
