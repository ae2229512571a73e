//! What a hard case is.

use std::fmt;
use std::sync::Arc;

use glam::DVec3;
use tetrascope::mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells};
use tetrascope::view::Ray;
use tetrascope::{Camera, CameraSection, Projection, ProjectionName, SceneFile, Volume};

use super::judge::{CHORD_LIMITS, CRACK_LIMITS, LIGHT_LIMITS};
use crate::chords::boundary_faces;
use crate::ways::Way;

/// A section of the document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names are the sections")]
pub enum Group {
    Classification,
    Eye,
    Pixels,
    Optics,
    Numbers,
    Mesh,
    Order,
}

/// One hard case: scenes that are hard for the same reason.
#[derive(Clone, Copy, Debug)]
pub struct HardCase {
    /// A heading of the document and the name of its picture: words joined by hyphens.
    pub name: &'static str,
    /// Where in the document.
    pub group: Group,
    /// What is hard, why the textbook method fails, what is done here: a paragraph of the document.
    pub text: &'static str,
    /// Makes its scenes. The first one is drawn for the document and given to other renderers.
    pub scenes: fn() -> Vec<HardScene>,
}

/// A scene with what is known of it.
#[derive(Clone, Debug)]
pub struct HardScene {
    /// Which of the case's scenes.
    pub place: String,
    /// The mesh.
    pub volume: Arc<Volume>,
    /// From where, and of what optics. Methods and back end are left open.
    pub scene: SceneFile,
    /// What its pictures are held against.
    pub truth: Truth,
    /// What the scene's own picture may differ by from the truth in any channel; see [`judge()`](super::judge()).
    pub within: Limits,
    /// What chords may differ by, of themselves.
    pub chord_within: Limits,
    /// What opacity may differ by from its neighbors' plane.
    pub crack_within: Limits,
    /// Who cannot hold this scene, if anybody.
    pub beyond: Option<Beyond>,
    /// Words that the user must be told, where a limit is reached.
    pub says: Option<&'static str>,
    /// Words of a refusal that is right on a GPU, besides [`CANNOT_SORT`](super::CANNOT_SORT).
    pub refused: Option<&'static str>,
}

/// Limits way by way: the device's f32 has no f64 beside it, and its triangles are blended by rounded products.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// For the CPU, the reference with it.
    pub cpu: f64,
    /// For tiles in compute programs.
    pub compute: f64,
    /// For blended triangles.
    pub triangles: f64,
}

impl Limits {
    /// The limit of a way.
    pub fn of(self, way: Way) -> f64 {
        match way {
            Way::Cpu | Way::Reference => self.cpu,
            Way::Compute => self.compute,
            Way::Triangles => self.triangles,
        }
    }

    /// One for the CPU, one for both ways of a GPU.
    pub const fn of_two(cpu: f64, gpu: f64) -> Self {
        Self { cpu, compute: gpu, triangles: gpu }
    }
}

/// Ways that cannot hold a scene as others do: the user must be told, and light is held to a limit of its own; chords are not judged.
#[derive(Clone, Copy, Debug)]
pub struct Beyond {
    /// Those.
    pub ways: &'static [Way],
    /// Words of the warning.
    pub words: &'static str,
    /// What their light may differ by from the truth in any channel. 1 where nothing is promised but a sound picture.
    pub within: f64,
}

impl Beyond {
    /// Both ways of a GPU.
    pub const fn gpu(words: &'static str, within: f64) -> Self {
        Self { ways: &[Way::Compute, Way::Triangles], words, within }
    }
}

/// The light of a ray: linear R, G, B times opacity, opacity. `None` where a ray runs along an edge.
pub type Light = Arc<dyn Fn(&Ray) -> Option<[f64; 4]> + Send + Sync>;

/// What is known of a scene without drawing it.
#[derive(Clone)]
pub enum Truth {
    /// The cells fill what these triangles bound, once: chords of rays are known. Triangles in world coordinates, normals outwards. The scene's
    /// own picture is held against the reference.
    Outline(Vec<[DVec3; 3]>),
    /// Nothing but what the renderer in f64 draws: cells lie in one another.
    Reference,
    /// The light of every ray in closed form.
    Light(Light),
}

impl fmt::Debug for Truth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Outline(triangles) => write!(f, "Outline of {} triangles", triangles.len()),
            Self::Reference => f.write_str("Reference"),
            Self::Light(_) => f.write_str("Light"),
        }
    }
}

impl HardScene {
    /// A scene whose cells fill their boundary, which is taken from the mesh itself, with the usual limits.
    pub fn partition(place: impl Into<String>, volume: Volume, scene: SceneFile) -> Self {
        // The points as they were given: those of a mesh are relative to its frame, and rounded on their way back.
        let points = &volume.dataset.points;
        let outline = boundary_faces(&volume.decomposition.mesh)
            .into_iter()
            .map(|face| face.map(|point| points[point as usize]))
            .collect();
        Self::new(place, volume, scene, Truth::Outline(outline))
    }

    /// A scene with the usual limits: 1e-5 on the CPU, 2e-5 on a GPU.
    pub fn new(place: impl Into<String>, volume: Volume, scene: SceneFile, truth: Truth) -> Self {
        Self {
            place: place.into(),
            volume: Arc::new(volume),
            scene,
            truth,
            within: LIGHT_LIMITS,
            chord_within: CHORD_LIMITS,
            crack_within: CRACK_LIMITS,
            beyond: None,
            says: None,
            refused: None,
        }
    }
}

impl HardScene {
    /// Whether a way is held to the scene's own limits, and not to those of what is [beyond](Self::beyond) it.
    pub fn is_judged(&self, way: Way) -> bool {
        self.beyond_of(way).is_none()
    }

    /// What is beyond a way here, if anything is.
    pub fn beyond_of(&self, way: Way) -> Option<Beyond> {
        self.beyond.filter(|beyond| beyond.ways.contains(&way))
    }

    /// What the light of a way may differ by.
    pub fn light_within(&self, way: Way) -> f64 {
        self.beyond_of(way).map_or_else(|| self.within.of(way), |beyond| beyond.within)
    }
}

/// A mesh of tetrahedra with one scalar a point, named "field".
///
/// # Panics
/// If nothing in it has a volume.
pub fn volume_of(points: &[DVec3], tetrahedra: &[[u32; 4]], scalars: &[f64]) -> Volume {
    let count = tetrahedra.len();
    let dataset = Dataset {
        points: points.to_vec(),
        cells: Cells::Unstructured(UnstructuredCells {
            kinds: vec![CellKind::Tetrahedron; count],
            offsets: (0..=count).map(|cell| 4 * cell).collect(),
            connectivity: tetrahedra.concat(),
            polyhedra: Vec::new(),
        }),
        point_arrays: vec![DataArray {
            name: "field".to_owned(),
            components: 1,
            values: ArrayValues::F64(scalars.to_vec()),
        }],
        cell_arrays: Vec::new(),
    };
    Volume::from_dataset(dataset, "hard case").expect("the case has cells")
}

/// A scene of this camera: so many pixels, colors and extinctions over the scalar as given.
pub fn scene_of(camera: &Camera, size: [u32; 2], color: &[[f64; 4]], extinction: &[[f64; 2]]) -> SceneFile {
    let mut scene = SceneFile::of_mesh("hard-case.vtu");
    (scene.image.width, scene.image.height) = (size[0], size[1]);
    scene.camera = CameraSection {
        eye: Some(camera.eye.to_array()),
        target: Some(camera.target.to_array()),
        up: Some(camera.up.to_array()),
        ..CameraSection::default()
    };
    match camera.projection {
        Projection::Perspective { fov_y } => scene.camera.fov_y = Some(fov_y.to_degrees()),
        Projection::Orthographic { height } => {
            scene.camera.projection = ProjectionName::Orthographic;
            scene.camera.height = Some(height);
        }
    }
    scene.transfer.color = Some(color.to_vec());
    scene.transfer.extinction = Some(extinction.to_vec());
    scene
}
