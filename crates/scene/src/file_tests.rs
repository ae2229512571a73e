//! Scene files: what is accepted, what is refused and where, and that what is written is read again.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;

use glam::DVec3;
use tetrascope_order::OrderMethod;

use crate::{Backend, Choice, MeshFacts, SceneError, SceneFile};

/// Every key of the contract, with values that are not the defaults.
const EVERY_KEY: &str = r#"
[mesh]
path = "bluntfin.vtu"
solution = "bluntfinq.bin"
field = "Density"
[camera]
projection = "perspective"
eye = [30.0, 20, 25.0]
target = [5.0, 3.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y = 31.5
height = 8.0
[image]
width = 300
height = 200
background = [0.1, 0.2, 0.3]
[optics]
model = "emitter"
[transfer]
color = [[0.2, 0.1, 0.2, 0.8], [1.0, 0.9, 0.9, 0.9]]
extinction = [[0.2, 0.0], [1.0, 0.05], [5.0, 2.0]]
preset = "cool-warm.json"
[[isosurface]]
value = 1.5
color = [0.9, 0.6, 0.2]
back_color = [0.2, 0.6, 0.9]
opacity = 0.5
shading = "smooth"
[[isosurface]]
value = 2.5
color = [0.9, 0.6, 0.2]
[[surface]]
path = "fin.glb"
[light]
direction = "headlight"
ambient = 0.1
diffuse = 0.8
specular = 0.4
shininess = 16.0
volume = true
[quality]
integration = "average"
interpolation = "screen"
order = "bucket"
slabs = 77
window = 3
cycles = "cut"
keep_heights = true
table_size = 33
table_lengths = 17
length_axis = "logarithmic"
isosurfaces = "map-smooth"
map_size = 100
max_error = 0.01
backend = "reference"
gpu_path = "triangles"
target_bits = 16
adapter = "llvmpipe"
"#;

fn toml(text: &str) -> SceneFile {
    SceneFile::parse(text, Path::new("a.toml")).unwrap()
}

fn message(text: &str, path: &str) -> String {
    SceneFile::parse(text, Path::new(path)).unwrap_err().to_string()
}

fn facts() -> MeshFacts {
    MeshFacts { lowest: DVec3::new(-1.0, 0.0, 2.0), highest: DVec3::new(3.0, 1.0, 2.5), scalar_range: (0.1, 4.7) }
}

#[test]
fn every_key_is_accepted() {
    let scene = toml(EVERY_KEY);
    assert_eq!(scene.camera.eye, Some([30.0, 20.0, 25.0]));
    assert_eq!(scene.isosurface.len(), 2);
    assert_eq!(scene.isosurface[1].opacity, 1.0);
    assert_eq!(scene.quality.order, Choice::Named("bucket".parse::<OrderMethod>().unwrap()));
    assert_eq!(scene.quality.backend, Choice::Named(Backend::Reference));
}

#[test]
fn everything_but_the_path_has_a_default() {
    assert_eq!(toml("[mesh]\npath = \"m.vtu\"\n"), SceneFile::of_mesh("m.vtu"));
    assert!(message("[mesh]\nfield = \"p\"\n", "a.toml").contains("missing key `path`"));
    assert!(message("", "a.toml").contains("missing key `mesh`"));
    assert!(message("", "a.json").contains("line 1"));
}

#[test]
fn json_holds_the_same() {
    let scene = toml(EVERY_KEY);
    let json = scene.to_json().unwrap();
    assert_eq!(SceneFile::parse(&json, Path::new("a.JSON")).unwrap(), scene);
}

#[test]
fn what_is_written_is_read_again() {
    let mut scene = toml(EVERY_KEY);
    scene.camera.eye = Some([1.0 / 3.0, -1e-300, 1.797e308]);
    scene.transfer.color = Some(vec![[0.1 + 0.2, 1e21, 5e-324, 123_456_789.123_456_78]]);
    let text = scene.to_toml().unwrap();
    assert_eq!(toml(&text), scene, "{text}");
}

#[test]
fn unknown_keys_are_named_with_line_and_known_ones() {
    let text = message("[mesh]\npath = \"m.vtu\"\n[image]\nwidht = 5\n", "dir/a.toml");
    for part in
        ["dir/a.toml", "line 4, column 1", "`widht`", "`width`", "`height`", "`background`", "4 | widht = 5\n  | ^"]
    {
        assert!(text.contains(part), "{part} is not in:\n{text}");
    }
    let text = message("[mesh]\npath = \"m.vtu\"\n[lights]\nambient = 1\n", "a.toml");
    assert!(text.contains("line 3") && text.contains("`lights`") && text.contains("`light`"), "{text}");
    let text = message("{\"mesh\": {\"path\": \"m\"},\n \"image\": {\"widht\": 5}}", "a.json");
    assert!(
        text.contains("a.json: line 2, column") && text.contains("`widht`") && text.contains("`background`"),
        "{text}"
    );
}

#[test]
fn wrong_values_are_named_with_key_and_line() {
    for (section, key, value, expected) in [
        ("image", "width", "\"wide\"", "u32"),
        ("image", "height", "-5", "u32"),
        ("camera", "eye", "[1.0, 2.0]", "length"),
        ("camera", "projection", "\"fisheye\"", "`perspective` or `orthographic`"),
        ("optics", "model", "\"fog\"", "density-emitter"),
        ("quality", "integration", "\"exakt\"", "\"exact\""),
        ("quality", "length_axis", "\"cubic\"", "`linear` or `logarithmic`"),
        ("quality", "isosurfaces", "\"map\"", "`map-smooth`"),
        ("quality", "table_size", "64.5", "u32"),
        ("quality", "order", "\"depth\"", "bsp-xmpvo"),
        ("quality", "window", "-1", "u32"),
        ("quality", "cycles", "\"ignore\"", "report, cut or per-pixel"),
        ("quality", "keep_heights", "1", "boolean"),
        ("quality", "backend", "\"cuda\"", "cpu, gpu and reference"),
        ("quality", "gpu_path", "\"mesh\"", "triangles and compute"),
        ("quality", "target_bits", "\"half\"", "u32"),
        ("quality", "adapter", "0", "string"),
        ("light", "direction", "\"sun\"", "headlight"),
        ("light", "direction", "[0, 1]", "headlight"),
        ("light", "volume", "1", "boolean"),
        ("transfer", "extinction", "[\n[0.0, 1.0],\n[1.0]]", "length"),
    ] {
        let text = message(&format!("[mesh]\npath = \"m\"\n[{section}]\n{key} = {value}\n"), "a.toml");
        let line = if value.contains('\n') { "line 6" } else { "line 4" };
        for part in [line, &format!("key {section}.{key}"), expected] {
            assert!(text.contains(part), "{part} is not in:\n{text}");
        }
    }
    let text = message("[mesh]\npath = \n", "a.toml");
    assert!(text.contains("line 2"), "{text}");
}

#[test]
fn a_byte_order_mark_is_no_error() {
    toml("\u{feff}[mesh]\npath = \"m.vtu\"\n");
}

#[test]
fn effects_that_are_not_there_are_refused_by_name() {
    let text = "[mesh]\npath = \"m\"\n[[surface]]\npath = \"fin.glb\"\n";
    let error = toml(text).complete(&facts()).unwrap_err();
    assert!(matches!(error, SceneError::NotSupported { .. }));
    let text = error.to_string();
    assert!(text.contains("[[surface]] (path = \"fin.glb\")") && text.contains("not supported yet"), "{text}");
}

#[test]
fn keys_without_an_effect_give_a_warning() {
    for (text, key) in [
        ("[light]\nambient = 0.5", "[light]"),
        ("[camera]\nheight = 2.0", "camera.height"),
        ("[camera]\nprojection = \"orthographic\"\nfov_y = 20.0", "camera.fov_y"),
        ("[quality]\nslabs = 8", "quality.slabs"),
        ("[quality]\ntable_size = 8", "quality.table_size"),
        ("[quality]\nintegration = \"partial\"\nlength_axis = \"linear\"", "quality.length_axis"),
        ("[quality]\nintegration = \"table-2d\"\ntable_lengths = 8", "quality.table_lengths"),
        ("[quality]\nisosurfaces = \"exact\"", "quality.isosurfaces"),
        ("[quality]\nmap_size = 8", "quality.map_size"),
    ] {
        let completed = toml(&format!("[mesh]\npath = \"m\"\n{text}\n")).complete(&facts()).unwrap();
        assert_eq!(completed.warnings.len(), 1);
        assert!(completed.warnings[0].contains(key), "{:?}", completed.warnings);
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    for (text, part) in [
        ("[quality]\nmax_error = 1.5", "quality.max_error is 1.5"),
        ("[quality]\nmax_error = nan", "quality.max_error is NaN"),
        ("[camera]\nfov_y = 180.0", "camera.fov_y is 180"),
        ("[camera]\nfov_y = nan", "camera.fov_y is NaN"),
        ("[camera]\nprojection = \"orthographic\"\nheight = 0.0", "height of the orthographic view"),
        ("[camera]\neye = [1.0, 0.0, inf]", "eye is not finite"),
        ("[image]\nwidth = 0", "0 x 512"),
        ("[image]\nbackground = [0.0, -1.0, 0.0]", "image.background"),
        ("[transfer]\ncolor = []", "transfer.color is empty; give at least one"),
        ("[transfer]\nextinction = []", "transfer.extinction is empty"),
        ("[transfer]\nextinction = [[1.0, 0.0], [0.0, 1.0]]", "transfer.extinction entry 1: scalar 0 lies below 1"),
        ("[transfer]\nextinction = [[1.0, 0.0], [2.0, -1.0]]", "transfer.extinction entry 1: extinction is -1"),
        ("[transfer]\nextinction = [[nan, 0.0]]", "transfer.extinction entry 0: scalar is NaN"),
        ("[transfer]\nextinction = [[0.0, inf]]", "transfer.extinction entry 0: extinction is inf"),
        ("[transfer]\ncolor = [[1.0, 0, 0, 0], [0.5, 0, 0, 0]]", "transfer.color entry 1: scalar 0.5 lies below 1"),
        ("[transfer]\ncolor = [[1.0, 0, -2, 0]]", "transfer.color entry 0: green is -2"),
        ("[transfer]\ncolor = [[1.0, 0, 0, nan]]", "transfer.color entry 0: blue is NaN"),
        ("[quality]\norder = \"bucket\"\nslabs = 0", "quality.slabs is 0"),
        ("[quality]\norder = \"k-buffer\"\nwindow = 0", "quality.window is 0"),
    ] {
        let error = toml(&format!("[mesh]\npath = \"m\"\n{text}\n")).complete(&facts()).unwrap_err().to_string();
        assert!(error.contains(part), "{part} is not in: {error}");
    }
}

#[test]
fn a_completed_scene_is_complete() {
    for text in [
        "",
        "[camera]\nprojection = \"orthographic\"",
        "[optics]\nmodel = \"absorption\"",
        "[quality]\norder = \"bucket\"\n[image]\nwidth = 100",
        "[quality]\norder = \"k-buffer\"",
        "[quality]\norder = \"k-buffer\"\nwindow = 2",
        "[quality]\norder = \"power\"\nkeep_heights = true",
        "[quality]\norder = \"mpvo\"\ncycles = \"cut\"",
        "[quality]\norder = \"per-pixel\"",
        "[quality]\ncycles = \"report\"",
        "[camera]\nup = [0, 0, 1]",
        "[quality]\nintegration = \"table-2d\"",
        "[quality]\nintegration = \"table-3d\"\ntable_size = 32",
        "[quality]\nisosurfaces = \"map-stopped\"\n[[isosurface]]\nvalue = 1.5\ncolor = [1, 0.5, 0.1]",
        "[[isosurface]]\nvalue = 1.5\ncolor = [1, 0.5, 0.1]\nopacity = 0.25\nshading = \"flat\"",
        "[light]\nvolume = true\ndirection = [1.0, 2.0, 3.0]",
    ] {
        let once = toml(&format!("[mesh]\npath = \"m\"\n{text}\n")).complete(&facts()).unwrap();
        let again = toml(&once.file.to_toml().unwrap()).complete(&facts()).unwrap();
        assert_eq!(once.file, again.file);
        assert_eq!(again.warnings, Vec::<String>::new());
        let (a, b) = (once.scene.plan().unwrap(), again.scene.plan().unwrap());
        assert_eq!((a.view, a.transfer.pieces(), a.order), (b.view, b.transfer.pieces(), b.order));
        assert_eq!((a.integration, a.tables, a.cycles), (b.integration, b.tables, b.cycles));
        assert_eq!((a.isosurfaces, a.lighting), (b.isosurfaces, b.lighting));
        // Nothing depends on the mesh any more.
        let elsewhere = MeshFacts { lowest: DVec3::ZERO, highest: DVec3::splat(9.0), scalar_range: (7.0, 8.0) };
        let moved = toml(&once.file.to_toml().unwrap()).complete(&elsewhere).unwrap();
        assert_eq!(moved.file, once.file);
    }
}

/// Whatever a file holds, its messages do nothing to a terminal and do not fill it.
#[test]
fn messages_have_no_control_characters_and_an_end() {
    let message = |text: &str, name: &str| SceneFile::parse(text, Path::new(name)).unwrap_err().to_string();
    for key in ["path", "field", "solution"] {
        let path = if key == "path" { "" } else { "path = \"a\"\n" };
        let found = message(&format!("[mesh]\n{path}{key} = \"\\u001b[2J\"\n"), "a.toml");
        assert!(found.contains(&format!("mesh.{key}")) && !found.contains('\u{1b}'), "{found}");
    }
    let raw = message("[mesh]\npath = \"a\u{1b}\u{7}\"\n", "a.toml");
    assert!(raw.contains("line 2") && !raw.contains('\u{1b}'), "{raw}");
    let unknown = message("[mesh]\npath = \"a\"\n\"\\u001b\" = 1\n", "a.toml");
    assert!(unknown.contains("unknown key") && !unknown.contains('\u{1b}'), "{unknown}");
    let json = message("{\"mesh\": {\"path\": \"a\", \"\\u001b[2J\": 1}}", "a.json");
    assert!(json.contains("unknown key") && !json.contains('\u{1b}'), "{json}");
    let long = message(&format!("[mesh]\npath = \"a\"\n{} = 1\n", "x".repeat(100_000)), "a.toml");
    assert!(long.chars().count() < 3000, "{}", long.len());
}
