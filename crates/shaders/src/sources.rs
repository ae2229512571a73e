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
    "integrate/light.wgsl",
    "order/candidate_own.wgsl",
    "order/candidate_permuted.wgsl",
    "order/cull.wgsl",
    "order/gather.wgsl",
    "raster/clear.wgsl",
    "raster/every_tile.wgsl",
    "raster/find_rings.wgsl",
    "raster/no_rings.wgsl",
    "raster/ordered.wgsl",
    "raster/rings.wgsl",
    "raster/sorted.wgsl",
    "raster/staged.wgsl",
    "raster/tile.wgsl",
];
