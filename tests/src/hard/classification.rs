//! Hard cases of classification: silhouettes between two classes, and cells that hardly have one.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use tetrascope::classify::{Sign, TRUTH_TABLE, TableEntry, Tests};
use tetrascope::{Camera, Projection};

use super::case::{Group, HardCase, HardScene};
use super::views::{Pieces, ULPS, down, down_from, lively, look, nudged, oriented, volume};
use crate::meshes::{Random, Tets};

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, scenes| HardCase { name, group: Group::Classification, scenes };
    vec![
        case("vertex-on-an-edge", vertex_on_an_edge),
        case("vertex-on-a-vertex", vertex_on_a_vertex),
        case("four-corners-on-a-line", four_corners_on_a_line),
        case("slivers", slivers),
        case("needles", needles),
        case("caps", caps),
        case("coincident-points", coincident_points),
        case("inverted-cells", inverted_cells),
        case("entries-of-the-table", entries_of_the_table),
        case("impossible-entries", impossible_entries),
        case("thick-vertex-between-parallel-edges", thick_vertex_between_parallel_edges),
        case("crossing-at-the-ends", crossing_at_the_ends),
    ]
}

/// Where pieces stand: coordinates of few digits, so that directions from the eye are exact, and not 0, so that they have units in the last place.
const PLACE: DVec3 = DVec3::new(1.375, 3.125, 0.0);
const RANGE: [f64; 2] = [0.0, 1.0];

/// Cells around an edge, seen so that two of their corners lie on it: class 3. The upper one is moved across by some ulp.
fn around_an_edge(place: DVec3, ulps: i32, is_single: bool) -> ([DVec3; 6], [[u32; 4]; 4]) {
    let mut points = [
        [-1.25, 0., 0.],
        [1.25, 0., 0.],
        [0.25, 0., 1.5],
        [-0.25, 0., -1.25],
        [0.25, 1.25, 0.25],
        [-0.125, -1.25, -0.125],
    ]
    .map(|p| place + DVec3::from(p));
    points[2].y = nudged(points[2].y, ulps, is_single);
    (points, [[0, 1, 2, 4], [0, 1, 4, 3], [0, 1, 3, 5], [0, 1, 5, 2]])
}

/// Scalars that make every cell many-colored.
const SPREAD: [f64; 8] = [0.0, 1.0, 0.55, 0.3, 0.8, 0.15, 0.65, 0.4];

/// A corner of a cell lies on an edge of its outline, exactly or within 1 to 1000 ulp of 64 and of 32 bits: the cell is of class 3, or
/// just not. Methods that look a fan up by rounded signs take another class than the neighbor does, and a crack opens between two fans.
/// Here each face is evaluated from its own corners in one order, so that both of its cells see the same volume with opposite signs,
/// bit for bit, and the thick vertex is a mean over corners of one sign, which changes continuously from class to class. Pixels are
/// drawn by the planes of the faces, which need no class at all.
fn vertex_on_an_edge() -> Vec<HardScene> {
    let mut scenes = Vec::new();
    let mut whole = Pieces::default();
    let (points, cells) = around_an_edge(PLACE, 0, false);
    whole.add(&points, &cells.map(|cell| oriented(&points, cell)), &SPREAD[..6]);
    for (place, camera, size) in [
        ("exactly, in perspective", down_from(PLACE + 6.0 * DVec3::Z, 0.5), [48, 46]),
        ("exactly, rays in the faces", down(PLACE, 2.75), [33, 33]),
    ] {
        scenes.push(HardScene::partition(place, whole.volume(), lively(&camera, size, RANGE, 1.0)));
    }
    for (is_single, unit) in [(false, "ulp"), (true, "ulp of 32 bits")] {
        let mut row = Pieces::default();
        for (i, ulps) in ULPS.into_iter().enumerate() {
            let (points, cells) = around_an_edge(PLACE + DVec3::X * (2.75 * (i as f64 - 4.5)), ulps, is_single);
            row.add(&points, &cells.map(|cell| oriented(&points, cell)), &SPREAD[..6]);
        }
        let (place, camera) = if is_single {
            ("in parallel", down(PLACE, 3.0))
        } else {
            ("in perspective", down_from(PLACE + 16.0 * DVec3::Z, 0.1875))
        };
        let place = format!("1 to 1000 {unit} beside, {place}");
        scenes.push(HardScene::partition(place, row.volume(), lively(&camera, [150, 16], RANGE, 1.0)));
    }
    scenes
}

/// Cells around an edge that runs along the ray of the eye (or down, without one), so that one of its ends lies behind the other: class 4.
fn along_the_ray(at: DVec3, eye: Option<DVec3>, [x, y]: [i32; 2], is_single: bool) -> ([DVec3; 7], Vec<[u32; 4]>) {
    let mut top = at + DVec3::Z * 1.5;
    // Half as deep again: exact for coordinates of few digits.
    let bottom = eye.map_or(at - DVec3::Z * 1.5, |eye| top + (top - eye) * 0.5);
    (top.x, top.y) = (nudged(top.x, x, is_single), nudged(top.y, y, is_single));
    let ring = [[1.25, 0.0], [0.375, 1.25], [-1.0, 0.75], [-1.0, -0.75], [0.375, -1.25]];
    let middle = eye.map_or(at, |_| top.lerp(bottom, 0.5));
    let [a, b, c, d, e] = ring.map(|[x, y]| middle + DVec3::new(x, y, 0.25 * x));
    ([top, bottom, a, b, c, d, e], (0..5_u32).map(|i| [0, 1, 2 + i, 2 + (i + 1) % 5]).collect())
}

/// Two corners lie on one another, so that the edge between them is a point on the screen: class 4, of one triangle. All cells about
/// that edge have their largest chord there, and two faces each that are seen edge-on; a division by the area of such a face has no
/// digits. Here a ray that runs in a face is moved a little to the right and, by far less, down, in every cell alike, so that exactly
/// one of the cells about the edge has it.
fn vertex_on_a_vertex() -> Vec<HardScene> {
    let mut scenes = Vec::new();
    let add = |pieces: &mut Pieces, at, eye, slip, is_single| {
        let (points, cells) = along_the_ray(at, eye, slip, is_single);
        let cells: Vec<_> = cells.into_iter().map(|cell| oriented(&points, cell)).collect();
        pieces.add(&points, &cells, &SPREAD[..7]);
    };
    let eye = PLACE + 6.0 * DVec3::Z;
    for (place, eye, camera, size) in [
        ("exactly, in perspective", Some(eye), down_from(eye, 0.4375), [48, 46]),
        ("exactly, rays along the edge", None, down(PLACE, 2.75), [33, 33]),
    ] {
        let mut whole = Pieces::default();
        add(&mut whole, PLACE, eye, [0, 0], false);
        scenes.push(HardScene::partition(place, whole.volume(), lively(&camera, size, RANGE, 1.0)));
    }
    let eye = PLACE + 16.0 * DVec3::Z;
    for (is_single, unit) in [(false, "ulp"), (true, "ulp of 32 bits")] {
        let (place, eye, camera) = if is_single {
            ("in perspective", Some(eye), down_from(eye, 0.4375))
        } else {
            ("in parallel", None, down(PLACE, 5.75))
        };
        {
            let mut rows = Pieces::default();
            for (i, ulps) in ULPS.into_iter().enumerate() {
                let (column, row) = (i % 5, i / 5);
                let at = PLACE + DVec3::new(2.75 * (column as f64 - 2.0), 2.75 * (row as f64 - 0.5), 0.0);
                // Towards all quarters.
                add(&mut rows, at, eye, [ulps, if i % 2 == 0 { ulps } else { -ulps }], is_single);
            }
            let place = format!("1 to 1000 {unit} beside, {place}");
            scenes.push(HardScene::partition(place, rows.volume(), lively(&camera, [70, 28], RANGE, 1.0)));
        }
    }
    scenes
}

/// A flat cell upright in the plane of the eye, between two cells on each side. `lift` moves one of its corners out of the plane; the cells
/// are joined such that the flat one fills what is between, to whichever side it goes.
fn upright(place: DVec3, lift: impl Fn(f64) -> f64) -> ([DVec3; 6], [[u32; 4]; 5]) {
    let mut points =
        [[-1., 0., 1.], [1., 0., -1.], [-0.75, 0., -1.], [1., 0., 0.75], [0.25, 1.25, 0.25], [-0.25, -1.25, 0.]]
            .map(|p| place + DVec3::from(p));
    points[1].y = lift(points[1].y);
    let [left, right] = if points[1].y < place.y { [5, 4] } else { [4, 5] };
    let [a, b, d, e] =
        [[0, 1, 2, left], [0, 1, 3, left], [2, 3, 0, right], [2, 3, 1, right]].map(|cell| oriented(&points, cell));
    (points, [a, b, oriented(&points, [0, 1, 2, 3]), d, e])
}

/// All four corners of a cell project onto a line: it is flat and upright, between good cells. A flat cell has a chord of 0 divided by
/// 0. A cell of exactly no volume is left out when the mesh is made, and the user is told how many; one that is 1 to 1000 ulp thick is
/// drawn like any other, and what it has goes to 0 with its thickness. Its neighbors keep their own faces, so that no pixel of the line
/// is dark or drawn twice.
fn four_corners_on_a_line() -> Vec<HardScene> {
    let mut scenes = Vec::new();
    let mut whole = Pieces::default();
    let (points, cells) = upright(PLACE, |y| y);
    whole.add(&points, &cells, &SPREAD[..6]);
    for (place, camera, size) in [
        ("exactly, in perspective", down_from(PLACE + 6.0 * DVec3::Z, 0.4375), [48, 46]),
        ("exactly, rays in the faces", down(PLACE, 2.7), [33, 33]),
    ] {
        let scene = HardScene::partition(place, whole.volume(), lively(&camera, size, RANGE, 1.0));
        scenes.push(HardScene { says: Some("1 of 5 tetrahedra have no volume"), ..scene });
    }
    for (is_single, unit) in [(false, "ulp"), (true, "ulp of 32 bits")] {
        let mut row = Pieces::default();
        for (i, ulps) in ULPS.into_iter().enumerate() {
            let place = PLACE + DVec3::X * (2.25 * (i as f64 - 4.5));
            let (points, cells) = upright(place, |y| nudged(y, ulps, is_single));
            row.add(&points, &cells, &SPREAD[..6]);
        }
        let views = if is_single {
            vec![
                ("in parallel", down(PLACE, 2.7), [130, 16]),
                ("from aside", look(PLACE + DVec3::new(6.0, 18.0, 9.0), PLACE, DVec3::Z, 20.0), [100, 32]),
            ]
        } else {
            vec![("in perspective", down_from(PLACE + 16.0 * DVec3::Z, 0.1875), [130, 16])]
        };
        for (place, camera, size) in views {
            let place = format!("1 to 1000 {unit} off the line, {place}");
            scenes.push(HardScene::partition(place, row.volume(), lively(&camera, size, RANGE, 1.0)));
        }
    }
    scenes
}

/// A block in which cells are split at points of these shares of their corners.
fn thin_in_a_block(shares: [f64; 4], seed: u64) -> HardScene {
    let mut tets = Tets::block(2, seed);
    let mut random = Random::new(seed);
    for _ in 0..20 {
        let cell = tets.cells[(random.unit() * tets.cells.len() as f64) as usize];
        // What was split is left alone: thin ones of thin ones have no volume that coordinates resolve.
        if !cell.iter().any(|&corner| corner as usize >= 27) {
            tets.split(&cell, &shares);
        }
    }
    let range = tets.range();
    let camera = look(DVec3::new(3.0, 2.5, 4.0), DVec3::new(0.1, 0.0, 0.0), DVec3::Y, 34.0);
    HardScene::partition("in a block", volume(&tets), lively(&camera, [64, 60], [range.0, range.1], 1.0))
}

/// One cell alone, with nothing beside that would make up for what it gets wrong. `length`: of an optical depth of about one.
fn alone(place: &str, corners: &[DVec3; 4], camera: &Camera, length: f64) -> HardScene {
    let mut cell = Pieces::default();
    cell.add(corners, &[oriented(corners, [0, 1, 2, 3])], &SPREAD[..4]);
    let scene = HardScene::partition(place, cell.volume(), lively(camera, [40, 39], RANGE, length));
    HardScene { beyond_gpu: Some(LATTICE), ..scene }
}

/// Coordinates on a GPU are integers: a step is 2^-29 of about the mesh's size. What is 1e-8 of the mesh thick is a few steps thick, and by as
/// much as a share of itself it is drawn too thick or too thin where it stands alone. Beside neighbors, who share its corners, nothing shows.
const LATTICE: &str = "a cell alone of a few lattice steps' thickness";

/// A parallel view across z from the side, y into the picture, as high as wide.
fn from_the_side(target: DVec3, height: f64) -> Camera {
    Camera { eye: target - 5.0 * DVec3::Y, target, up: DVec3::Z, projection: Projection::Orthographic { height } }
}

/// Height over edge of the thin cells.
const THIN: f64 = 1e-8;

/// Four corners near a circle, 1e-8 of its size apart: volumes are differences of nearly equal numbers, and gradients quotients of
/// them. f32 planes of such a cell have no digits left. Cells whose planes are too steep for f32 are drawn in f64 on the CPU and in
/// integers on a GPU, and scalars are kept within the range of the corners. A GPU's coordinates are integers of 2^-29 of about the
/// mesh's size: between neighbors that costs nothing, as they share corners, but a sliver alone is a few steps thick and drawn too
/// thick or too thin by as much as it is; the CPU draws it within 1e-5.
fn slivers() -> Vec<HardScene> {
    // Four corners near a circle, crosswise up and down.
    let corners = [[1., 0., THIN], [0., 1., -THIN], [-1., 0.1, THIN], [-0.1, -1., -THIN]].map(DVec3::from);
    let mut scenes = vec![
        thin_in_a_block([0.5 - THIN, 0.5 - THIN, THIN, THIN], 7100),
        alone("alone", &corners, &down(DVec3::ZERO, 2.5), THIN),
        alone("alone, along it", &corners, &from_the_side(DVec3::new(-0.02, 0.0, 0.0), 2.5 * THIN), 1.0),
    ];
    let (points, cells) = upright(DVec3::ZERO, |y| y + 2.0 * THIN);
    let mut pair = Pieces::default();
    pair.add(&points, &cells, &SPREAD[..6]);
    for (place, camera) in [
        ("between good cells, edge-on", down(DVec3::ZERO, 2.7)),
        ("between good cells, from aside", look(DVec3::new(1.5, 4.0, 3.0), DVec3::ZERO, DVec3::Z, 30.0)),
    ] {
        scenes.push(HardScene::partition(place, pair.volume(), lively(&camera, [33, 33], RANGE, 1.0)));
    }
    scenes
}

/// A cell whose one side is 1e-8 of its length, seen from aside and along its axis. On the screen it is thinner than a pixel from most
/// sides, and along the axis all its length lies in a region of 1e-8. Methods with snapped or rounded screen positions lose it there.
/// Here its planes are relative to a point inside, and steep ones are kept in f64; on a GPU the needle alone is a few steps of its
/// lattice thick, and between neighbors it is right.
fn needles() -> Vec<HardScene> {
    let corners = [[-1., 0., 0.], [1., THIN, 0.], [1., -0.5 * THIN, THIN], [1., -0.5 * THIN, -THIN]].map(DVec3::from);
    // Along its axis from the point, as near as it is thin.
    let axis = Camera {
        eye: DVec3::new(-5.0, 0.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Orthographic { height: 2.5 * THIN },
    };
    vec![
        thin_in_a_block([THIN, THIN, 0.4, 0.6 - 2.0 * THIN], 7200),
        alone("alone, along its axis", &corners, &axis, 1.0),
        alone("alone, across it", &corners, &from_the_side(DVec3::new(0.98, 0.0, 0.0), 2.5 * THIN), THIN),
    ]
}

/// A corner 1e-8 above the middle of the opposite face: three faces lie nearly in the plane of the fourth, and seen flat the thick
/// vertex has a chord of 1e-8. As a difference of two depths that chord has no digits in f32. Here it is a quotient of volumes of one
/// sign, and per pixel a difference of nearnesses relative to a point in the cell. A cap alone on a GPU is as thick as its lattice has
/// it.
fn caps() -> Vec<HardScene> {
    let corners = [[-1., -0.6, 0.], [1., -0.7, 0.], [0.1, 1., 0.], [0.05, -0.1, THIN]].map(DVec3::from);
    vec![
        thin_in_a_block([THIN, 0.3, 0.3, 0.4 - THIN], 7300),
        alone("alone", &corners, &down(DVec3::ZERO, 2.5), THIN),
        alone("alone, along it", &corners, &from_the_side(DVec3::new(0.03, 0.0, 0.0), 2.5 * THIN), 1.0),
    ]
}

/// A block is cut along its cells: every point of the cut is there twice, with flat cells between the two. Programs that find neighbors
/// by point numbers see a boundary inside, and the flat cells divide by 0. Flat cells are left out with a warning that counts them, and
/// the two sides are drawn like any boundary: their faces have the same coordinates, so that they neither overlap nor leave a gap.
fn coincident_points() -> Vec<HardScene> {
    let tets = Tets::block(3, 7400);
    let middle = |cell: &[u32; 4]| cell.iter().map(|&p| tets.points[p as usize].x).sum::<f64>() / 4.0;
    let is_left: Vec<bool> = tets.cells.iter().map(|cell| middle(cell) < 0.1).collect();
    let mut other = vec![None; tets.points.len()];
    let (mut points, mut scalars) = (tets.points.clone(), tets.scalars.clone());
    let mut used_left = vec![false; points.len()];
    for (cell, _) in tets.cells.iter().zip(&is_left).filter(|(_, is_left)| **is_left) {
        cell.iter().for_each(|&p| used_left[p as usize] = true);
    }
    let mut cells = Vec::new();
    for (cell, is_left) in tets.cells.iter().zip(&is_left) {
        if *is_left {
            cells.push(oriented(&tets.points, *cell));
            continue;
        }
        let moved = cell.map(|p| {
            if !used_left[p as usize] {
                return p;
            }
            *other[p as usize].get_or_insert_with(|| {
                points.push(tets.points[p as usize]);
                scalars.push(tets.scalars[p as usize]);
                points.len() as u32 - 1
            })
        });
        cells.push(oriented(&points, moved));
    }
    // Three flat cells on every face of the cut: a prism between a triangle and itself.
    let mut flat = Vec::new();
    for (cell, _) in tets.cells.iter().zip(&is_left).filter(|(_, is_left)| **is_left) {
        let shared: Vec<u32> = cell.iter().copied().filter(|&p| other[p as usize].is_some()).collect();
        if let [a, b, c] = shared[..] {
            let [d, e, f] = [a, b, c].map(|p| other[p as usize].unwrap_or(p));
            flat.extend([[a, b, c, d], [b, c, d, e], [c, d, e, f]]);
        }
    }
    cells.extend(flat);
    let range = tets.range();
    let camera = look(DVec3::new(2.0, 2.5, 4.5), DVec3::new(0.1, 0.0, 0.0), DVec3::Y, 34.0);
    let inside = look(DVec3::new(0.1, 0.05, 0.0), DVec3::new(0.2, 1.0, 0.3), DVec3::Z, 90.0);
    [("from outside", camera), ("from inside", inside)]
        .map(|(place, camera)| {
            let made = super::case::volume_of(&points, &cells, &scalars);
            let scene = lively(&camera, [56, 54], [range.0, range.1], 1.0);
            HardScene { says: Some("have no volume"), ..HardScene::partition(place, made, scene) }
        })
        .to_vec()
}

/// Every second cell, or every cell, is given inside out, with a negative volume. A table of classes takes the front of such a cell for
/// its back: light runs backwards or opacity is negative. Cells are turned round when the mesh is made, which the user is told, and the
/// pictures are those of the upright mesh in every bit, in all four ways.
fn inverted_cells() -> Vec<HardScene> {
    let mut tets = Tets::block(3, 7500);
    tets.cells = tets.cells.iter().map(|&cell| oriented(&tets.points, cell)).collect();
    let range = tets.range();
    let camera = look(DVec3::new(-2.5, 2.0, 4.0), DVec3::new(0.1, 0.0, 0.0), DVec3::Y, 36.0);
    let scene = lively(&camera, [56, 54], [range.0, range.1], 1.0);
    let upright = Arc::new(volume(&tets));
    [("every second", 2), ("all", 1), ("none", usize::MAX)]
        .map(|(place, step)| {
            let mut turned = tets.clone();
            turned.cells.iter_mut().step_by(step).for_each(|cell| cell.swap(0, 1));
            if step == usize::MAX {
                turned.cells[0].swap(0, 1);
            }
            let outline = crate::chords::boundary(&upright.decomposition.mesh);
            let scene = HardScene::new(place, volume(&turned), scene.clone(), super::Truth::Outline(outline));
            HardScene { says: (step != usize::MAX).then_some("were inverted and are turned round"), ..scene }
        })
        .to_vec()
}

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

/// One cell for each of the 50 entries of the table of 81 that points can have: 8 of class 1, 6 of class 2, 24 of class 3, 12 of class
/// 4. The table is not typed in but generated from the signs, and a test holds it against a second generator, drawn shapes under all
/// relabelings. A typed-in table with one wrong row shows in few pictures; here each row is one cell of the chart, held against its
/// exact chords.
fn entries_of_the_table() -> Vec<HardScene> {
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

/// Cross products of four points add up to zero, so that 30 entries of the table cannot happen; rounding happens to them all where four
/// corners lie nearly on a line. A program with nothing in those rows, or an assertion, draws rubbish or stops. In the table here they
/// are an entry of their own that has no fan. Signs without rounding never give one, and cells whose rounded signs do cover less than
/// 1e-15 of area. No back end asks the table: pixels are drawn by planes. The cells of this scene stand like hairs on a cube, one for
/// each of the 30 entries.
fn impossible_entries() -> Vec<HardScene> {
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

/// Two edges over one another at an angle from a tenth to 1e-12: the thick vertex is where they cross, and the textbook's intersection
/// of two lines divides two numbers near zero. Here it is the mean of the front corners weighted by volumes of one sign; nothing
/// cancels, and a test holds it to the ulp of the coordinates over the angle, which is what the data itself knows. Where the eye comes
/// near a face, one of the two sums goes to zero: the chord is known as well as the eye's height over the face is, to 1e-9 of itself at
/// 1e-7. A GPU's lattice ends at angles of about 1e-6, seen from as near as the silhouette is wide.
fn thick_vertex_between_parallel_edges() -> Vec<HardScene> {
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
    for (place, camera) in [("side by side", look(DVec3::new(1.0, -3.0, 8.0), DVec3::ZERO, DVec3::Y, 20.0))] {
        scenes.push(HardScene::partition(place, rows.volume(), lively(&camera, [96, 40], RANGE, 0.7)));
    }
    for (angle, is_perspective) in [(1e-3, false), (1e-3, true), (1e-6, false), (1e-9, true)] {
        // As near as the silhouette is wide.
        let (words, camera) = if is_perspective {
            (", in perspective", down_from(PLACE + 4.0 * DVec3::Z, 0.5 * angle))
        } else {
            ("", down(PLACE, 2.0 * angle))
        };
        let place = format!("an angle of {angle:e}, near{words}");
        let near = alone(&place, &cell(PLACE, angle), &camera, 0.5);
        // 1e-3 of the mesh is a million of a lattice's steps.
        scenes.push(HardScene { beyond_gpu: near.beyond_gpu.filter(|_| angle < 1e-4), ..near });
    }
    scenes
}

/// Two edges over one another that cross where both of them begin, and around there on all sides.
///
/// - `slip`: how far the one's begin lies from above the other's, in the plane
pub fn crossing(at: DVec3, slip: DVec2) -> [DVec3; 4] {
    [
        at + DVec3::new(0.0, 0.0, 0.75),
        at + DVec3::new(1.75, 0.25, 0.5),
        at + DVec3::new(slip.x, slip.y, -0.75),
        at + DVec3::new(0.25, 1.75, -0.5),
    ]
}

/// The crossing of class 2 lies at the ends of both edges: a step to any side makes it class 1, 2, 3 or 4, as around each cell of this
/// chart, with steps from a quarter down to one ulp. Where classes are computed by formulas of their own, the thick vertex jumps or
/// divides by a vanishing length. Here one formula holds in all classes: thick vertex and chord change by no more than eight times the
/// step, down to 1e-17.
fn crossing_at_the_ends() -> Vec<HardScene> {
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
