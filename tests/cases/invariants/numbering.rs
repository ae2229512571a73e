//! The order of a cell's vertices, of points and of cells in the file is nobody's business.

use tetrascope::{Integration, Plan, View};
use tetrascope_tests::meshes::{Random, Tets};
use tetrascope_tests::pictures::{Renderer, SMALL_TABLES, Worst, largest, mean_opacity, plan, random_camera};

use super::refinement::order_free;

const EXTINCTION: &[[f64; 2]] = &[[-1.0, 0.0], [-0.2, 3.0], [0.1, 0.2], [1.0, 2.0]];
const COLOR: &[[f64; 4]] = &[[-1.0, 0.9, 0.1, 0.2], [0.0, 0.1, 0.8, 0.3], [1.2, 1.0, 0.9, 0.1]];

/// A permutation of `0..n`, as likely as any other.
fn shuffled(n: usize, random: &mut Random) -> Vec<u32> {
    let mut order: Vec<u32> = (0..n as u32).collect();
    for end in (1..n).rev() {
        order.swap(end, (random.unit() * (end + 1) as f64) as usize);
    }
    order
}

/// To the bit: cells are put into the order of their points' numbers before anything is computed.
#[test]
fn order_of_vertices_in_a_cell_changes_no_bit() {
    for seed in 0..6 {
        let tets = Tets::block(3, seed + 700);
        let mut random = Random::new(seed);
        let mut permuted = tets.clone();
        for cell in &mut permuted.cells {
            let order = shuffled(4, &mut random);
            *cell = std::array::from_fn(|i| cell[order[i] as usize]);
        }
        assert_ne!(tets.cells, permuted.cells);
        let (a, b) = (tets.mesh(), permuted.mesh());
        for is_perspective in [false, true] {
            let view = View::new(&random_camera(&mut random, glam::DVec3::ZERO, 1.0, is_perspective), 45, 40).unwrap();
            for renderer in Renderer::ALL.into_iter().chain(Renderer::BETWEEN) {
                let plan = Plan { tables: SMALL_TABLES, ..plan(view, COLOR, EXTINCTION) };
                let (one, other) = (renderer.draw(&a, &tets.scalars, &plan), renderer.draw(&b, &tets.scalars, &plan));
                assert!(mean_opacity(&one) > 0.1);
                assert_eq!(one, other, "seed {seed}, {renderer:?}");
            }
        }
    }
}

/// Tolerance 1e-5: sums run in another order, and so do cells at one depth, where that cannot be seen.
#[test]
fn order_of_points_and_cells_changes_nothing() {
    let mut worst = Worst::new("renumbering", 1e-5);
    for seed in 0..5 {
        let tets = Tets::block(3, seed + 800);
        let mut random = Random::new(seed);
        let (to, cell_order) = (shuffled(tets.points.len(), &mut random), shuffled(tets.cells.len(), &mut random));
        let mut other = tets.clone();
        for (from, &to) in to.iter().enumerate() {
            other.points[to as usize] = tets.points[from];
            other.scalars[to as usize] = tets.scalars[from];
        }
        other.cells = cell_order.iter().map(|&c| tets.cells[c as usize].map(|v| to[v as usize])).collect();
        let (a, b) = (tets.mesh(), other.mesh());
        for is_perspective in [false, true] {
            let view = View::new(&random_camera(&mut random, glam::DVec3::ZERO, 1.0, is_perspective), 40, 40).unwrap();
            for (plan, mut renderers) in order_free(view) {
                let plan = Plan { tables: SMALL_TABLES, ..plan };
                if renderers.len() == 2 {
                    renderers.extend([Renderer::Fast(Integration::Average), Renderer::Reference(Integration::Average)]);
                    renderers.extend(Renderer::BETWEEN);
                    renderers.retain(|renderer| renderer.integration().covers(plan.model));
                }
                for renderer in renderers {
                    let one = renderer.draw(&a, &tets.scalars, &plan);
                    let two = renderer.draw(&b, &other.scalars, &plan);
                    worst.note(largest(&one, &two, 0..4), || {
                        format!("seed {seed}, {renderer:?}, {}, perspective {is_perspective}", plan.model)
                    });
                }
            }
        }
    }
    worst.finish();
}
