//! How many pixels every visibility order gets wrong, mesh by mesh.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use glam::DVec3;
use tetrascope::mesh::rings_sample;
use tetrascope::order::{Bucket, CycleRemedy, OrderMethod};
use tetrascope::{
    Camera, CpuRenderer, LinearImage, OpticalModel, Plan, Projection, ReadOptions, Silent, TransferFunction, View,
    Volume,
};

use crate::Failure;

/// Pixels a side.
const SIDE: u32 = 256;

/// What a channel of an 8-bit picture shows.
const VISIBLE: f64 = 1.0 / 255.0;

/// What rounding leaves.
const ROUNDING: f64 = 1e-5;

/// From where meshes are looked at, as directions from their middle; the second number is the distance in radii. The last one is inside.
const VIEWS: [([f64; 3], f64); 5] = [
    ([0.8, 0.3, 0.52], 3.0),
    ([-0.2, 0.9, -0.38], 3.0),
    ([0.02, 0.03, 1.0], 4.0),
    ([0.1, -0.6, 0.8], 1.2),
    ([0.3, 0.2, 0.1], 0.35),
];

/// An order, and what is done about rings of cells.
struct Way {
    name: String,
    method: OrderMethod,
    cycles: CycleRemedy,
}

/// Orders, from the cheapest; the last ones promise to be right.
fn ways() -> Vec<Way> {
    let report = |name: &str, method| Way { name: name.to_owned(), method, cycles: CycleRemedy::Report };
    let mut ways = vec![
        report("none", OrderMethod::None),
        report("bucket", OrderMethod::Bucket { slabs: Bucket::DEFAULT_SLABS }),
        report("centroid", OrderMethod::Centroid),
    ];
    for window in [2, 6, 32] {
        ways.push(report(&format!("k-buffer, {window}"), OrderMethod::KBuffer { window }));
    }
    for method in [OrderMethod::Power, OrderMethod::Mpvo, OrderMethod::BspXmpvo] {
        ways.push(report(&method.to_string(), method));
    }
    let (method, cycles) = (OrderMethod::BspXmpvo, CycleRemedy::PerPixel);
    ways.push(Way { name: "bsp-xmpvo, rings per-pixel".to_owned(), method, cycles });
    ways
}

/// A mesh to be drawn: its name in the table, its file beside the repository, and the field.
struct Subject {
    name: &'static str,
    files: &'static [&'static str],
    field: Option<&'static str>,
}

/// Meshes beside the repository.
const SUBJECTS: &[Subject] = &[
    Subject { name: "Delaunay of random points", files: &["vtk/delaunay_unitcube_binary_v4.2.vtk"], field: None },
    Subject { name: "blunt fin", files: &["plot3d/bluntfinxyz.bin", "plot3d/bluntfinq.bin"], field: Some("Density") },
    Subject { name: "combustor", files: &["plot3d/combxyz.bin", "plot3d/combq.bin"], field: Some("Density") },
    Subject { name: "oxygen post", files: &["plot3d/postxyz.bin", "plot3d/postq.bin"], field: Some("Momentum:mag") },
    Subject { name: "Gmsh block", files: &["vtu/gmsh_block_98k.vtu"], field: None },
    Subject { name: "fire", files: &["vtu/fire_ug.vtu"], field: None },
    Subject { name: "bracket", files: &["vtu/kiefer_bracket.vtu"], field: None },
    Subject { name: "can", files: &["vtu/can.vtu"], field: None },
    Subject { name: "wind around buildings", files: &["vtu/openfoam_windAroundBuildings.vtu"], field: None },
    Subject { name: "twisted column", files: &["vtu/cycle_twisted_column_18.vtu"], field: None },
];

/// What an order did to the pictures of a mesh.
#[derive(Clone, Copy, Debug, Default)]
struct Wrong {
    /// Pixels of all views in which the mesh is seen.
    seen: usize,
    /// Of these, beyond rounding, and so far that it shows in 8 bits.
    beyond_rounding: usize,
    visible: usize,
    /// The largest difference of a channel.
    largest: f64,
}

/// The text of all tables: a row a mesh, a column an order.
///
/// - `data`: the folder of the meshes beside the repository; `None` measures the built-in sample alone
pub(super) fn tables(data: Option<&Path>, only: &str) -> Result<String, Failure> {
    let ways = ways();
    let names: Vec<&str> = ways.iter().map(|way| way.name.as_str()).collect();
    let head = |text: &mut String, title: &str| {
        let _ = writeln!(text, "### {title}\n");
        let _ = writeln!(text, "| Mesh | Tetrahedra | {} |", names.join(" | "));
        let _ = writeln!(text, "| --- | --- |{}", " --- |".repeat(names.len()));
    };
    let [mut smooth, mut peaks] = [String::new(), String::new()];
    head(&mut smooth, "A smooth transfer function");
    head(&mut peaks, "Thin peaks");
    let mut add = |name: &str, volume: &Volume, field: Option<&str>| -> Result<(), Failure> {
        for (text, is_thin) in [(&mut smooth, false), (&mut peaks, true)] {
            let row = row(volume, field, is_thin, &ways)?;
            let cells: Vec<String> = row.iter().map(cell).collect();
            let tetrahedra = volume.decomposition.mesh.tetrahedra().len();
            let _ = writeln!(text, "| {name} | {tetrahedra} | {} |", cells.join(" | "));
        }
        println!("measured: {name}");
        Ok(())
    };
    if "built-in sample".contains(only) {
        add("built-in sample", &Volume::from_dataset(rings_sample(24), "sample")?, None)?;
    }
    for subject in SUBJECTS.iter().filter(|subject| subject.name.contains(only)) {
        let Some(data) = data else { break };
        let files: Vec<PathBuf> = subject.files.iter().map(|file| data.join(file)).collect();
        add(
            subject.name,
            &Volume::load(&files[0], &ReadOptions::with_solution(files.get(1).map(PathBuf::as_path)))?,
            subject.field,
        )?;
    }
    Ok(format!("{smooth}\n{peaks}"))
}

/// What every order does to a mesh.
fn row(volume: &Volume, field: Option<&str>, is_thin: bool, ways: &[Way]) -> Result<Vec<Wrong>, Failure> {
    let field = volume.field(field)?;
    let (low, high) = field.facts.scalar_range;
    let diagonal = field.facts.diagonal();
    let transfer = if is_thin { thin_peaks(low, high, diagonal)? } else { smooth(low, high, diagonal)? };
    let renderer = CpuRenderer::new(field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars)?;
    let mut row = vec![Wrong::default(); ways.len()];
    for (away, radii) in VIEWS {
        let center = field.facts.center();
        let eye = center + DVec3::from(away).normalize() * (radii * diagonal / 2.0);
        let fov_y = if radii < 1.0 { 1.4 } else { 0.75 };
        let camera = Camera { eye, target: center, up: DVec3::Z, projection: Projection::Perspective { fov_y } };
        let view = View::new(&camera, SIDE, SIDE)?;
        let plan = Plan::new(view, transfer.clone(), OpticalModel::DensityEmitter);
        let draw =
            |order, cycles| Ok::<_, Failure>(renderer.render(&Plan { order, cycles, ..plan.clone() }, &Silent)?.image);
        let exact = draw(OrderMethod::PerPixel, CycleRemedy::Report)?;
        for (way, wrong) in ways.iter().zip(&mut row) {
            wrong.compare(&exact, &draw(way.method, way.cycles)?);
        }
    }
    Ok(row)
}

impl Wrong {
    fn compare(&mut self, exact: &LinearImage, other: &LinearImage) {
        for (p, q) in exact.pixels().iter().zip(other.pixels()) {
            let difference = p.iter().zip(q).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
            self.seen += usize::from(p[3] > 0.0);
            self.beyond_rounding += usize::from(difference > ROUNDING);
            self.visible += usize::from(difference > VISIBLE);
            self.largest = self.largest.max(difference);
        }
    }
}

/// Share of the pixels beyond rounding, share of those that show, and the largest difference; `0` where all are right.
fn cell(wrong: &Wrong) -> String {
    if wrong.beyond_rounding == 0 {
        return "0".to_owned();
    }
    let share = |count: usize| match 100.0 * count as f64 / wrong.seen.max(1) as f64 {
        0.0 => "0 %".to_owned(),
        share if share < 0.01 => "<0.01 %".to_owned(),
        share if share < 1.0 => format!("{share:.2} %"),
        share => format!("{share:.0} %"),
    };
    format!("{} / {} / {:.0e}", share(wrong.beyond_rounding), share(wrong.visible), wrong.largest)
}

/// Colors that change twice over the range, and an extinction that rises.
fn smooth(low: f64, high: f64, diagonal: f64) -> Result<TransferFunction, Failure> {
    let at = |share: f64| low + (high - low) * share;
    let color =
        [[at(0.0), 0.1, 0.2, 0.9], [at(0.3), 0.9, 0.9, 0.9], [at(0.6), 0.9, 0.5, 0.1], [at(1.0), 0.7, 0.0, 0.1]];
    let extinction = [[at(0.0), 1.0 / diagonal], [at(1.0), 12.0 / diagonal]];
    Ok(TransferFunction::new(&color, &extinction)?)
}

/// Seven peaks of seven colors, each a hundredth of the range wide, nearly opaque: what shows a wrong order most.
fn thin_peaks(low: f64, high: f64, diagonal: f64) -> Result<TransferFunction, Failure> {
    let at = |share: f64| low + (high - low) * share;
    let (mut color, mut extinction) = (Vec::new(), vec![[at(0.0), 0.0]]);
    for peak in 0..7_u8 {
        let middle = (f64::from(peak) + 0.5) / 7.0;
        let channel = |bit: u8| if (peak + 1) >> bit & 1 == 1 { 0.9 } else { 0.1 };
        color.push([at(middle), channel(0), channel(1), channel(2)]);
        extinction.extend([[at(middle - 0.01), 0.0], [at(middle), 1000.0 / diagonal], [at(middle + 0.01), 0.0]]);
    }
    extinction.push([at(1.0), 0.0]);
    Ok(TransferFunction::new(&color, &extinction)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_pixels_are_counted() {
        let [mut exact, mut other] = [0, 1].map(|_| LinearImage::transparent(2, 2));
        exact.pixels_mut().iter_mut().for_each(|pixel| pixel[3] = 0.5);
        other.pixels_mut().iter_mut().for_each(|pixel| pixel[3] = 0.5);
        other.pixels_mut()[0][1] = 0.25;
        other.pixels_mut()[3][2] = 1e-4;
        let mut wrong = Wrong::default();
        wrong.compare(&exact, &other);
        assert_eq!((wrong.seen, wrong.beyond_rounding, wrong.visible), (4, 2, 1));
        assert_eq!(cell(&wrong), "50 % / 25 % / 2e-1");
        wrong.beyond_rounding = 0;
        assert_eq!(cell(&wrong), "0");
    }
}
