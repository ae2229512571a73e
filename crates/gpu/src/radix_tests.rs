//! Sorted lists against the CPU's stable sort.

use wgpu::ComputePassDescriptor;

use crate::Gpu;
use crate::radix::{RadixLists, RadixSort};
use crate::scan::ListKernels;
use crate::testing::{Numbers, checked, contents, gpu};

/// The lists after a sort of the first `count` of them, for up to `most`.
fn sorted(gpu: &Gpu, keys: &[u32], count: u32, most: u32, bits: u32) -> (Vec<u32>, Vec<u32>) {
    let kernels = ListKernels::new(gpu).unwrap();
    checked(gpu, || {
        let order: Vec<u32> = (0..keys.len() as u32).map(|place| place ^ 1 << 31).collect();
        let (keys_buffer, order) = (gpu.storage_of("keys", keys), gpu.storage_of("order", &order));
        let totals = gpu.storage_of("totals", &[0, 0, count]);
        let lists = RadixLists { keys: &keys_buffer, order: &order, totals: &totals, count_at: 2 };
        let sort = RadixSort::new(gpu, &kernels, lists, most).unwrap();
        assert!(sort.bytes() <= u64::from(most) * 17 / 2 + 4096);
        let mut encoder = gpu.encoder("sort");
        sort.record(&mut encoder.begin_compute_pass(&ComputePassDescriptor::default()), bits);
        let keys = contents(gpu, encoder, &keys_buffer, keys.len());
        (contents(gpu, gpu.encoder("order"), &order, keys.len()), keys)
    })
}

fn check(keys: &[u32], count: usize, bits: u32) {
    let Some(gpu) = gpu() else { return };
    let (order, sorted_keys) = sorted(&gpu, keys, count as u32, keys.len() as u32, bits);
    let mut expected: Vec<u32> = (0..keys.len() as u32).collect();
    expected[..count].sort_by_key(|&place| keys[place as usize]);
    for (place, &entry) in expected.iter().enumerate() {
        let (got, key) = (order[place], sorted_keys[place]);
        // What lies beyond the list stays, or becomes anything.
        if place < count {
            assert_eq!((got, key), (entry ^ 1 << 31, keys[entry as usize]), "{place} of {count}, {bits} bits");
        }
    }
}

#[test]
fn lists_of_any_length_and_keys_of_any_bits() {
    let mut numbers = Numbers::new(5);
    for length in [0, 1, 2, 8, 9, 255, 256, 257, 2047, 2048, 2049, 4095, 4097, 33_000] {
        for bits in [1, 4, 8, 9, 12, 16, 17, 24, 31, 32] {
            let keys: Vec<u32> = (0..length).map(|_| numbers.below(u32::MAX) >> (32 - bits)).collect();
            check(&keys, length, bits);
        }
    }
}

#[test]
fn fewer_entries_than_there_is_room_for() {
    let mut numbers = Numbers::new(6);
    let keys: Vec<u32> = (0..10_000).map(|_| numbers.below(1 << 13)).collect();
    for count in [0, 1, 2047, 2048, 2049, 9_999] {
        check(&keys, count, 13);
    }
}

/// A count beyond the room, as a stage that ran over would leave it: no more than the room is sorted.
#[test]
fn a_count_beyond_the_room() {
    let Some(gpu) = gpu() else { return };
    let keys: Vec<u32> = (0..5000_u32).rev().collect();
    let (_, sorted) = sorted(&gpu, &keys, u32::MAX, 5000, 16);
    assert!(sorted == (0..5000).collect::<Vec<u32>>());
}

#[test]
fn keys_that_are_all_alike_or_sorted() {
    let length = 20_000_u32;
    check(&vec![0; length as usize], length as usize, 32);
    check(&vec![u32::MAX; length as usize], length as usize, 32);
    check(&vec![0xff; length as usize], length as usize, 8);
    check(&(0..length).collect::<Vec<u32>>(), length as usize, 32);
    check(&(0..length).rev().map(|key| key << 12).collect::<Vec<u32>>(), length as usize, 32);
    check(&(0..length).map(|key| key % 2 * u32::MAX).collect::<Vec<u32>>(), length as usize, 32);
}

#[test]
fn a_million_keys() {
    let mut numbers = Numbers::new(7);
    let keys: Vec<u32> = (0..1_000_003).map(|_| numbers.below(u32::MAX)).collect();
    check(&keys, keys.len(), 32);
    let tiles: Vec<u32> = keys.iter().map(|key| key % 8160).collect();
    check(&tiles, tiles.len(), 13);
}
