//! `tetrascope check`: which visibility orders are right for a mesh, and where and by how much the others are wrong.

mod report;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tetrascope::{
    Backend, Choice, CycleRemedy, OrderCheck, OrderMethod, PixelDifference, Plan, ProjectionName, SceneFile, Volume,
    VolumeField, seen_pixels, write_png,
};

use crate::Failure;
use crate::args::CheckArgs;
use crate::interrupt;
use crate::progress::Bar;
use crate::render::{check_target, wrong_scene};
use crate::report::{line, object, warning};
use crate::scene_of::scene_as_seen;
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
        maps_of(args, map).iter().for_each(|path| interrupt::will_write(path));
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
    let (mut scene, base_dir) = scene_as_seen(&args.input, &args.mesh, &args.camera, args.size)?;
    // Orders are what is judged: the scene's own, and what goes with it, is not looked at.
    scene.quality.replace_backend(Choice::Named(Backend::Cpu));
    scene.quality.order = Choice::Auto;
    (scene.quality.slabs, scene.quality.window, scene.quality.cycles, scene.quality.keep_heights) =
        (None, None, None, None);

    bar.step("reading and cutting into tetrahedra");
    let volume = Volume::of_section(&scene.mesh, &base_dir, bar.reading())?;
    let field = volume.field_of_section(&scene.mesh)?;
    interrupt::go_on()?;
    bar.step("looking at the mesh");
    let solves = args.heights || args.order.contains(&OrderMethod::Power);
    let mesh = field.check_mesh(&volume.decomposition, solves, args.threads.map(usize::from))?;
    bar.clear();
    interrupt::go_on()?;
    let mut warnings: Vec<String> = volume.warnings.clone();
    warnings.extend(field.field.warnings.iter().cloned());
    warnings.extend(field.on_mesh.warning());
    let orders = orders_of(args, mesh.power.is_some(), &mut warnings);
    warnings.iter().for_each(|text| warning(text));
    if !args.json {
        report::mesh(&volume, &mesh).iter().for_each(|text| line(text));
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
        // Two pictures that are compared, and where they differ.
        let pixels = u64::from(plan.view.width) * u64::from(plan.view.height);
        field.check_memory(&plan, &[("pictures compared", 48 * pixels)])?;
        bar.step("relations between cells");
        let relations = field.relations(&plan)?;
        interrupt::go_on()?;
        bar.step("drawing what pictures are compared with");
        let exact = field.exact_picture(&plan, bar)?;
        bar.clear();
        let seen = report::Seen { pixels: seen_pixels(&exact), all: exact.pixels().len() };
        if !args.json {
            report::view(index, &completed.scene.camera, &relations, seen).iter().for_each(|text| line(text));
        }
        let mut judged = Vec::new();
        for &method in &orders {
            interrupt::go_on()?;
            bar.step("judging an order");
            let order = field.check_order(&plan, method, &relations, &exact, bar)?;
            bar.clear();
            if !args.json {
                line(&report::order(&order));
            }
            let map = match &args.map {
                None => None,
                Some(path) => {
                    let name = (orders.len() > 1).then(|| name_in_maps(method, &orders));
                    let view = (wanted.len() > 1).then_some(index);
                    Some(write_map(&name_of_map(path, view, name.as_deref()), &order, &plan)?)
                }
            };
            judged.push(report::order_json(&order, map.as_deref()));
        }
        views.push(report::view_json(&completed.scene.camera, &relations, seen, judged));
    }
    let mut said = report::mesh_json(&volume, &mesh);
    if let Value::Object(said) = &mut said {
        said.insert("image".to_owned(), json!({ "width": scene.image.width, "height": scene.image.height }));
        said.insert("views".to_owned(), json!(views));
        said.insert("warnings".to_owned(), json!(warnings));
    }
    Ok(said)
}

/// The orders to be judged, each with every number that it is to go by; a warning for numbers without an order.
///
/// - `with_power`: whether heights are known
fn orders_of(args: &CheckArgs, with_power: bool, warnings: &mut Vec<String>) -> Vec<OrderMethod> {
    let mut asked = if args.order.is_empty() { ORDERS.to_vec() } else { args.order.clone() };
    if args.order.is_empty() {
        if with_power {
            asked.insert(3, OrderMethod::Power);
        }
        if !args.window.is_empty() {
            asked.push(OrderMethod::KBuffer { window: OrderMethod::DEFAULT_WINDOW });
        }
    }
    let mut warn = |is_there: bool, option: &str, order: &str| {
        if !is_there {
            warnings.push(format!("{option} has no effect: {order} is not among the orders"));
        }
    };
    let has_window = asked.iter().any(|order| matches!(order, OrderMethod::KBuffer { .. }));
    warn(args.window.is_empty() || has_window, "--window", "k-buffer");
    let has_slabs = asked.iter().any(|order| matches!(order, OrderMethod::Bucket { .. }));
    warn(args.slabs.is_empty() || has_slabs, "--slabs", "bucket");
    let with_numbers = |order: OrderMethod| match order {
        OrderMethod::KBuffer { .. } if !args.window.is_empty() => {
            args.window.iter().map(|&window| OrderMethod::KBuffer { window }).collect()
        }
        OrderMethod::Bucket { .. } if !args.slabs.is_empty() => {
            args.slabs.iter().map(|&slabs| OrderMethod::Bucket { slabs }).collect()
        }
        other => vec![other],
    };
    asked.into_iter().flat_map(with_numbers).collect()
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

/// `mpvo`, or `k-buffer-2` where it is judged with several numbers.
fn name_in_maps(method: OrderMethod, orders: &[OrderMethod]) -> String {
    let name = method.to_string();
    let is_repeated = orders.iter().any(|other| *other != method && other.to_string() == name);
    match report::number_of(method) {
        Some((_, number)) if is_repeated => format!("{name}-{number}"),
        _ => name,
    }
}

/// `wrong.png` for one, else `wrong-2-mpvo.png`: the view's number, counted from 0, and the order's name where there are several.
fn name_of_map(path: &Path, view: Option<usize>, order: Option<&str>) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    if let Some(view) = view {
        name.push(format!("-{}", view + 1));
    }
    if let Some(order) = order {
        name.push(format!("-{order}"));
    }
    name.push(".png");
    path.with_file_name(name)
}

/// All maps that there may be: whether heights are known is not known yet, and an order's name does not depend on it.
fn maps_of(args: &CheckArgs, path: &Path) -> Vec<PathBuf> {
    let orders = orders_of(args, true, &mut Vec::new());
    let views: Vec<_> = if args.view.len() > 1 { (0..args.view.len()).map(Some).collect() } else { vec![None] };
    let name_in = |order| (orders.len() > 1).then(|| name_in_maps(order, &orders));
    let name = |view| orders.iter().map(move |&order| name_of_map(path, view, name_in(order).as_deref()));
    views.into_iter().flat_map(name).collect()
}

fn write_map(path: &Path, order: &OrderCheck, plan: &Plan) -> Result<PathBuf, Failure> {
    let pixels: &PixelDifference = &order.pixels;
    let map = pixels.map(plan.view.width).ok_or_else(|| Failure::Input("the map has no pixels".to_owned()))?;
    write_png(path, &map, [0.0; 3]).map_err(tetrascope::Error::Io)?;
    interrupt::wrote(path);
    Ok(path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_have_names_of_their_own() {
        let name = |order, view| {
            let path = name_of_map(Path::new("a/wrong.png"), view, order);
            path.to_str().map(str::to_owned).unwrap()
        };
        assert_eq!(name(None, None), "a/wrong.png");
        assert_eq!(name(Some("bsp-xmpvo"), None), "a/wrong-bsp-xmpvo.png");
        assert_eq!(name(Some("bsp-xmpvo"), Some(1)), "a/wrong-2-bsp-xmpvo.png");
        assert_eq!(name(None, Some(1)), "a/wrong-2.png");
        let [two, six] = [2, 6].map(|window| OrderMethod::KBuffer { window });
        assert_eq!(name_in_maps(six, &[six, OrderMethod::Mpvo]), "k-buffer");
        assert_eq!(name_in_maps(six, &[two, six]), "k-buffer-6");
        assert_eq!(name_in_maps(OrderMethod::Mpvo, &[two, OrderMethod::Mpvo]), "mpvo");
    }
}
