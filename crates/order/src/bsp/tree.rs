//! Building the tree, and walking it from the eye.

use std::ops::Range;

use rayon::prelude::*;

use super::split::{Face, Fragment, Place, Plane};

/// Fragments per boundary face, beyond which nothing is split any more.
pub(super) const FRAGMENTS_PER_FACE: usize = 8;

/// Planes above one another. Halving needs 30 of them for 10⁹ faces; the rest is for lists that no plane halves.
const DEEPEST: u32 = 200;

/// Faces whose planes are tried at a node, and fragments that a plane is tried on. More make the tree little better.
const CANDIDATES: usize = 4;
const SAMPLE: usize = 32;

/// Fragments from which planes across the axes are tried too. A few faces are better ordered by their own planes.
const AXES_FROM: usize = 12;

/// What a split is worth in comparisons of a fragment with a plane. A guess; 1 to 8 make no great difference.
const SPLIT_COST: f64 = 3.0;

/// Fragments from which the two sides of a plane are built in parallel.
const PARALLEL_FROM: usize = 1 << 10;

/// No node.
const NONE: u32 = u32::MAX;

/// A plane with what lies on it, and what is on its two sides; or, without a plane, fragments in no order.
#[derive(Clone, Debug)]
struct Node {
    plane: Option<Plane>,
    fragments: Range<u32>,
    positive: u32,
    negative: u32,
}

/// The tree with its nodes in one list.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// The face of every fragment.
    fragments: Vec<u32>,
    pub(super) depth: u32,
    /// Faces that share a leaf with others and have no order there.
    pub(super) unordered: Vec<u32>,
}

/// A tree while it is built.
enum Growing {
    Empty,
    Leaf(Vec<u32>),
    Branch(Box<Branch>),
}

struct Branch {
    plane: Plane,
    on: Vec<u32>,
    sides: [Growing; 2],
}

impl Tree {
    pub(super) fn new(faces: &[Face]) -> Self {
        let whole = (0..faces.len() as u32).map(|face| Fragment { face, corners: Vec::new() }).collect();
        let budget = (FRAGMENTS_PER_FACE - 1) * faces.len();
        let growing = grow(faces, whole, budget, 0);
        let mut tree = Self { nodes: Vec::new(), fragments: Vec::new(), depth: 0, unordered: Vec::new() };
        tree.flatten(growing, 1);
        tree
    }

    /// Bytes that it keeps.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.fragments.as_slice())
    }

    /// Number of fragments.
    pub(super) fn fragments(&self) -> usize {
        self.fragments.len()
    }

    /// For every face, whether it has one fragment only, and that has an order.
    pub(super) fn whole_faces(&self, faces: usize) -> Vec<bool> {
        let mut counts = vec![0_u32; faces];
        for &face in self.fragments.iter().chain(&self.unordered) {
            counts[face as usize] += 1;
        }
        counts.into_iter().map(|count| count == 1).collect()
    }

    fn flatten(&mut self, growing: Growing, depth: u32) -> u32 {
        let index = self.nodes.len() as u32;
        let start = self.fragments.len() as u32;
        let (plane, sides) = match growing {
            Growing::Empty => return NONE,
            Growing::Leaf(faces) => {
                if faces.len() > 1 {
                    self.unordered.extend(&faces);
                }
                self.fragments.extend(faces);
                (None, None)
            }
            Growing::Branch(branch) => {
                self.fragments.extend(branch.on);
                (Some(branch.plane), Some(branch.sides))
            }
        };
        self.depth = self.depth.max(depth);
        self.nodes.push(Node { plane, fragments: start..self.fragments.len() as u32, positive: NONE, negative: NONE });
        if let Some([positive, negative]) = sides {
            let positive = self.flatten(positive, depth + 1);
            let negative = self.flatten(negative, depth + 1);
            let node = &mut self.nodes[index as usize];
            (node.positive, node.negative) = (positive, negative);
        }
        index
    }

    /// Goes through all nodes that have fragments, the near side of each plane before the plane, and that before the
    /// far side. `visit` gets the faces of a node's fragments and whether they lie in one plane.
    ///
    /// - `eye_side`: the side of a plane that the eye is on
    pub(super) fn walk(&self, eye_side: impl Fn(Plane) -> i8, mut visit: impl FnMut(&[u32], bool)) {
        /// A node whose near side was seen to.
        const READY: u32 = 1 << 31;
        let mut stack = Vec::with_capacity(2 * self.depth as usize + 1);
        if !self.nodes.is_empty() {
            stack.push(0);
        }
        while let Some(entry) = stack.pop() {
            let node = &self.nodes[(entry & !READY) as usize];
            let Range { start, end } = node.fragments;
            let fragments = &self.fragments[start as usize..end as usize];
            match node.plane {
                Some(plane) if entry & READY == 0 => {
                    // Seen edge-on no side hides the other.
                    let (near, far) = match eye_side(plane) {
                        0.. => (node.positive, node.negative),
                        _ => (node.negative, node.positive),
                    };
                    if far != NONE {
                        stack.push(far);
                    }
                    if !fragments.is_empty() {
                        stack.push(entry | READY);
                    }
                    if near != NONE {
                        stack.push(near);
                    }
                }
                plane => visit(fragments, plane.is_some()),
            }
        }
    }
}

/// A tree over fragments, with at most `budget` of them more.
fn grow(faces: &[Face], fragments: Vec<Fragment>, budget: usize, depth: u32) -> Growing {
    let leaf = |fragments: Vec<Fragment>| Growing::Leaf(fragments.into_iter().map(|f| f.face).collect());
    match fragments.len() {
        0 => return Growing::Empty,
        1 => return leaf(fragments),
        _ if depth == DEEPEST => return leaf(fragments),
        _ => {}
    }
    let Some((plane, places)) = choose(faces, &fragments) else { return leaf(fragments) };
    let splits = places.iter().filter(|place| matches!(place, Place::Across)).count();
    if splits > budget {
        return leaf(fragments);
    }
    let mut on = Vec::new();
    let mut sides = [Vec::new(), Vec::new()];
    for (fragment, place) in fragments.into_iter().zip(places) {
        match place {
            Place::On => on.push(fragment.face),
            Place::Positive => sides[0].push(fragment),
            Place::Negative => sides[1].push(fragment),
            Place::Across => {
                for (side, part) in sides.iter_mut().zip(plane.split(faces, &fragment)) {
                    side.push(part);
                }
            }
        }
    }
    let [positive, negative] = sides;
    let total = positive.len() + negative.len();
    // Shares in proportion: what one side does not need the other does not get, so that the tree is the same in any
    // order of work.
    let share = (budget - splits) * positive.len() / total.max(1);
    let budgets = [share, budget - splits - share];
    let depth = depth + 1;
    let sides = if total >= PARALLEL_FROM {
        let both =
            rayon::join(|| grow(faces, positive, budgets[0], depth), || grow(faces, negative, budgets[1], depth));
        [both.0, both.1]
    } else {
        [grow(faces, positive, budgets[0], depth), grow(faces, negative, budgets[1], depth)]
    };
    Growing::Branch(Box::new(Branch { plane, on, sides }))
}

/// The best plane of a few, and where it puts every fragment. A plane of a face takes that face out at least.
fn choose(faces: &[Face], fragments: &[Fragment]) -> Option<(Plane, Vec<Place>)> {
    let evenly = |count: usize| {
        let count = count.min(fragments.len());
        (0..count).map(move |i| &fragments[i * fragments.len() / count])
    };
    let sample: Vec<&Fragment> = evenly(SAMPLE).collect();
    let mut tried: Vec<(f64, Plane)> = Vec::with_capacity(CANDIDATES + 3);
    tried.extend(evenly(CANDIDATES).map(|fragment| (0.0, Plane::Face(fragment.face))));
    if fragments.len() >= AXES_FROM {
        for axis in 0..3 {
            let mut values: Vec<f64> =
                sample.iter().flat_map(|f| faces[f.face as usize].points).map(|p| p[axis]).collect();
            let middle = values.len() / 2;
            let (_, &mut at, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
            tried.push((0.0, Plane::Axis { axis, at }));
        }
    }
    let scale = fragments.len() as f64 / sample.len() as f64;
    for (cost, plane) in &mut tried {
        let (mut positive, mut negative, mut across) = (0.0, 0.0, 0.0);
        for fragment in &sample {
            match plane.place(faces, fragment) {
                Place::On => {}
                Place::Positive => positive += scale,
                Place::Negative => negative += scale,
                Place::Across => across += scale,
            }
        }
        let work = |count: f64| count * (count + 1.0).log2();
        *cost = work(positive + across) + work(negative + across) + SPLIT_COST * across;
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    tried.into_iter().find_map(|(_, plane)| {
        let place = |fragment| plane.place(faces, fragment);
        let places: Vec<Place> = if fragments.len() >= PARALLEL_FROM {
            fragments.par_iter().map(place).collect()
        } else {
            fragments.iter().map(place).collect()
        };
        let count = |wanted: fn(&Place) -> bool| places.iter().filter(|place| wanted(place)).count();
        let (positive, negative) = (count(|p| matches!(p, Place::Positive)), count(|p| matches!(p, Place::Negative)));
        let across = count(|p| matches!(p, Place::Across));
        (positive.max(negative) + across < fragments.len()).then_some((plane, places))
    })
}
