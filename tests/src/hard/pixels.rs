//! Hard cases of pixels: rays along what cells share, and meshes in line with the pixels.

use glam::{DVec2, DVec3};
use tetrascope::mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset, StructuredBlock, UnstructuredCells};
use tetrascope::{Camera, Projection, Volume};

use super::case::{Group, HardCase, HardScene, Truth};
use super::views::{Pieces, down, down_from, lively, oriented};

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, text, scenes| HardCase { name, group: Group::Pixels, text, scenes };
    vec![
        case(
            "rays-through-vertices",
            "Every vertex of the mesh projects into the middle of a pixel: the ray meets up to 24 cells in one point, and each \
             decides with rounded numbers whether it is hit. All may say no, and the pixel is dark, or several yes, and it is too \
             dense. Here two cells of a face decide from the same plane with opposite signs; what a cell loses at a vertex another \
             has, or it is a chord of rounding.",
            rays_through_vertices,
        ),
        case(
            "rays-along-edges",
            "Rays run along upright edges of 3 to 6 cells, in parallel and from an eye above or on the edge: each of the cells has \
             the ray in its boundary for all of its length. Without a rule the edge is drawn by none or by all of them. The rule \
             for rays in a face, to the right and then down, leaves exactly one.",
            rays_along_edges,
        ),
        case(
            "rays-in-faces",
            "Upright faces, inner ones and two of the boundary, lie in the middles of columns of pixels. A ray in an inner face \
             belongs to one of its two cells. A ray in the boundary belongs to the mesh or not by the same rule, so that two meshes \
             side by side share it out as two cells do.",
            rays_in_faces,
        ),
        case(
            "grid-of-five-in-line-with-pixels",
            "A structured grid, five tetrahedra a cube, seen straight down each axis, with centers of pixels on its lines and \
             between them, in parallel, in perspective and from a vertex inside. Rays run in faces and along edges of whole columns \
             of cells; renderers are known to leave those pixels dark. The chord of the box is known for every pixel, and none is \
             off by more than 2e-6 of it in any of the four ways.",
            || grids(&structured),
        ),
        case(
            "grid-of-six-in-line-with-pixels",
            "The same as hexahedra of six tetrahedra, which share the cube's diagonal: seen straight down, the six are of classes 3 \
             and 4, and no cell is in general position.",
            || grids(&hexahedra),
        ),
    ]
}

/// Cells a side.
const SIDE: usize = 4;
/// Half the length of a side; cells are cubes of size 1 about the origin.
const HALF: f64 = 0.5 * SIDE as f64;

fn points() -> Vec<DVec3> {
    let side = SIDE + 1;
    (0..side.pow(3))
        .map(|i| DVec3::new((i % side) as f64, (i / side % side) as f64, (i / side / side) as f64) - HALF)
        .collect()
}

fn field() -> DataArray {
    let scalar = |p: DVec3| (1.1 * p.x + 0.3).sin() * (0.9 * p.y - 0.2).cos() + 0.6 * (1.3 * p.z + 0.4 * p.x).sin();
    let values = ArrayValues::F64(points().into_iter().map(scalar).collect());
    DataArray { name: "field".to_owned(), components: 1, values }
}

fn volume(cells: Cells) -> Volume {
    let dataset = Dataset { points: points(), cells, point_arrays: vec![field()], cell_arrays: Vec::new() };
    Volume::from_dataset(dataset, "hard case").expect("a grid has cells")
}

/// A structured grid, five tetrahedra a cube, seen straight down each axis, with centers of pixels on its lines and between them, in
/// parallel, in perspective and from a vertex inside. Rays run in faces and along edges of whole columns of cells; renderers are known
/// to leave those pixels dark. The chord of the box is known for every pixel, and none is off by more than 2e-6 of it in any of the
/// four ways.
fn structured() -> Volume {
    volume(Cells::Structured(vec![StructuredBlock { dims: [SIDE + 1; 3], first_point: 0, hidden_points: Vec::new() }]))
}

/// The same as hexahedra of six tetrahedra, which share the cube's diagonal: seen straight down, the six are of classes 3 and 4, and no
/// cell is in general position.
fn hexahedra() -> Volume {
    let side = SIDE + 1;
    let mut connectivity = Vec::new();
    for cell in 0..SIDE.pow(3) {
        let lowest = cell % SIDE + side * (cell / SIDE % SIDE + side * (cell / SIDE / SIDE));
        let offsets = [0, 1, 1 + side, side].map(|at| lowest + at);
        connectivity.extend(offsets.into_iter().chain(offsets.map(|at| at + side * side)).map(|at| at as u32));
    }
    volume(Cells::Unstructured(UnstructuredCells {
        kinds: vec![CellKind::Hexahedron; SIDE.pow(3)],
        offsets: (0..=SIDE.pow(3)).map(|cell| 8 * cell).collect(),
        connectivity,
        polyhedra: Vec::new(),
    }))
}

/// The outline of the grid in triangles whose edges no ray of these views meets but at the silhouette: each side is cut from a point in nothing's line.
fn outline() -> Vec<[DVec3; 3]> {
    let aside = DVec2::new(0.21371, 0.33119);
    let corners = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(|p| DVec2::from(p) * HALF);
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [-HALF, HALF] {
            let at = |p: DVec2| {
                let mut point = DVec3::ZERO;
                (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) = (side, p.x, p.y);
                point
            };
            for i in 0..4 {
                let [a, b] = if side > 0.0 { [i, (i + 1) % 4] } else { [(i + 1) % 4, i] };
                triangles.push([at(aside), at(corners[a]), at(corners[b])]);
            }
        }
    }
    triangles
}

const RANGE: [f64; 2] = [-1.6, 1.6];

fn grid_scene(place: String, volume: Volume, camera: &Camera, size: [u32; 2]) -> HardScene {
    HardScene::new(place, volume, lively(camera, size, RANGE, 2.0), Truth::Outline(outline()))
}

/// Down each axis: pixel centers on the grid's lines and between, in parallel and in perspective, from outside and from a vertex inside.
fn grids(grid: &dyn Fn() -> Volume) -> Vec<HardScene> {
    let mut scenes = Vec::new();
    for (axis, name, up) in [(DVec3::Z, "z", DVec3::Y), (DVec3::X, "x", DVec3::Z), (DVec3::Y, "y", DVec3::X)] {
        let camera = |distance: f64, projection| Camera {
            eye: axis * distance,
            target: axis * (distance - 1.0),
            up,
            projection,
        };
        // Odd numbers of pixels: centers at multiples of a pixel from the middle; eight pixels a cell.
        // All of it down one axis, and rays in the grid's faces down the others.
        let is_first = axis == DVec3::Z;
        for (place, side) in
            [("on the lines", 33), ("between the lines", 34)].into_iter().take(1 + usize::from(is_first))
        {
            let projection = Projection::Orthographic { height: f64::from(side) / 8.0 };
            scenes.push(grid_scene(
                format!("down {name}, pixels {place}"),
                grid(),
                &camera(6.0, projection),
                [side; 2],
            ));
        }
        // Slopes are multiples of a sixteenth: rays meet vertices of the layers at depths of 4, 5, 6, 7 and 8.
        let views = [("outside", 6.0, 33), ("outside, between the lines", 6.0, 32), ("a vertex inside", 1.0, 33)];
        for (place, distance, side) in views.into_iter().filter(|_| is_first) {
            let per_pixel = if distance > 2.0 { 1.0 / 32.0 } else { 1.0 / 16.0 };
            let projection = Projection::Perspective { fov_y: 2.0 * (0.5 * per_pixel * f64::from(side)).atan() };
            let place = format!("down {name}, in perspective from {place}");
            scenes.push(grid_scene(place, grid(), &camera(distance, projection), [side; 2]));
        }
    }
    scenes
}

fn rays_through_vertices() -> Vec<HardScene> {
    // A lattice of points, those of each layer moved by whole pixels of 1/8: every vertex is in the middle of a pixel.
    let mut shape = Pieces::default();
    let side = SIDE + 1;
    let shifts = [[0., 0.], [0.25, -0.125], [-0.125, 0.25], [0.125, 0.125], [0., -0.25]].map(DVec2::from);
    let mut points = points();
    for (i, point) in points.iter_mut().enumerate() {
        let layer = i / side / side;
        let bump = 0.125 * ((i * 7 % 5) as f64 - 2.0);
        let is_inner = point.x.abs() < HALF && point.y.abs() < HALF && point.z.abs() < HALF;
        *point += shifts[layer].extend(0.0) + if is_inner { DVec3::new(bump, -bump, 0.5 * bump) } else { DVec3::ZERO };
    }
    let scalars = field().values.to_f64();
    let cells = hexahedra();
    let mesh = &cells.decomposition.mesh;
    let tetrahedra: Vec<[u32; 4]> = mesh.tetrahedra().iter().map(|cell| oriented(&points, cell.map(|v| v.0))).collect();
    shape.add(&points, &tetrahedra, &scalars);
    let scene = |place: &str, camera: &Camera, size| {
        HardScene::partition(place, shape.volume(), lively(camera, size, RANGE, 2.0))
    };
    vec![
        scene("in parallel", &down(DVec3::ZERO, 41.0 / 8.0), [41, 41]),
        scene("in perspective, the eye over a vertex", &down_from(DVec3::new(0.25, 0.25, 6.0), 41.0 / 32.0), [41, 41]),
    ]
}

fn rays_along_edges() -> Vec<HardScene> {
    let mut posts = Pieces::default();
    for place in 0..4 {
        let at = DVec3::new(1.5 * f64::from(place % 2) - 0.75, 1.5 * f64::from(place / 2) - 0.75, 0.0);
        let mut points = vec![at + DVec3::Z, at, at - DVec3::Z];
        let count = 3 + place as u32;
        for i in 0..count {
            let turn = std::f64::consts::TAU * f64::from(i) / f64::from(count) + 0.4;
            points.push(at + DVec3::new(0.7 * turn.cos(), 0.7 * turn.sin(), 0.2 * turn.sin()));
        }
        let mut cells = Vec::new();
        for i in 0..count {
            let [p, q] = [3 + i, 3 + (i + 1) % count];
            cells.extend([[0, 1, p, q], [1, 2, p, q]].map(|cell| oriented(&points, cell)));
        }
        let scalars: Vec<f64> = (0..points.len()).map(|i| (0.37 * i as f64 + 0.1 * f64::from(place)).fract()).collect();
        posts.add(&points, &cells, &scalars);
    }
    let scene = |place: &str, camera: &Camera, size| {
        HardScene::partition(place, posts.volume(), lively(camera, size, [0.0, 1.0], 0.7))
    };
    // Centers of pixels are multiples of a sixteenth from the middle, and so are the posts.
    vec![
        scene("in parallel", &down(DVec3::ZERO, 53.0 / 16.0), [53, 53]),
        scene("in perspective, the eye over a post", &down_from(DVec3::new(0.75, 0.75, 4.0), 1.0), [49, 49]),
        scene("in perspective, the eye in a post", &down_from(DVec3::new(0.75, 0.75, 0.0), 3.0), [33, 33]),
    ]
}

fn rays_in_faces() -> Vec<HardScene> {
    let mut walls = Pieces::default();
    // Prisms of three cells between planes x = -1, -0.5, .. 1; their upper and lower sides are oblique.
    let section = |i: u32| {
        let x = -1.0 + 0.5 * f64::from(i);
        [[x, -1.0, 0.1 * x], [x, 1.0, -0.5], [x, 0.25, 0.8 - 0.2 * x]].map(DVec3::from)
    };
    let points: Vec<DVec3> = (0..5).flat_map(section).collect();
    let cells: Vec<[u32; 4]> = (0..4_u32)
        .flat_map(|i| [[0, 1, 2, 3], [1, 2, 3, 4], [2, 3, 4, 5]].map(|cell| cell.map(|corner| corner + 3 * i)))
        .map(|cell| oriented(&points, cell))
        .collect();
    let scalars: Vec<f64> = points.iter().map(|p| 0.5 + 0.3 * (2.0 * p.x + p.y).sin() + 0.2 * p.z).collect();
    walls.add(&points, &cells, &scalars);
    let scene = |place: &str, camera: &Camera, size| {
        HardScene::partition(place, walls.volume(), lively(camera, size, [0.0, 1.0], 0.5))
    };
    vec![
        scene("in parallel", &down(DVec3::ZERO, 41.0 / 16.0), [41, 41]),
        scene("in perspective, the eye over a face", &down_from(DVec3::new(0.5, 0.0, 4.0), 0.75), [49, 49]),
        scene("in perspective, the eye in a face", &down_from(DVec3::new(0.5, 0.0, 0.0), 3.0), [33, 33]),
        scene(
            "in perspective, the eye over a face of the boundary",
            &down_from(DVec3::new(1.0, 0.0, 4.0), 1.0),
            [49, 49],
        ),
    ]
}
