//! Cells set up and sampled on the device, against rays clipped in f64.

mod classified;
mod partition;
mod samples;
mod stage;
mod twin;

use glam::DVec3;
use tetrascope_view::{Camera, Projection, View};

/// Numbers that look random and are the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::from([0; 3].map(|_| self.between(-1.0, 1.0)))
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let vector = self.vector();
            if (0.1..1.0).contains(&vector.length()) {
                return vector.normalize();
            }
        }
    }
}

/// A view whose pixels are `pixel` wide at the target.
fn view(eye: DVec3, target: DVec3, is_perspective: bool, pixel: f64, [width, height]: [u32; 2]) -> View {
    let height_there = pixel * f64::from(height);
    let projection = if is_perspective {
        Projection::Perspective { fov_y: 2.0 * (0.5 * height_there / eye.distance(target)).atan() }
    } else {
        Projection::Orthographic { height: height_there }
    };
    let forward = target - eye;
    let up = if forward.x == 0.0 && forward.z == 0.0 { DVec3::X } else { DVec3::Y };
    View::new(&Camera { eye, target, up, projection }, width, height).unwrap()
}
