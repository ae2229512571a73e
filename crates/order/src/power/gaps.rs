//! Whether heights order a mesh across its gaps too.
//!
//! Let a ray leave cell `a` at `x`, through a boundary face, and enter cell `b` later at `y`, through another. Let the function
//! of no cell at the boundary reach the height of any point of the boundary but those of its own corners. At `x` the function
//! `H_a` is a mean of heights of points of the boundary, and so at least `H_b(x)`; at `y` it is the other way round. So
//! `H_a - H_b`, affine along the ray, falls from `x` to `y` and is positive at the eye, which lies before both: the keys are in the
//! right order. Zero it would be only if all corners of the face that `a` is left through were corners of `b`; then the two cells
//! share that face.
//!
//! A Delaunay mesh, some of whose cells are left out, has it; so has every mesh whose heights lift it to a part of one convex
//! surface. It is more than necessary. The idea is ours.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;
use robust::orient3d;
use tetrascope_mesh::{CellFace, CellId, FaceAdjacency, VertexId};

use super::certify::{coord, is_convex};
use super::keys::CellKey;
use crate::Cells;

/// Points that are compared one by one.
const LEAF: usize = 8;

/// Share of the numbers that are summed below which a bound is not believed: far more than their rounding.
const DOUBT: f64 = 1e-12;

/// Points of the boundary in a box: their heights are at least `lowest + slope · (p - center)`.
struct Node {
    center: DVec3,
    half: DVec3,
    slope: DVec3,
    lowest: f64,
    /// The largest of the numbers that `lowest` was summed from.
    magnitude: f64,
    points: Range<u32>,
    /// The second child, of which the first follows this node; 0 for a leaf.
    second: u32,
}

/// A point of the boundary, and the slope of a cell there.
#[derive(Clone, Copy)]
struct Point {
    position: DVec3,
    height: f64,
    slope: DVec3,
    vertex: VertexId,
}

/// Cells at the boundary whose function is not proven to stay below all points of the boundary but its own corners. Cells at faces
/// of three or more cells count.
///
/// - `keys`: of all cells; their functions are taken to be precise
/// - `center`: what the keys are relative to
/// - `reach`: half the sum of the sides of the box around the points
pub(super) fn unproven(
    cells: Cells<'_>,
    adjacency: &FaceAdjacency,
    heights: &[f64],
    keys: &[CellKey],
    center: DVec3,
    reach: f64,
) -> usize {
    let manifold = adjacency.boundary_faces();
    let mut points: Vec<Point> = manifold
        .iter()
        .flat_map(|&CellFace { cell, corner }| {
            let own = cells.tetrahedra[cell.index()];
            (0..4).filter(move |&i| i != usize::from(corner)).map(move |i| (own[i], cell))
        })
        .map(|(vertex, cell)| Point {
            position: cells.positions[vertex.index()],
            height: heights[vertex.index()],
            slope: keys[cell.index()].gradient(),
            vertex,
        })
        .collect();
    points.sort_by_key(|point| point.vertex);
    points.dedup_by_key(|point| point.vertex);
    let mut nodes = Vec::new();
    if !points.is_empty() {
        grow(&mut points, 0, &mut nodes);
    }
    let mut at_boundary: Vec<CellId> = manifold.iter().map(|face| face.cell).collect();
    at_boundary.dedup();
    let mut undecided: Vec<CellId> = at_boundary
        .into_par_iter()
        .filter(|&cell| !is_below(cells, heights, cell, &Tree { nodes: &nodes, points: &points, center, reach }, keys))
        .collect();
    // Cells that meet in one face with a third are told apart by nothing here.
    undecided.extend(adjacency.non_manifold_faces().iter().flatten().map(|face| face.cell));
    undecided.sort_unstable();
    undecided.dedup();
    undecided.len()
}

struct Tree<'a> {
    nodes: &'a [Node],
    points: &'a [Point],
    center: DVec3,
    reach: f64,
}

/// Whether a cell's function is proven to stay below the heights of all points but its corners.
fn is_below(cells: Cells<'_>, heights: &[f64], cell: CellId, tree: &Tree<'_>, keys: &[CellKey]) -> bool {
    let (key, corners) = (&keys[cell.index()], cells.tetrahedra[cell.index()]);
    let gradient = key.gradient();
    let positions = corners.map(|v| cells.positions[v.index()]);
    let [a, b, c, d] = positions.map(coord);
    let is_far_below = orient3d(a, b, c, d) < 0.0;
    let mut stack = vec![0_u32];
    while let Some(index) = stack.pop() {
        let Some(node) = tree.nodes.get(index as usize) else { break };
        let at_center = key.at(tetrascope_view::Viewpoint::Eye(node.center), tree.center, tree.reach);
        // The key is the function, negated.
        let lowest = node.lowest + at_center.value - (node.slope - gradient).abs().dot(node.half);
        let magnitude = node.magnitude + at_center.value.abs() + gradient.abs().dot(node.half);
        if lowest > DOUBT * magnitude + 2.0 * at_center.error {
            continue;
        }
        if node.second != 0 {
            stack.extend([node.second, index + 1]);
            continue;
        }
        for point in &tree.points[node.points.start as usize..node.points.end as usize] {
            let here = key.at(tetrascope_view::Viewpoint::Eye(point.position), tree.center, tree.reach);
            if point.height + here.value > 2.0 * here.error + f64::EPSILON * point.height.abs()
                || corners.contains(&point.vertex)
            {
                continue;
            }
            let [a, b, c, d] = positions;
            let [p, q, r, s] = corners.map(|v| heights[v.index()]);
            if !is_convex([a, b, c, d, point.position], [p, q, r, s, point.height], is_far_below) {
                return false;
            }
        }
    }
    true
}

/// Halves points along their longest side until few are left.
fn grow(points: &mut [Point], first: u32, nodes: &mut Vec<Node>) {
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) =
        points.iter().fold(empty, |(low, high), point| (low.min(point.position), high.max(point.position)));
    let (center, half) = ((low + high) * 0.5, (high - low) * 0.5);
    let slope = points.iter().map(|point| point.slope).sum::<DVec3>() / points.len() as f64;
    let above = |point: &Point| point.height - slope.dot(point.position - center);
    let tallest = points.iter().map(|point| point.height.abs()).fold(0.0, f64::max);
    let index = nodes.len();
    nodes.push(Node {
        center,
        half,
        slope,
        lowest: points.iter().map(above).fold(f64::INFINITY, f64::min),
        magnitude: tallest + slope.abs().dot(half),
        points: first..first + points.len() as u32,
        second: 0,
    });
    if points.len() > LEAF {
        let axis = half.to_array().iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(axis, _)| axis);
        let middle = points.len() / 2;
        points.select_nth_unstable_by(middle, |a, b| {
            a.position[axis].total_cmp(&b.position[axis]).then(a.vertex.cmp(&b.vertex))
        });
        let (left, right) = points.split_at_mut(middle);
        grow(left, first, nodes);
        nodes[index].second = nodes.len() as u32;
        grow(right, first + middle as u32, nodes);
    }
}
