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
    "integrate/light.wgsl",
    "order/centroid_keys.wgsl",
    "order/compact.wgsl",
    "order/pairs.wgsl",
    "order/power_keys.wgsl",
    "order/radix.wgsl",
    "order/scan.wgsl",
    "order/tiles.wgsl",
    "test/outline.wgsl",
];
