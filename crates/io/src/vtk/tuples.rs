//! Tuples of an array, picked out and put elsewhere.

use tetrascope_mesh::ArrayValues;

/// So many tuples: where they are, where they go, how many.
pub(super) type Run = (usize, usize, usize);

/// Runs one expression for two arrays of one type, `$other` where their types differ.
macro_rules! for_both {
    ($a:expr, $b:expr, ($x:ident, $y:ident) => $body:expr, $other:expr) => {
        match ($a, $b) {
            (ArrayValues::I8($x), ArrayValues::I8($y)) => $body,
            (ArrayValues::U8($x), ArrayValues::U8($y)) => $body,
            (ArrayValues::I16($x), ArrayValues::I16($y)) => $body,
            (ArrayValues::U16($x), ArrayValues::U16($y)) => $body,
            (ArrayValues::I32($x), ArrayValues::I32($y)) => $body,
            (ArrayValues::U32($x), ArrayValues::U32($y)) => $body,
            (ArrayValues::I64($x), ArrayValues::I64($y)) => $body,
            (ArrayValues::U64($x), ArrayValues::U64($y)) => $body,
            (ArrayValues::F32($x), ArrayValues::F32($y)) => $body,
            (ArrayValues::F64($x), ArrayValues::F64($y)) => $body,
            _ => $other,
        }
    };
}

/// Copies runs of tuples `(from, to, length)`; `false`, and nothing done, where the types differ. Runs beyond either array are passed over.
pub(super) fn copy_runs(to: &mut ArrayValues, from: &ArrayValues, components: usize, runs: &[Run]) -> bool {
    for_both!(to, from, (a, b) => { copy_tuples(a, b, components, runs); true }, false)
}

/// The same for any tuples.
pub(super) fn copy_tuples<T: Copy>(to: &mut [T], from: &[T], components: usize, runs: &[Run]) {
    for &(source, target, length) in runs {
        let (source, target, length) = (source * components, target * components, length * components);
        if let (Some(to), Some(from)) = (to.get_mut(target..target + length), from.get(source..source + length)) {
            to.copy_from_slice(from);
        }
    }
}

/// So many numbers of the type of an array: NaN, or 0 for whole numbers.
pub(super) fn blank(like: &ArrayValues, length: usize) -> ArrayValues {
    match like {
        ArrayValues::I8(_) => ArrayValues::I8(vec![0; length]),
        ArrayValues::U8(_) => ArrayValues::U8(vec![0; length]),
        ArrayValues::I16(_) => ArrayValues::I16(vec![0; length]),
        ArrayValues::U16(_) => ArrayValues::U16(vec![0; length]),
        ArrayValues::I32(_) => ArrayValues::I32(vec![0; length]),
        ArrayValues::U32(_) => ArrayValues::U32(vec![0; length]),
        ArrayValues::I64(_) => ArrayValues::I64(vec![0; length]),
        ArrayValues::U64(_) => ArrayValues::U64(vec![0; length]),
        ArrayValues::F32(_) => ArrayValues::F32(vec![f32::NAN; length]),
        ArrayValues::F64(_) => ArrayValues::F64(vec![f64::NAN; length]),
    }
}

/// The tuples that are to be kept, in their order.
pub(super) fn kept(values: &ArrayValues, components: usize, keep: &[bool]) -> ArrayValues {
    let mut runs = Vec::new();
    let mut count = 0;
    for (index, _) in keep.iter().enumerate().filter(|(_, keep)| **keep) {
        match runs.last_mut() {
            Some((from, _, length)) if *from + *length == index => *length += 1,
            _ => runs.push((index, count, 1)),
        }
        count += 1;
    }
    let mut all = blank(values, count * components);
    copy_runs(&mut all, values, components, &runs);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tuples_are_kept_and_copied() {
        let pairs = ArrayValues::I16(vec![1, 2, 3, 4, 5, 6, 7, 8]);
        let ArrayValues::I16(v) = kept(&pairs, 2, &[true, false, true, true]) else { panic!("not Int16") };
        assert_eq!(v, [1, 2, 5, 6, 7, 8]);
        let mut to = blank(&pairs, 4);
        assert!(copy_runs(&mut to, &pairs, 2, &[(3, 0, 1), (0, 9, 1), (9, 0, 1)]));
        let ArrayValues::I16(v) = &to else { panic!("not Int16") };
        assert_eq!(v, &[7, 8, 0, 0]);
        assert!(!copy_runs(&mut to, &ArrayValues::U8(vec![1]), 1, &[(0, 0, 1)]));
    }
}
