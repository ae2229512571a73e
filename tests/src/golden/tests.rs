//! The checks themselves, on a made-up folder: what is wrong must be found.

use std::fs;
use std::path::PathBuf;

use super::*;

/// A folder of its own for every test, with one scene in it, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("tetrascope-golden-{}-{test}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        for file in ["tetrahedron.toml", "tetrahedron.vtu"] {
            fs::copy(folder().join(file), path.join(file)).unwrap();
        }
        Self(path)
    }

    fn check(&self) -> Vec<String> {
        let outcomes = check(&self.0, &ONE, &self.0.join("evidence"));
        outcomes.into_iter().flat_map(|o| o.failures).collect()
    }

    fn change(&self, change: impl Fn(&mut [[f32; 4]])) {
        let path = self.0.join("tetrahedron.exr");
        let mut image = read_exr(&path).unwrap();
        change(image.pixels_mut());
        write_exr(&path, &image).unwrap();
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const ONE: [Golden; 1] = [Golden { name: "tetrahedron", fast: Fast::Within(2e-5) }];

#[test]
fn missing_reference_fails() {
    let folder = Folder::new("missing");
    assert!(folder.check()[0].contains("tetrahedron.exr is missing"), "{:?}", folder.check());
}

#[test]
fn regenerating_writes_once() {
    let folder = Folder::new("once");
    assert_eq!(regenerate(&folder.0, &ONE).unwrap(), ["tetrahedron"]);
    assert_eq!(folder.check(), [""; 0]);
    assert!(regenerate(&folder.0, &ONE).unwrap().is_empty());
    fs::remove_file(folder.0.join("tetrahedron.txt")).unwrap();
    assert!(folder.check()[0].contains("tetrahedron.txt"));
    assert_eq!(regenerate(&folder.0, &ONE).unwrap(), ["tetrahedron"]);
}

#[test]
fn changed_channel_is_found_and_leaves_evidence() {
    for channel in 0..4 {
        let folder = Folder::new(&format!("channel-{channel}"));
        regenerate(&folder.0, &ONE).unwrap();
        folder.change(|pixels| pixels[77][channel] += 3e-5);
        let failures = folder.check();
        assert_eq!(failures.len(), 2, "reference and fast renderer: {failures:?}");
        assert!(failures[0].contains("column 13, row 1"), "{failures:?}");
        for file in ["expected.exr", "actual.png", "difference.png", "difference.exr", "summary.txt"] {
            for backend in [Backend::Reference, Backend::Cpu] {
                let path = folder.0.join("evidence").join(format!("tetrahedron-{backend}-{file}"));
                assert!(path.is_file(), "{}", path.display());
            }
        }
        // Nothing stays of a failure that is mended.
        regenerate(&folder.0, &ONE).unwrap();
        assert_eq!(folder.check(), [""; 0]);
        assert_eq!(fs::read_dir(folder.0.join("evidence")).unwrap().count(), 0);
    }
}

#[test]
fn probes_belong_to_the_picture() {
    let folder = Folder::new("probes");
    regenerate(&folder.0, &ONE).unwrap();
    let path = folder.0.join("tetrahedron.txt");
    let text = fs::read_to_string(&path).unwrap();
    for (wrong, expected) in [
        (text.replace("32 32   ", "33 32   "), "tetrahedron.txt says"),
        (text.replace("32 32   ", "32 99   "), "not in the picture"),
        (text.replace("32 32   ", "32   "), "is not a column"),
        ("# nothing\n".to_owned(), "names no pixel"),
    ] {
        fs::write(&path, wrong).unwrap();
        assert!(folder.check()[0].contains(expected), "{:?}", folder.check());
    }
}

#[test]
fn unexpected_pass_fails() {
    let folder = Folder::new("pass");
    regenerate(&folder.0, &ONE).unwrap();
    let scenes = [Golden { name: "tetrahedron", fast: Fast::Wrong { beyond: 1e-2, why: "it was" } }];
    let outcomes = check(&folder.0, &scenes, &folder.0.join("evidence"));
    assert!(outcomes[0].failures[0].contains("if it is right now"), "{outcomes:?}");
}

#[test]
fn review_shows_what_changed() {
    let folder = Folder::new("review");
    regenerate(&folder.0, &ONE).unwrap();
    let evidence = folder.0.join("evidence");
    let same = review(&folder.0, &ONE, &evidence, |name| stored(&folder.0, name).ok()).unwrap();
    assert!(same.is_empty());
    folder.change(|pixels| pixels[5][3] += 0.25);
    let changed = review(&folder.0, &ONE, &evidence, |name| stored(&folder.0, name).ok()).unwrap();
    assert!(changed[0].picture.is_file());
    assert!((changed[0].factor.unwrap() - 4.0).abs() < 1e-5);
    let new = review(&folder.0, &ONE, &evidence, |_| None).unwrap();
    assert_eq!(new[0].factor, None);
}

#[test]
fn probes_read_back() {
    let mut image = LinearImage::transparent(64, 64);
    image.pixels_mut()[32 * 64 + 32] = [0.1, 1.0 / 3.0, 1e-20, 1.0];
    assert_eq!(parse_probes(&print_probes(&image)).unwrap(), probe(&image));
}
