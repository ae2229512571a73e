//! PLOT3D's grids and solutions in every layout.

use fastrand::Rng;

use super::joined;

/// One way of writing.
#[derive(Clone, Copy, Debug)]
struct Layout {
    text: bool,
    big: bool,
    double: bool,
    marks: bool,
    multi: bool,
    iblank: bool,
}

impl Layout {
    fn of_chance(rng: &mut Rng) -> Self {
        Self {
            text: rng.u8(..4) == 0,
            big: rng.bool(),
            double: rng.bool(),
            marks: rng.bool(),
            multi: rng.bool(),
            iblank: rng.bool(),
        }
    }

    fn integer(self, out: &mut Vec<u8>, value: i32) {
        match (self.text, self.big) {
            (true, _) => out.extend(format!("{value} ").bytes()),
            (_, true) => out.extend(value.to_be_bytes()),
            (_, false) => out.extend(value.to_le_bytes()),
        }
    }

    fn float(self, out: &mut Vec<u8>, value: f64) {
        match (self.text, self.double, self.big) {
            (true, ..) => out.extend(format!("{value:e}\n").bytes()),
            (_, true, true) => out.extend(value.to_be_bytes()),
            (_, true, false) => out.extend(value.to_le_bytes()),
            (_, false, true) => out.extend((value as f32).to_be_bytes()),
            (_, false, false) => out.extend((value as f32).to_le_bytes()),
        }
    }

    fn record(self, out: &mut Vec<u8>, body: impl FnOnce(&mut Vec<u8>)) {
        let mut inside = Vec::new();
        body(&mut inside);
        let marks = self.marks && !self.text;
        let length = inside.len() as i32;
        if marks {
            self.integer(out, length);
        }
        out.append(&mut inside);
        if marks {
            self.integer(out, length);
        }
    }

    fn header(self, out: &mut Vec<u8>, grids: &[[i32; 3]]) {
        if self.multi {
            self.record(out, |out| self.integer(out, grids.len() as i32));
        }
        self.record(out, |out| grids.iter().flatten().for_each(|&n| self.integer(out, n)));
    }
}

fn sizes(layout: Layout, rng: &mut Rng) -> Vec<[i32; 3]> {
    let count = if layout.multi { rng.usize(1..4) } else { 1 };
    (0..count).map(|_| [rng.i32(2..5), rng.i32(2..4), rng.i32(2..4)]).collect()
}

fn grid_of(layout: Layout, grids: &[[i32; 3]], rng: &mut Rng) -> Vec<u8> {
    let mut out = Vec::new();
    layout.header(&mut out, grids);
    for &[ni, nj, nk] in grids {
        layout.record(&mut out, |out| {
            for axis in 0..3 {
                for at in 0..ni * nj * nk {
                    let place = [at % ni, at / ni % nj, at / (ni * nj)][axis];
                    layout.float(out, f64::from(place) + 0.1 * rng.f64());
                }
            }
            if layout.iblank {
                (0..ni * nj * nk).for_each(|_| layout.integer(out, i32::from(rng.u8(..9) > 0)));
            }
        });
    }
    out
}

pub(super) fn grid(rng: &mut Rng) -> Vec<u8> {
    let layout = Layout::of_chance(rng);
    let grids = sizes(layout, rng);
    grid_of(layout, &grids, rng)
}

pub(super) fn pair(rng: &mut Rng) -> Vec<u8> {
    let layout = Layout::of_chance(rng);
    let grids = sizes(layout, rng);
    let grid = grid_of(layout, &grids, rng);
    let mut out = Vec::new();
    layout.header(&mut out, &grids);
    for &[ni, nj, nk] in &grids {
        layout.record(&mut out, |out| [2.0, 0.5, 1e6, 1.25].iter().for_each(|&v| layout.float(out, v)));
        layout.record(&mut out, |out| (0..5 * ni * nj * nk).for_each(|_| layout.float(out, 0.5 + rng.f64())));
    }
    joined(&grid, &out)
}
