//! Orders made on the device against those of the CPU.

use glam::DVec3;
use tetrascope_shaders::layout::{Frame, LATTICE_STEP, NEGATIVE_BIT, RING_BIT};
use wgpu::ComputePassDescriptor;

use crate::keys::{CentroidOrder, KeysKernels, PowerOrder, SortedOrder};
use crate::power_functions_tests::{Mesh, key, viewpoints};
use crate::scan::ListKernels;
use crate::testing::{Numbers, checked, contents, gpu};

/// Every third cell in a ring.
fn listed(count: usize) -> Vec<u32> {
    (0..count as u32).map(|cell| if cell % 3 == 0 { cell | RING_BIT } else { cell }).collect()
}

#[test]
fn power_orders_are_those_of_the_whole_numbers() {
    let Some(gpu) = gpu() else { return };
    let mut numbers = Numbers::new(15);
    let mesh = Mesh::new(6, 0.2, &mut numbers);
    let functions = mesh.functions().1.unwrap();
    let cells = listed(mesh.tetrahedra.len());
    checked(&gpu, || {
        let (lists, kernels) = (ListKernels::new(&gpu).unwrap(), KeysKernels::new(&gpu).unwrap());
        let order = gpu.storage_of("order", &cells);
        let totals = gpu.storage_of("totals", &[cells.len() as u32]);
        let sorted = SortedOrder { order: &order, totals: &totals, most: cells.len() as u32 };
        let power = PowerOrder::new(&gpu, &lists, &kernels, sorted, &functions).unwrap();
        assert!(power.bytes() <= cells.len() as u64 * 45 + 8192);
        for viewpoint in viewpoints(&mut numbers) {
            let frame = functions.view(viewpoint).unwrap();
            gpu.queue.write_buffer(&order, 0, bytemuck::cast_slice(&cells));
            let mut encoder = gpu.encoder("power");
            power.record(&gpu, &mut encoder.begin_compute_pass(&ComputePassDescriptor::default()), &frame);
            let got: Vec<u32> = contents(&gpu, encoder, &order, cells.len());
            let mut expected = cells.clone();
            expected.sort_by_key(|cell| key(&functions, &frame, (cell & !RING_BIT) as usize));
            assert!(got == expected, "{viewpoint:?}, {} bits", frame.bits);
        }
    });
}

/// Centroids from near and far eyes: neighbors in the list are in order but for f32's rounding.
#[test]
fn centroids_are_in_order() {
    let Some(gpu) = gpu() else { return };
    let mut numbers = Numbers::new(16);
    let mesh = Mesh::new(6, 0.3, &mut numbers);
    // As if these were camera axes, and beside the base.
    let points: Vec<[i32; 4]> = mesh
        .positions
        .iter()
        .map(|p| {
            let [x, y, z] = (*p / LATTICE_STEP).to_array().map(|value| value.round() as i32);
            [x, y, z, 7]
        })
        .collect();
    let corners: Vec<[u32; 4]> = mesh.tetrahedra.iter().map(|cell| cell.map(|v| v.0)).collect();
    let flagged: Vec<[u32; 4]> = corners.iter().map(|&[a, b, c, d]| [a, b, c, d | ((a & 1) * NEGATIVE_BIT)]).collect();
    let cells = listed(corners.len());
    let views = [0.1, 1.0, 10.0, 1e3, 1e6, 1e30, 3e38].map(|far| Some(DVec3::new(0.3, -0.2, -0.9) * far));
    for view in views.into_iter().chain([None]) {
        let eye = view.unwrap_or(DVec3::ZERO).as_vec3();
        let frame =
            Frame { eye: [eye.x, eye.y, eye.z, 0.0], is_perspective: u32::from(view.is_some()), ..Frame::default() };
        let got: Vec<u32> = checked(&gpu, || {
            let (lists, kernels) = (ListKernels::new(&gpu).unwrap(), KeysKernels::new(&gpu).unwrap());
            let order = gpu.storage_of("order", &cells);
            let totals = gpu.storage_of("totals", &[cells.len() as u32]);
            let frame = gpu.uniform_of("frame", &frame);
            let (points, flagged) = (gpu.storage_of("points", &points), gpu.storage_of("cells", &flagged));
            let named = [
                ("frame", frame.as_entire_binding()),
                ("points", points.as_entire_binding()),
                ("cells", flagged.as_entire_binding()),
            ];
            let sorted = SortedOrder { order: &order, totals: &totals, most: cells.len() as u32 };
            let centroid = CentroidOrder::new(&gpu, &lists, &kernels, sorted, &named).unwrap();
            assert!(centroid.bytes() <= cells.len() as u64 * 13 + 8192);
            let mut encoder = gpu.encoder("centroid");
            centroid.record(&mut encoder.begin_compute_pass(&ComputePassDescriptor::default()));
            contents(&gpu, encoder, &order, cells.len())
        });
        let eye = eye.as_dvec3();
        let depth = |entry: u32| {
            let corners = corners[(entry & !RING_BIT) as usize];
            let lattice = |v: u32| DVec3::from_array([0, 1, 2].map(|k| f64::from(points[v as usize][k])));
            let c = corners.iter().map(|&v| lattice(v)).sum::<DVec3>() * 0.25 * LATTICE_STEP;
            // The distance but for what all have in common, in units of length.
            view.map_or(c.z, |_| c.dot(c / (2.0 * eye.length()) - eye.normalize()))
        };
        let worst = got.windows(2).map(|pair| depth(pair[0]) - depth(pair[1])).fold(0.0, f64::max);
        println!("eye {eye}: {worst:e}");
        assert!(worst <= if view.is_some() { 1e-6 } else { LATTICE_STEP }, "eye {eye}: {worst}");
        let mut all = got;
        all.sort_by_key(|entry| entry & !RING_BIT);
        assert!(all == cells);
    }
}
