//! Writes PLOT3D files in every layout, for the tests.

use super::layout::{Encoding, Layout, Precision};
use crate::bytes::ByteOrder;

/// One grid's numbers, as a file of any layout is to hold them.
#[derive(Clone, Debug)]
pub(super) struct Written {
    pub(super) dims: Vec<usize>,
    pub(super) reference: [f64; 4],
    /// Quantity after quantity. Exact in 32 bits, so that all layouts hold the same.
    pub(super) values: Vec<f64>,
    pub(super) iblank: Vec<i32>,
}

/// Numbers without a pattern that a wrong layout could share: multiples of 1/64 around `shift`.
pub(super) fn written(dims: &[usize], quantities: usize, shift: f64) -> Written {
    let points: usize = dims.iter().product();
    let value = |i: usize| shift + ((i * 7919 + 13) % 1021) as f64 / 64.0;
    Written {
        dims: dims.to_vec(),
        reference: [2.95, 0.5, 2.1e6, 1.25].map(|v: f64| f64::from(v as f32)),
        values: (0..points * quantities).map(value).collect(),
        iblank: (0..points).map(|i| [1, 1, 0, -1, 2][i % 5]).collect(),
    }
}

/// The bytes of a file. A layout without count takes one grid alone.
pub(super) fn file(layout: Layout, grids: &[Written]) -> Vec<u8> {
    let mut out = Out { layout, bytes: Vec::new() };
    if layout.multi {
        out.record(|out| out.integer(grids.len() as i32));
    }
    out.record(|out| grids.iter().flat_map(|grid| &grid.dims).for_each(|&n| out.integer(n as i32)));
    for grid in grids {
        if layout.floats_per_block() > 0 {
            out.record(|out| grid.reference.iter().for_each(|&v| out.float(v)));
        }
        out.record(|out| {
            grid.values.iter().for_each(|&v| out.float(v));
            if layout.iblank {
                grid.iblank.iter().for_each(|&v| out.integer(v));
            }
        });
    }
    out.bytes
}

struct Out {
    layout: Layout,
    bytes: Vec<u8>,
}

impl Out {
    fn record(&mut self, body: impl FnOnce(&mut Self)) {
        let start = self.bytes.len();
        body(self);
        match self.layout.encoding {
            Encoding::Text => self.bytes.push(b'\n'),
            Encoding::Binary { marks: false, .. } => {}
            Encoding::Binary { marks: true, .. } => {
                let size = (self.bytes.len() - start) as i32;
                let body = self.bytes.split_off(start);
                self.integer(size);
                self.bytes.extend(body);
                self.integer(size);
            }
        }
    }

    fn integer(&mut self, value: i32) {
        match self.layout.encoding {
            Encoding::Text => self.bytes.extend(format!("{value} ").bytes()),
            Encoding::Binary { order: ByteOrder::Little, .. } => self.bytes.extend(value.to_le_bytes()),
            Encoding::Binary { order: ByteOrder::Big, .. } => self.bytes.extend(value.to_be_bytes()),
        }
    }

    fn float(&mut self, value: f64) {
        let Encoding::Binary { order, precision, .. } = self.layout.encoding else {
            self.bytes.extend(format!("{value:e}\n").bytes());
            return;
        };
        let mut bytes = match precision {
            Precision::Single => (value as f32).to_le_bytes().to_vec(),
            Precision::Double => value.to_le_bytes().to_vec(),
        };
        if order == ByteOrder::Big {
            bytes.reverse();
        }
        self.bytes.extend(bytes);
    }
}
