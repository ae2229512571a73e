//! `tetrascope check`: which visibility orders are right for a mesh, and where and by how much the others are wrong.

mod report;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tetrascope::{
    Backend, CycleRemedy, OrderCheck, OrderMethod, PixelDifference, Plan, ProjectionName, SceneFile, Volume,
    VolumeField, resolve_path, write_png,
};

use crate::Failure;
use crate::args::CheckArgs;
use crate::progress::Bar;
use crate::render::{check_target, override_camera, scene_of_inputs, wrong_scene};
use crate::report::{line, object, warning};
use crate::scene_paths::is_scene;

/// What is judged when nothing is said. `power` joins them where heights are known.
const ORDERS: [OrderMethod; 5] = [
    OrderMethod::None,
    OrderMethod::Bucket { slabs: 20 },
    OrderMethod::Centroid,
    OrderMethod::Mpvo,
    OrderMethod::BspXmpvo,
];

pub(crate) fn run(args: &CheckArgs) -> Result<(), Failure> {
    if let Some(map) = &args.map {
        check_target(map, &["png"], "maps")?;
    }
    let bar = Bar::new(false);
    let done = check(args, &bar);
    bar.clear();
    let said = done?;
    if args.json {
        object(&said);
    }
    Ok(())
}

/// Judges everything, telling each part as soon as it is known; gives the same for machines.
fn check(args: &CheckArgs, bar: &Bar) -> Result<Value, Failure> {
    let (mut scene, base_dir) = scene_of_inputs(&args.input)?;
    if args.field.is_some() {
        scene.mesh.field.clone_from(&args.field);
    }
    override_camera(&mut scene.camera, &args.camera);
    if let Some((width, height)) = args.size {
        (scene.image.width, scene.image.height) = (width, height);
    }
    // Orders are what is judged: the scene's own, and what goes with it, is not looked at.
    scene.quality.backend = Backend::Cpu;
    scene.quality.order = tetrascope::Choice::Auto;
    (scene.quality.slabs, scene.quality.window, scene.quality.cycles, scene.quality.keep_heights) =
        (None, None, None, None);

    bar.step("reading and cutting into tetrahedra");
    let solution = scene.mesh.solution.as_ref().map(|path| resolve_path(&base_dir, path));
    let volume = Volume::load(&resolve_path(&base_dir, &scene.mesh.path), solution.as_deref())?;
    let field = volume.field(scene.mesh.field.as_deref())?;
    bar.step("looking at the mesh");
    let solves = args.heights || args.order.contains(&OrderMethod::Power);
    let mesh = field.check_mesh(&volume.decomposition, solves)?;
    bar.clear();
    let mut warnings: Vec<String> = volume.warnings.clone();
    warnings.extend(field.field.warnings.iter().cloned());
    warnings.extend(field.on_mesh.warning());
    warnings.iter().for_each(|text| warning(text));
    if !args.json {
        report::mesh(&volume, &mesh).iter().for_each(|text| line(text));
    }

    let mut orders = if args.order.is_empty() { ORDERS.to_vec() } else { args.order.clone() };
    if args.order.is_empty() && mesh.power.is_some() {
        orders.insert(3, OrderMethod::Power);
    }
    let mut views = Vec::new();
    let wanted = views_of(&scene, args, &field);
    for (index, view) in wanted.iter().enumerate() {
        let scene_path = args.input.first().map(PathBuf::as_path).filter(|path| is_scene(path));
        let wrong = |error: tetrascope::Error| wrong_scene(scene_path, error);
        let mut completed = view.complete(&field.facts).map_err(|error| wrong(error.into()))?;
        completed.scene.threads = args.threads.map(usize::from);
        let mut plan = completed.scene.plan().map_err(|error| wrong(error.into()))?;
        // Whole cells in the order itself: no remedy mends what is to be judged.
        plan.cycles = CycleRemedy::Report;
        bar.step("relations between cells");
        let relations = field.relations(&plan)?;
        bar.step("drawing what pictures are compared with");
        let exact = field.exact_picture(&plan, bar)?;
        bar.clear();
        if !args.json {
            report::view(index, &completed.scene.camera, &relations).iter().for_each(|text| line(text));
        }
        let mut judged = Vec::new();
        for &method in &orders {
            bar.step("judging an order");
            let order = field.check_order(&plan, method, &relations, &exact, bar)?;
            bar.clear();
            if !args.json {
                line(&report::order(&order));
            }
            let map = match &args.map {
                None => None,
                Some(path) => {
                    let several = (orders.len() > 1, wanted.len() > 1);
                    Some(write_map(&name_of_map(path, index, method, several), &order, &plan)?)
                }
            };
            judged.push(report::order_json(&order, map.as_deref()));
        }
        views.push(report::view_json(&completed.scene.camera, &relations, judged));
    }
    let mut said = report::mesh_json(&volume, &mesh);
    if let Value::Object(said) = &mut said {
        said.insert("image".to_owned(), json!({ "width": scene.image.width, "height": scene.image.height }));
        said.insert("views".to_owned(), json!(views));
        said.insert("warnings".to_owned(), json!(warnings));
    }
    Ok(said)
}

/// The scene from every place that was asked for.
fn views_of(scene: &SceneFile, args: &CheckArgs, field: &VolumeField<'_>) -> Vec<SceneFile> {
    let center = field.facts.center().to_array();
    let seen_from = |&eye: &[f64; 3]| {
        let mut scene = scene.clone();
        let camera = &mut scene.camera;
        (camera.projection, camera.height) = (ProjectionName::Perspective, None);
        camera.eye = Some(eye);
        // From the very middle there is no way to it: then as the default camera looks.
        camera.target = Some(if eye == center { [eye[0], eye[1], eye[2] - field.facts.diagonal()] } else { center });
        if args.camera.up.is_none() {
            camera.up = None;
        }
        scene
    };
    if args.view.is_empty() { vec![scene.clone()] } else { args.view.iter().map(seen_from).collect() }
}

/// `wrong.png` for one, else `wrong-2-mpvo.png`: the view's number and the order's name where there are several.
fn name_of_map(path: &Path, view: usize, method: OrderMethod, (orders, views): (bool, bool)) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    if views {
        name.push(format!("-{}", view + 1));
    }
    if orders {
        name.push(format!("-{method}"));
    }
    name.push(".png");
    path.with_file_name(name)
}

fn write_map(path: &Path, order: &OrderCheck, plan: &Plan) -> Result<PathBuf, Failure> {
    let pixels: &PixelDifference = &order.pixels;
    let map = pixels.map(plan.view.width).ok_or_else(|| Failure::Input("the map has no pixels".to_owned()))?;
    write_png(path, &map, [0.0; 3]).map_err(tetrascope::Error::Io)?;
    Ok(path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_have_names_of_their_own() {
        let name = |orders, views| {
            let path = name_of_map(Path::new("a/wrong.png"), 1, OrderMethod::BspXmpvo, (orders, views));
            path.to_str().map(str::to_owned).unwrap()
        };
        assert_eq!(name(false, false), "a/wrong.png");
        assert_eq!(name(true, false), "a/wrong-bsp-xmpvo.png");
        assert_eq!(name(true, true), "a/wrong-2-bsp-xmpvo.png");
        assert_eq!(name(false, true), "a/wrong-2.png");
    }
}
