//! Each finding on a mesh that has it.

use super::*;
use crate::{decompose, rings_sample};

fn report(points: &[DVec3], tetrahedra: &[[u32; 4]]) -> MeshReport {
    let cut = TetMesh::from_tetrahedra(points, tetrahedra).expect("some tetrahedron has a volume");
    check(&cut, &FaceAdjacency::new(cut.mesh.tetrahedra()))
}

const CORNERS: [DVec3; 5] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];

#[test]
fn a_good_mesh_has_no_findings() {
    let cut = decompose(&rings_sample(8)).expect("the sample is good");
    let report = check(&cut, &FaceAdjacency::new(cut.mesh.tetrahedra()));
    assert_eq!(report.findings(), Vec::<String>::new());
    assert_eq!((report.connected_parts, report.boundary_faces, report.tetrahedra), (1, 6 * 64 * 2, 5 * 512));
    let (lowest, highest) = report.bounds_world.expect("there are tetrahedra");
    let expected = rings_sample(8).points.iter().fold(DVec3::ZERO, |m, p| m.max(*p));
    assert!((highest - expected).length() < 1e-15 && (lowest + expected).length() < 1e-14, "{lowest} {highest}");
}

#[test]
fn every_oddity_is_counted_and_told() {
    let nan = DVec3::new(f64::NAN, 0.0, 0.0);
    let far = CORNERS.map(|p| p + DVec3::splat(8.0));
    let points = [&CORNERS[..], &[nan, DVec3::Y], &far].concat();
    // Two good neighbors, the first again, one at a point without a place, one inverted far away, one flat.
    let cells = [[0, 1, 2, 3], [1, 2, 3, 4], [2, 0, 1, 3], [0, 1, 2, 5], [7, 9, 8, 10], [0, 1, 2, 6]];
    let report = report(&points, &cells);
    assert_eq!(report.tetrahedra, 4);
    assert_eq!(report.duplicate_tetrahedra, 1);
    assert_eq!(report.decomposition.non_finite, 1);
    assert_eq!(report.decomposition.no_volume, 1);
    assert_eq!(report.decomposition.inverted, 1);
    assert_eq!((report.non_finite_points, report.coincident_points), (1, 1));
    assert_eq!(report.unreferenced_points, 3);
    assert_eq!(report.connected_parts, 2);
    assert_eq!(report.non_manifold_faces, 1);
    assert_eq!(report.folded_faces, 3);
    // 1/6 twice and again, and 1/3 of the unit cube for the cell between the corner's face and the far corner.
    assert!((report.volume_world - (3.0 / 6.0 + 2.0 / 6.0)).abs() < 1e-13, "{}", report.volume_world);
    assert_eq!(report.findings().len(), 10, "{:#?}", report.findings());
}

#[test]
fn volume_survives_scale_and_distance() {
    for (scale, offset) in [(1e-9, 0.0), (1e9, 0.0), (1e20, 0.0), (1.0, 1048576.0)] {
        let points = CORNERS.map(|p| p * scale + DVec3::splat(offset));
        let exact = 0.5 * scale * scale * scale;
        let found = report(&points, &[[0, 1, 2, 3], [1, 2, 3, 4]]).volume_world;
        assert!((found / exact - 1.0).abs() < 1e-12, "{found} for {exact}");
    }
}
