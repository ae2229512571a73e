//! What is kept of a list, against the CPU.

use crate::compact::Compact;
use crate::scan::ListKernels;
use crate::testing::{Numbers, checked, contents, gpu};

const NOTHING: u32 = u32::MAX;

fn check(kept: &[u32]) {
    let Some(gpu) = gpu() else { return };
    let kernels = ListKernels::new(&gpu).unwrap();
    let expected: Vec<u32> = kept.iter().copied().filter(|&entry| entry != NOTHING).collect();
    let (totals, order): (Vec<u32>, Vec<u32>) = checked(&gpu, || {
        let buffer = gpu.storage_of("kept", kept);
        let order = gpu.storage("order", size_of_val(kept) as u64);
        let totals = gpu.storage_of("totals", &[77_u32; 8]);
        let compact = Compact::new(&gpu, &kernels, &buffer, &order, &totals, kept.len() as u32).unwrap();
        let mut encoder = gpu.encoder("compact");
        compact.record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()));
        let totals = contents(&gpu, encoder, &totals, 2);
        (totals, contents(&gpu, gpu.encoder("order"), &order, expected.len()))
    });
    assert_eq!(totals, [expected.len() as u32, 77]);
    assert!(order == expected, "of {} entries", kept.len());
}

#[test]
fn the_rest_comes_in_order() {
    let mut numbers = Numbers::new(4);
    for length in [0, 1, 2, 255, 256, 2047, 2048, 2049, 70_000, 1_000_003] {
        for one_in in [1, 2, 50] {
            let kept: Vec<u32> =
                (0..length).map(|place| if numbers.below(one_in) == 0 { place ^ 1 << 31 } else { NOTHING }).collect();
            check(&kept);
        }
    }
    check(&[NOTHING; 5_000]);
}
