//! The files of the folder `shaders`.

macro_rules! sources {
    ($($path:literal),* $(,)?) => {
        /// Path within the folder, and text, of every file.
        pub const SOURCES: &[(&str, &str)] = &[$(($path, include_str!(concat!("../../../shaders/", $path)))),*];
    };
}

sources![
    "cell/cell.wgsl",
    "cell/classify.wgsl",
    "cell/corners.wgsl",
    "cell/optics.wgsl",
    "cell/outline.wgsl",
    "cell/project.wgsl",
    "cell/ray.wgsl",
    "cell/sample.wgsl",
    "cell/set_up.wgsl",
    "cell/wide.wgsl",
    "include/frame.wgsl",
    "include/list.wgsl",
    "integrate/light.wgsl",
    "test/cell_classify.wgsl",
    "test/cell_sample.wgsl",
    "test/pieces.wgsl",
];
