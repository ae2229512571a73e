//! Plans and pictures: what a test says of optics and view, drawn by each renderer.

use glam::{DQuat, DVec3};
use tetrascope::mesh::TetMesh;
use tetrascope::{
    Backend, Camera, CpuRenderer, Integration, LengthAxis, LinearImage, OpticalModel, Plan, Projection, Silent,
    TableSettings, TransferFunction, View, reference,
};

use crate::meshes::Random;

/// A renderer with a way to integrate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Renderer {
    /// [`CpuRenderer`].
    Fast(Integration),
    /// [`reference::render`], which has no [`Integration::Vertex`].
    Reference(Integration),
}

impl Renderer {
    /// Both renderers where they are exact.
    pub const EXACT: [Self; 2] = [Self::Fast(Integration::Exact), Self::Reference(Integration::Exact)];

    /// Everything that draws a picture.
    pub const ALL: [Self; 5] = [
        Self::Fast(Integration::Exact),
        Self::Reference(Integration::Exact),
        Self::Fast(Integration::Average),
        Self::Reference(Integration::Average),
        Self::Fast(Integration::Vertex),
    ];

    /// The fast renderer's ways between the oldest and the exact: from the scalars at both ends of a segment, or by a table. Not
    /// all of them have every optical model ([`Integration::covers`]), and tables know a chord only as well as they resolve it.
    pub const BETWEEN: [Self; 5] = [
        Self::Fast(Integration::Opacity2d),
        Self::Fast(Integration::Partial),
        Self::Fast(Integration::Cumulative),
        Self::Fast(Integration::Table2d),
        Self::Fast(Integration::Table3d),
    ];

    /// How it integrates.
    pub fn integration(self) -> Integration {
        match self {
            Self::Fast(integration) | Self::Reference(integration) => integration,
        }
    }

    /// Whether it sorts per pixel, so that its colors can be trusted on any mesh.
    pub fn sorts_per_pixel(self) -> bool {
        matches!(self, Self::Reference(_))
    }

    /// Draws a field; the plan's integration is replaced.
    ///
    /// # Panics
    /// If the renderer refuses, or gives a number that is not finite.
    pub fn draw(self, mesh: &TetMesh, scalars: &[f64], plan: &Plan) -> LinearImage {
        let image = match self {
            Self::Fast(integration) => {
                let plan = Plan { integration, ..plan.clone() };
                let renderer = CpuRenderer::new(mesh, scalars).expect("the field fits");
                renderer.render(&plan, &Silent).expect("the plan is good").image
            }
            Self::Reference(integration) => {
                let plan = Plan { integration, backend: Backend::Reference, ..plan.clone() };
                reference::render(mesh, scalars, &plan, &Silent).expect("the plan is good").image
            }
        };
        assert!(image.pixels().iter().flatten().all(|c| c.is_finite()), "{self:?} gave a number that is not finite");
        image
    }
}

/// Tables of a few thousand entries, where many are built and none has to be accurate.
pub const SMALL_TABLES: Option<TableSettings> =
    Some(TableSettings { scalars: 24, lengths: 12, length_axis: LengthAxis::Linear });

/// A transfer function that colors nothing but one color.
pub const WHITE: &[[f64; 4]] = &[[0.0, 1.0, 1.0, 1.0]];

/// A plan of these optics: density emitter, exact, by centroids; nothing ends early.
///
/// # Panics
/// If the control points make no transfer function.
pub fn plan(view: View, color: &[[f64; 4]], extinction: &[[f64; 2]]) -> Plan {
    let transfer = TransferFunction::new(color, extinction).expect("the control points are good");
    Plan::new(view, transfer, OpticalModel::DensityEmitter)
}

/// A random turn, each as likely.
pub fn random_turn(random: &mut Random) -> DQuat {
    // Shoemake, Uniform random rotations, 1992.
    let (a, b, c) =
        (random.unit(), random.between(0.0, std::f64::consts::TAU), random.between(0.0, std::f64::consts::TAU));
    let (p, q) = ((1.0 - a).sqrt(), a.sqrt());
    DQuat::from_xyzw(p * b.sin(), p * b.cos(), q * c.sin(), q * c.cos()).normalize()
}

/// A camera that looks from a random side at something of radius about `size` around `center`.
pub fn random_camera(random: &mut Random, center: DVec3, size: f64, is_perspective: bool) -> Camera {
    let turn = random_turn(random);
    let target = center + random.point() * (0.2 * size);
    if is_perspective {
        let distance = random.between(2.5, 6.0);
        let fov_y = 2.0 * (1.4 / distance).atan();
        Camera {
            eye: target + turn * DVec3::Z * (distance * size),
            target,
            up: turn * DVec3::Y,
            projection: Projection::Perspective { fov_y },
        }
    } else {
        Camera {
            eye: target + turn * DVec3::Z * (4.0 * size),
            target,
            up: turn * DVec3::Y,
            projection: Projection::Orthographic { height: 3.2 * size },
        }
    }
}

/// The largest difference of two pictures in the channels chosen, 0 to 3 for red, green, blue and opacity.
///
/// # Panics
/// If the pictures differ in size.
pub fn largest(a: &LinearImage, b: &LinearImage, channels: std::ops::Range<usize>) -> f64 {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let pairs = a.pixels().iter().zip(b.pixels());
    pairs
        .flat_map(|(p, q)| channels.clone().map(move |c| (f64::from(p[c]) - f64::from(q[c])).abs()))
        .fold(0.0, f64::max)
}

/// Mean opacity: says whether a picture shows anything.
pub fn mean_opacity(image: &LinearImage) -> f64 {
    image.pixels().iter().map(|p| f64::from(p[3])).sum::<f64>() / image.pixels().len() as f64
}

/// Keeps the largest of what was found, with its place, and fails beyond a limit.
#[derive(Debug)]
pub struct Worst {
    what: String,
    limit: f64,
    found: f64,
    place: String,
    failures: usize,
}

impl Worst {
    /// Nothing found yet.
    pub fn new(what: impl Into<String>, limit: f64) -> Self {
        Self { what: what.into(), limit, found: 0.0, place: String::new(), failures: 0 }
    }

    /// Notes a finding.
    pub fn note(&mut self, value: f64, place: impl FnOnce() -> String) {
        self.failures += usize::from(value.is_nan() || value > self.limit);
        if value.is_nan() || value > self.found {
            self.found = value;
            self.place = place();
        }
    }

    /// Says what was the largest.
    ///
    /// # Panics
    /// If something was beyond the limit.
    #[expect(clippy::print_stdout, reason = "measured maxima are worth a line in a test's output")]
    pub fn finish(self) {
        let Self { what, limit, found, place, failures } = self;
        println!("{what}: largest {found:.2e} of {limit:.0e}, at {place}");
        assert_eq!(failures, 0, "{what}: {found:e} is beyond {limit:e}, at {place}");
    }
}
