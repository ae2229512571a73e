//! Real meshes: a hundred views each, judged by exact planes and by the boundary's tree.

use std::path::Path;

use tetrascope::Volume;
use tetrascope::mesh::CellId;
use tetrascope::order::{Cells, Guarantee, MeshVisibility, OrderMethod};
use tetrascope_tests::meshes::Random;
use tetrascope_tests::shared;

use super::views::hundred;

struct Case {
    mesh: &'static str,
    /// Whether heights of points sort it by one key.
    has_power: bool,
    /// Cells that overlap others, where rays are not told which comes first.
    folds: bool,
}

/// Convex and not, structured and not.
const CASES: &[Case] = &[
    Case { mesh: "vtk/delaunay_unitcube_binary_v4.2.vtk", has_power: true, folds: false },
    Case { mesh: "plot3d/bluntfinxyz.bin", has_power: true, folds: false },
    Case { mesh: "plot3d/combxyz.bin", has_power: false, folds: false },
    Case { mesh: "plot3d/postxyz.bin", has_power: true, folds: false },
    Case { mesh: "vtu/gmsh_block_98k.vtu", has_power: true, folds: false },
    Case { mesh: "vtu/can.vtu", has_power: false, folds: true },
];

fn load(data: &Path, mesh: &str) -> Volume {
    let solution = mesh.strip_suffix("xyz.bin").map(|name| data.join(format!("{name}q.bin")));
    Volume::load(&data.join(mesh), solution.as_deref()).unwrap()
}

/// Zero pairs out of order but within rings, and rings only where the mesh overlaps itself.
#[test]
fn real_meshes_come_in_order_from_a_hundred_views() {
    let Some(folder) = shared::folder("orders of real meshes") else { return };
    for case in CASES {
        let volume = load(&folder.join("data"), case.mesh);
        let mesh = &volume.decomposition.mesh;
        let cells = Cells::from(mesh);
        let drawn: Vec<CellId> = (0..cells.tetrahedra.len() as u32).map(CellId).collect();
        let visibility = MeshVisibility::new();
        let mut methods = vec![OrderMethod::BspXmpvo, OrderMethod::Mpvo];
        if case.has_power {
            methods.push(OrderMethod::Power);
        }
        let orders = methods.iter().map(|&method| (method, visibility.prepare(cells, method))).collect::<Vec<_>>();
        let mut random = Random::new(4);
        let center = cells.tetrahedra.iter().flatten().map(|v| cells.positions[v.index()]).sum::<glam::DVec3>()
            / (4.0 * cells.tetrahedra.len() as f64);
        let size = cells.positions.iter().map(|p| (*p - center).length()).filter(|d| d.is_finite()).fold(0.0, f64::max);
        let views = hundred(&mut random, center, size, |random| {
            let cell = (random.unit() * cells.tetrahedra.len() as f64) as usize;
            cells.tetrahedra[cell].map(|v| cells.positions[v.index()])
        });
        let (mut rings, mut pairs, mut gap_pairs) = (0, 0, 0);
        for (number, &viewpoint) in views.iter().enumerate() {
            let relations = visibility.relations(cells, viewpoint);
            rings += relations.rings().len();
            for (method, order) in &orders {
                let order = order.order(cells, viewpoint, &drawn);
                let place = || format!("{}, {method}, view {number}, {viewpoint:?}", case.mesh);
                assert_eq!(order.front_to_back.len(), drawn.len(), "{}", place());
                if *method == OrderMethod::BspXmpvo {
                    assert_eq!(order.guarantee, Guarantee::Exact, "{}", place());
                    assert_eq!(order.cycles, relations.rings(), "{}", place());
                }
                let verdict = relations.judge(&order.front_to_back);
                assert_eq!(verdict.misordered_faces, 0, "{}: {verdict:?}", place());
                if *method == OrderMethod::BspXmpvo {
                    assert_eq!(verdict.misordered_gaps, 0, "{}: {verdict:?}", place());
                }
                (pairs, gap_pairs) = (pairs + verdict.pairs_of_faces, gap_pairs + verdict.pairs_across_gaps);
            }
        }
        println!("{}: {pairs} pairs across faces and {gap_pairs} across gaps in order, {rings} rings", case.mesh);
        assert_eq!(rings > 0, case.folds, "{}: {rings} rings", case.mesh);
    }
}
