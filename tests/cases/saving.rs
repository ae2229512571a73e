//! Pictures appear whole or not at all.

use std::path::{Path, PathBuf};

use tetrascope::{Error, Picture, SceneFile, Silent, Volume, mesh::rings_sample, read_exr, render_volume};

fn picture() -> Picture {
    let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
    (scene.image.width, scene.image.height) = (16, 12);
    render_volume(&Volume::from_dataset(rings_sample(3), "rings").unwrap(), &scene, &Silent).unwrap()
}

/// An empty folder of this test's own.
fn folder(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("saving-{test}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn failed_saves_leave_nothing() {
    let (picture, folder) = (picture(), folder("failed"));
    let missing = folder.join("missing");
    for (path, words) in [
        (missing.join("a.png"), "a.png"),
        (missing.join("a.exr"), "a.exr"),
        (folder.join("a.jpg"), "jpg"),
        (folder.join("a"), "png"),
        (folder.join("a.png.part"), "png"),
    ] {
        let error = picture.save(&path).unwrap_err();
        assert!(matches!(error, Error::Io(_)), "{error:?}");
        let text = error.to_string();
        assert!(text.contains(words), "{text}");
        assert_eq!(names(&folder), Vec::<String>::new(), "{}", path.display());
    }
    // A folder in the picture's place stays.
    std::fs::create_dir(folder.join("taken.png")).unwrap();
    assert!(matches!(picture.save(folder.join("taken.png")), Err(Error::Io(_))));
    assert_eq!(names(&folder), ["taken.png"]);
    assert_eq!(names(&folder.join("taken.png")), Vec::<String>::new());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn failed_saves_keep_what_was_there() {
    let (picture, folder) = (picture(), folder("kept"));
    let path = folder.join("old.jpg");
    std::fs::write(&path, b"an older picture").unwrap();
    picture.save(&path).unwrap_err();
    assert_eq!(std::fs::read(&path).unwrap(), b"an older picture");
    assert_eq!(names(&folder), ["old.jpg"]);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn saves_replace_and_come_back() {
    let (picture, folder) = (picture(), folder("replaced"));
    for name in ["a.exr", "a.png", "B.EXR"] {
        let path = folder.join(name);
        std::fs::write(&path, vec![b'x'; 100_000]).unwrap();
        picture.save(&path).unwrap();
        picture.save(&path).unwrap();
        if path.extension().unwrap().eq_ignore_ascii_case("exr") {
            assert_eq!(read_exr(&path).unwrap(), picture.image);
        } else {
            let bytes = std::fs::read(&path).unwrap();
            assert!(bytes.starts_with(b"\x89PNG") && bytes.ends_with(b"IEND\xaeB`\x82"));
        }
    }
    assert_eq!(names(&folder), ["B.EXR", "a.exr", "a.png"]);
    std::fs::remove_dir_all(folder).unwrap();
}
