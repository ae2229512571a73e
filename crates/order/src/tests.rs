//! Orders are permutations, stable, and right where one number decides.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_mesh::{CellId, VertexId};
use tetrascope_view::Viewpoint;

use crate::*;

/// Small cells of one shape at the given places.
fn row(places: &[DVec3]) -> (Vec<DVec3>, Vec<[VertexId; 4]>) {
    let shape = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * 0.01);
    let points = places.iter().flat_map(|&p| shape.map(|s| s + p)).collect();
    let cells = (0..places.len() as u32).map(|c| [0, 1, 2, 3].map(|v| VertexId(4 * c + v))).collect();
    (points, cells)
}

fn all(n: usize) -> Vec<CellId> {
    (0..n as u32).map(CellId).collect()
}

const METHODS: [OrderMethod; 6] = [
    OrderMethod::None,
    OrderMethod::Bucket { slabs: 20 },
    OrderMethod::Bucket { slabs: 1 },
    OrderMethod::Bucket { slabs: u32::MAX },
    OrderMethod::Centroid,
    OrderMethod::Mpvo,
];

fn place() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0_f64).prop_map(DVec3::from)
}

proptest! {
    #[test]
    fn every_order_is_a_permutation(places in prop::collection::vec(place(), 0..200), eye in place(), parallel: bool) {
        let (points, tetrahedra) = row(&places);
        let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
        let view = if parallel { Viewpoint::Direction(DVec3::Z) } else { Viewpoint::Eye(eye) };
        // Every second cell is drawn.
        let drawn: Vec<_> = all(places.len()).into_iter().step_by(2).collect();
        for method in METHODS {
            let mut ordered = MeshVisibility::new().prepare(cells, method).order(cells, view, &drawn).front_to_back;
            ordered.sort();
            prop_assert_eq!(&ordered, &drawn);
        }
    }

    #[test]
    fn centroid_sorts_by_distance(places in prop::collection::vec(place(), 2..200), eye in place()) {
        let (points, tetrahedra) = row(&places);
        let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
        let order = Centroid.order(cells, Viewpoint::Eye(eye), &all(places.len()));
        for pair in order.front_to_back.windows(2) {
            let [near, far] = [pair[0], pair[1]].map(|c| (cells.centroid(c) - eye).length());
            prop_assert!(near <= far * (1.0 + 1e-6), "{} before {}", near, far);
        }
    }

    #[test]
    fn bucket_errs_by_less_than_a_slab(places in prop::collection::vec(place(), 2..200), slabs in 1_u32..50) {
        let (points, tetrahedra) = row(&places);
        let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
        let order = Bucket { slabs }.order(cells, Viewpoint::Direction(DVec3::Z), &all(places.len()));
        let depths: Vec<f64> = order.front_to_back.iter().map(|&c| cells.centroid(c).z).collect();
        let (low, high) = depths.iter().fold((f64::MAX, f64::MIN), |(l, h), &d| (l.min(d), h.max(d)));
        let slab = (high - low) / f64::from(slabs);
        let mut farthest = f64::MIN;
        for d in depths {
            prop_assert!(d > farthest - slab * (1.0 + 1e-9) - 1e-15);
            farthest = farthest.max(d);
        }
    }

    #[test]
    fn sortable_bits_order_as_floats(a: f32, b: f32) {
        prop_assume!(!a.is_nan() && !b.is_nan() && (a != 0.0 || b != 0.0));
        prop_assert_eq!(sortable_bits(a).cmp(&sortable_bits(b)), a.partial_cmp(&b).unwrap());
    }
}

/// Long enough for the parallel passes, with many equal keys.
#[test]
fn radix_sort_is_stable_and_independent_of_threads() {
    let items: Vec<(u32, CellId)> =
        (0..100_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 17 << (i % 17), CellId(i))).collect();
    let mut expected = items.clone();
    expected.sort_by_key(|&(key, _)| key);
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut sorted = items.clone();
        pool.install(|| sort_by_key(&mut sorted));
        assert!(sorted == expected, "{threads} threads");
    }
}

#[test]
fn all_cells_at_one_depth_stay_as_they_come() {
    let (points, tetrahedra) = row(&[DVec3::ZERO; 5]);
    let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
    for method in METHODS {
        let order = MeshVisibility::new().prepare(cells, method).order(cells, Viewpoint::Direction(DVec3::Z), &all(5));
        assert_eq!(order.front_to_back, all(5), "{method}");
    }
}

#[test]
fn names_round_trip_and_unknown_ones_say_what_there_is() {
    for &name in OrderMethod::NAMES {
        assert_eq!(name.parse::<OrderMethod>().unwrap().to_string(), name);
    }
    let message = "depth".parse::<OrderMethod>().unwrap_err().to_string();
    assert!(message.contains("no visibility order") && message.contains("bucket"), "{message}");
}
