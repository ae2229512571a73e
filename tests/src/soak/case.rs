//! A whole scene that a seed names.

use glam::DVec3;
use tetrascope::mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells};
use tetrascope::{Error, SceneFile, Volume};

use super::{mesh, numbers, optics, quality, view};
use crate::meshes::{Random, Tets};

/// A mesh of tetrahedra with a field, and what is to be drawn of it.
#[derive(Clone, Debug)]
pub struct Case {
    /// The seed that it was made from.
    pub seed: u64,
    /// What the mesh is, and what was done to it.
    pub mesh_kind: &'static str,
    /// Further changes of the mesh.
    pub changes: Vec<&'static str>,
    /// Where the eye is.
    pub view_kind: &'static str,
    /// What kind of transfer function it has.
    pub transfer_kind: &'static str,
    /// World coordinates, cells with four points each either way round, one scalar a point, not all of them finite.
    pub tets: Tets,
    /// Everything else; camera and transfer function are given in numbers, so that they stay when the mesh is reduced.
    pub scene: SceneFile,
}

impl Case {
    /// The case of a seed: the same on every machine but for the last digits of sines.
    pub fn of(seed: u64) -> Self {
        let mut random = Random::new(seed ^ 0x50A_C4A5E);
        let mut made = mesh::mesh(&mut random, seed);
        let field_kind = numbers::field(&mut random, &mut made.tets);
        made.changes.push(field_kind);
        let mut scene = SceneFile::of_mesh(format!("soak-{seed}.vtu"));
        scene.mesh.field = Some("field".to_owned());
        let bounds = Bounds::of(&made.tets);
        (scene.image.width, scene.image.height) = view::size(&mut random);
        let (view_kind, camera) = view::view(&mut random, &made, bounds);
        scene.camera = camera;
        let transfer_kind = optics::optics(&mut random, &made.tets, bounds, &mut scene);
        quality::quality(&mut random, &mut scene);
        let mesh::Made { kind, changes, tets, .. } = made;
        Self { seed, mesh_kind: kind, changes, view_kind, transfer_kind, tets, scene }
    }

    /// The mesh as a file would give it.
    pub fn dataset(&self) -> Dataset {
        let count = self.tets.cells.len();
        Dataset {
            points: self.tets.points.clone(),
            cells: Cells::Unstructured(UnstructuredCells {
                kinds: vec![CellKind::Tetrahedron; count],
                offsets: (0..=count).map(|cell| 4 * cell).collect(),
                connectivity: self.tets.cells.concat(),
                polyhedra: Vec::new(),
            }),
            point_arrays: vec![DataArray {
                name: "field".to_owned(),
                components: 1,
                values: ArrayValues::F64(self.tets.scalars.clone()),
            }],
            cell_arrays: Vec::new(),
        }
    }

    /// The mesh as it is drawn.
    ///
    /// # Errors
    /// [`Error::Mesh`] if nothing in it has a volume.
    pub fn volume(&self) -> Result<Volume, Error> {
        Volume::from_dataset(self.dataset(), &format!("soak {}", self.seed))
    }

    /// One line that says what it is.
    pub fn describe(&self) -> String {
        let Self { seed, mesh_kind, changes, view_kind, transfer_kind, tets, scene } = self;
        let changes: String = changes.iter().map(|change| format!(", {change}")).collect();
        format!(
            "seed {seed}: {mesh_kind}{changes}; {} cells; {view_kind}; {transfer_kind}, {}; {} isosurfaces; {} x {} pixels",
            tets.cells.len(),
            scene.optics.model,
            scene.isosurface.len(),
            scene.image.width,
            scene.image.height
        )
    }

    /// Lowest and highest finite scalar that a cell has; 0 and 0 where there is none.
    pub fn scalar_range(&self) -> [f64; 2] {
        scalar_range(&self.tets)
    }
}

/// Lowest and highest finite scalar that a cell has; 0 and 0 where there is none.
pub(super) fn scalar_range(tets: &Tets) -> [f64; 2] {
    let used = tets.cells.iter().flatten().map(|&v| tets.scalars[v as usize]).filter(|s| s.is_finite());
    let [low, high] = used.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], s| [l.min(s), h.max(s)]);
    if low <= high { [low, high] } else { [0.0; 2] }
}

/// The box of the points that cells use.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) center: DVec3,
    /// Half of the diagonal; never 0.
    pub(super) radius: f64,
}

impl Bounds {
    pub(super) fn of(tets: &Tets) -> Self {
        let used = tets.cells.iter().flatten().map(|&v| tets.points[v as usize]);
        let (low, high) = used.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        Self { center: low * 0.5 + high * 0.5, radius: (0.5 * (high - low).length()).max(f64::MIN_POSITIVE) }
    }
}
