//! Whole numbers against the functions in f64, and faces in the right order.

use glam::DVec3;
use tetrascope_mesh::{CellId, FaceAdjacency, VertexId};
use tetrascope_order::{Budget, Cells, Power, misordered_faces};
use tetrascope_view::Viewpoint;

use crate::power_functions::{NotResolved, PowerFrame, PowerFunctions};
use crate::testing::Numbers;

pub(crate) struct Mesh {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) tetrahedra: Vec<[VertexId; 4]>,
}

impl Mesh {
    /// n³ cubes of five tetrahedra each, mirrored from cube to cube, about the origin; points off their places by so much of a side.
    pub(crate) fn new(n: u32, off: f64, numbers: &mut Numbers) -> Self {
        let side = n + 1;
        let point = |[x, y, z]: [u32; 3]| VertexId((z * side + y) * side + x);
        let mut mesh = Self { positions: Vec::new(), tetrahedra: Vec::new() };
        let places = |n: u32| (0..n * n * n).map(move |i| [i % n, i / n % n, i / n / n]);
        for place in places(side) {
            let random = DVec3::from_array([(); 3].map(|()| numbers.unit() - 0.5));
            let place = DVec3::from_array(place.map(f64::from)) + random * off;
            mesh.positions.push(place / f64::from(n) - 0.5);
        }
        for place in places(n) {
            let odd = (place.iter().sum::<u32>() % 2) as usize * 7;
            let corner = |c: usize| point(std::array::from_fn(|axis| place[axis] + (c >> axis & 1) as u32));
            let five = [[0, 3, 5, 6], [1, 0, 3, 5], [2, 0, 3, 6], [4, 0, 5, 6], [7, 3, 5, 6]];
            mesh.tetrahedra.extend(five.map(|cell: [usize; 4]| cell.map(|c| corner(c ^ odd))));
        }
        mesh
    }

    pub(crate) fn cells(&self) -> Cells<'_> {
        Cells { positions: &self.positions, tetrahedra: &self.tetrahedra }
    }

    pub(crate) fn functions(&self) -> (Power, Result<PowerFunctions, NotResolved>) {
        let adjacency = FaceAdjacency::new(&self.tetrahedra);
        let power = Power::with_adjacency(self.cells(), &adjacency, Budget::default());
        let functions = PowerFunctions::new(&power, self.cells(), &adjacency);
        (power, functions)
    }
}

/// As the shader has it, in 128 bits.
pub(crate) fn key(functions: &PowerFunctions, frame: &PowerFrame, cell: usize) -> u64 {
    let [a, b] = [functions.words[2 * cell], functions.words[2 * cell + 1]];
    let whole = |low: u32, high: u32| i128::from((u64::from(high) << 32 | u64::from(low)) as i64);
    let gradient = [whole(a[0], a[1]), whole(a[2], a[3]), whole(b[0], b[1])];
    let view = &frame.view;
    let mut value: i128 = gradient.iter().zip(view.axis).map(|(g, axis)| g * i128::from(axis)).sum();
    value += (whole(b[2], b[3]) << view.constant_shift) * i128::from(view.has_constant);
    let lowest =
        i128::from(view.lowest[2] as i32) << 64 | i128::from(view.lowest[1]) << 32 | i128::from(view.lowest[0]);
    assert!(value >= lowest);
    let key = (value - lowest) >> view.drop;
    assert!(key >> frame.bits == 0, "{key} has more than {} bits", frame.bits);
    key as u64
}

/// Inside, around, far away, farther than whole numbers reach, and along directions.
pub(crate) fn viewpoints(numbers: &mut Numbers) -> Vec<Viewpoint> {
    let mut viewpoints = Vec::new();
    for far in [0.5, 2.0, 30.0, 1e6, 1e12, 1e40] {
        for _ in 0..4 {
            let place = DVec3::from_array([(); 3].map(|()| 2.0 * numbers.unit() - 1.0));
            viewpoints.push(Viewpoint::Eye(place * far));
        }
    }
    for _ in 0..4 {
        let along = DVec3::from_array([(); 3].map(|()| 2.0 * numbers.unit() - 1.0));
        viewpoints.push(Viewpoint::Direction(along.normalize()));
    }
    viewpoints.extend([Viewpoint::Eye(DVec3::ZERO), Viewpoint::Direction(DVec3::Z)]);
    viewpoints
}

#[test]
fn faces_come_in_the_right_order() {
    let mut numbers = Numbers::new(10);
    for off in [0.0, 0.2] {
        let mesh = Mesh::new(8, off, &mut numbers);
        let (_, functions) = mesh.functions();
        let functions = functions.unwrap();
        let mut most_bits = 0;
        let generic = viewpoints(&mut numbers).into_iter().take(28);
        for viewpoint in generic {
            let frame = functions.view(viewpoint).unwrap();
            most_bits = most_bits.max(frame.bits);
            let mut order: Vec<CellId> = (0..mesh.tetrahedra.len() as u32).map(CellId).collect();
            order.sort_by_key(|cell| key(&functions, &frame, cell.index()));
            assert_eq!(misordered_faces(mesh.cells(), viewpoint, &order), 0, "{viewpoint:?}");
        }
        println!("off {off}: {most_bits} bits");
        assert!(most_bits <= 56, "{most_bits} bits");
    }
}

/// Thin cells have steep functions: whether the common scale still tells all faces apart is said, and then true.
#[test]
fn thin_cells_are_refused_or_right() {
    let mut numbers = Numbers::new(11);
    for exponent in 0..14 {
        let mut mesh = Mesh::new(4, 0.2, &mut numbers);
        let thin = 10.0_f64.powi(-exponent);
        mesh.positions.iter_mut().for_each(|p| p.x *= thin);
        let (power, functions) = mesh.functions();
        println!("1e-{exponent}: {:?}, {:?}", functions.as_ref().map(|f| f.words.len()), power.certificate());
        let Ok(functions) = functions else { continue };
        for _ in 0..10 {
            let eye = DVec3::from_array([(); 3].map(|()| 2.0 * numbers.unit() - 1.0));
            let frame = functions.view(Viewpoint::Eye(eye)).unwrap();
            let mut order: Vec<CellId> = (0..mesh.tetrahedra.len() as u32).map(CellId).collect();
            order.sort_by_key(|cell| key(&functions, &frame, cell.index()));
            assert_eq!(misordered_faces(mesh.cells(), Viewpoint::Eye(eye), &order), 0, "{eye}");
        }
    }
}

#[test]
fn what_is_not_proven_is_refused() {
    let mesh = Mesh::new(2, 0.0, &mut Numbers::new(12));
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let flat = Power::with_heights(mesh.cells(), &adjacency, &[]);
    assert_eq!(PowerFunctions::new(&flat, mesh.cells(), &adjacency).unwrap_err(), NotResolved::NotExact);
    // Cells of a cube differ by a part in 10¹³ of what others differ by: f64 proves it, and whole numbers have lost it.
    let nearly = |p: &DVec3| {
        let place = ((*p + 0.5) * 2.0).round();
        p.length_squared() + 1e-13 * (place.element_sum() % 2.0)
    };
    let heights: Vec<f64> = mesh.positions.iter().map(nearly).collect();
    let power = Power::with_heights(mesh.cells(), &adjacency, &heights);
    assert!(power.certificate().is_exact());
    let refused = PowerFunctions::new(&power, mesh.cells(), &adjacency).unwrap_err();
    assert_eq!(refused, NotResolved::Faces { faces: 4 * 8 });
}

/// No cell, one cell, an eye that is no number.
#[test]
fn little_is_ordered_too() {
    let all = Mesh::new(1, 0.0, &mut Numbers::new(13));
    for count in [0, 1] {
        let mesh = Mesh { positions: all.positions.clone(), tetrahedra: all.tetrahedra[..count].to_vec() };
        let functions = mesh.functions().1.unwrap();
        for viewpoint in viewpoints(&mut Numbers::new(14)) {
            let frame = functions.view(viewpoint).unwrap();
            assert!((0..count).all(|cell| key(&functions, &frame, cell) >> 32 >> frame.bits.saturating_sub(32) == 0));
        }
        assert!(functions.view(Viewpoint::Eye(DVec3::NAN)).is_none());
    }
}
