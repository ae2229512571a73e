//! Prefix sums against those of the CPU.

use crate::scan::{ListKernels, Scan};
use crate::testing::{Numbers, checked, contents, gpu};

fn check(values: &[u32]) {
    let Some(gpu) = gpu() else { return };
    let kernels = ListKernels::new(&gpu).unwrap();
    let got: Vec<u32> = checked(&gpu, || {
        let buffer = gpu.storage_of("values", values);
        let scan = Scan::new(&gpu, &kernels, &buffer, values.len() as u32).unwrap();
        let mut encoder = gpu.encoder("scan");
        scan.record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()));
        contents(&gpu, encoder, &buffer, values.len())
    });
    let mut sum = 0_u32;
    for (place, (&value, &got)) in values.iter().zip(&got).enumerate() {
        assert_eq!(got, sum, "{place} of {}", values.len());
        sum = sum.saturating_add(value);
    }
}

/// Around the sizes of threads, groups and blocks of them.
#[test]
fn sums_of_any_length() {
    let mut numbers = Numbers::new(1);
    for length in [0, 1, 2, 7, 8, 9, 255, 256, 257, 2047, 2048, 2049, 4096, 65_535, 65_537, 300_001] {
        let values: Vec<u32> = (0..length).map(|_| numbers.below(1000)).collect();
        check(&values);
    }
}

/// Three levels.
#[test]
fn sums_of_five_million() {
    let mut numbers = Numbers::new(2);
    let values: Vec<u32> = (0..2048 * 2048 + 812_345).map(|_| numbers.below(500)).collect();
    check(&values);
}

#[test]
fn sums_stay_at_the_largest_number() {
    let mut numbers = Numbers::new(3);
    let values: Vec<u32> = (0..10_000).map(|_| numbers.below(1 << 20)).collect();
    check(&values);
    check(&[u32::MAX; 3000]);
    check(&[0; 5000]);
}
