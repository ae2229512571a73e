//! Small steps are repaired, to a right order; large ones and rings are given up.

use glam::DVec3;
use tetrascope_mesh::{CellId, FaceAdjacency};
use tetrascope_view::Viewpoint;

use crate::gaps::Gaps;
use crate::mpvo_tests::jittered;
use crate::repair::Kept;
use crate::sides::FaceSides;
use crate::sweep::{sweep, waiting};
use crate::*;

#[test]
fn small_steps_are_repaired_and_large_ones_given_up() {
    let mesh = jittered(12, 5);
    let cells: Cells<'_> = (&mesh).into();
    let adjacency = FaceAdjacency::new(cells.tetrahedra);
    let sides = FaceSides::new(cells, &adjacency);
    let bytes_at = |eye: DVec3| {
        let mut bytes = vec![0; sides.len() + 1];
        sides.relations(cells, Viewpoint::Eye(eye), &mut bytes[..sides.len()], waiting);
        bytes
    };
    let mut kept = Kept::default();
    assert!(!kept.repair(&bytes_at(DVec3::ZERO), adjacency.table()), "nothing is known yet");
    for start in [DVec3::new(3.0, 1.0, 0.5), DVec3::new(0.1, 0.2, 0.3), DVec3::new(-0.9, 5.0, 1.1)] {
        let bytes = bytes_at(start);
        let placed = sweep(&mut bytes.clone(), adjacency.table(), &Gaps::default());
        assert_eq!(placed.len(), sides.len());
        kept.keep(&bytes, &placed);
        let mut was_wrong = 0;
        for step in 1..40 {
            let eye = start + DVec3::new(0.001, -0.0007, 0.0004) * f64::from(step);
            was_wrong += misordered_faces(cells, Viewpoint::Eye(eye), kept.placed());
            assert!(kept.repair(&bytes_at(eye), adjacency.table()), "{step} steps from {start}");
            assert_eq!(misordered_faces(cells, Viewpoint::Eye(eye), kept.placed()), 0);
        }
        assert!(was_wrong > 10, "there was something to repair: {was_wrong}");
        let mut sorted = kept.placed().to_vec();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(number, cell)| cell.index() == number));
        assert!(!kept.repair(&bytes_at(-start), adjacency.table()));
    }
}

/// A face turns so that three cells are in a ring.
#[test]
fn rings_are_given_up() {
    const NONE: u32 = u32::MAX;
    // A long chain of cells, so that three may be looked at: each one's neighbors are the one before and the one behind.
    let count = 200_u32;
    let mut table: Vec<[u32; 4]> =
        (0..count).map(|c| [c.wrapping_sub(1), if c + 1 < count { c + 1 } else { NONE }, NONE, NONE]).collect();
    (table[0][2], table[2][2]) = (2, 0);
    let mut bytes = vec![0b10; count as usize + 1];
    bytes[count as usize - 1] = 0;
    bytes[0] = 0b110;
    let placed: Vec<_> = (0..count).map(CellId).collect();
    let mut kept = Kept::default();
    kept.keep(&bytes, &placed);
    let mut same = Kept::default();
    same.keep(&bytes, &placed);
    assert!(same.repair(&bytes.clone(), &table) && same.placed() == placed);
    // The face between the first and the third turns: 0, 1, 2 and back.
    let mut ring = bytes.clone();
    (ring[0], ring[2]) = (0b010, 0b110);
    assert!(!kept.repair(&ring, &table));
}
