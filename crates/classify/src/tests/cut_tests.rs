//! Cells cut across the line of sight: volume, field, orientation, seams.

use std::collections::BTreeSet;

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_view::Viewpoint;

use super::{cell, clip, direction, field_at, point, scalars};
use crate::{Cut, DepthPlane, PieceId, cut_at_depth, project, six_volume};

const IDS: [u32; 4] = [4, 2, 9, 7];

fn volume(cut: &Cut) -> f64 {
    cut.pieces().map(|piece| six_volume(&piece.positions, piece.ids)).sum()
}

/// A plane through the cells, in front of them, or beyond.
fn plane() -> impl Strategy<Value = DepthPlane> {
    (point(), direction(), -1.0..1.0_f64).prop_map(|(origin, forward, depth)| DepthPlane { origin, forward, depth })
}

#[test]
fn cut_counts_and_volumes() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let across = |forward: DVec3, depth| DepthPlane { origin: DVec3::ZERO, forward, depth };
    // Plane, pieces, volume: corners before the plane 0, 1, 3, 2, 4, and planes through corners and faces.
    let cases = [
        (across(DVec3::Z, -1.0), 1, 1.0),
        (across(-DVec3::Z, -0.5), 3, 0.875),
        (across(DVec3::Z, 0.5), 1, 0.125),
        (across(DVec3::X + DVec3::Y, 0.5), 3, 0.5),
        (across(DVec3::Z, 2.0), 0, 0.0),
        (across(DVec3::Z, 0.0), 1, 1.0),
        (across(-DVec3::Z, 0.0), 0, 0.0),
        (across(DVec3::Z, 1.0), 0, 0.0),
        (across(DVec3::X - DVec3::Y, 0.0), 1, 0.5),
    ];
    for (plane, count, remaining) in cases {
        let cut = cut_at_depth(&positions, &[0.0; 4], IDS, &plane);
        assert_eq!((cut.len(), cut.is_empty()), (count, count == 0), "{plane:?}");
        assert_eq!(cut.pieces().count(), count);
        assert!((volume(&cut) - remaining).abs() < 1e-15, "{plane:?}: {}", volume(&cut));
    }
}

proptest! {
    #[test]
    fn cut_conserves_volume_and_field(positions in cell(), scalars in scalars(), plane in plane()) {
        let beyond = cut_at_depth(&positions, &scalars, IDS, &plane);
        let opposite = DepthPlane { forward: -plane.forward, depth: -plane.depth, ..plane };
        let before = cut_at_depth(&positions, &scalars, IDS, &opposite);
        let whole = six_volume(&positions, IDS);
        prop_assert!((volume(&beyond) + volume(&before) - whole).abs() < 1e-12 * whole.max(1.0));
        for piece in beyond.pieces() {
            prop_assert!(six_volume(&piece.positions, piece.ids) > 0.0);
            for (position, scalar) in piece.positions.iter().zip(piece.scalars) {
                prop_assert!((position - plane.origin).dot(plane.forward) - plane.depth > -1e-13);
                prop_assert!((field_at(&positions, &scalars, *position) - scalar).abs() < 1e-8);
            }
        }
    }

    /// A ray meets the pieces for as long as it meets the cell beyond the plane: nothing missing, nothing twice.
    #[test]
    fn pieces_share_out_every_ray(positions in cell(), plane in plane(), through in point(), way in direction()) {
        let along = |(enter, leave): (f64, f64)| (leave - enter).max(0.0);
        let (speed, ahead) = (way.dot(plane.forward), plane.depth - (through - plane.origin).dot(plane.forward));
        prop_assume!(speed > 0.01);
        let expected = clip(&positions, through, way).map_or(0.0, |(enter, leave)| along((enter.max(ahead / speed), leave)));
        let cut = cut_at_depth(&positions, &[0.0; 4], IDS, &plane);
        let found: f64 = cut.pieces().filter_map(|piece| clip(&piece.positions, through, way)).map(along).sum();
        prop_assert!((found - expected).abs() < 1e-7, "{} for {}", found, expected);
    }

    /// The pieces of the two cells of a face divide it into the same triangles, bit for bit.
    #[test]
    fn seams_are_closed(
        positions in cell(), beyond in point(), plane in plane(), ids in Just([4_u32, 2, 9, 7, 5]).prop_shuffle(),
    ) {
        let [p, q, r, _] = positions;
        let outward = (r - p).cross(q - p);
        prop_assume!(outward.dot(beyond - p) > 0.01);
        let seam = |cut: &Cut, ids: [u32; 3]| -> BTreeSet<Vec<(PieceId, [u64; 3])>> {
            let is_on_face = |id: &PieceId| id.iter().all(|end| ids.contains(end));
            cut.pieces()
                .filter_map(|piece| {
                    let mut corners: Vec<_> = (0..4)
                        .filter(|&i| is_on_face(&piece.ids[i]))
                        .map(|i| (piece.ids[i], piece.positions[i].to_array().map(f64::to_bits)))
                        .collect();
                    corners.sort_unstable();
                    (corners.len() == 3).then_some(corners)
                })
                .collect()
        };
        let here = cut_at_depth(&positions, &[0.0; 4], [ids[0], ids[1], ids[2], ids[3]], &plane);
        let there = cut_at_depth(&[r, q, p, beyond], &[0.0; 4], [ids[2], ids[1], ids[0], ids[4]], &plane);
        let face = [ids[0], ids[1], ids[2]];
        prop_assert_eq!(seam(&here, face), seam(&there, face));
    }

    /// Cells around the eye: once cut, every piece can be drawn, wholly in front of the eye.
    #[test]
    fn pieces_can_be_drawn(positions in cell(), eye in point(), forward in direction()) {
        let plane = DepthPlane { origin: eye, forward, depth: 1e-3 };
        for piece in cut_at_depth(&positions, &[1.0; 4], IDS, &plane).pieces() {
            let shown = project(&piece.positions, &piece.scalars, piece.ids, Viewpoint::Eye(eye));
            prop_assert!(shown.class != crate::ProjectionClass::EyeInside);
            for vertex in shown.fan.as_slice() {
                let attributes = shown.screen_attributes(*vertex, &piece.positions, &piece.scalars, eye, forward).unwrap();
                prop_assert!(attributes.q_front > 0.0 && attributes.q_front < 1.001e3);
                prop_assert!(attributes.dq >= 0.0 && attributes.dq <= attributes.q_front);
            }
        }
    }
}
