//! Hard cases of classification: silhouettes between two classes, and cells that hardly have one.

mod shapes;
mod table;

use glam::DVec3;

use super::case::{Group, HardCase, HardScene};
use super::views::{Pieces, ULPS, down, down_from, lively, look, nudged, oriented};
use shapes::{caps, coincident_points, inverted_cells, needles, slivers};
use table::{crossing_at_the_ends, entries_of_the_table, impossible_entries, thick_vertex_between_parallel_edges};

pub use table::{cells_of_the_table, impossible_cells};

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, text, scenes| HardCase { name, group: Group::Classification, text, scenes };
    vec![
        case(
            "vertex-on-an-edge",
            "A corner of a cell lies on an edge of its outline, exactly or within 1 to 1000 ulp of 64 and of 32 bits: the cell is \
             of class 3, or just not. Methods that look a fan up by rounded signs take another class than the neighbor does, and a \
             crack opens between two fans. Here each face is evaluated from its own corners in one order, so that both of its cells \
             see the same volume with opposite signs, bit for bit, and the thick vertex is a mean over corners of one sign, which \
             changes continuously from class to class. Pixels are drawn by the planes of the faces, which need no class at all.",
            vertex_on_an_edge,
        ),
        case(
            "vertex-on-a-vertex",
            "Two corners lie on one another, so that the edge between them is a point on the screen: class 4, of one triangle. All \
             cells about that edge have their largest chord there, and two faces each that are seen edge-on; a division by the area \
             of such a face has no digits. Here a ray that runs in a face is moved a little to the right and, by far less, down, in \
             every cell alike, so that exactly one of the cells about the edge has it.",
            vertex_on_a_vertex,
        ),
        case(
            "four-corners-on-a-line",
            "All four corners of a cell project onto a line: it is flat and upright, between good cells. A flat cell has a chord of \
             0 divided by 0. A cell of exactly no volume is left out when the mesh is made, and the user is told how many; one that \
             is 1 to 1000 ulp thick is drawn like any other, and what it has goes to 0 with its thickness. Its neighbors keep their \
             own faces, so that no pixel of the line is dark or drawn twice.",
            four_corners_on_a_line,
        ),
        case(
            "slivers",
            "Four corners near a circle, 1e-8 of its size apart: volumes are differences of nearly equal numbers, and gradients \
             quotients of them. f32 planes of such a cell have no digits left. Cells whose planes are too steep for f32 are drawn \
             in f64 on the CPU and in integers on a GPU, and scalars are kept within the range of the corners. A GPU's coordinates \
             are integers of 2^-29 of about the mesh's size: between neighbors that costs nothing, as they share corners, but a \
             sliver alone is a few steps thick and drawn too thick or too thin by as much as it is; the CPU draws it within 1e-5.",
            slivers,
        ),
        case(
            "needles",
            "A cell whose one side is 1e-8 of its length, seen from aside and along its axis. On the screen it is thinner than a \
             pixel from most sides, and along the axis all its length lies in a region of 1e-8. Methods with snapped or rounded \
             screen positions lose it there. Here its planes are relative to a point inside, and steep ones are kept in f64; on a \
             GPU the needle alone is a few steps of its lattice thick, and between neighbors it is right.",
            needles,
        ),
        case(
            "caps",
            "A corner 1e-8 above the middle of the opposite face: three faces lie nearly in the plane of the fourth, and seen flat \
             the thick vertex has a chord of 1e-8. As a difference of two depths that chord has no digits in f32. Here it is a \
             quotient of volumes of one sign, and per pixel a difference of nearnesses relative to a point in the cell. A cap alone \
             on a GPU is as thick as its lattice has it.",
            caps,
        ),
        case(
            "coincident-points",
            "A block is cut along its cells: every point of the cut is there twice, with flat cells between the two. Programs that \
             find neighbors by point numbers see a boundary inside, and the flat cells divide by 0. Flat cells are left out with a \
             warning that counts them, and the two sides are drawn like any boundary: their faces have the same coordinates, so \
             that they neither overlap nor leave a gap.",
            coincident_points,
        ),
        case(
            "inverted-cells",
            "Every second cell, or every cell, is given inside out, with a negative volume. A table of classes takes the front of \
             such a cell for its back: light runs backwards or opacity is negative. Cells are turned round when the mesh is made, \
             which the user is told, and the pictures are those of the upright mesh in every bit, in all four ways.",
            inverted_cells,
        ),
        case(
            "entries-of-the-table",
            "One cell for each of the 50 entries of the table of 81 that points can have: 8 of class 1, 6 of class 2, 24 of class \
             3, 12 of class 4. The table is not typed in but generated from the signs, and a test holds it against a second \
             generator, drawn shapes under all relabelings. A typed-in table with one wrong row shows in few pictures; here each \
             row is one cell of the chart, held against its exact chords.",
            entries_of_the_table,
        ),
        case(
            "impossible-entries",
            "Cross products of four points add up to zero, so that 30 entries of the table cannot happen; rounding happens to them \
             all where four corners lie nearly on a line. A program with nothing in those rows, or an assertion, draws rubbish or \
             stops. In the table here they are an entry of their own that has no fan. Signs without rounding never give one, and \
             cells whose rounded signs do cover less than 1e-15 of area. No back end asks the table: pixels are drawn by planes. \
             The cells of this scene stand like hairs on a cube, one for each of the 30 entries.",
            impossible_entries,
        ),
        case(
            "thick-vertex-between-parallel-edges",
            "Two edges over one another at an angle from a tenth to 1e-12: the thick vertex is where they cross, and the textbook's \
             intersection of two lines divides two numbers near zero. Here it is the mean of the front corners weighted by volumes \
             of one sign; nothing cancels, and a test holds it to the ulp of the coordinates over the angle, which is what the data \
             itself knows. Where the eye comes near a face, one of the two sums goes to zero: the chord is known as well as the \
             eye's height over the face is, to 1e-9 of itself at 1e-7. A GPU's lattice ends at angles of about 1e-6, seen from as \
             near as the silhouette is wide.",
            thick_vertex_between_parallel_edges,
        ),
        case(
            "crossing-at-the-ends",
            "The crossing of class 2 lies at the ends of both edges: a step to any side makes it class 1, 2, 3 or 4, as around each \
             cell of this chart, with steps from a quarter down to one ulp. Where classes are computed by formulas of their own, \
             the thick vertex jumps or divides by a vanishing length. Here one formula holds in all classes: thick vertex and chord \
             change by no more than eight times the step, down to 1e-17.",
            crossing_at_the_ends,
        ),
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
