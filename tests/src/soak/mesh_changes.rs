//! What is done to a mesh to make it hard: slivers, cracks, duplicates, cells without volume, and coordinates of any size.

use glam::DVec3;

use super::mesh::{Made, pick};
use crate::meshes::{Random, Tets};

/// Changes a mesh by chance; most are left alone by most changes.
pub(super) fn change(random: &mut Random, made: &mut Made, seed: u64) {
    let mut did = Vec::new();
    let tets = &mut made.tets;
    let mut chance = |share: f64| random.unit() < share;
    let [splits, holes, hanging, flat, doubled, inverted] = [0.2, 0.1, 0.07, 0.1, 0.06, 0.15].map(&mut chance);
    let [snapped, squashed, beside, over, again, renumbered] = [0.1, 0.2, 0.06, 0.03, 0.03, 0.2].map(&mut chance);
    let [turned, scaled, moved] = [0.4, 0.25, 0.2].map(&mut chance);
    if splits {
        split(random, tets);
        did.push("slivers");
    }
    if holes && tets.cells.len() > 4 {
        let share = random.between(0.05, 0.8);
        let kept: Vec<[u32; 4]> = tets.cells.iter().copied().filter(|_| random.unit() > share).collect();
        if !kept.is_empty() {
            tets.cells = kept;
            did.push("cells taken out");
        }
    }
    if hanging {
        hang(random, tets);
        did.push("hanging nodes");
    }
    if doubled {
        tear(random, tets);
        did.push("points twice");
    }
    if flat {
        flatten(random, tets);
        did.push("cells without volume");
    }
    if inverted {
        for cell in &mut tets.cells {
            if random.unit() < 0.5 {
                cell.swap(0, 1);
            }
        }
        did.push("inverted cells");
    }
    if beside || over {
        let other = crate::shapes::delaunay(5 + pick(random, 6), seed ^ 0xB51DE);
        let away =
            if beside { random.point().normalize_or(DVec3::X) * random.between(3.6, 5.0) } else { random.point() };
        let first = tets.points.len() as u32;
        tets.points.extend(other.points.iter().map(|&p| p + away));
        tets.cells.extend(other.tetrahedra.iter().map(|cell| cell.map(|v| v.0 + first)));
        did.push(if beside { "another part" } else { "an overlapping part" });
        made.grid = None;
    }
    if again {
        let count = 1 + pick(random, 3);
        for _ in 0..count {
            tets.cells.push(tets.cells[pick(random, tets.cells.len())]);
        }
        did.push("cells twice");
    }
    if snapped {
        let step = 2.0_f64.powi(-(1 + pick(random, 5) as i32));
        for point in &mut tets.points {
            *point = (*point / step).round() * step;
        }
        did.push("on a lattice");
    }
    if squashed {
        let mut stretch = DVec3::ONE;
        stretch[pick(random, 3)] = 10.0_f64.powf(random.between(-6.0, 6.0));
        tets.points.iter_mut().for_each(|point| *point *= stretch);
        did.push("squashed");
    }
    if turned {
        let turn = crate::pictures::random_turn(random);
        tets.points.iter_mut().for_each(|point| *point = turn * *point);
        made.grid = None;
        did.push("turned");
    }
    if moved {
        let far = [1.0, 1e3, 5e6, 1e9][pick(random, 4)];
        let away = random.point() * far;
        tets.points.iter_mut().for_each(|point| *point += away);
        did.push("moved");
    }
    if scaled {
        let scale = 10.0_f64.powf(random.between(-12.0, 12.0));
        tets.points.iter_mut().for_each(|point| *point *= scale);
        did.push("scaled");
    }
    if renumbered {
        renumber(random, tets);
        did.push("renumbered");
    }
    made.changes = did;
}

/// Cells, faces and edges are split very near to one of their corners.
fn split(random: &mut Random, tets: &mut Tets) {
    tets.scalars.resize(tets.points.len(), 0.0);
    for _ in 0..=pick(random, 8) {
        let cell = tets.cells[pick(random, tets.cells.len())];
        let parents = 2 + pick(random, 3);
        let tiny = 10.0_f64.powf(-random.between(0.0, 9.0)) * 0.5;
        let mut shares = vec![tiny / (parents - 1) as f64; parents];
        shares[pick(random, parents)] = 1.0 - tiny;
        let sum: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= sum);
        tets.split(&cell[..parents], &shares);
    }
}

/// Edges are split in one of the cells that have them, and in no other.
fn hang(random: &mut Random, tets: &mut Tets) {
    for _ in 0..=pick(random, 4) {
        let place = pick(random, tets.cells.len());
        let cell = tets.cells[place];
        let share = random.between(0.1, 0.9);
        let new = tets.points.len() as u32;
        let [a, b] = [0, 1].map(|i| tets.points[cell[i] as usize]);
        tets.points.push(a * share + b * (1.0 - share));
        tets.cells[place] = [new, cell[1], cell[2], cell[3]];
        tets.cells.push([cell[0], new, cell[2], cell[3]]);
    }
}

/// Some corners of cells become points of their own, at the same place.
fn tear(random: &mut Random, tets: &mut Tets) {
    for place in 0..tets.cells.len() {
        for corner in 0..4 {
            if random.unit() < 0.1 {
                let old = tets.cells[place][corner] as usize;
                tets.cells[place][corner] = tets.points.len() as u32;
                tets.points.push(tets.points[old]);
            }
        }
    }
}

/// Cells whose four points lie in one plane, or are not four.
fn flatten(random: &mut Random, tets: &mut Tets) {
    for _ in 0..=pick(random, 5) {
        let [a, b, c, d] = tets.cells[pick(random, tets.cells.len())];
        if random.unit() < 0.5 {
            tets.cells.push([a, b, c, a]);
        } else {
            let new = tets.points.len() as u32;
            let [p, q, r] = [a, b, d].map(|v| tets.points[v as usize]);
            tets.points.push((p + q + r) / 3.0);
            tets.cells.push([a, b, d, new]);
        }
    }
}

/// Points and cells by other numbers.
fn renumber(random: &mut Random, tets: &mut Tets) {
    let mut shuffled = |count: usize| {
        let mut order: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            order.swap(i, pick(random, i + 1));
        }
        order
    };
    let (points, cells) = (shuffled(tets.points.len()), shuffled(tets.cells.len()));
    let mut number = vec![0_u32; points.len()];
    for (new, &old) in points.iter().enumerate() {
        number[old] = new as u32;
    }
    tets.points = points.iter().map(|&old| tets.points[old]).collect();
    tets.cells = cells.iter().map(|&old| tets.cells[old].map(|v| number[v as usize])).collect();
}
