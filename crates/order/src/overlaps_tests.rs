//! Overlaps of a few cells each, and none where cells only touch.

use glam::DVec3;
use tetrascope_mesh::{FaceAdjacency, VertexId};

use crate::overlaps::{folded_pairs, overlaps};
use crate::{Cells, Overlaps};

fn found(points: &[DVec3], tetrahedra: &[[u32; 4]]) -> Overlaps {
    let tetrahedra: Vec<_> = tetrahedra.iter().map(|t| t.map(VertexId)).collect();
    let (cells, adjacency) = (Cells { positions: points, tetrahedra: &tetrahedra }, FaceAdjacency::new(&tetrahedra));
    overlaps(cells, &adjacency, folded_pairs(cells, &adjacency).len()).0
}

fn count(points: &[DVec3], tetrahedra: &[[u32; 4]]) -> usize {
    let found = found(points, tetrahedra);
    assert!(found.is_complete);
    found.piercing
}

#[test]
fn cells_on_one_side_of_a_face() {
    let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let with = |more: &[DVec3]| [&corner[..], more].concat();
    let pair = [[0, 1, 2, 3], [1, 2, 3, 4]];
    // Beyond the common face; within the first cell; the points of the cells in any order.
    assert_eq!(found(&with(&[DVec3::splat(0.6)]), &pair).folded, 0);
    assert_eq!(found(&with(&[DVec3::splat(0.1)]), &pair).folded, 1);
    assert_eq!(found(&with(&[DVec3::splat(0.1)]), &[[1, 0, 2, 3], [4, 3, 2, 1]]).folded, 1);
    // Three cells at one face, two of them beyond it; a cell that is there twice.
    let three = [[0, 1, 2, 3], [1, 2, 3, 4], [1, 2, 3, 5]];
    assert_eq!(found(&with(&[DVec3::splat(0.6), DVec3::splat(0.7)]), &three).folded, 1);
    assert_eq!(found(&corner, &[[0, 1, 2, 3], [1, 0, 3, 2]]).folded, 1);
    assert!(!found(&corner, &[[0, 1, 2, 3]]).any());
}

#[test]
fn parts_inside_others() {
    let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let with = |size: f64, place: DVec3| [corner.to_vec(), corner.map(|p| p * size + place).to_vec()].concat();
    let two = [[0, 1, 2, 3], [4, 5, 6, 7]];
    let inside = found(&with(0.1, DVec3::splat(0.15)), &two);
    assert_eq!((inside.contained, inside.piercing), (1, 0));
    assert!(!found(&with(0.1, DVec3::new(-0.5, 0.15, 0.16)), &two).any(), "beside it, and a ray passes through it");
    assert!(!found(&with(0.1, DVec3::new(1.5, 0.15, 0.16)), &two).any());
    // A shell of cells about an empty middle contains what is in the middle nowhere.
    let outer = corner.map(|p| p * 4.0 - 0.5);
    let inner = corner.map(|p| p * 1.0 + 0.1);
    let mut points = [outer, inner].concat();
    let mut shell = Vec::new();
    for face in [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]] {
        // A prism between a face outside and the one inside, as three cells.
        let [a, b, c] = face;
        shell.extend([[a, b, c, c + 4], [a, b, b + 4, c + 4], [a, a + 4, b + 4, c + 4]]);
    }
    points.extend(corner.map(|p| p * 0.1 + 0.3));
    shell.push([8, 9, 10, 11]);
    assert_eq!(found(&points, &shell).contained, 0);
}

#[test]
fn faces_that_touch_do_not_pierce() {
    let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let beside = |away: DVec3| [corner.to_vec(), corner.map(|p| p + away).to_vec()].concat();
    let two = [[0, 1, 2, 3], [4, 5, 6, 7]];
    assert_eq!(count(&[], &[]), 0);
    assert_eq!(count(&corner, &two[..1]), 0);
    // Apart, in a point, in one place.
    for away in [DVec3::X * 2.0, DVec3::X, DVec3::ZERO] {
        assert_eq!(count(&beside(away), &two), 0, "{away}");
    }
    assert!(count(&beside(DVec3::splat(0.1)), &two) > 0);
    // Neighbors share a face and its edges.
    let pair = [corner.to_vec(), vec![DVec3::splat(1.0)]].concat();
    assert_eq!(count(&pair, &[[0, 1, 2, 3], [1, 2, 3, 4]]), 0);
    // A tip that comes back through the first cell.
    let back = [corner.to_vec(), vec![DVec3::splat(-1.0)]].concat();
    assert_eq!(count(&back, &[[0, 1, 2, 3], [1, 2, 3, 4]]), 0, "it lies around the first cell and pierces nothing");
}

#[test]
fn every_pair_is_found_once() {
    // A row of thin needles through one large face.
    let mut points = vec![DVec3::new(-9.0, -9.0, 0.0), DVec3::new(9.0, -9.0, 0.0), DVec3::new(0.0, 9.0, 0.0)];
    points.push(DVec3::new(0.0, 0.0, -9.0));
    let mut tetrahedra = vec![[0, 1, 2, 3]];
    for needle in 0..40 {
        let place = DVec3::new(f64::from(needle) * 0.1 - 2.0, 0.03, 0.0);
        let first = points.len() as u32;
        points.extend(
            [(0.0, 0.0, 0.5), (0.01, 0.0, -0.1), (0.0, 0.01, -0.1), (0.01, 0.01, -0.1)]
                .map(|(x, y, z)| place + DVec3::new(x, y, z)),
        );
        tetrahedra.push([0, 1, 2, 3].map(|i| first + i));
    }
    // The tip is above the face, the rest below: three faces of each needle pass through it.
    assert_eq!(count(&points, &tetrahedra), 3 * 40);
}
