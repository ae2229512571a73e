//! Real meshes: a hundred views each, judged by rays, by exact planes and by the boundary's tree.

use std::path::Path;

use tetrascope::mesh::CellId;
use tetrascope::order::{Cells, Guarantee, MeshVisibility, OrderMethod};
use tetrascope::{ReadOptions, Volume};
use tetrascope_tests::meshes::Random;
use tetrascope_tests::shared;

use super::rays::{Found, judge_by_rays};
use super::views::hundred;

struct Case {
    mesh: &'static str,
    power: Power,
    /// Whether cells overlap; then they hide one another from everywhere, as rings do.
    overlaps: bool,
}

/// How far heights of points sort a mesh by one key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Power {
    No,
    Faces,
    Everything,
}

/// Convex and not, structured and not.
const CASES: &[Case] = &[
    Case { mesh: "vtk/delaunay_unitcube_binary_v4.2.vtk", power: Power::Everything, overlaps: false },
    Case { mesh: "plot3d/bluntfinxyz.bin", power: Power::Faces, overlaps: false },
    Case { mesh: "plot3d/combxyz.bin", power: Power::No, overlaps: true },
    Case { mesh: "plot3d/postxyz.bin", power: Power::Faces, overlaps: false },
    Case { mesh: "vtu/gmsh_block_98k.vtu", power: Power::Everything, overlaps: false },
    Case { mesh: "vtu/fire_ug.vtu", power: Power::Everything, overlaps: false },
    Case { mesh: "vtu/can.vtu", power: Power::No, overlaps: true },
];

/// Rays from each view.
const RAYS: usize = 2;

fn load(data: &Path, mesh: &str) -> Volume {
    let solution = mesh.strip_suffix("xyz.bin").map(|name| data.join(format!("{name}q.bin")));
    Volume::load(&data.join(mesh), &ReadOptions::with_solution(solution.as_deref())).unwrap()
}

/// Zero pairs out of order but within rings. Rays judge nobody where cells overlap: the order of what they meet is no fact there.
#[test]
fn real_meshes_come_in_order_from_a_hundred_views() {
    let Some(folder) = shared::folder("orders of real meshes") else { return };
    for case in CASES {
        let volume = load(&folder.join("data"), case.mesh);
        check(case, Cells::from(&volume.decomposition.mesh));
    }
}

fn check(case: &Case, cells: Cells<'_>) {
    let drawn: Vec<CellId> = (0..cells.tetrahedra.len() as u32).map(CellId).collect();
    let visibility = MeshVisibility::new();
    assert_eq!(visibility.overlaps(cells).any(), case.overlaps, "{}: {:?}", case.mesh, visibility.overlaps(cells));
    let mut methods = vec![OrderMethod::BspXmpvo, OrderMethod::Mpvo];
    if case.power != Power::No {
        methods.push(OrderMethod::Power);
    }
    let orders: Vec<_> = methods.iter().map(|&method| (method, visibility.prepare(cells, method))).collect();
    let is_convex = visibility.is_convex(cells);
    let promise = |method| match method {
        OrderMethod::BspXmpvo if case.overlaps => Guarantee::Overlapping,
        OrderMethod::BspXmpvo => Guarantee::Exact,
        OrderMethod::Power if case.power == Power::Everything => Guarantee::Exact,
        OrderMethod::Mpvo if is_convex => Guarantee::Exact,
        _ => Guarantee::Faces,
    };
    let mut random = Random::new(4);
    let center = cells.tetrahedra.iter().flatten().map(|v| cells.positions[v.index()]).sum::<glam::DVec3>()
        / (4.0 * cells.tetrahedra.len() as f64);
    let size = cells.positions.iter().map(|p| (*p - center).length()).filter(|d| d.is_finite()).fold(0.0, f64::max);
    let views = hundred(&mut random, center, size, |random| {
        let cell = (random.unit() * cells.tetrahedra.len() as f64) as usize;
        cells.tetrahedra[cell].map(|v| cells.positions[v.index()])
    });
    let (mut cyclic, mut pairs, mut gap_pairs, mut along_rays) = (0, 0, 0, 0);
    for (number, &viewpoint) in views.iter().enumerate() {
        let relations = visibility.relations(cells, viewpoint);
        cyclic += relations.rings().iter().map(Vec::len).sum::<usize>();
        for (method, order) in &orders {
            let order = order.order(cells, viewpoint, &drawn);
            let place = || format!("{}, {method}, view {number}, {viewpoint:?}", case.mesh);
            assert_eq!(order.front_to_back.len(), drawn.len(), "{}", place());
            assert_eq!(order.guarantee, promise(*method), "{}", place());
            let verdict = relations.judge(&order.front_to_back);
            assert_eq!(verdict.misordered_faces, 0, "{}: {verdict:?}", place());
            (pairs, gap_pairs) = (pairs + verdict.pairs_of_faces, gap_pairs + verdict.pairs_across_gaps);
            if promise(*method) != Guarantee::Faces {
                assert_eq!(verdict.misordered_gaps, 0, "{}: {verdict:?}", place());
                assert_eq!(order.cycles, relations.rings(), "{}", place());
            }
            if promise(*method) == Guarantee::Exact {
                let found: Found = judge_by_rays(cells, size, viewpoint, &order, RAYS, &mut random);
                assert_eq!(found.wrong, 0, "{}: {found:?}", place());
                along_rays += found.pairs;
            }
        }
    }
    println!(
        "{}: in order are {pairs} pairs across faces, {gap_pairs} across gaps, {along_rays} along rays; {} cells in rings of a view",
        case.mesh,
        cyclic / views.len()
    );
    assert!(case.overlaps || along_rays > 1000, "{}: {along_rays} pairs along rays only", case.mesh);
    assert!(cyclic == 0 || case.overlaps, "{}: rings where nothing overlaps", case.mesh);
}
