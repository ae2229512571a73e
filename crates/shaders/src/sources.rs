//! The files of the folder `shaders`.

macro_rules! sources {
    ($($path:literal),* $(,)?) => {
        /// Path within the folder, and text, of every file.
        pub const SOURCES: &[(&str, &str)] = &[$(($path, include_str!(concat!("../../../shaders/", $path)))),*];
    };
}

sources![
    "cell/cell.wgsl",
    "include/frame.wgsl",
    "include/list.wgsl",
    "include/points.wgsl",
    "integrate/light.wgsl",
    "test/triangles_cell.wgsl",
    "test/triangles_model.wgsl",
    "test/triangles_pieces.wgsl",
    "test/triangles_shade.wgsl",
    "test/triangles_vertices.wgsl",
    "test/triangles_volume.wgsl",
    "triangles/accumulate.wgsl",
    "triangles/corners.wgsl",
    "triangles/draw.wgsl",
    "triangles/fan.wgsl",
    "triangles/fans.wgsl",
    "triangles/list.wgsl",
    "triangles/rays.wgsl",
    "triangles/resolve.wgsl",
    "triangles/screen.wgsl",
    "triangles/thick.wgsl",
    "triangles/varying.wgsl",
];
