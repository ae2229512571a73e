//! The files of the folder `shaders`.

macro_rules! sources {
    ($($path:literal),* $(,)?) => {
        /// Path within the folder, and text, of every file.
        pub const SOURCES: &[(&str, &str)] = &[$(($path, include_str!(concat!("../../../shaders/", $path)))),*];
    };
}

sources![
    "cell/cell.wgsl",
    "cell/wide.wgsl",
    "effects/axes.wgsl",
    "effects/carry.wgsl",
    "effects/cell_corners.wgsl",
    "effects/constant_gradient.wgsl",
    "effects/gradient_cell.wgsl",
    "effects/gradient_mixed.wgsl",
    "effects/gradient_points.wgsl",
    "effects/interpolated_gradient.wgsl",
    "effects/joint.wgsl",
    "effects/lamp.wgsl",
    "effects/lit.wgsl",
    "effects/maps.wgsl",
    "effects/none.wgsl",
    "effects/over.wgsl",
    "effects/power.wgsl",
    "effects/surface_lit.wgsl",
    "effects/surface_plain.wgsl",
    "effects/surface_set.wgsl",
    "effects/surfaces.wgsl",
    "effects/visible_none.wgsl",
    "effects/visible_surfaces.wgsl",
    "effects/volume_lit.wgsl",
    "effects/volume_plain.wgsl",
    "include/frame.wgsl",
    "include/list.wgsl",
    "include/points.wgsl",
    "integrate/exponential.wgsl",
    "integrate/light.wgsl",
    "test/effects.wgsl",
    "test/volume_grey.wgsl",
];
