//! Samples in the order of points, whatever the order of axes in the file.

use tetrascope_mesh::ArrayValues;

use super::axes::{Axes, Role};

/// Number of samples and distance between them along each axis of what is wanted, fastest first.
#[derive(Debug)]
pub(super) struct Gather {
    axes: Vec<(usize, usize)>,
    /// The first sample.
    start: usize,
}

impl Gather {
    /// The components of every point beside each other, points with the fastest axis of space first.
    ///
    /// - `start`: where the samples of the step begin among those that were read
    pub(super) fn new(axes: &Axes, start: usize) -> Self {
        let strides = axes.strides();
        let order = axes.of(Role::Component).chain(axes.of(Role::Space));
        let size_and_stride = |axis: usize| Some((*axes.sizes.get(axis)?, *strides.get(axis)?));
        Self { axes: order.filter_map(size_and_stride).collect(), start }
    }

    /// The samples in their new order.
    pub(super) fn run(&self, values: ArrayValues) -> ArrayValues {
        macro_rules! each {
            ($($kind:ident),*) => {
                match values {
                    $(ArrayValues::$kind(values) => ArrayValues::$kind(self.gathered(values)),)*
                }
            };
        }
        each!(I8, U8, I16, U16, I32, U32, I64, U64, F32, F64)
    }

    fn gathered<T: Copy>(&self, values: Vec<T>) -> Vec<T> {
        let count: usize = self.axes.iter().map(|&(size, _)| size).product();
        let mut packed = 1;
        let in_order = self.axes.iter().all(|&(size, stride)| {
            let as_packed = stride == packed || size == 1;
            packed *= size;
            as_packed
        });
        if in_order && self.start == 0 && count == values.len() {
            return values;
        }
        let mut gathered = Vec::with_capacity(count.min(values.len()));
        let mut index = vec![0; self.axes.len()];
        let mut at = self.start;
        for _ in 0..count {
            gathered.extend(values.get(at).copied());
            for (place, &(size, stride)) in index.iter_mut().zip(&self.axes) {
                *place += 1;
                at += stride;
                if *place < size {
                    break;
                }
                *place = 0;
                at -= size * stride;
            }
        }
        gathered
    }
}
