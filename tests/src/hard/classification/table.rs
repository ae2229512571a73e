//! Entries of the table of 81, and thick vertices that the textbook divides by zero for.

use glam::{DVec2, DVec3};
use tetrascope::classify::{Sign, TRUTH_TABLE, TableEntry, Tests};

use super::super::case::{Beyond, HardScene};
use super::super::views::{Pieces, down, down_from, lively, look, nudged, oriented};
use super::shapes::alone;
use super::{PLACE, RANGE, SPREAD};
use crate::meshes::Random;

/// A cell for every entry of the table that points can have, as the table counts them, in rows of eight.
pub fn cells_of_the_table() -> Vec<(usize, [DVec3; 4])> {
    let point = |code: usize| DVec2::new((code % 3) as f64, (code / 3 % 3) as f64);
    let valid = |code: &usize| matches!(TRUTH_TABLE[*code], TableEntry::Valid { .. });
    (0..81)
        .filter(valid)
        .enumerate()
        .filter_map(|(place, code)| {
            // The widest of the lattice's quadruples, on the screen: y down.
            let area = |points: &[DVec2; 4]| {
                let [a, b, c, d] = *points;
                ((b - a).perp_dot(c - a).abs()
                    + (b - a).perp_dot(d - a).abs()
                    + (c - a).perp_dot(d - a).abs()
                    + (c - b).perp_dot(d - b).abs()) as u32
            };
            let points = (0..6561)
                .map(|lattice: usize| [point(lattice), point(lattice / 9), point(lattice / 81), point(lattice / 729)])
                .filter(|points| Tests::of(points).code() == code)
                .max_by_key(area)?;
            // Corners of one sign before those of the other make an upright cell.
            let signs = Tests::from_code(code).signs();
            let corners: [DVec3; 4] = std::array::from_fn(|i| {
                let near = if signs[i] == Sign::Positive {
                    1.0
                } else if signs[i] == Sign::Negative {
                    -1.0
                } else {
                    0.0
                };
                let at = points[i] + 2.75 * DVec2::new((place % 8) as f64, (place / 8) as f64);
                DVec3::new(at.x, -at.y, near)
            });
            Some((code, corners))
        })
        .collect()
}

pub(super) fn entries_of_the_table() -> Vec<HardScene> {
    let mut chart = Pieces::default();
    for (code, corners) in cells_of_the_table() {
        let shift = 0.06 * (code % 8) as f64;
        chart.add(&corners, &[[0, 1, 2, 3]], &[0.05, 0.3, 0.55, 0.5].map(|s| s + shift));
    }
    let middle = DVec3::new(0.5 * (7.0 * 2.75 + 2.0), -0.5 * (6.0 * 2.75 + 2.0), 0.0);
    [("straight down", down(middle, 19.5), [120, 104]), ("straight down, on pixels", down(middle, 18.5), [87, 74])]
        .map(|(place, camera, size)| HardScene::partition(place, chart.volume(), lively(&camera, size, RANGE, 1.0)))
        .to_vec()
}

/// Cells whose corners lie on a line but for rounding, such that the four rounded cross products are those of no four points; each with its
/// entry of the table, one cell for every such entry that was found.
pub fn impossible_cells() -> Vec<(usize, [DVec3; 4])> {
    let mut random = Random::new(7600);
    let mut found: Vec<Option<[DVec3; 4]>> = vec![None; 81];
    for _ in 0..200_000 {
        let start = random.point().truncate();
        let along = random.point().truncate();
        let points: [DVec2; 4] = std::array::from_fn(|_| start + along * random.unit());
        let code = Tests::of(&points).code();
        if TRUTH_TABLE[code] != TableEntry::Impossible || found[code].is_some() {
            continue;
        }
        let heights: [f64; 4] = std::array::from_fn(|_| random.between(0.5, 1.5));
        // On the screen of a view straight down y runs down.
        found[code] = Some(std::array::from_fn(|i| DVec3::new(points[i].x, -points[i].y, heights[i])));
    }
    found.into_iter().enumerate().filter_map(|(code, cell)| Some((code, cell?))).collect()
}

pub(super) fn impossible_entries() -> Vec<HardScene> {
    let mut stage = Pieces::default();
    let cube: [DVec3; 8] = std::array::from_fn(|i| {
        let side = |bit: usize| if i >> bit & 1 == 1 { 1.125 } else { -1.125 };
        DVec3::new(side(0), side(1), if i >> 2 == 1 { 0.25 } else { -0.75 })
    });
    let cells = [[0, 3, 5, 6], [1, 0, 3, 5], [2, 0, 3, 6], [4, 0, 5, 6], [7, 3, 5, 6]];
    stage.add(&cube, &cells.map(|cell| oriented(&cube, cell)), &SPREAD);
    for (_, corners) in impossible_cells() {
        stage.add(&corners, &[oriented(&corners, [0, 1, 2, 3])], &SPREAD[..4]);
    }
    let aside = look(DVec3::new(2.0, -4.0, 4.0), DVec3::new(0.0, 0.0, 0.25), DVec3::Z, 36.0);
    [("from aside", aside), ("straight down", down(DVec3::ZERO, 2.5))]
        .map(|(place, camera)| HardScene::partition(place, stage.volume(), lively(&camera, [48, 46], RANGE, 1.0)))
        .to_vec()
}

pub(super) fn thick_vertex_between_parallel_edges() -> Vec<HardScene> {
    let angles = [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
    let cell = |at: DVec3, angle: f64| {
        [[-1.25, 0., 0.5], [1.25, 0., 0.5], [-1.25, -1.25 * angle, -0.5], [1.25, 1.25 * angle, -0.5]]
            .map(|p| at + DVec3::from(p))
    };
    let mut scenes = Vec::new();
    let mut rows = Pieces::default();
    for (i, angle) in angles.into_iter().enumerate() {
        let at = DVec3::new(2.75 * ((i % 2) as f64 - 0.5), 0.5 * ((i / 2) as f64 - 1.5), 0.0);
        let corners = cell(at, angle);
        rows.add(&corners, &[oriented(&corners, [0, 1, 2, 3])], &SPREAD[..4]);
    }
    let aside = look(DVec3::new(1.0, -3.0, 8.0), DVec3::ZERO, DVec3::Y, 20.0);
    scenes.push(HardScene::partition("side by side", rows.volume(), lively(&aside, [96, 40], RANGE, 0.7)));
    for (angle, is_perspective, gpu_within) in
        [(1e-3, false, None), (1e-3, true, None), (1e-6, false, Some(5e-2)), (1e-9, true, Some(1.0))]
    {
        // As near as the silhouette is wide.
        let (words, camera) = if is_perspective {
            (", in perspective", down_from(PLACE + 4.0 * DVec3::Z, 0.5 * angle))
        } else {
            ("", down(PLACE, 2.0 * angle))
        };
        let place = format!("an angle of {angle:e}, near{words}");
        let near = alone(&place, &cell(PLACE, angle), &camera, 0.5);
        // 1e-3 of the mesh is a million of a lattice's steps.
        let beyond = gpu_within.map(|within| Beyond::gpu("less than a hundredth of the mesh", within));
        scenes.push(HardScene { beyond, ..near });
    }
    scenes
}

/// Two edges over one another that cross where both of them begin, and around there on all sides.
///
/// - `slip`: how far the one's begin lies from above the other's, in the plane
fn crossing(at: DVec3, slip: DVec2) -> [DVec3; 4] {
    [
        at + DVec3::new(0.0, 0.0, 0.75),
        at + DVec3::new(1.75, 0.25, 0.5),
        at + DVec3::new(slip.x, slip.y, -0.75),
        at + DVec3::new(0.25, 1.75, -0.5),
    ]
}

pub(super) fn crossing_at_the_ends() -> Vec<HardScene> {
    let ways = [[0, 0], [1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
    let chart = |slip: &dyn Fn(DVec3, [i32; 2]) -> DVec2| {
        let mut chart = Pieces::default();
        for (i, way) in ways.into_iter().enumerate() {
            let at =
                PLACE + DVec3::new(2.25 * ((i % 3) as f64 - 1.0) - 0.875, 2.25 * ((i / 3) as f64 - 1.0) - 0.875, 0.0);
            let corners = crossing(at, slip(at, way));
            chart.add(&corners, &[oriented(&corners, [0, 1, 2, 3])], &SPREAD[..4]);
        }
        chart.volume()
    };
    let mut scenes = Vec::new();
    let wide = chart(&|_, [x, y]| DVec2::new(f64::from(x), f64::from(y)) * 0.25);
    let ulp = |is_single: bool, ulps: i32| {
        move |at: DVec3, [x, y]: [i32; 2]| {
            DVec2::new(nudged(at.x, x * ulps, is_single) - at.x, nudged(at.y, y * ulps, is_single) - at.y)
        }
    };
    let tiny = [
        ("a quarter aside".to_owned(), wide),
        ("a thousandth aside".to_owned(), chart(&|_, [x, y]| DVec2::new(f64::from(x), f64::from(y)) * 1e-3)),
        ("1 ulp of 32 bits aside".to_owned(), chart(&ulp(true, 1))),
        ("1 ulp aside".to_owned(), chart(&ulp(false, 1))),
    ];
    for (place, volume) in tiny {
        let scene = lively(&down(PLACE, 7.1), [62, 62], RANGE, 0.7);
        scenes.push(HardScene::partition(place, volume, scene));
    }
    scenes
}
