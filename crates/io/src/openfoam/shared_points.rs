//! Points that several processors have, each under one number.
//!
//! Faces between two processors stand in a patch of each, in the same order; the one starts at the same point as the other and goes
//! round the other way. So points are found to be the same without comparing positions, which are only looked at to make sure.

use std::collections::HashMap;

use glam::DVec3;
use tetrascope_mesh::ArrayValues;

use super::part::Part;

/// How far two positions of one point may be apart, relative to the extent of their face: positions in text have six digits.
const APART: f64 = 1e-3;
/// The same relative to their distance from the origin, where digits are lost.
const DIGITS: f64 = 2e-5;

/// For every point of all parts one after the other, its number among those that are kept.
#[derive(Debug)]
pub(super) struct Merger {
    /// Empty where all are kept.
    numbers: Vec<u32>,
    /// Whether each is kept; of points that are the same the first one is.
    kept: Vec<bool>,
}

impl Merger {
    /// Finds the points that parts share.
    pub(super) fn new(parts: &[Part], warnings: &mut Vec<String>) -> Self {
        let identity = Self { numbers: Vec::new(), kept: Vec::new() };
        if parts.iter().all(|part| part.shared.is_empty()) {
            return identity;
        }
        let mut first = 0;
        let firsts: Vec<usize> = parts
            .iter()
            .map(|part| {
                first += part.points.len();
                first - part.points.len()
            })
            .collect();
        let mut sides = HashMap::new();
        for (number, part) in parts.iter().enumerate() {
            for (place, shared) in part.shared.iter().enumerate() {
                sides.entry((part.region, shared.own, shared.other)).or_insert((number, place));
            }
        }

        let mut same: Vec<u32> = (0..first as u32).collect();
        let mut unmatched = 0;
        for (number, part) in parts.iter().enumerate() {
            for shared in &part.shared {
                let Some(&(other, place)) = sides.get(&(part.region, shared.other, shared.own)) else {
                    unmatched += usize::from(parts.len() > 1) * shared.faces.len();
                    continue;
                };
                // Each pair of sides is met twice.
                if other <= number {
                    continue;
                }
                let (Some(other_part), Some(&other_first)) = (parts.get(other), firsts.get(other)) else { continue };
                let Some(other_side) = other_part.shared.get(place) else { continue };
                unmatched += shared.faces.len().abs_diff(other_side.faces.len());
                for (face, turned) in shared.faces.iter().zip(&other_side.faces) {
                    let pairs = || face.iter().zip(turned.iter().take(1).chain(turned.iter().skip(1).rev()));
                    let positions = |(&a, &b): (&u32, &u32)| {
                        Some((*part.points.get(a as usize)?, *other_part.points.get(b as usize)?))
                    };
                    let positions: Option<Vec<_>> = pairs().map(positions).collect();
                    if face.len() != turned.len() || !positions.is_some_and(|positions| are_close(&positions)) {
                        unmatched += 1;
                        continue;
                    }
                    let own_first = firsts.get(number).copied().unwrap_or_default();
                    for (&a, &b) in pairs() {
                        unite(&mut same, own_first + a as usize, other_first + b as usize);
                    }
                }
            }
        }
        if unmatched > 0 {
            warnings.push(format!(
                "{unmatched} faces between processors do not match; the mesh is read with a seam of double points there"
            ));
        }
        Self::of(&mut same)
    }

    fn of(same: &mut [u32]) -> Self {
        let mut numbers = Vec::with_capacity(same.len());
        let mut kept = Vec::with_capacity(same.len());
        let mut next = 0;
        for point in 0..same.len() {
            let root = root_of(same, point);
            kept.push(root == point);
            // The root is the smallest of its points, so that it has its number already.
            numbers.push(if root == point { next } else { numbers.get(root).copied().unwrap_or_default() });
            next += u32::from(root == point);
        }
        Self { numbers, kept }
    }

    /// Whether all points keep their numbers.
    pub(super) fn is_identity(&self) -> bool {
        self.numbers.is_empty()
    }

    /// The number of a point that is kept for this one.
    pub(super) fn number_of(&self, point: usize) -> u32 {
        self.numbers.get(point).copied().unwrap_or(point as u32)
    }

    /// The points that are kept.
    pub(super) fn kept_points(&self, mut points: Vec<DVec3>) -> Vec<DVec3> {
        if !self.is_identity() {
            let mut kept = self.kept.iter();
            points.retain(|_| kept.next() == Some(&true));
        }
        points
    }

    /// The tuples of points that are kept.
    pub(super) fn kept_tuples(&self, values: ArrayValues, components: usize) -> ArrayValues {
        fn of<T>(kept: &[bool], mut values: Vec<T>, components: usize) -> Vec<T> {
            let mut flags = kept.iter().flat_map(|&keep| std::iter::repeat_n(keep, components));
            values.retain(|_| flags.next() == Some(true));
            values
        }
        match values {
            _ if self.is_identity() => values,
            ArrayValues::F32(values) => ArrayValues::F32(of(&self.kept, values, components)),
            ArrayValues::F64(values) => ArrayValues::F64(of(&self.kept, values, components)),
            other => other,
        }
    }
}

fn are_close(pairs: &[(DVec3, DVec3)]) -> bool {
    let Some(&(start, _)) = pairs.first() else { return false };
    let extent = pairs.iter().map(|(a, _)| a.distance(start)).fold(0.0, f64::max);
    let far = pairs.iter().map(|(a, _)| a.abs().max_element()).fold(0.0, f64::max);
    pairs.iter().all(|(a, b)| a.distance(*b) <= APART * extent + DIGITS * far)
}

/// Makes two points one; the smaller number stands for both.
fn unite(same: &mut [u32], a: usize, b: usize) {
    let (a, b) = (root_of(same, a), root_of(same, b));
    if let Some(slot) = same.get_mut(a.max(b)) {
        *slot = a.min(b) as u32;
    }
}

/// The point that stands for this one; the way to it is halved, so that later ways are short.
fn root_of(same: &mut [u32], mut point: usize) -> usize {
    while let Some(&parent) = same.get(point)
        && parent as usize != point
    {
        let grandparent = same.get(parent as usize).copied().unwrap_or(parent);
        if let Some(slot) = same.get_mut(point) {
            *slot = grandparent;
        }
        point = grandparent as usize;
    }
    point
}
