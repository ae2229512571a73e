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
    "integrate/absorption.wgsl",
    "integrate/average.wgsl",
    "integrate/cumulative.wgsl",
    "integrate/density_emitter.wgsl",
    "integrate/emission.wgsl",
    "integrate/emitter.wgsl",
    "integrate/ends.wgsl",
    "integrate/exact.wgsl",
    "integrate/exponential.wgsl",
    "integrate/light.wgsl",
    "integrate/optics.wgsl",
    "integrate/partial.wgsl",
    "integrate/parts.wgsl",
    "integrate/pieces.wgsl",
    "integrate/table.wgsl",
    "integrate/table_2d.wgsl",
    "integrate/table_3d.wgsl",
    "integrate/visible.wgsl",
    "integrate/weights.wgsl",
    "test/integrate.wgsl",
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
