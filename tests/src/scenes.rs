//! Whole scenes of chance: a Delaunay mesh of random points with a field, a transfer function and a view, named by a seed.

use glam::DVec3;
use tetrascope::mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells};
use tetrascope::{CameraSection, OpticalModel, ProjectionName, SceneFile, Volume};

use crate::meshes::Random;
use crate::shapes::delaunay;

/// Pixels a row, and rows.
pub const SIZE: [u32; 2] = [160, 120];

/// A mesh with a field, and what is to be drawn of it.
#[derive(Debug)]
pub struct RandomScene {
    /// The mesh.
    pub volume: Volume,
    /// Camera, size, model and transfer function; all methods are left open.
    pub scene: SceneFile,
    /// What kind of transfer function it has.
    pub transfer: &'static str,
}

/// The scene of a seed.
///
/// Of every kind there is something: fields that are smooth or jump from point to point, transfer functions from a ramp to 256 random entries,
/// optical depths from a hundredth to fifty, all models, eyes far, near and inside, with and without perspective.
///
/// # Panics
/// Never: a dozen points in general position have cells.
pub fn random_scene(seed: u64) -> RandomScene {
    let mut random = Random::new(seed ^ 0x5CE_4E5);
    let count = 12 + (random.unit() * 26.0) as usize;
    let shape = delaunay(count, seed);
    let frequency = random.between(0.7, 2.5);
    let chance = random.unit().powi(2);
    let scalars: Vec<f64> = shape
        .points
        .iter()
        .map(|p| {
            let smooth = (frequency * p.x + 0.3).sin() * (frequency * p.y).cos() + 0.5 * (1.3 * frequency * p.z).sin();
            smooth * (1.0 - chance) + random.between(-1.0, 1.0) * chance
        })
        .collect();
    let (low, high) = scalars.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &s| (l.min(s), h.max(s)));
    let cells = shape.tetrahedra.len();
    let dataset = Dataset {
        points: shape.points,
        cells: Cells::Unstructured(UnstructuredCells {
            kinds: vec![CellKind::Tetrahedron; cells],
            offsets: (0..=cells).map(|cell| 4 * cell).collect(),
            connectivity: shape.tetrahedra.iter().flatten().map(|v| v.0).collect(),
            polyhedra: Vec::new(),
        }),
        point_arrays: vec![DataArray { name: "field".to_owned(), components: 1, values: ArrayValues::F64(scalars) }],
        cell_arrays: Vec::new(),
    };
    let volume = Volume::from_dataset(dataset, &format!("scene {seed}")).expect("random points span cells");

    let mut scene = SceneFile::of_mesh("in memory");
    (scene.image.width, scene.image.height) = (SIZE[0], SIZE[1]);
    scene.camera = camera(&mut random);
    scene.optics.model = match random.unit() {
        x if x < 0.55 => OpticalModel::DensityEmitter,
        x if x < 0.75 => OpticalModel::Emitter,
        x if x < 0.9 => OpticalModel::Absorption,
        _ => OpticalModel::Emission,
    };
    let (transfer, shares) = extinction(&mut random);
    // The mean over the range, so that depths are about what is drawn whatever the shape.
    let mean: f64 = shares.windows(2).map(|w| (w[1][0] - w[0][0]) * (w[0][1] + w[1][1]) / 2.0).sum();
    let depth = 10.0_f64.powf(random.between(-2.0, 1.7));
    let scale = depth / 2.0 / mean.max(1e-3);
    let at = |share: f64| low + (high - low) * share;
    scene.transfer.extinction = Some(shares.iter().map(|&[s, e]| [at(s), e * scale]).collect());
    scene.transfer.color = Some(colors(&mut random).iter().map(|&[s, r, g, b]| [at(s), r, g, b]).collect());
    RandomScene { volume, scene, transfer }
}

fn camera(random: &mut Random) -> CameraSection {
    let direction = loop {
        let p = random.point();
        if (0.1..1.0).contains(&p.length()) {
            break p.normalize();
        }
    };
    let distance = match random.unit() {
        x if x < 0.15 => 0.3,
        x if x < 0.4 => 2.2,
        _ => random.between(3.5, 9.0),
    };
    let eye = direction * distance;
    let target = if distance < 1.0 { DVec3::ZERO } else { random.point() * 0.2 };
    let mut camera = CameraSection { eye: Some(eye.to_array()), target: Some(target.to_array()), ..Default::default() };
    if distance > 1.0 && random.unit() < 0.25 {
        camera.projection = ProjectionName::Orthographic;
        camera.height = Some(random.between(2.0, 4.0));
    } else {
        camera.fov_y = Some(if distance < 1.0 { 80.0 } else { 2.0 * (1.6 / distance).atan().to_degrees() });
    }
    camera
}

/// Extinction over the range from 0 to 1, not scaled yet, and what kind it is.
fn extinction(random: &mut Random) -> (&'static str, Vec<[f64; 2]>) {
    match (random.unit() * 6.0) as u32 {
        0 => ("ramp", vec![[0.0, random.unit()], [1.0, random.unit()]]),
        1 => {
            let peaks = 1 + (random.unit() * 4.0) as u32;
            let width = random.between(0.01, 0.08);
            let mut points = vec![[0.0, 0.0]];
            for peak in 0..peaks {
                let middle = (f64::from(peak) + random.between(0.3, 0.7)) / f64::from(peaks);
                let half = width.min(0.25 / f64::from(peaks));
                points.extend([[middle - half, 0.0], [middle, random.between(0.3, 1.0)], [middle + half, 0.0]]);
            }
            points.push([1.0, 0.0]);
            ("peaks", points)
        }
        2 => {
            let [from, to] = [random.between(0.1, 0.4), random.between(0.5, 0.9)];
            ("step", vec![[0.0, 0.0], [from, 0.0], [from, 1.0], [to, 1.0], [to, 0.2], [1.0, 0.2]])
        }
        3 => {
            let points = (0..=8).map(|i| [f64::from(i) / 8.0, random.unit()]).collect();
            ("polygon", points)
        }
        4 => {
            let points = (0..256).map(|i| [f64::from(i) / 255.0, random.unit()]).collect();
            ("table", points)
        }
        _ => ("constant", vec![[0.0, 1.0], [1.0, 1.0]]),
    }
}

fn colors(random: &mut Random) -> Vec<[f64; 4]> {
    let count = [1, 2, 4, 33][(random.unit() * 4.0) as usize];
    let phases = random.point();
    (0..count)
        .map(|i| {
            let s = f64::from(i) / f64::from((count - 1).max(1));
            let channel = |phase: f64| 0.5 + 0.5 * (4.0 * s + 3.0 * phase).sin();
            [s, channel(phases.x), channel(phases.y), channel(phases.z)]
        })
        .collect()
}
