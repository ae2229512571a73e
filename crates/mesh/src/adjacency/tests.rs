//! Symmetry, invariance under renumbering, and oddities.

use super::*;
use crate::{decompose, rings_sample};
use proptest::prelude::*;

fn cells(list: &[[u32; 4]]) -> Vec<[VertexId; 4]> {
    list.iter().map(|t| t.map(VertexId)).collect()
}

/// Every promise of the structure, checked the slow way.
fn sanity_check(tetrahedra: &[[VertexId; 4]], adjacency: &FaceAdjacency) {
    let sorted = |cell: usize, corner: usize| ascending(face_points(tetrahedra[cell], corner as u8));
    let mut owners = std::collections::BTreeMap::<[u32; 3], Vec<CellFace>>::new();
    for cell in 0..tetrahedra.len() {
        for corner in 0..4 {
            let face = CellFace { cell: CellId(cell as u32), corner: corner as u8 };
            owners.entry(sorted(cell, corner)).or_default().push(face);
        }
    }
    let mut boundary = Vec::new();
    let mut non_manifold = Vec::new();
    for faces in owners.values() {
        for face in faces {
            let expected = match faces.as_slice() {
                [a, b] => Some(if a == face { b.cell } else { a.cell }),
                _ => None,
            };
            assert_eq!(adjacency.neighbor(face.cell, usize::from(face.corner)), expected, "{face:?}");
        }
        match faces.len() {
            1 => boundary.push(faces[0]),
            2 => {}
            _ => non_manifold.push(faces.clone()),
        }
    }
    boundary.sort_unstable();
    non_manifold.sort_unstable();
    assert_eq!(adjacency.boundary_faces(), boundary);
    assert_eq!(adjacency.non_manifold_faces(), non_manifold);
    let mut seen = std::collections::BTreeMap::new();
    let mut duplicates = Vec::new();
    for (cell, tetrahedron) in tetrahedra.iter().enumerate() {
        let mut key = *tetrahedron;
        key.sort_unstable();
        match seen.get(&key) {
            Some(first) => duplicates.push([*first, CellId(cell as u32)]),
            None => drop(seen.insert(key, CellId(cell as u32))),
        }
    }
    duplicates.sort_unstable();
    assert_eq!(adjacency.duplicates(), duplicates);
}

#[test]
fn neighbors_duplicates_and_folds_are_told() {
    // Two on different sides of a face, a third on the side of the second.
    let pair = cells(&[[0, 1, 2, 3], [0, 2, 1, 4]]);
    let adjacency = FaceAdjacency::new(&pair);
    assert_eq!(adjacency.neighbor(CellId(0), 3), Some(CellId(1)));
    assert_eq!(adjacency.boundary_faces().len(), 6);
    assert!(adjacency.folded_faces().is_empty());
    let folded = cells(&[[0, 1, 2, 3], [0, 1, 2, 4]]);
    assert_eq!(FaceAdjacency::new(&folded).folded_faces().len(), 1);
    let three = cells(&[[0, 1, 2, 3], [0, 2, 1, 4], [0, 2, 1, 5]]);
    let adjacency = FaceAdjacency::new(&three);
    assert_eq!((adjacency.non_manifold_faces().len(), adjacency.boundary_faces().len()), (1, 9));
    assert_eq!(adjacency.neighbor(CellId(0), 3), None);
    let twice = cells(&[[7, 1, 2, 3], [1, 7, 3, 2], [4, 5, 6, 7], [2, 3, 7, 1]]);
    let adjacency = FaceAdjacency::new(&twice);
    assert_eq!(adjacency.duplicates(), [[CellId(0), CellId(1)], [CellId(0), CellId(3)]]);
    sanity_check(&twice, &adjacency);
}

#[test]
fn empty_and_sparse_indices() {
    assert!(FaceAdjacency::new(&[]).boundary_faces().is_empty());
    let sparse = cells(&[[0, u32::MAX, u32::MAX - 7, 5], [5, u32::MAX, 9, u32::MAX - 7]]);
    let adjacency = FaceAdjacency::new(&sparse);
    sanity_check(&sparse, &adjacency);
    assert_eq!(adjacency.neighbor(CellId(0), 0), Some(CellId(1)));
}

#[test]
fn a_whole_mesh_passes_the_slow_check() {
    let mesh = decompose(&rings_sample(20)).expect("the sample is good").mesh;
    let adjacency = FaceAdjacency::new(mesh.tetrahedra());
    sanity_check(mesh.tetrahedra(), &adjacency);
    assert_eq!(adjacency.boundary_faces().len(), 6 * 20 * 20 * 2);
    assert!(adjacency.folded_faces().is_empty());
}

proptest! {
    #[test]
    fn neighbor_of_neighbor_is_the_cell(list in prop::collection::vec([0_u32..12, 0..12, 0..12, 0..12], 0..60)) {
        let list: Vec<_> = list.into_iter().filter(|t| (0..4).all(|n| !t[..n].contains(&t[n]))).collect();
        let tetrahedra = cells(&list);
        let adjacency = FaceAdjacency::new(&tetrahedra);
        sanity_check(&tetrahedra, &adjacency);
        for cell in 0..tetrahedra.len() {
            for corner in 0..4 {
                if let Some(neighbor) = adjacency.neighbor(CellId(cell as u32), corner) {
                    let back = (0..4).filter_map(|n| adjacency.neighbor(neighbor, n));
                    prop_assert!(back.into_iter().any(|c| c.index() == cell));
                }
            }
        }
    }

    #[test]
    fn renumbering_cells_renumbers_neighbors(seed in any::<u64>()) {
        let mesh = decompose(&rings_sample(3)).expect("the sample is good").mesh;
        let mut order: Vec<usize> = (0..mesh.tetrahedra().len()).collect();
        order.sort_by_key(|&n| (n as u64 + 1).wrapping_mul(seed | 1).rotate_left(29));
        let shuffled: Vec<_> = order.iter().map(|&n| mesh.tetrahedra()[n]).collect();
        let (plain, other) = (FaceAdjacency::new(mesh.tetrahedra()), FaceAdjacency::new(&shuffled));
        for (new, &old) in order.iter().enumerate() {
            for corner in 0..4 {
                let expected = plain.neighbor(CellId(old as u32), corner);
                let found = other.neighbor(CellId(new as u32), corner).map(|c| CellId(order[c.index()] as u32));
                prop_assert_eq!(found, expected);
            }
        }
        prop_assert_eq!(plain.boundary_faces().len(), other.boundary_faces().len());
    }
}
