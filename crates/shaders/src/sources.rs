//! The files of the folder `shaders`.

macro_rules! sources {
    ($($path:literal),* $(,)?) => {
        /// Path within the folder, and text, of every file.
        pub const SOURCES: &[(&str, &str)] = &[$(($path, include_str!(concat!("../../../shaders/", $path)))),*];
    };
}

sources![
    "cell/cell.wgsl",
    "include/block.wgsl",
    "include/frame.wgsl",
    "include/group_scan.wgsl",
    "include/list.wgsl",
    "include/work.wgsl",
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
    "order/candidate_own.wgsl",
    "order/candidate_permuted.wgsl",
    "order/compact.wgsl",
    "order/cull.wgsl",
    "order/gather.wgsl",
    "order/pairs.wgsl",
    "order/radix.wgsl",
    "order/scan.wgsl",
    "order/tiles.wgsl",
    "raster/clear.wgsl",
    "raster/every_tile.wgsl",
    "raster/find_rings.wgsl",
    "raster/no_rings.wgsl",
    "raster/ordered.wgsl",
    "raster/rings.wgsl",
    "raster/sorted.wgsl",
    "raster/staged.wgsl",
    "raster/tile.wgsl",
    "test/integrate.wgsl",
    "test/outline.wgsl",
];
