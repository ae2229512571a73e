//! Steps ascend with the keys, and cells are sorted by them.

use proptest::prelude::*;
use tetrascope_mesh::CellId;

use crate::steps::{Drawn, Steps, sort_cells};

fn listed(count: usize) -> Vec<CellId> {
    (0..count as u32).map(CellId).collect()
}

/// Near each other, spread over magnitudes, and no numbers at all.
fn key() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -1.0..1.0_f64,
        4 => (-30..30_i32, -1.0..1.0_f64).prop_map(|(power, part)| part * 10.0_f64.powi(power)),
        1 => prop_oneof![Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(0.0), Just(1.0)],
    ]
}

proptest! {
    #[test]
    fn a_larger_key_never_has_the_lower_step(keys in prop::collection::vec(key(), 1..3000), more in key()) {
        let cells = listed(keys.len());
        let drawn = Drawn::new(&cells);
        let steps = Steps::new(&drawn, |cell| keys[cell.index()]);
        let mut ascending = keys.clone();
        ascending.push(more);
        ascending.sort_by(f64::total_cmp);
        let found: Vec<u64> = ascending.iter().map(|&key| steps.step(key)).collect();
        prop_assert!(found.is_sorted());
        let word_bits = steps.word_bits();
        prop_assert!(ascending.iter().all(|&key| steps.word(key, 0) >> word_bits == 0));
        prop_assert_eq!(steps.of_word(steps.word(more, 0)), steps.step(more));
        prop_assert!(steps.word(f64::NAN, 0) >> word_bits == 0);
    }

    /// Keys 1/1000 of their range apart have different steps; equal ones keep their order.
    #[test]
    fn cells_come_by_their_keys(keys in prop::collection::vec(0..1000_u32, 0..4000), backwards: bool) {
        let mut cells = listed(keys.len());
        if backwards {
            cells.reverse();
        }
        let found = sort_cells(&cells, |cell| f64::from(keys[cell.index()]) - 500.0);
        let mut expected = cells;
        expected.sort_by_key(|cell| keys[cell.index()]);
        prop_assert_eq!(found, expected);
    }
}
