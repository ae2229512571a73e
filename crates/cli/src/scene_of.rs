//! The scene that inputs and options mean.

use std::path::{Path, PathBuf};

use tetrascope::{
    CameraSection, Choice, GpuPath, IsosurfaceSection, MeshSection, ProjectionName, SceneFile, TransferSection,
    read_preset,
};

use crate::Failure;
use crate::args::{CameraArgs, LookArgs, MeshArgs, SceneArgs};
use crate::scene_paths::{self, folder_of, is_scene};

/// The scene of inputs and options, and the folder that its paths are relative to.
pub(crate) fn scene_of(args: &SceneArgs) -> Result<(SceneFile, PathBuf), Failure> {
    let (mut scene, base_dir) = scene_of_inputs(&args.input)?;
    override_by_options(&mut scene, &args.look);
    read_color_map(&mut scene, &base_dir, &args.look)?;
    Ok((scene, base_dir))
}

impl SceneArgs {
    /// The scene file, for messages; `None` where the input is a mesh.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.input.first().map(PathBuf::as_path).filter(|path| is_scene(path))
    }
}

/// A scene file with its folder, or a scene of nothing but a mesh.
pub(crate) fn scene_of_inputs(inputs: &[PathBuf]) -> Result<(SceneFile, PathBuf), Failure> {
    match inputs {
        [scene] if is_scene(scene) => Ok((scene_paths::read(scene)?, folder_of(scene).to_owned())),
        [mesh] => Ok((SceneFile::of_mesh(mesh), PathBuf::new())),
        [grid, solution] if !is_scene(grid) && !is_scene(solution) => {
            let mut scene = SceneFile::of_mesh(grid);
            scene.mesh.solution = Some(solution.clone());
            Ok((scene, PathBuf::new()))
        }
        _ => Err(Failure::Usage(
            "a scene file names its mesh itself: give one scene, one mesh, or a PLOT3D grid and its solution"
                .to_owned(),
        )),
    }
}

/// The same with the field, the camera and the size that options say.
pub(crate) fn scene_as_seen(
    inputs: &[PathBuf],
    mesh: &MeshArgs,
    camera: &CameraArgs,
    size: Option<(u32, u32)>,
) -> Result<(SceneFile, PathBuf), Failure> {
    let (mut scene, base_dir) = scene_of_inputs(inputs)?;
    override_mesh(&mut scene.mesh, mesh);
    read_preset(&mut scene, &base_dir)?;
    override_camera(&mut scene.camera, camera);
    if let Some((width, height)) = size {
        (scene.image.width, scene.image.height) = (width, height);
    }
    Ok((scene, base_dir))
}

fn set_some<T: Clone>(slot: &mut Option<T>, value: Option<&T>) {
    if value.is_some() {
        *slot = value.cloned();
    }
}

fn override_mesh(section: &mut MeshSection, args: &MeshArgs) {
    set_some(&mut section.field, args.field.as_ref());
    section.cells |= args.cells;
    let read = &args.read;
    if read.step.is_some() || read.time.is_some() {
        (section.step, section.time) = (read.step, read.time);
    }
    set_some(&mut section.raw, read.raw.map(|raw| raw.to_string()).as_ref());
}

/// What an option says counts alone: what the scene file has for the same gives way.
fn override_transfer(section: &mut TransferSection, args: &LookArgs) {
    if let Some(points) = &args.color {
        section.color = Some(points.0.clone());
        section.colormap = None;
    }
    if let Some(cmap) = &args.cmap {
        (section.color, section.colormap) = (None, None);
        match color_map_file(cmap) {
            Some((file, name)) => (section.preset, section.preset_name) = (Some(file), name),
            None => section.colormap = Some(cmap.clone()),
        }
    }
    if let Some(points) = &args.extinction {
        section.extinction = Some(points.0.clone());
        (section.opacity, section.opacity_length) = (None, None);
    }
    if let Some(opacity) = &args.opacity {
        section.opacity = Some(opacity.clone());
        section.extinction = None;
    }
    set_some(&mut section.opacity_length, args.opacity_length.as_ref());
    set_some(&mut section.range, args.range.as_ref());
}

/// Reads the color map's file. One of the scene's gives way to an option's name, and goes where it has nothing but colors.
pub(crate) fn read_color_map(scene: &mut SceneFile, base_dir: &Path, args: &LookArgs) -> Result<(), Failure> {
    read_preset(scene, base_dir)?;
    let transfer = &mut scene.transfer;
    let has_opacity = transfer.preset_map.as_ref().is_some_and(|preset| preset.map.opacity().is_some());
    if args.cmap.is_some() && transfer.colormap.is_some() && !has_opacity {
        (transfer.preset, transfer.preset_name, transfer.preset_map) = (None, None, None);
    }
    Ok(())
}

/// The file that a word for a color map names, and which of its maps: color maps themselves have names without extension.
fn color_map_file(word: &str) -> Option<(PathBuf, Option<String>)> {
    let is_file = |word: &str| {
        Path::new(word).extension().is_some_and(|e| e.eq_ignore_ascii_case("json") || e.eq_ignore_ascii_case("xml"))
    };
    // Paths of a scene are relative to its folder, and those of an option to the current one.
    let from_here = |word: &str| std::path::absolute(word).unwrap_or_else(|_| PathBuf::from(word));
    if is_file(word) {
        return Some((from_here(word), None));
    }
    let (file, name) = word
        .split_once(".json:")
        .map(|(stem, name)| (format!("{stem}.json"), name))
        .or_else(|| word.split_once(".xml:").map(|(stem, name)| (format!("{stem}.xml"), name)))?;
    Some((from_here(&file), Some(name.to_owned())))
}

fn override_camera(camera: &mut CameraSection, args: &CameraArgs) {
    set_some(&mut camera.eye, args.eye.as_ref());
    set_some(&mut camera.target, args.target.as_ref());
    set_some(&mut camera.up, args.up.as_ref());
    if args.fov.is_some() {
        (camera.projection, camera.fov_y, camera.height) = (ProjectionName::Perspective, args.fov, None);
    }
    if args.orthographic.is_some() {
        (camera.projection, camera.fov_y, camera.height) = (ProjectionName::Orthographic, None, args.orthographic);
    }
}

pub(crate) fn override_by_options(scene: &mut SceneFile, args: &LookArgs) {
    fn set<T: Clone>(slot: &mut T, value: Option<&T>) {
        if let Some(value) = value {
            slot.clone_from(value);
        }
    }
    override_mesh(&mut scene.mesh, &args.mesh);
    override_camera(&mut scene.camera, &args.camera);
    if let Some((width, height)) = args.size {
        (scene.image.width, scene.image.height) = (width, height);
    }
    set(&mut scene.image.background, args.background.as_ref());
    set(&mut scene.optics.model, args.model.as_ref());
    override_transfer(&mut scene.transfer, args);
    let shading = args.shading.unwrap_or_default();
    scene.isosurface.extend(args.isosurface.iter().map(|added| IsosurfaceSection { shading, ..added.clone() }));
    let quality = &mut scene.quality;
    if args.integration.is_some_and(|asked| asked != quality.integration) {
        // The scene file's table belongs to the integration that is replaced.
        (quality.table_size, quality.table_lengths, quality.length_axis) = (None, None, None);
    }
    set(&mut quality.integration, args.integration.as_ref());
    set(&mut quality.interpolation, args.interpolation.as_ref());
    if args.table_size.is_some() {
        // One size for all axes, whatever the scene file has for the lengths.
        (quality.table_size, quality.table_lengths) = (args.table_size, None);
    }
    set_some(&mut quality.length_axis, args.length_axis.as_ref());
    if let Some(order) = args.order {
        quality.replace_order(order);
    }
    set_some(&mut quality.slabs, args.slabs.as_ref());
    set_some(&mut quality.window, args.window.as_ref());
    set_some(&mut quality.cycles, args.cycles.as_ref());
    if args.keep_heights {
        quality.keep_heights = Some(true);
    }
    set_some(&mut quality.max_error, args.max_error.as_ref());
    if let Some(backend) = args.backend {
        quality.replace_backend(backend);
    }
    set_some(&mut quality.gpu_path, args.gpu_path.as_ref());
    if args.gpu_path == Some(Choice::Named(GpuPath::Compute)) {
        // It has no target; what the scene file has for the other path is no mistake.
        quality.target_bits = None;
    }
    set_some(&mut quality.target_bits, args.target_bits.as_ref());
    set_some(&mut quality.adapter, args.adapter.as_ref());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_for_color_maps() {
        assert_eq!(color_map_file("viridis"), None);
        assert_eq!(color_map_file("paraview:Jet"), None);
        let (file, name) = color_map_file("a/b.JSON").unwrap();
        assert!(file.ends_with("a/b.JSON") && file.is_absolute() && name.is_none());
        let (file, name) = color_map_file("maps.xml:Cool to Warm").unwrap();
        assert!(file.ends_with("maps.xml") && name.as_deref() == Some("Cool to Warm"));
    }
}
