//! Small scenes that show, one each, what other renderers of tetrahedral meshes get wrong.
//!
//! Each is ordinary for Tetrascope. The one named [`CONTROL`] is ordinary for every renderer: where pictures of it differ, the
//! scene was not given to the other renderer as it is.

use glam::{DVec3, dvec3};
use tetrascope::mesh::TetMesh;
use tetrascope::{Camera, Projection, SceneFile, Volume};

use crate::hard::{scene_of, volume_of};
use crate::meshes::{Random, bent_block, grid};

/// The scene that all renderers draw alike.
pub const CONTROL: &str = "control";

/// Pixels a row, and rows: not square, so that nobody mixes them up.
const SIZE: [u32; 2] = [144, 120];

/// A scene with a name.
#[derive(Debug)]
pub struct PeerScene {
    /// Words joined by hyphens.
    pub name: &'static str,
    /// What it is, in a few words.
    pub says: &'static str,
    /// The mesh.
    pub volume: Volume,
    /// Camera, size and transfer function.
    pub scene: SceneFile,
    /// Whether color and extinction are given to others with one set of control points, which is how they lose none.
    pub is_merged: bool,
}

/// All scenes, the control first.
pub fn all() -> Vec<PeerScene> {
    vec![
        control(),
        thin_cells(),
        thin_cells_without_perspective(),
        off_center_diagonals(),
        one_frame(),
        narrow_peak(true),
        narrow_peak(false),
        faint_extinction(),
        slope(),
        flat_cells(),
        silhouettes(),
        eye_inside(),
        large_cells(),
    ]
}

fn perspective(eye: DVec3, target: DVec3, degrees: f64) -> Camera {
    Camera { eye, target, up: DVec3::Y, projection: Projection::Perspective { fov_y: degrees.to_radians() } }
}

/// The cells of a mesh with a field of the place, named "field".
fn with_field(mesh: &TetMesh, field: impl Fn(DVec3) -> f64) -> (Vec<DVec3>, Vec<[u32; 4]>, Vec<f64>) {
    let points: Vec<DVec3> = mesh.positions().iter().map(|&p| mesh.frame().to_world(p)).collect();
    let scalars = points.iter().map(|&p| field(p)).collect();
    (points, mesh.tetrahedra().iter().map(|cell| cell.map(|v| v.0)).collect(), scalars)
}

fn volume(mesh: &TetMesh, field: impl Fn(DVec3) -> f64) -> Volume {
    let (points, cells, scalars) = with_field(mesh, field);
    volume_of(&points, &cells, &scalars)
}

/// A field without sharp places, from about -1.5 to 1.5 in a block.
fn smooth(p: DVec3) -> f64 {
    (1.1 * p.x + 0.3).sin() * (0.9 * p.y).cos() + 0.4 * p.z
}

/// Colors and extinctions that vary slowly, with the same control points.
fn gentle(camera: &Camera) -> SceneFile {
    let color = [[-1.5, 0.1, 0.2, 0.9], [0.0, 0.2, 0.9, 0.3], [1.5, 0.9, 0.2, 0.1]];
    scene_of(camera, SIZE, &color, &[[-1.5, 0.1], [0.0, 0.5], [1.5, 1.2]])
}

fn control() -> PeerScene {
    let camera = perspective(dvec3(2.6, 1.9, 3.7), dvec3(0.05, 0.02, 0.0), 38.0);
    PeerScene {
        name: CONTROL,
        says: "a bent block of 2,560 cells of like size, optics that vary slowly, seen from general position",
        volume: volume(&bent_block(8, 0.1, 11).mesh, smooth),
        scene: gentle(&camera),
        is_merged: true,
    }
}

/// A plate of cells 50 times as long as thick, with an optical depth of 1 across.
fn plate(name: &'static str, says: &'static str, camera: &Camera) -> PeerScene {
    let mesh = grid([8, 8, 1], DVec3::ZERO, 1.0).mesh;
    let (points, cells, scalars) = with_field(&mesh, |p| p.x / 8.0);
    let points: Vec<DVec3> = points.iter().map(|p| dvec3(p.x / 4.0 - 1.0, p.y / 4.0 - 1.0, p.z * 0.005)).collect();
    let color = [[0.0, 0.1, 0.3, 0.9], [1.0, 0.9, 0.5, 0.1]];
    let scene = scene_of(camera, SIZE, &color, &[[0.0, 200.0], [1.0, 200.0]]);
    PeerScene { name, says, volume: volume_of(&points, &cells, &scalars), scene, is_merged: true }
}

fn thin_cells() -> PeerScene {
    let camera = perspective(dvec3(0.7, 0.4, 3.6), DVec3::ZERO, 38.0);
    plate("thin-cells", "a plate of cells 70 times as long as thick, of optical depth 1, in perspective", &camera)
}

fn thin_cells_without_perspective() -> PeerScene {
    let projection = Projection::Orthographic { height: 2.5 };
    let camera = Camera { projection, ..perspective(dvec3(0.7, 0.4, 3.6), DVec3::ZERO, 38.0) };
    plate("thin-cells-orthographic", "the same plate in orthographic projection", &camera)
}

/// One cell whose silhouette has four corners: the near edge is crossed near its end, the far one near its start.
fn off_center_diagonals() -> PeerScene {
    let points = [dvec3(-1.7, -0.3, 0.1), dvec3(0.3, -0.3, 0.1), dvec3(0.0, -0.7, -0.3), dvec3(0.0, 1.3, -0.3)];
    let projection = Projection::Orthographic { height: 2.3 };
    let camera = Camera { projection, ..perspective(dvec3(-0.6, 0.2, 5.0), dvec3(-0.6, 0.2, 0.0), 30.0) };
    let color = [[0.0, 0.9, 0.9, 0.9], [1.0, 0.9, 0.9, 0.9]];
    PeerScene {
        name: "off-center-diagonals",
        says: "one cell, class 2, whose diagonals cross far from their middles; extinction rises along one of them",
        volume: volume_of(&points, &[[0, 1, 2, 3]], &[0.0, 0.0, 0.0, 1.0]),
        scene: scene_of(&camera, SIZE, &color, &[[0.0, 0.0], [1.0, 8.0]]),
        is_merged: true,
    }
}

fn one_frame() -> PeerScene {
    let camera = perspective(dvec3(2.6, 1.9, 3.7), dvec3(0.05, 0.02, 0.0), 38.0);
    PeerScene {
        name: "one-frame",
        says: "the control with 625 cells, as a single screenshot has it",
        volume: volume(&bent_block(5, 0.1, 12).mesh, smooth),
        scene: gentle(&camera),
        is_merged: true,
    }
}

/// A shell of extinction thinner than a cell.
fn narrow_peak(is_merged: bool) -> PeerScene {
    let camera = perspective(dvec3(2.6, 1.9, 3.7), dvec3(0.05, 0.02, 0.0), 38.0);
    let color = [[-1.5, 0.1, 0.2, 0.9], [1.5, 0.9, 0.6, 0.1]];
    let extinction = [[-1.5, 0.0], [0.30, 0.0], [0.33, 20.0], [0.36, 0.0], [1.5, 0.0]];
    PeerScene {
        name: if is_merged { "narrow-peak" } else { "narrow-peak-as-set" },
        says: if is_merged {
            "a peak of extinction that lies within the cells; color has the control points of extinction, too"
        } else {
            "the same, but color keeps its own two control points"
        },
        volume: volume(&bent_block(6, 0.1, 13).mesh, smooth),
        scene: scene_of(&camera, SIZE, &color, &extinction),
        is_merged,
    }
}

/// Extinction that is small beside a peak which no scalar reaches.
fn faint_extinction() -> PeerScene {
    let camera = perspective(dvec3(2.6, 1.9, 3.7), dvec3(0.05, 0.02, 0.0), 38.0);
    let color = [[-2.0, 0.9, 0.8, 0.7], [2.0, 0.9, 0.8, 0.7]];
    let extinction = [[-2.0, 0.25], [2.0, 0.25], [3.0, 200.0]];
    PeerScene {
        name: "faint-extinction",
        says: "extinction of an eight-hundredth of its peak, over a path of about 2",
        volume: volume(&bent_block(6, 0.1, 14).mesh, smooth),
        scene: scene_of(&camera, SIZE, &color, &extinction),
        is_merged: true,
    }
}

/// A blue cell that slopes away into depth, in front of a red one that is small.
fn slope() -> PeerScene {
    let points = [
        // The far edge comes first: who sorts by the first point of a face sorts by this.
        dvec3(4.0, -1.2, -9.0),
        dvec3(4.0, 1.2, -9.4),
        dvec3(-0.2, -1.2, 1.0),
        dvec3(-0.2, 1.2, 1.4),
        dvec3(0.1, -0.5, -2.3),
        dvec3(0.9, -0.4, -2.4),
        dvec3(0.5, 0.5, -2.2),
        dvec3(0.5, 0.0, -3.0),
    ];
    let scalars = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let projection = Projection::Orthographic { height: 3.0 };
    let camera = Camera { projection, ..perspective(dvec3(0.8, 0.0, 5.0), dvec3(0.8, 0.0, 0.0), 30.0) };
    let color = [[0.0, 0.1, 0.1, 1.0], [1.0, 1.0, 0.1, 0.1]];
    PeerScene {
        name: "sloping-cell",
        says: "a blue cell that slopes away in front of a small red one",
        volume: volume_of(&points, &[[0, 1, 2, 3], [4, 5, 6, 7]], &scalars),
        scene: scene_of(&camera, SIZE, &color, &[[0.0, 20.0], [1.0, 20.0]]),
        is_merged: true,
    }
}

/// A block one of whose sides is drawn together into a line, as structured grids around a body have it: cells there have no volume.
fn flat_cells() -> PeerScene {
    let (mut points, cells, scalars) = with_field(&grid([5, 5, 5], DVec3::splat(-1.0), 0.4).mesh, smooth);
    let mut random = Random::new(15);
    for p in &mut points {
        let is_inside = p.abs().max_element() < 0.9;
        *p = if p.x < -0.9 { dvec3(p.x, p.y, 0.0) } else { *p };
        if is_inside {
            *p += random.point() * 0.03;
        }
    }
    let camera = perspective(dvec3(2.6, 1.9, 3.7), DVec3::ZERO, 38.0);
    PeerScene {
        name: "cells-of-no-volume",
        says: "a block with one side drawn together into a line, as grids around bodies have it",
        volume: volume_of(&points, &cells, &scalars),
        scene: gentle(&camera),
        is_merged: true,
    }
}

/// An opaque block.
fn silhouettes() -> PeerScene {
    let camera = perspective(dvec3(2.6, 1.9, 3.7), dvec3(0.05, 0.02, 0.0), 38.0);
    let color = [[-1.5, 0.9, 0.8, 0.7], [1.5, 0.9, 0.8, 0.7]];
    PeerScene {
        name: "silhouettes",
        says: "a block of large extinction, whose outline is a step",
        volume: volume(&bent_block(5, 0.1, 16).mesh, smooth),
        scene: scene_of(&camera, SIZE, &color, &[[-1.5, 60.0], [1.5, 60.0]]),
        is_merged: true,
    }
}

fn eye_inside() -> PeerScene {
    let camera = perspective(dvec3(0.21, -0.13, 0.34), dvec3(-0.6, 0.2, -0.5), 75.0);
    PeerScene {
        name: "eye-inside",
        says: "the eye in the middle of the control's block",
        volume: volume(&bent_block(8, 0.1, 11).mesh, smooth),
        scene: gentle(&camera),
        is_merged: true,
    }
}

/// A cube of five cells that reach from near the eye to three times as far.
fn large_cells() -> PeerScene {
    let camera = perspective(dvec3(0.9, 0.7, 2.4), dvec3(0.1, 0.0, 0.0), 62.0);
    let color = [[-1.0, 0.1, 0.2, 1.0], [0.0, 0.1, 0.9, 0.2], [1.0, 1.0, 0.2, 0.1]];
    PeerScene {
        name: "large-cells",
        says: "a cube of five cells, seen from near by, with a field that changes with depth",
        volume: volume(&grid([1, 1, 1], DVec3::splat(-1.0), 2.0).mesh, |p| p.z),
        scene: scene_of(&camera, SIZE, &color, &[[-1.0, 1.5], [1.0, 1.5]]),
        is_merged: true,
    }
}

#[cfg(test)]
mod tests {
    use tetrascope::mesh::Cells;

    use super::*;
    use crate::compare::difference;
    use crate::ways::Way;

    #[test]
    fn scenes_of_peers_are_drawn_right() {
        for peer in all() {
            let [exact, fast] =
                [Way::Reference, Way::Cpu].map(|way| way.draw(&peer.volume, &peer.scene).expect(peer.name));
            let opacities = exact.image.pixels().iter().map(|p| f64::from(p[3]));
            let (sum, highest) = opacities.fold((0.0, 0.0_f64), |(sum, highest), a| (sum + a, highest.max(a)));
            assert!(highest > 0.1 && sum > 0.0, "{}: there is nothing to see, {highest}", peer.name);
            let apart = difference(&fast.image, &exact.image, 1e-5, &[]);
            // Light is steep at the outline of the thin plate: 2e-5 there.
            assert!(apart.largest < 5e-5, "{}: {apart:?}", peer.name);
        }
    }

    #[test]
    fn flat_cells_have_no_volume() {
        let made = flat_cells();
        let Cells::Unstructured(cells) = &made.volume.dataset.cells else { panic!("it is made of tetrahedra") };
        let given = cells.kinds.len();
        let drawn = made.volume.decomposition.mesh.tetrahedra().len();
        assert!(given > drawn + 10, "{given} cells, {drawn} with volume");
    }
}
