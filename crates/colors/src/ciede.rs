//! Shortest paths between colors by the color difference CIEDE2000.
//!
//! sRGB is sampled on a grid, neighbors are joined (across edges and corners as well), and a path is a shortest one of that graph. ParaView
//! has the same grid and so the same paths; like it, this takes the colors at the ends from the grid too, up to 8 gray levels off.

use core::cmp::Reverse;
use core::f64::consts::PI;
use std::collections::BinaryHeap;
use std::sync::OnceLock;

use crate::convert::lab;

/// Samples a channel.
const SIDE: usize = 17;
/// Points that a map in this space may have: a path takes about a millisecond.
pub(crate) const MAX_PATHS: usize = 256;

const NODES: usize = SIDE * SIDE * SIDE;

/// 25 to the seventh power, where the differences in chroma of the standard's data change their behavior.
const CHROMA_SCALE: f64 = 6_103_515_625.0;

/// A color on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    /// Its length up to here over that of the whole path.
    pub(crate) share: f64,
    pub(crate) rgb: [f64; 3],
}

/// The path from one sRGB color (0 to 1 each) to another, both moved to the nearest node: two steps at least, the first with share 0, the
/// last with share 1, ascending.
pub(crate) fn path(from: [f64; 3], to: [f64; 3]) -> Vec<Step> {
    let mut nodes = nodes_between(nearest(from), nearest(to));
    if nodes.len() < 2 {
        nodes = vec![nearest(to); 2];
    }
    let mut length = 0.0;
    let mut steps: Vec<Step> = Vec::with_capacity(nodes.len());
    for rgb in nodes.into_iter().map(node_color) {
        if let Some(last) = steps.last() {
            length += difference(lab(last.rgb), lab(rgb));
        }
        steps.push(Step { share: length, rgb });
    }
    for step in &mut steps {
        step.share = if length > 0.0 { step.share / length } else { 0.0 };
    }
    if let Some(last) = steps.last_mut() {
        last.share = 1.0;
    }
    steps
}

/// Dijkstra's algorithm from the far end, so that following the nearest neighbors from `start` gives the path in its order. It ends as
/// soon as the start is reached: for colors close to each other that is soon.
fn nodes_between(start: usize, end: usize) -> Vec<usize> {
    let mut lengths = vec![f64::INFINITY; NODES];
    let mut next = vec![end; NODES];
    let mut front = BinaryHeap::new();
    lengths[end] = 0.0;
    // The bits of a float that is not negative order as the float does.
    front.push(Reverse((0_u64, cell(end))));
    while let Some(Reverse((bits, position))) = front.pop() {
        let (node, length) = (index(position), f64::from_bits(bits));
        if node == start {
            break;
        }
        if length > lengths[node] {
            continue;
        }
        for neighbor in neighbors(position) {
            let other = index(neighbor);
            let longer = length + difference(grid()[node], grid()[other]);
            if longer < lengths[other] {
                lengths[other] = longer;
                next[other] = node;
                front.push(Reverse((longer.to_bits(), neighbor)));
            }
        }
    }
    let mut nodes = vec![start];
    let mut node = start;
    while node != end {
        node = next[node];
        nodes.push(node);
    }
    nodes
}

/// Lab of all nodes.
fn grid() -> &'static [[f64; 3]] {
    static GRID: OnceLock<Vec<[f64; 3]>> = OnceLock::new();
    GRID.get_or_init(|| (0..NODES).map(|node| lab(node_color(node))).collect())
}

fn index([r, g, b]: [usize; 3]) -> usize {
    r + SIDE * (g + SIDE * b)
}

fn cell(node: usize) -> [usize; 3] {
    [node % SIDE, node / SIDE % SIDE, node / (SIDE * SIDE)]
}

#[expect(clippy::cast_precision_loss, reason = "below 17")]
fn node_color(node: usize) -> [f64; 3] {
    cell(node).map(|step| step as f64 / (SIDE - 1) as f64)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "channels are within 0 to 1, and what is not becomes an end"
)]
fn nearest(rgb: [f64; 3]) -> usize {
    index(rgb.map(|channel| ((channel * (SIDE - 1) as f64 + 0.5) as usize).min(SIDE - 1)))
}

/// All up to 26 around a node.
fn neighbors(position: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let around = position.map(|step| step.saturating_sub(1)..=(step + 1).min(SIDE - 1));
    let [r, g, b] = around;
    b.flat_map(move |b| {
        let r = r.clone();
        g.clone().flat_map(move |g| r.clone().map(move |r| [r, g, b]))
    })
    .filter(move |&neighbor| neighbor != position)
}

/// How different two Lab colors look. Source: [Sharma 2005], eqs. (2) to (22), all weights 1.
pub(crate) fn difference(first: [f64; 3], second: [f64; 3]) -> f64 {
    let chroma_of = |lab: [f64; 3]| lab[1].hypot(lab[2]);
    let bend = |chroma: f64| {
        let seventh = chroma.powi(7);
        (seventh / (seventh + CHROMA_SCALE)).sqrt()
    };
    let stretch = 1.0 + 0.5 * (1.0 - bend(0.5 * (chroma_of(first) + chroma_of(second))));
    // Lightness, chroma and hue (0 to a full turn) after the stretch of the axis between green and red.
    let polar = |[l, a, b]: [f64; 3]| {
        let a = stretch * a;
        let hue = if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a) };
        [l, a.hypot(b), if hue < 0.0 { hue + 2.0 * PI } else { hue }]
    };
    let ([l1, c1, h1], [l2, c2, h2]) = (polar(first), polar(second));
    let has_hue = c1 * c2 != 0.0;
    let turn = match h2 - h1 {
        _ if !has_hue => 0.0,
        turn if turn < -PI => turn + 2.0 * PI,
        turn if turn > PI => turn - 2.0 * PI,
        turn => turn,
    };
    let middle_hue = match h1 + h2 {
        sum if !has_hue => sum,
        sum if (h1 - h2).abs() <= PI => 0.5 * sum,
        sum if sum < 2.0 * PI => 0.5 * sum + PI,
        sum => 0.5 * sum - PI,
    };
    let (middle_lightness, middle_chroma) = (0.5 * (l1 + l2) - 50.0, 0.5 * (c1 + c2));

    let degrees = PI / 180.0;
    let weight = 1.0 - 0.17 * (middle_hue - 30.0 * degrees).cos()
        + 0.24 * (2.0 * middle_hue).cos()
        + 0.32 * (3.0 * middle_hue + 6.0 * degrees).cos()
        - 0.20 * (4.0 * middle_hue - 63.0 * degrees).cos();
    let lightness_scale = 1.0 + 0.015 * middle_lightness.powi(2) / (20.0 + middle_lightness.powi(2)).sqrt();
    let chroma_scale = 1.0 + 0.045 * middle_chroma;
    let hue_scale = 1.0 + 0.015 * middle_chroma * weight;
    // Chroma and hue depend on each other among blues.
    let blue = (-((middle_hue - 275.0 * degrees) / (25.0 * degrees)).powi(2)).exp();
    let joint = -(60.0 * degrees * blue).sin() * 2.0 * bend(middle_chroma);

    let lightness = (l2 - l1) / lightness_scale;
    let chroma = (c2 - c1) / chroma_scale;
    let hue = 2.0 * (c1 * c2).sqrt() * (0.5 * turn).sin() / hue_scale;
    (lightness.powi(2) + chroma.powi(2) + hue.powi(2) + joint * chroma * hue).max(0.0).sqrt()
}
