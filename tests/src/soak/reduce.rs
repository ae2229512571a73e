//! Makes a failing case small while it fails in the same manner.

use std::collections::HashMap;

use tetrascope::Choice;

use super::{Case, Drawing, Failure, judge};
use crate::ways::Way;

/// Judgements that a reduction may cost: some minutes at most.
const MOST_TRIES: usize = 400;

/// Share of a difference that has to stay: of many pixels beyond a limit the last is hardly so.
const SHARE_KEPT: f64 = 0.3;

/// A case made small.
#[derive(Clone, Debug)]
pub struct Reduced {
    /// The case.
    pub case: Case,
    /// How it fails.
    pub failure: Failure,
    /// Judgements that it took.
    pub tries: usize,
}

/// Leaves out what the failure does not need: cells by halves, quarters and so on down to single ones (delta debugging), then surfaces, light and keys,
/// control points, pixels, and digits. Camera, and the rest of the transfer function, stay as they are.
///
/// - `failure`: the one to keep; another fault or another way is another failure
pub fn reduce(case: &Case, failure: &Failure, drawing: Drawing<'_>) -> Reduced {
    let ways = if failure.way == Way::Reference { vec![Way::Reference] } else { vec![Way::Reference, failure.way] };
    // Refusals are a matter of who else draws.
    let ways = if failure.fault == super::Fault::Refused { Way::ALL.to_vec() } else { ways };
    let mut search =
        Search { ways, drawing, best: case.clone(), failure: failure.clone(), first: failure.size, tries: 0 };
    loop {
        let cells = search.best.tets.cells.len();
        search.fewer_cells();
        search.fewer_effects();
        search.fewer_points();
        if search.best.tets.cells.len() == cells || search.tries >= MOST_TRIES {
            break;
        }
    }
    search.smaller_picture();
    search.fewer_digits();
    Reduced { case: search.best, failure: search.failure, tries: search.tries }
}

struct Search<'a> {
    ways: Vec<Way>,
    drawing: Drawing<'a>,
    best: Case,
    failure: Failure,
    /// Size of the failure as it was found.
    first: f64,
    tries: usize,
}

impl Search<'_> {
    /// Whether a change keeps the failure; then it is kept.
    fn try_case(&mut self, case: Case) -> bool {
        if self.tries >= MOST_TRIES {
            return false;
        }
        self.tries += 1;
        let judged = judge(&case, &self.ways, self.drawing);
        // No larger than needed, but no other failure that is hardly one.
        let same = judged
            .failures
            .into_iter()
            .find(|f| f.fault == self.failure.fault && f.way == self.failure.way && f.size >= SHARE_KEPT * self.first);
        let Some(failure) = same else { return false };
        (self.best, self.failure) = (case, failure);
        true
    }

    fn change(&mut self, change: impl FnOnce(&mut Case)) -> bool {
        let mut case = self.best.clone();
        change(&mut case);
        self.try_case(case)
    }

    fn fewer_cells(&mut self) {
        let mut size = self.best.tets.cells.len().div_ceil(2);
        while size > 0 {
            let mut start = 0;
            while start < self.best.tets.cells.len() && self.best.tets.cells.len() > 1 {
                let mut case = self.best.clone();
                let end = (start + size).min(case.tets.cells.len());
                case.tets.cells.drain(start..end);
                if case.tets.cells.is_empty() {
                    break;
                }
                compact(&mut case);
                if !self.try_case(case) {
                    start = end;
                }
            }
            size /= 2;
        }
    }

    fn fewer_effects(&mut self) {
        for index in (0..self.best.scene.isosurface.len()).rev() {
            self.change(|case| {
                case.scene.isosurface.remove(index);
            });
        }
        if self.best.scene.light.is_some() {
            self.change(|case| case.scene.light = None);
        }
        let quality = self.best.scene.quality.clone();
        if quality.integration != Choice::Auto {
            self.change(|case| {
                let quality = &mut case.scene.quality;
                (quality.integration, quality.table_size, quality.table_lengths) = (Choice::Auto, None, None);
            });
        }
        if quality.order != Choice::Auto {
            self.change(|case| {
                let quality = &mut case.scene.quality;
                (quality.order, quality.slabs, quality.window, quality.cycles) = (Choice::Auto, None, None, None);
            });
        }
        if quality.interpolation != Choice::Auto {
            self.change(|case| case.scene.quality.interpolation = Choice::Auto);
        }
        if quality.isosurfaces.is_some() {
            self.change(|case| (case.scene.quality.isosurfaces, case.scene.quality.map_size) = (None, None));
        }
        if quality.max_error.is_some() {
            self.change(|case| case.scene.quality.max_error = None);
        }
    }

    fn fewer_points(&mut self) {
        let count = |case: &Case| case.scene.transfer.extinction.as_ref().map_or(0, Vec::len);
        let mut size = count(&self.best).div_ceil(2);
        while size > 0 {
            let mut start = 0;
            while start < count(&self.best) && count(&self.best) > 1 {
                let end = (start + size).min(count(&self.best));
                let done = end - start < count(&self.best)
                    && self.change(|case| {
                        case.scene.transfer.extinction.iter_mut().for_each(|list| drop(list.drain(start..end)));
                    });
                if !done {
                    start = end;
                }
            }
            size /= 2;
        }
        // The first color alone, then the first and the last.
        let _ = self.change(|case| case.scene.transfer.color.iter_mut().for_each(|list| list.truncate(1)))
            || self.change(|case| {
                case.scene
                    .transfer
                    .color
                    .iter_mut()
                    .filter(|list| list.len() > 2)
                    .for_each(|list| drop(list.drain(1..list.len() - 1)));
            });
    }

    fn smaller_picture(&mut self) {
        // Rays depend on the size, so that not every size has the one that fails.
        for side in [1, 2, 3, 5, 8, 13, 21] {
            let image = &self.best.scene.image;
            let (width, height) = (image.width.min(side), image.height.min(side));
            if (width, height) != (image.width, image.height)
                && self.change(|case| (case.scene.image.width, case.scene.image.height) = (width, height))
            {
                return;
            }
        }
    }

    fn fewer_digits(&mut self) {
        for digits in [2, 4, 7] {
            let round = |number: f64| format!("{number:.digits$e}").parse::<f64>().unwrap_or(number);
            self.change(|case| {
                case.tets.points.iter_mut().for_each(|point| *point = point.to_array().map(round).into())
            });
            self.change(|case| case.tets.scalars.iter_mut().for_each(|scalar| *scalar = round(*scalar)));
            self.change(|case| {
                let camera = &mut case.scene.camera;
                [&mut camera.eye, &mut camera.target, &mut camera.up]
                    .into_iter()
                    .for_each(|v| *v = v.map(|v| v.map(round)));
                (camera.fov_y, camera.height) = (camera.fov_y.map(round), camera.height.map(round));
            });
            self.change(|case| {
                let transfer = &mut case.scene.transfer;
                transfer.color.iter_mut().flatten().flatten().for_each(|number| *number = round(*number));
                transfer.extinction.iter_mut().flatten().flatten().for_each(|number| *number = round(*number));
            });
        }
    }
}

/// Takes away points that no cell uses.
fn compact(case: &mut Case) {
    let tets = &mut case.tets;
    let mut used: Vec<u32> = tets.cells.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let number: HashMap<u32, u32> = used.iter().copied().zip(0..).collect();
    tets.cells.iter_mut().flatten().for_each(|v| *v = number[v]);
    tets.points = used.iter().map(|&v| tets.points[v as usize]).collect();
    tets.scalars = used.iter().map(|&v| tets.scalars[v as usize]).collect();
}
