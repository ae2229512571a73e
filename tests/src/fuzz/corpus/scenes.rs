//! Scene files with every section and key, as TOML and as JSON.

use std::path::Path;

use fastrand::Rng;
use tetrascope::SceneFile;

/// Lines of a section of which a scene has some.
const SECTIONS: &[(&str, &[&str])] = &[
    (
        "camera",
        &[
            "projection = \"orthographic\"",
            "eye = [0.3, 0.2, 4.0]",
            "target = [0.5, 0.5, 0.5]",
            "up = [0.0, 1.0, 0.0]",
            "fov_y = 36.0",
            "height = 2.5",
        ],
    ),
    ("image", &["width = 12", "height = 9", "background = [0.1, 0.2, 0.3]"]),
    ("optics", &["model = \"absorption\""]),
    (
        "transfer",
        &[
            "color = [[0.0, 0.05, 0.1, 0.6], [0.5, 0.3, 0.8, 0.4], [1.0, 0.9, 0.6, 0.1]]",
            "extinction = [[0.0, 0.1], [0.48, 0.1], [0.5, 6.0], [0.5, 0.1], [1.0, 1.5]]",
        ],
    ),
    (
        "light",
        &[
            "direction = [0.0, 0.5, 1.0]",
            "ambient = 0.2",
            "diffuse = 0.7",
            "specular = 0.3",
            "shininess = 20.0",
            "volume = true",
        ],
    ),
    (
        "quality",
        &[
            "integration = \"table-2d\"",
            "interpolation = \"exact\"",
            "order = \"bucket\"",
            "slabs = 8",
            "table_size = 16",
            "table_lengths = 8",
            "length_axis = \"logarithmic\"",
            "cycles = \"report\"",
            "isosurfaces = \"map-smooth\"",
            "map_size = 32",
            "max_error = 0.01",
            "backend = \"cpu\"",
            "window = 4",
            "target_bits = 32",
            "gpu_path = \"compute\"",
            "adapter = \"0\"",
        ],
    ),
];

pub(super) fn toml(rng: &mut Rng) -> Vec<u8> {
    let mut text = String::from("[mesh]\npath = \"a mesh.vtu\"\nfield = \"s\"\n");
    for (name, lines) in SECTIONS {
        text += &format!("\n[{name}] # a section\n");
        let some = lines.iter().filter(|_| rng.u8(..3) == 0).fold(String::new(), |some, line| some + line + "\n");
        text += &some;
    }
    for _ in 0..rng.u8(..3) {
        text += "\n[[isosurface]]\nvalue = 0.4\ncolor = [0.9, 0.2, 0.1]\nback_color = [0.1, 0.2, 0.9]\nopacity = 0.5\n";
        text += ["", "shading = \"flat\"\n", "shading = \"smooth\"\n"][rng.usize(..3)];
    }
    text.into_bytes()
}

pub(super) fn json(rng: &mut Rng) -> Vec<u8> {
    let text = String::from_utf8(toml(rng)).unwrap_or_default();
    // What is chosen by chance is known everywhere, so that every text is a scene.
    let scene = SceneFile::parse(&text, Path::new("scene.toml")).expect("the corpus has sound scenes");
    scene.to_json().expect("a scene has a text").into_bytes()
}
