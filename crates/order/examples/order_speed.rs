//! What orders cost: milliseconds a view and nanoseconds a tetrahedron, side by side on meshes of growing size.
//!
//! `cargo run --release -p tetrascope-order --example order_speed [LARGEST [ROUNDS]]`
//!
//! - `LARGEST`: tetrahedra of the largest mesh, 1,000,000 by default
//! - `ROUNDS`: views a mesh, 9 by default; every method draws the same, in turn, and medians are printed
//!
//! Meshes are cubes of n³ hexahedra cut into five tetrahedra each: `even` on a grid (convex), `bent` twisted and bulging,
//! `jitter` with inner points moved by up to 0.15 of a cell (convex), and `shuffled`, the even one with its cells in random order.

#![expect(clippy::print_stdout, reason = "an example that prints a table")]

use std::time::Instant;

use glam::DVec3;
use tetrascope_mesh::{CellId, TetMesh, VertexId, decompose, rings_sample};
use tetrascope_order::{Cells, MeshVisibility, Mpvo, OrderMethod, VisibilityOrder};
use tetrascope_view::Viewpoint;

/// A mesh, by its parts.
struct Grid {
    name: &'static str,
    points: Vec<DVec3>,
    tetrahedra: Vec<[VertexId; 4]>,
}

impl Grid {
    fn cells(&self) -> Cells<'_> {
        Cells { positions: &self.points, tetrahedra: &self.tetrahedra }
    }
}

/// Three numbers from -1 to 1, from a state that moves on.
fn noise(state: &mut u64) -> DVec3 {
    let mut number = || {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    DVec3::new(number(), number(), number())
}

fn grids(side: usize) -> Option<Vec<Grid>> {
    let mut dataset = rings_sample(side);
    let of = |mesh: TetMesh| (mesh.positions().to_vec(), mesh.tetrahedra().to_vec());
    let (points, tetrahedra) = of(decompose(&dataset).ok()?.mesh);
    let bent = Grid { name: "bent", points, tetrahedra };
    let at = |n: usize| 2.0 * n as f64 / side as f64 - 1.0;
    let places = |index: usize| [index % (side + 1), index / (side + 1) % (side + 1), index / (side + 1) / (side + 1)];
    for (index, point) in dataset.points.iter_mut().enumerate() {
        *point = DVec3::from(places(index).map(at));
    }
    let (points, tetrahedra) = of(decompose(&dataset).ok()?.mesh);
    let mut state = 1;
    let mut shuffled = tetrahedra.clone();
    for last in (1..shuffled.len()).rev() {
        shuffled.swap(last, ((noise(&mut state).x + 1.0) * 0.5 * last as f64) as usize);
    }
    let even = Grid { name: "even", points: points.clone(), tetrahedra };
    let shuffled = Grid { name: "shuffled", points, tetrahedra: shuffled };
    for (index, point) in dataset.points.iter_mut().enumerate() {
        let is_inner = places(index).iter().all(|&n| n > 0 && n < side);
        *point += if is_inner { noise(&mut state) * 0.3 / side as f64 } else { DVec3::ZERO };
    }
    let (points, tetrahedra) = of(decompose(&dataset).ok()?.mesh);
    Some(vec![even, bent, Grid { name: "jitter", points, tetrahedra }, shuffled])
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Degrees from view to view.
const TURNS: [f64; 4] = [0.02, 0.1, 0.5, 3.0];

/// What an order costs that may begin with the one of the view before, relative to one that may not.
fn turn(cells: Cells<'_>, drawn: &[CellId], degrees: f64, rounds: usize) -> f64 {
    let [going, new] = [(), ()].map(|()| Mpvo::new(cells));
    let eye = |angle: f64| Viewpoint::Eye(DVec3::new(angle.cos() * 3.1, angle.sin() * 3.1, 1.7));
    let seconds = |mpvo: &Mpvo, angle: f64| {
        let start = Instant::now();
        std::hint::black_box(mpvo.order(cells, eye(angle), drawn));
        start.elapsed().as_secs_f64()
    };
    let (mut going_times, mut new_times) = (Vec::new(), Vec::new());
    for round in 0..rounds {
        let angle = 0.3 + round as f64 * degrees.to_radians();
        // The other one comes from the far side.
        new.order(cells, eye(angle + 3.0), drawn);
        new_times.push(seconds(&new, angle));
        going.order(cells, eye(angle - degrees.to_radians()), drawn);
        going_times.push(seconds(&going, angle));
    }
    median(going_times) / median(new_times)
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let largest: f64 = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(1e6);
    let rounds: usize = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(9);
    let methods = [OrderMethod::Centroid, OrderMethod::Power, OrderMethod::Mpvo, OrderMethod::BspXmpvo];
    println!("{:>9} {:>9}  {:>10} {:>9} {:>7}", "cells", "mesh", "order", "ms", "ns/cell");
    for size in [1e4, 1e5, 1e6, 5e6_f64].into_iter().filter(|&size| size <= largest) {
        for grid in grids((size / 5.0).cbrt().round() as usize).into_iter().flatten() {
            let cells = grid.cells();
            let count = cells.tetrahedra.len();
            let drawn: Vec<CellId> = (0..count as u32).map(CellId).collect();
            let visibility = MeshVisibility::new();
            let orders: Vec<_> = methods
                .iter()
                .filter(|&&method| method != OrderMethod::Power || visibility.quick_certificate(cells).is_exact())
                .map(|&method| (method, visibility.prepare(cells, method)))
                .collect();
            let mut state = 7;
            let mut times = vec![Vec::new(); orders.len()];
            for round in 0..rounds.max(1) {
                let place = noise(&mut state);
                let view = match round % 3 {
                    0 => Viewpoint::Direction(place.normalize()),
                    1 => Viewpoint::Eye(place.normalize() * 4.0),
                    _ => Viewpoint::Eye(place),
                };
                for (times, (_, order)) in times.iter_mut().zip(&orders) {
                    let start = Instant::now();
                    let order: &dyn VisibilityOrder = order.as_ref();
                    std::hint::black_box(order.order(cells, view, &drawn));
                    times.push(start.elapsed().as_secs_f64());
                }
            }
            for (times, (method, _)) in times.into_iter().zip(&orders) {
                let seconds = median(times);
                let (ms, ns) = (seconds * 1e3, seconds * 1e9 / count as f64);
                println!("{count:>9} {:>9}  {:>10} {ms:>9.3} {ns:>7.1}", grid.name, method.to_string());
            }
            for degrees in TURNS {
                let turned = turn(cells, &drawn, degrees, rounds.max(2));
                println!("{count:>9} {:>9}  mpvo, a turn of {degrees} degrees: {turned:.2} of a new order", grid.name);
            }
        }
    }
}
