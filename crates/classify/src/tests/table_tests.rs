//! The table of 81: counts, what geometry can reach, and a second generator.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::{is_odd, permutations, turn};
use crate::{Fan, FanVertex, ProjectionClass, Sign, TRUTH_TABLE, TableEntry, Tests};

/// A triangle as its cycle of vertices from the least.
fn normalized(triangle: [FanVertex; 3]) -> [usize; 3] {
    let [p, q, r] = triangle.map(|vertex| match vertex {
        FanVertex::Thick => 9,
        FanVertex::Corner(corner) => corner,
    });
    [[p, q, r], [q, r, p], [r, p, q]].into_iter().min().unwrap()
}

fn triangles(fan: &Fan) -> BTreeSet<[usize; 3]> {
    fan.triangles().map(normalized).collect()
}

fn lattice() -> impl Iterator<Item = [DVec2; 4]> {
    let point = |code: usize| DVec2::new((code % 3) as f64, (code / 3 % 3) as f64);
    (0..6561).map(move |code| [point(code), point(code / 9), point(code / 81), point(code / 729)])
}

#[test]
fn table_counts() {
    let count = |wanted: fn(&TableEntry) -> bool| TRUTH_TABLE.iter().filter(|entry| wanted(entry)).count();
    let class = |wanted: &[ProjectionClass]| {
        let is_wanted =
            |entry: &&TableEntry| matches!(entry, TableEntry::Valid { class, .. } if wanted.contains(class));
        TRUTH_TABLE.iter().filter(is_wanted).count()
    };
    use ProjectionClass::{Four, OneA, OneB, ThreeA, ThreeB, Two};
    assert_eq!([class(&[OneA]), class(&[OneB]), class(&[Two])], [4, 4, 6]);
    assert_eq!([class(&[ThreeA]), class(&[ThreeB]), class(&[Four])], [12, 12, 12]);
    assert_eq!(count(|entry| matches!(entry, TableEntry::Degenerate)), 1);
    assert_eq!(count(|entry| matches!(entry, TableEntry::Impossible)), 30);
    assert_eq!(TRUTH_TABLE[40], TableEntry::Degenerate);
    for entry in &TRUTH_TABLE {
        if let TableEntry::Valid { class, fan } = entry {
            assert_eq!(fan.triangles().count(), class.triangle_count());
            assert_eq!(fan.as_slice()[0], FanVertex::Thick);
        }
    }
}

#[test]
fn table_impossible_entries() {
    let listed = "0101 0102 0111 0112 0201 0202 0211 0212 1010 1011 1020 1021 1101 1102 1110 1112 1120 1121 1201 1202 \
                  1211 1212 2010 2011 2020 2021 2110 2111 2120 2121";
    let found: Vec<String> = (0..81)
        .filter(|&code| TRUTH_TABLE[code] == TableEntry::Impossible)
        .map(|code| Tests::from_code(code).digits().iter().map(u8::to_string).collect())
        .collect();
    assert_eq!(found.join(" "), listed);
}

#[test]
fn table_codes_round_trip() {
    for code in 0..81 {
        assert_eq!(Tests::from_code(code).code(), code);
    }
}

#[test]
fn lattice_reaches_exactly_the_possible_entries() {
    let mut reached = BTreeSet::new();
    for points in lattice() {
        // Cross products in integers, from the paper's vectors.
        let v = points.map(|p| [p.x as i64, p.y as i64]);
        let vector = |to: usize, from: usize| [v[to][0] - v[from][0], v[to][1] - v[from][1]];
        let pairs = [
            (vector(1, 0), vector(2, 0)),
            (vector(1, 0), vector(3, 0)),
            (vector(2, 0), vector(3, 0)),
            (vector(1, 2), vector(1, 3)),
        ];
        let digits = pairs.map(|(u, w)| ((u[0] * w[1] - u[1] * w[0]).signum() + 1) as u8);
        assert_eq!(Tests::of(&points).digits(), digits);
        assert_eq!(Tests::exact(&points).digits(), digits);
        reached.insert(Tests::of(&points).code());
    }
    let possible: BTreeSet<usize> = (0..81).filter(|&code| TRUTH_TABLE[code] != TableEntry::Impossible).collect();
    assert_eq!(reached.len(), 51);
    assert_eq!(reached, possible);
}

/// One drawn example a shape, carried to all relabelings and mirror images.
#[test]
fn orbits_generate_the_same_table() {
    use FanVertex::{Corner, Thick};
    let p = DVec2::new;
    // Shape, class with the thick corner nearest, with it farthest, the thick corner, the fan.
    let shapes = [
        (
            [p(1.0, 1.0), p(0.0, 0.0), p(4.0, 0.0), p(0.0, 4.0)],
            [ProjectionClass::OneA, ProjectionClass::OneB],
            vec![[Thick, Corner(1), Corner(2)], [Thick, Corner(2), Corner(3)], [Thick, Corner(3), Corner(1)]],
        ),
        (
            [p(0.0, 0.0), p(2.0, 0.0), p(2.0, 2.0), p(0.0, 2.0)],
            [ProjectionClass::Two; 2],
            vec![
                [Thick, Corner(0), Corner(1)],
                [Thick, Corner(1), Corner(2)],
                [Thick, Corner(2), Corner(3)],
                [Thick, Corner(3), Corner(0)],
            ],
        ),
        (
            [p(1.0, 0.0), p(0.0, 0.0), p(2.0, 0.0), p(1.0, 2.0)],
            [ProjectionClass::ThreeA, ProjectionClass::ThreeB],
            vec![[Thick, Corner(1), Corner(3)], [Thick, Corner(2), Corner(3)]],
        ),
        (
            [p(0.0, 0.0), p(0.0, 0.0), p(1.0, 0.0), p(0.0, 1.0)],
            [ProjectionClass::Four; 2],
            vec![[Thick, Corner(2), Corner(3)]],
        ),
    ];
    let mut table: BTreeMap<usize, (ProjectionClass, BTreeSet<[usize; 3]>)> = BTreeMap::new();
    let mut sizes = Vec::new();
    for (shape, classes, fan) in shapes {
        let before = table.len();
        for order in permutations() {
            for mirror in [1.0, -1.0] {
                let mut points = [DVec2::ZERO; 4];
                for (corner, point) in shape.into_iter().enumerate() {
                    points[order[corner]] = point * DVec2::new(mirror, 1.0);
                }
                // The example with its corner 0 nearer than the others: the orientation says whether that can be so.
                let solid: [DVec3; 4] = std::array::from_fn(|i| points[i].extend(f64::from(i != order[0])));
                let volume = (solid[1] - solid[0]).cross(solid[2] - solid[0]).dot(solid[3] - solid[0]);
                let class = classes[usize::from(volume < 0.0)];
                let thick = match class {
                    ProjectionClass::Two => p(1.0 * mirror, 1.0),
                    _ => points[order[0]],
                };
                let place = |vertex| match vertex {
                    Thick => thick,
                    Corner(corner) => points[corner],
                };
                let fan = fan.iter().map(|triangle| {
                    let [t, q, r] = triangle.map(|vertex| match vertex {
                        Thick => Thick,
                        Corner(corner) => Corner(order[corner]),
                    });
                    normalized(if turn(place(t), place(q), place(r)) < 0.0 { [t, q, r] } else { [t, r, q] })
                });
                let entry = (class, fan.collect());
                let code = Tests::of(&points).code();
                assert_eq!(*table.entry(code).or_insert_with(|| entry.clone()), entry, "code {code}");
            }
        }
        sizes.push(table.len() - before);
    }
    assert_eq!(sizes, [8, 6, 24, 12]);
    for (code, entry) in TRUTH_TABLE.iter().enumerate() {
        let generated = match entry {
            TableEntry::Valid { class, fan } => Some((*class, triangles(fan))),
            _ => None,
        };
        assert_eq!(table.get(&code).cloned(), generated, "code {code}");
    }
}

#[test]
fn relabeling_permutes_signs_and_fans() {
    for points in lattice().step_by(7) {
        let signs = Tests::of(&points).signs();
        for order in permutations() {
            let relabeled = Tests::of(&order.map(|corner| points[corner]));
            let expected = order.map(|corner| if is_odd(order) { signs[corner].negated() } else { signs[corner] });
            assert_eq!(relabeled.signs(), expected);
            // An odd order turns front into back: the triangles on the screen stay the same.
            let (TableEntry::Valid { fan, .. }, TableEntry::Valid { fan: other, class }) =
                (Tests::of(&points).entry(), relabeled.entry())
            else {
                assert_eq!(Tests::of(&points).entry(), relabeled.entry());
                continue;
            };
            let back: BTreeSet<[usize; 3]> = other
                .triangles()
                .map(|triangle| {
                    normalized(triangle.map(|vertex| match vertex {
                        FanVertex::Thick => FanVertex::Thick,
                        FanVertex::Corner(corner) => FanVertex::Corner(order[corner]),
                    }))
                })
                .collect();
            assert_eq!(back, triangles(fan), "{class:?}");
        }
    }
}

proptest! {
    #[test]
    fn tests_agree_with_exact_ones_in_general_position(
        points in prop::array::uniform4((-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| DVec2::new(x, y))),
    ) {
        let (rounded, exact) = (Tests::of(&points), Tests::exact(&points));
        let [p, q, r, s] = points;
        let smallest = [turn(p, q, r), turn(p, q, s), turn(p, r, s), turn(q, r, s)]
            .into_iter().fold(f64::INFINITY, |least, area| least.min(area.abs()));
        prop_assert!(rounded == exact || smallest < 1e-14);
        prop_assert!(*exact.entry() != TableEntry::Impossible);
    }

    /// Four points within a few ulp of a line: the exact tests never are impossible.
    #[test]
    fn exact_tests_never_impossible_near_a_line(
        along in prop::array::uniform4(0_i32..4), slips in prop::array::uniform4(-1000_i64..1000), slope in -2.0..2.0_f64,
    ) {
        let points: [DVec2; 4] = std::array::from_fn(|i| {
            let x = 0.1 + f64::from(along[i]) / 3.0;
            DVec2::new(x, slope * x + slips[i] as f64 * 2.0_f64.powi(-52))
        });
        prop_assert!(*Tests::exact(&points).entry() != TableEntry::Impossible);
    }

    #[test]
    fn signs_of_codes(code in 0_usize..81) {
        let [t1, t2, t3, t4] = Tests::from_code(code).digits().map(|digit| i32::from(digit) - 1);
        prop_assert_eq!(Tests::from_code(code).signs().map(Sign::value), [t4, -t3, t2, -t1]);
    }
}
