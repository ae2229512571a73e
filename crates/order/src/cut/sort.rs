//! Sorting the cells of one ring: components, and planes where a component has more than one body.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use super::body::{Body, MOST_PLANES, Parts, are_seen_apart};
use super::components::components;
use super::relation::{Ball, Relation, eye_height, relation};
use super::{MEMBERS, ROUNDING, corners};
use crate::signs::side_of;
use crate::{Cells, CutPlane};

/// Pairs of cells of which the exact relation is looked for; a few microseconds each.
const PAIRS: usize = 1 << 18;

/// Bodies a cell, beyond which a ring is given up, and in any case. Rings in use need one or two.
const BODIES_PER_CELL: usize = 8;
const BODIES: usize = 1 << 10;

/// Corners compared with planes and pairs of bodies compared with each other, all in all; some nanoseconds each.
const STEPS: usize = 1 << 27;

/// Faces whose planes are tried for one cut. More make the cuts little better.
const CANDIDATES: usize = 64;

/// Bodies that may hide one another.
struct Group {
    bodies: Vec<Body>,
    /// For every body those in front of it.
    front_of: Vec<Vec<u32>>,
}

/// What is still to be done, the nearest last.
enum Task {
    /// A body in its place.
    Done(Body),
    /// To be sorted into components.
    Sort(Group),
    /// A component of several bodies.
    Cut(Group),
}

struct Sorter<'a> {
    viewpoint: Viewpoint,
    members: &'a [[DVec3; 4]],
    tolerance: f64,
    /// What is left of [`STEPS`].
    steps: usize,
    /// Bodies that may still be made.
    bodies: usize,
}

/// The bodies of these cells, front to back; `None` if that takes too much, or if cells penetrate each other.
pub(super) fn sort(cells: Cells<'_>, viewpoint: Viewpoint, members: &[CellId]) -> Option<Vec<Body>> {
    if members.len() > MEMBERS {
        return None;
    }
    let members: Vec<[DVec3; 4]> = members.iter().map(|&cell| corners(cells, cell)).collect();
    let largest = members.iter().flatten().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    // Corners relative to the eye are rounded to the larger of both.
    let scale = match viewpoint {
        Viewpoint::Eye(eye) => largest.max(eye.abs().max_element()),
        Viewpoint::Direction(_) => largest,
    };
    let bodies: Vec<Body> = members.iter().enumerate().map(|(number, corners)| Body::whole(number, corners)).collect();
    let front_of = relations(viewpoint, &members, scale)?;
    let mut sorter = Sorter {
        viewpoint,
        members: &members,
        tolerance: scale * ROUNDING,
        steps: STEPS,
        bodies: BODIES + BODIES_PER_CELL * members.len(),
    };
    let mut sorted = Vec::with_capacity(members.len());
    let mut tasks = vec![Task::Sort(Group { bodies, front_of })];
    while let Some(task) = tasks.pop() {
        match task {
            Task::Done(body) => sorted.push(body),
            Task::Sort(group) => tasks.extend(sorter.components(group)?.into_iter().rev()),
            Task::Cut(group) => {
                let [near, far] = sorter.cut(group)?;
                tasks.extend([Task::Sort(far), Task::Sort(near)]);
            }
        }
    }
    Some(sorted)
}

/// For every cell those in front of it; `None` if some penetrate each other, or if there are too many pairs. Cells without volume
/// have no relations: no ray passes through them.
fn relations(viewpoint: Viewpoint, members: &[[DVec3; 4]], scale: f64) -> Option<Vec<Vec<u32>>> {
    let balls: Vec<Ball> = members.iter().map(|corners| Ball::new(viewpoint, corners)).collect();
    let has_volume: Vec<bool> = members.iter().map(|&[a, b, c, d]| side_of([a, b, c], d) != 0).collect();
    let later = |i: usize| {
        let (balls, has_volume) = (&balls, &has_volume);
        (i + 1..balls.len()).filter(move |&j| has_volume[i] && has_volume[j] && balls[i].meets(&balls[j]))
    };
    let pairs: usize = (0..members.len()).into_par_iter().map(|i| later(i).count()).sum();
    if pairs > PAIRS {
        return None;
    }
    let related = |i: usize| -> Vec<(usize, Relation)> {
        later(i)
            .map(|j| (j, relation(viewpoint, &members[i], &members[j], scale)))
            .filter(|&(_, relation)| relation != Relation::Apart)
            .collect()
    };
    let related: Vec<Vec<(usize, Relation)>> = (0..members.len()).into_par_iter().map(related).collect();
    let mut front_of = vec![Vec::new(); members.len()];
    for (i, related) in related.iter().enumerate() {
        for &(j, relation) in related {
            match relation {
                Relation::Front => front_of[j].push(i as u32),
                Relation::Behind => front_of[i].push(j as u32),
                Relation::Entangled => return None,
                Relation::Apart => {}
            }
        }
    }
    Some(front_of)
}

impl Sorter<'_> {
    /// The components of a group, front to back.
    fn components(&mut self, group: Group) -> Option<Vec<Task>> {
        self.spend(group.bodies.len() + group.front_of.iter().map(Vec::len).sum::<usize>())?;
        let found = components(&group.front_of);
        let (mut component_of, mut number_in) = (vec![0; group.bodies.len()], vec![0_u32; group.bodies.len()]);
        for (component, members) in found.iter().enumerate() {
            for (number, &member) in (0..).zip(members) {
                (component_of[member as usize], number_in[member as usize]) = (component, number);
            }
        }
        let mut groups: Vec<Group> = found.iter().map(|_| Group { bodies: Vec::new(), front_of: Vec::new() }).collect();
        for (number, (body, front_of)) in group.bodies.into_iter().zip(&group.front_of).enumerate() {
            let component = component_of[number];
            let inside = front_of.iter().filter(|&&other| component_of[other as usize] == component);
            groups[component].front_of.push(inside.map(|&other| number_in[other as usize]).collect());
            groups[component].bodies.push(body);
        }
        let task = |mut group: Group| match (group.bodies.len(), group.bodies.pop()) {
            (1, Some(body)) => Task::Done(body),
            (_, last) => {
                group.bodies.extend(last);
                Task::Cut(group)
            }
        };
        Some(groups.into_iter().map(task).collect())
    }

    /// A component, divided by a plane: what is on the eye's side of it, and the rest.
    fn cut(&mut self, group: Group) -> Option<[Group; 2]> {
        let plane = self.plane(&group.bodies)?;
        let eye_is_before = eye_height(self.viewpoint, plane.point, plane.normal) > 0.0;
        let mut sides = [Vec::new(), Vec::new()];
        // For every body its numbers on both sides.
        let mut numbers: Vec<[Option<u32>; 2]> = Vec::with_capacity(group.bodies.len());
        for body in group.bodies {
            if body.planes.len() >= MOST_PLANES {
                return None;
            }
            let Parts { behind, before } = body.divide(&plane, self.tolerance);
            let parts = if eye_is_before { [before, behind] } else { [behind, before] };
            if parts[0].is_some() && parts[1].is_some() {
                self.bodies = self.bodies.checked_sub(1)?;
            }
            let mut number = [None; 2];
            for (side, part) in parts.into_iter().enumerate() {
                if let Some(part) = part {
                    number[side] = Some(sides[side].len() as u32);
                    sides[side].push(part);
                }
            }
            numbers.push(number);
        }
        let is_cut = |number: [Option<u32>; 2]| number[0].is_some() && number[1].is_some();
        let mut front_of = [0, 1].map(|side: usize| vec![Vec::new(); sides[side].len()]);
        for (&back, fronts) in numbers.iter().zip(&group.front_of) {
            for &front in fronts {
                let front = numbers[front as usize];
                for side in 0..2 {
                    let (Some(front_here), Some(back_here)) = (front[side], back[side]) else { continue };
                    let [a, b] = [front_here, back_here].map(|number| &sides[side][number as usize]);
                    if is_cut(front) || is_cut(back) {
                        self.spend((a.corners.len() + b.corners.len()).pow(2))?;
                        if are_seen_apart(self.viewpoint, a, b, self.tolerance) {
                            continue;
                        }
                    }
                    front_of[side][back_here as usize].push(front_here);
                }
            }
        }
        let ([near, far], [near_front_of, far_front_of]) = (sides, front_of);
        Some([Group { bodies: near, front_of: near_front_of }, Group { bodies: far, front_of: far_front_of }])
    }

    /// The plane of a face that divides a component best; `None` if none has bodies on both sides.
    fn plane(&mut self, bodies: &[Body]) -> Option<CutPlane> {
        let faces = 4 * bodies.len();
        let step = faces.div_ceil(CANDIDATES);
        let mut best: Option<(usize, CutPlane)> = None;
        // Some of the faces; if none of them is of use, the others.
        for offset in 0..step {
            for face in (offset..faces).step_by(step) {
                let [p, q, r] = self.face(&bodies[face / 4], face % 4);
                let Some(normal) = (q - p).cross(r - p).try_normalize() else { continue };
                let plane = CutPlane { point: p, normal };
                if let Some(cost) = self.cost(bodies, &plane)?
                    && best.is_none_or(|(least, _)| cost < least)
                {
                    best = Some((cost, plane));
                }
            }
            if best.is_some() {
                break;
            }
        }
        best.map(|(_, plane)| plane)
    }

    fn face(&self, body: &Body, corner: usize) -> [DVec3; 3] {
        let corners = &self.members[body.member];
        [1, 2, 3].map(|next| corners[(corner + next) % 4])
    }

    /// What a plane costs: bodies that it cuts, and how uneven its sides are; the inner `None` if it has all on one side.
    fn cost(&mut self, bodies: &[Body], plane: &CutPlane) -> Option<Option<usize>> {
        let (mut behind, mut before, mut cut) = (0_usize, 0_usize, 0);
        for body in bodies {
            self.spend(body.corners.len())?;
            let [reach_behind, reach_before] = body.reach(plane);
            if reach_behind.min(reach_before) > self.tolerance {
                cut += 1;
            } else if reach_behind >= reach_before {
                behind += 1;
            } else {
                before += 1;
            }
        }
        let divides = cut > 0 || behind > 0 && before > 0;
        Some(divides.then(|| CUT_COST * cut + behind.abs_diff(before)))
    }

    fn spend(&mut self, steps: usize) -> Option<()> {
        self.steps = self.steps.checked_sub(steps)?;
        Some(())
    }
}

/// Unevenness that one more cut is worth: a plane that puts one body aside leaves nearly the whole ring, and the next one has to cut
/// again. A guess; among some hundred bars across each other it leaves a tenth fewer pieces than the fewest cuts each time.
const CUT_COST: usize = 4;
