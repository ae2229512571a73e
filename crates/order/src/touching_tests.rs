//! Cells about a point that lies on another cell's edge but for rounding.

use glam::DVec3;
use tetrascope_mesh::{CellId, VertexId};
use tetrascope_view::Viewpoint;

use crate::signs::side_of;
use crate::{Cells, MeshVisibility, OrderMethod};

/// A cell split at point 5 on its edge from 0 to 1, and two whole cells beyond the faces at that edge, to all sides of it.
const POINTS: [[f64; 3]; 6] = [
    [-0.10736082736185695, 0.20071435660043868, 0.9861115873189158],
    [0.30635159132828815, -0.1646565404823438, -0.8687759427291921],
    [-0.5146620833391484, 0.5168051628363314, 0.09178018237459773],
    [0.5989269013062377, 0.4423491843917584, -0.5921570364107146],
    [0.42096157093923475, -0.3695315839720512, -0.8681349222493495],
    [0.2239491942725042, -0.09188270925589295, -0.49932322185420364],
];

const TETRAHEDRA: [[u32; 4]; 4] = [[5, 1, 2, 3], [0, 1, 2, 4], [0, 1, 3, 4], [0, 5, 2, 3]];

#[test]
fn a_hanging_node_inside_the_next_cell_by_a_last_digit() {
    let points = POINTS.map(DVec3::from_array);
    let tetrahedra = TETRAHEDRA.map(|t| t.map(VertexId));
    let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
    // The point lies beyond both faces at the edge: by a last digit in one of the whole cells.
    for (face, within) in [([0, 1, 2], 3), ([0, 1, 3], 2)] {
        let face = face.map(|i: usize| points[i]);
        assert_eq!(side_of(face, points[5]), -side_of(face, points[within]));
    }
    let visibility = MeshVisibility::new();
    assert!(!visibility.is_convex(cells) && !visibility.overlaps(cells).any());
    let order = visibility.prepare(cells, OrderMethod::BspXmpvo);
    let drawn = [0, 1, 2, 3].map(CellId);
    let mut both = [0, 0];
    for step in 0..400 {
        let angle = f64::from(step) * 2.4;
        let height = f64::from(step) / 200.0 - 0.9975;
        let eye = DVec3::new(angle.cos(), angle.sin(), 0.0) * (1.0 - height * height).sqrt() + DVec3::Z * height;
        for viewpoint in [Viewpoint::Eye(eye * 4.0), Viewpoint::Direction(-eye)] {
            let order = order.order(cells, viewpoint, &drawn);
            assert!(order.cycles.is_empty());
            let place = |cell: u32| order.front_to_back.iter().position(|c| c.0 == cell);
            // The halves, which have point 3 or 2, against the whole cells beyond the faces with the other one.
            for (whole, face, within) in [(1, [0, 1, 2], 3), (2, [0, 1, 3], 2)] {
                let face = face.map(|i: usize| points[i]);
                let eye = crate::signs::eye_side(face, viewpoint);
                let is_half_in_front = eye == side_of(face, points[within]);
                both[usize::from(is_half_in_front)] += 1;
                for half in [0, 3] {
                    assert_eq!(place(half) < place(whole), is_half_in_front, "{viewpoint:?}: {half} and {whole}");
                }
            }
        }
    }
    assert!(both.iter().all(|&count| count > 100), "{both:?}");
}
