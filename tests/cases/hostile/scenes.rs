//! Scenes whose numbers no picture can have: an error that names the key, or a picture.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use tetrascope::{Backend, Choice, SceneFile, Silent, Volume, render_volume};
use tetrascope_tests::pictures::largest as largest_difference;

use super::is_sound;

/// How a scene ends.
enum End {
    /// In an error with this word.
    Refused(&'static str),
    /// In a picture.
    Drawn,
    /// In either; never in a panic.
    Either,
}
use End::{Drawn, Either, Refused};

/// Parses and draws a scene of 8 x 8 pixels unless it says otherwise.
fn draw(text: &str) -> Result<(), String> {
    let path = Path::new("hostile.toml");
    let mut scene = SceneFile::parse(text, path).map_err(|error| {
        assert!(error.to_string().contains("hostile.toml"), "{error}");
        error.to_string()
    })?;
    if !text.contains("[image]") {
        (scene.image.width, scene.image.height) = (8, 8);
    }
    let volume = Volume::sample().unwrap();
    let picture = render_volume(&volume, &scene, &Silent).map_err(|error| error.to_string())?;
    assert!(is_sound(&picture.image), "unsound pixels");
    Ok(())
}

fn check(sections: &str, end: End) {
    let text = format!("[mesh]\npath = \"a.vtu\"\n{sections}\n");
    let shown: String = sections.chars().take(120).collect();
    let result = catch_unwind(AssertUnwindSafe(|| draw(&text))).unwrap_or_else(|_| panic!("panics: {shown}"));
    println!("{shown}: {}", result.as_ref().err().map_or("drawn", |error| error));
    match (end, result) {
        (Refused(word), Err(error)) => assert!(error.contains(word), "{shown}: \"{word}\" is not in: {error}"),
        (Drawn, Ok(())) | (Either, _) => {}
        (Refused(_), Ok(())) => panic!("drawn: {shown}"),
        (Drawn, Err(error)) => panic!("{shown}: {error}"),
    }
}

#[test]
fn hostile_sizes_are_refused() {
    for (width, height) in [(u32::MAX, u32::MAX), (0, 0), (0, 8), (8, 0), (u32::MAX, 1), (1, u32::MAX)] {
        check(&format!("[image]\nwidth = {width}\nheight = {height}"), Refused("image.width and image.height"));
    }
    for size in ["-1", "4294967296", "18446744073709551616", "1e400", "nan", "8.5", "\"8\"", "[8]"] {
        check(&format!("[image]\nwidth = {size}\nheight = 8"), Refused("width"));
    }
    let table = |size: &str| format!("[quality]\nintegration = \"table-2d\"\ntable_size = {size}");
    for size in ["0", "1", "2147483648", "4294967295"] {
        check(&table(size), Refused("quality.table_size"));
    }
    check(&table("-1"), Refused("table_size"));
    for size in ["0", "2147483648", "4294967295"] {
        check(
            &format!("[quality]\nintegration = \"table-3d\"\ntable_size = 8\ntable_lengths = {size}"),
            Refused("quality.table_lengths"),
        );
        check(
            &format!(
                "[quality]\nisosurfaces = \"map-smooth\"\nmap_size = {size}\n[[isosurface]]\nvalue = 0.5\ncolor = [1, 1, 1]"
            ),
            Refused("map"),
        );
    }
    check("[quality]\norder = \"bucket\"\nslabs = 0", Refused("slabs"));
    check("[quality]\norder = \"bucket\"\nslabs = 4294967295", Either);
    check("[quality]\norder = \"k-buffer\"\nwindow = 0", Refused("window"));
    check("[quality]\norder = \"k-buffer\"\nwindow = 4294967295", Either);
}

#[test]
fn hostile_cameras_are_refused() {
    let camera = |keys: &str| format!("[camera]\n{keys}");
    check(&camera("eye = [1.0, 1.0, 1.0]\ntarget = [1.0, 1.0, 1.0]"), Refused("camera.eye"));
    check(&camera("eye = [0.5, 0.5, 9.0]\ntarget = [0.5, 0.5, 0.5]\nup = [0.0, 0.0, 1.0]"), Refused("camera.up"));
    check(&camera("up = [0.0, 0.0, 0.0]"), Refused("camera.up"));
    for angle in ["0.0", "180.0", "nan", "-1.0", "inf", "-inf", "360.0"] {
        check(&camera(&format!("fov_y = {angle}")), Refused("camera.fov_y"));
    }
    for angle in ["1e-300", "5e-324", "179.99999999999997", "1e-9"] {
        check(&camera(&format!("fov_y = {angle}")), Either);
    }
    for height in ["0.0", "nan", "-1.0", "inf"] {
        check(&camera(&format!("projection = \"orthographic\"\nheight = {height}")), Refused("camera.height"));
    }
    for height in ["1e-300", "1e300"] {
        check(&camera(&format!("projection = \"orthographic\"\nheight = {height}")), Either);
    }
    for key in ["eye", "target", "up"] {
        for number in ["nan", "inf", "-inf"] {
            check(&camera(&format!("{key} = [0.0, {number}, 5.0]")), Refused("camera"));
        }
        for number in ["1e300", "-1e308", "5e-324"] {
            check(&camera(&format!("{key} = [0.1, {number}, 5.0]")), Either);
        }
        check(&camera(&format!("{key} = [0.0, 1.0]")), Refused(key));
        check(&camera(&format!("{key} = \"there\"")), Refused(key));
    }
}

#[test]
fn hostile_transfer_functions_are_refused() {
    let extinction = |points: &str| format!("[transfer]\nextinction = [{points}]");
    check(&extinction(""), Refused("transfer.extinction"));
    check(&extinction("[0.5, 1.0], [0.2, 1.0]"), Refused("transfer.extinction"));
    for number in ["nan", "inf", "-inf"] {
        check(&extinction(&format!("[0.0, 1.0], [{number}, 1.0]")), Refused("transfer.extinction"));
        check(&extinction(&format!("[0.0, 1.0], [1.0, {number}]")), Refused("transfer.extinction"));
        check(&format!("[transfer]\ncolor = [[0.0, 1.0, {number}, 0.0]]"), Refused("transfer.color"));
        check(
            &format!("[image]\nwidth = 8\nheight = 8\nbackground = [0.0, {number}, 0.0]"),
            Refused("image.background"),
        );
    }
    check(&extinction("[0.0, -1.0], [1.0, 1.0]"), Refused("transfer.extinction"));
    check("[transfer]\ncolor = [[0.0, -1.0, 0.0, 0.0]]", Refused("transfer.color"));
    check("[transfer]\ncolor = []", Refused("transfer.color"));
    for number in ["1e300", "1e308", "5e-324"] {
        check(&extinction(&format!("[0.0, 1.0], [{number}, 2.0]")), Either);
        check(&format!("[transfer]\ncolor = [[0.0, {number}, 0.0, 0.0]]"), Either);
    }
    for number in ["1e300", "1e38", "1e30", "5e-324"] {
        check(&extinction(&format!("[0.0, 0.0], [1.0, {number}]")), Drawn);
    }
    // Many control points, all within the field's range, which is 0 to 1 or so.
    let many: String = (0..10_000).map(|n| format!("[{}, 1.0],", f64::from(n) * 1e-4)).collect();
    check(&extinction(&many), Either);
    check(&extinction(&"[0.5, 1.0],".repeat(10_000)), Either);
}

/// An optical depth beyond the largest 32-bit float was NaN in the fast renderer.
#[test]
fn hostile_extinction_beyond_32_bits() {
    for largest in ["1e38", "1e300"] {
        for color in ["[[0.0, 1.0, 0.5, 0.2]]", "[[0.0, 1.0, 0.5, 0.2], [1.0, 0.1, 0.2, 0.9]]"] {
            let text = format!(
                "[mesh]\npath = \"a.vtu\"\n[transfer]\nextinction = [[0.0, 0.0], [1.0, {largest}]]\ncolor = {color}\n\
                 [image]\nwidth = 8\nheight = 8\n"
            );
            let mut scene = SceneFile::parse(&text, Path::new("hostile.toml")).unwrap();
            let volume = Volume::sample().unwrap();
            let mut draw = |backend| {
                scene.quality.backend = Choice::Named(backend);
                render_volume(&volume, &scene, &Silent).unwrap().image
            };
            let [fast, exact] = [Backend::Cpu, Backend::Reference].map(&mut draw);
            assert!(is_sound(&fast) && is_sound(&exact), "{largest}");
            let difference = largest_difference(&fast, &exact, 0..4);
            assert!(difference < 1e-5, "{largest}: {difference:e}");
        }
    }
}

#[test]
fn hostile_surfaces_lights_and_errors_are_refused() {
    for error in ["nan", "-1.0", "2.0", "inf"] {
        check(&format!("[quality]\nmax_error = {error}"), Refused("quality.max_error"));
    }
    check("[quality]\nmax_error = 0.0", Either);
    let surface = |keys: &str| format!("[[isosurface]]\n{keys}");
    for number in ["nan", "inf", "-1.0", "1.5"] {
        check(&surface(&format!("value = 0.5\ncolor = [1, 1, 1]\nopacity = {number}")), Refused("isosurface[0]"));
    }
    check(&surface("value = nan\ncolor = [1, 1, 1]"), Refused("isosurface[0]"));
    check(&surface("value = 0.5\ncolor = [1, nan, 1]"), Refused("isosurface[0]"));
    check(&surface("value = 1e300\ncolor = [1, 1, 1]"), Drawn);
    for key in ["ambient", "diffuse", "specular", "shininess"] {
        for number in ["nan", "inf", "-1.0", "1e300"] {
            check(
                &format!(
                    "[light]\n{key} = {number}\n[[isosurface]]\nvalue = 0.5\ncolor = [1, 1, 1]\nshading = \"flat\""
                ),
                Either,
            );
        }
    }
    for direction in ["[0.0, 0.0, 0.0]", "[nan, 0.0, 1.0]", "[inf, 0.0, 1.0]"] {
        check(
            &format!(
                "[light]\ndirection = {direction}\n[[isosurface]]\nvalue = 0.5\ncolor = [1, 1, 1]\nshading = \"flat\""
            ),
            Refused("light.direction"),
        );
    }
}

/// Text that is no scene, or one of a million parts.
#[test]
fn hostile_texts_are_refused() {
    for text in
        ["", "\0", "[", "[mesh", "mesh = 1", "[mesh]", "[mesh]\npath = 1", "\u{feff}\u{feff}", "[[mesh]]\npath = \"a\""]
    {
        let error = SceneFile::parse(text, Path::new("hostile.toml")).unwrap_err().to_string();
        assert!(error.contains("hostile.toml"), "{error}");
        let error = SceneFile::parse(text, Path::new("hostile.json")).unwrap_err().to_string();
        assert!(error.contains("hostile.json"), "{error}");
    }
    for (open, close) in [("[", "]"), ("{a=", "}"), ("{a.b=", "}")] {
        let deep = format!("a = {}1{}", open.repeat(100_000), close.repeat(100_000));
        assert!(SceneFile::parse(&deep, Path::new("hostile.toml")).is_err());
    }
    let dotted = format!("[mesh]\npath = \"a\"\n[a{}]\n", ".a".repeat(100_000));
    assert!(SceneFile::parse(&dotted, Path::new("hostile.toml")).is_err());
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(SceneFile::parse(&deep, Path::new("hostile.json")).is_err());
    check("[quality]\nunknown = 1", Refused("unknown"));
    check("[mesh]", Refused("hostile.toml"));
}
