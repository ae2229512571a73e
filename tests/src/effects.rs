//! Scenes in pairs: one that never had an effect, and one that has its keys but switched off. Both must take the same work.

use glam::DVec3;
use tetrascope::mesh::{CellKind, Cells, UnstructuredCells};
use tetrascope::{
    CameraSection, Choice, Dataset, Error, Integration, IsosurfaceSection, LightDirection, LightSection, MeshFacts,
    OpticalModel, SceneFile, Shading, Volume, VolumeField,
};

/// An effect in a scene, in all states.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The effect.
    pub name: &'static str,
    /// What makes the other one a scene without it.
    pub off_by: &'static str,
    /// A scene without a word of it.
    pub never: SceneFile,
    /// One with its keys, switched off.
    pub off: SceneFile,
    /// With it, by how much of it.
    pub on: Vec<(&'static str, SceneFile)>,
    /// Whether the scene without it is of a mesh that has not the cells in which the other one shows nothing.
    pub is_of_fewer_cells: bool,
}

/// A scene with a camera that does not depend on which cells there are, seen from aside, and a plain transfer function.
fn plain(facts: &MeshFacts, size: u32) -> SceneFile {
    let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
    let center = facts.center();
    let eye = center + DVec3::new(1.0, 0.6, 0.5).normalize() * facts.diagonal() * 2.0;
    scene.camera = CameraSection {
        eye: Some(eye.to_array()),
        target: Some(center.to_array()),
        up: Some([0.0, 0.0, 1.0]),
        ..CameraSection::default()
    };
    (scene.image.width, scene.image.height) = (size, size);
    let at = at_shares(facts);
    scene.transfer.color = Some(vec![[at(0.0), 0.1, 0.3, 0.8], [at(0.4), 0.9, 0.8, 0.3], [at(1.0), 0.8, 0.1, 0.1]]);
    let depth = 1.0 / facts.diagonal();
    scene.transfer.extinction = Some(vec![[at(0.0), 0.5 * depth], [at(0.5), 2.0 * depth], [at(1.0), 8.0 * depth]]);
    scene
}

fn at_shares(facts: &MeshFacts) -> impl Fn(f64) -> f64 {
    let (low, high) = facts.scalar_range;
    move |share| low + (high - low) * share
}

/// All pairs, for a field.
///
/// - `shown`: extinction that shows about a tenth of the cells, see [`thin_extinction`]
/// - `size`: pixels along both sides
pub fn pairs(facts: &MeshFacts, shown: Vec<[f64; 2]>, size: u32) -> Vec<Pair> {
    let scene = plain(facts, size);
    let at = at_shares(facts);
    let with = |change: &dyn Fn(&mut SceneFile)| {
        let mut scene = scene.clone();
        change(&mut scene);
        scene
    };
    let light = LightSection { direction: LightDirection::Vector([1.0, 2.0, 3.0]), ..LightSection::default() };
    let surfaces = |count: u32, opacity: f64, shading: Shading| -> Vec<IsosurfaceSection> {
        let value = |index: u32| at((f64::from(index) + 0.5) / f64::from(count));
        let one =
            |index| IsosurfaceSection { opacity, shading, ..IsosurfaceSection::new(value(index), [0.9, 0.6, 0.2]) };
        (0..count).map(one).collect()
    };
    let model = |model: OpticalModel| with(&|scene| scene.optics.model = model);
    let thin = with(&|scene| scene.transfer.extinction = Some(shown.clone()));
    vec![
        Pair {
            name: "lighting",
            off_by: "a light that falls on nothing",
            never: scene.clone(),
            off: with(&|scene| scene.light = Some(LightSection { volume: false, ..light.clone() })),
            on: vec![("volume lit", with(&|scene| scene.light = Some(LightSection { volume: true, ..light.clone() })))],
            is_of_fewer_cells: false,
        },
        Pair {
            name: "isosurfaces",
            off_by: "100 of opacity 0, to be lit",
            never: scene.clone(),
            off: with(&|scene| scene.isosurface = surfaces(100, 0.0, Shading::Smooth)),
            on: vec![
                ("1", with(&|scene| scene.isosurface = surfaces(1, 0.3, Shading::None))),
                ("100", with(&|scene| scene.isosurface = surfaces(100, 0.3, Shading::None))),
                ("100 lit", with(&|scene| scene.isosurface = surfaces(100, 0.3, Shading::Smooth))),
            ],
            is_of_fewer_cells: false,
        },
        Pair {
            name: "order, absorption",
            off_by: "the remedy for rings of cells asked for",
            never: model(OpticalModel::Absorption),
            off: with(&|scene| {
                scene.optics.model = OpticalModel::Absorption;
                scene.quality.cycles = Some(tetrascope::CycleRemedy::PerPixel);
            }),
            on: vec![("density emitter", model(OpticalModel::DensityEmitter))],
            is_of_fewer_cells: false,
        },
        Pair {
            name: "order, emission",
            off_by: "extinction that the model ignores",
            never: with(&|scene| {
                scene.optics.model = OpticalModel::Emission;
                scene.transfer.extinction = None;
            }),
            off: model(OpticalModel::Emission),
            on: vec![("emitter", model(OpticalModel::Emitter))],
            is_of_fewer_cells: false,
        },
        Pair {
            name: "table",
            off_by: "sizes of a table with the exact integration",
            never: scene.clone(),
            off: with(&|scene| {
                scene.quality.integration = Choice::Named(Integration::Exact);
                scene.quality.table_size = Some(128);
            }),
            on: vec![("64 x 64 x 64", with(&|scene| scene.quality.integration = Choice::Named(Integration::Table3d)))],
            is_of_fewer_cells: false,
        },
        Pair {
            name: "cells that show nothing",
            off_by: "90 % of the cells transparent",
            never: thin.clone(),
            off: thin,
            on: vec![("all shown", scene.clone())],
            is_of_fewer_cells: true,
        },
    ]
}

/// Control points of an extinction that shows a share of a field's cells: those of the highest scalars.
pub fn thin_extinction(field: &VolumeField<'_>, share: f64) -> Vec<[f64; 2]> {
    let scalars = &field.on_mesh.scalars;
    let highest =
        |cell: &[tetrascope::mesh::VertexId; 4]| cell.map(|v| scalars[v.index()]).into_iter().fold(f64::MIN, f64::max);
    let mut of_cells: Vec<f64> = field.on_mesh.mesh.tetrahedra().iter().map(highest).collect();
    of_cells.sort_by(f64::total_cmp);
    let first = ((of_cells.len() as f64 * (1.0 - share)) as usize).min(of_cells.len().saturating_sub(1));
    let (start, end) = (of_cells.get(first).copied().unwrap_or_default(), field.facts.scalar_range.1);
    vec![[start, 0.0], [end, 8.0 / field.facts.diagonal()]]
}

/// The tetrahedra of a field without those in which nothing is seen above a scalar, all points kept.
///
/// # Errors
/// [`Error`] if no cell is left.
pub fn only_above(field: &VolumeField<'_>, scalar: f64) -> Result<Volume, Error> {
    let mesh = &field.on_mesh.mesh;
    let scalars = &field.on_mesh.scalars;
    let shown = mesh.tetrahedra().iter().filter(|cell| cell.iter().any(|v| scalars[v.index()] > scalar));
    let connectivity: Vec<u32> = shown.flat_map(|cell| cell.map(|v| v.0)).collect();
    let count = connectivity.len() / 4;
    let cells = Cells::Unstructured(UnstructuredCells {
        kinds: vec![CellKind::Tetrahedron; count],
        offsets: (0..=count).map(|c| 4 * c).collect(),
        connectivity,
        polyhedra: Vec::new(),
    });
    let points = mesh.positions().iter().map(|&p| mesh.frame().to_world(p)).collect();
    let array = tetrascope::DataArray {
        name: "s".to_owned(),
        components: 1,
        values: tetrascope::ArrayValues::F64(scalars.clone()),
    };
    let dataset = Dataset { points, cells, point_arrays: vec![array], ..Dataset::default() };
    Volume::from_dataset(dataset, "the cells that are shown")
}
