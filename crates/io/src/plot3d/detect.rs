//! Which layout a file has: all are tried, the best is taken.

use super::{
    blocks::{self, Block},
    layout::{Encoding, Kind, Layout, Precision, all_layouts},
    measure::{Content, Fit, Misfit, Stage, measure},
    records::RecordError,
};

/// Coordinates and flow quantities beyond this are taken for numbers read in the wrong layout. A guess; used only
/// where two layouts fit or where padding follows the data.
const LARGEST_SANE: f64 = 1e30;

/// iblank values are grid numbers and flags; see [`LARGEST_SANE`] for the use.
const LARGEST_SANE_IBLANK: u32 = 1_000_000;

/// Why no layout was chosen.
#[derive(Debug)]
pub(super) enum NoFit {
    /// None fits; the nearest one.
    Nearest(Misfit),
    /// The file fits several equally well.
    Ambiguous(Vec<Fit>),
    /// The file fits a layout with two axes.
    Planar(Layout),
}

/// The layout of a file: an exact fit is best, then the one with the least zero padding.
///
/// Fits with padding must hold finite numbers of sane magnitude. So must one of two that are equally good. A fit with
/// padding that also needs zeros for a whole quantity takes other padding for data, and stands behind those that do not.
pub(super) fn detect(content: &Content<'_>, kind: Kind) -> Result<Fit, NoFit> {
    let text = matches!(content, Content::Text(_));
    let mut fits = Vec::new();
    let mut misfits = Vec::new();
    for layout in all_layouts(kind, text, 3) {
        match measure(content, layout) {
            Ok(fit) if fit.padding == 0 || is_sane(content, &fit) => fits.push(fit),
            Ok(_) => {}
            Err(misfit) => misfits.push(misfit),
        }
    }
    let rank = |fit: &Fit| (fit.padding > 0 && ends_in_zeros(content, fit), fit.padding);
    let best = fits.iter().map(rank).min();
    fits.retain(|fit| Some(rank(fit)) == best);
    if fits.len() > 1 && fits.iter().any(|fit| is_sane(content, fit)) {
        fits.retain(|fit| is_sane(content, fit));
    }
    match fits.len() {
        1 => Ok(fits.remove(0)),
        0 => Err(no_fit(content, kind, misfits)),
        _ => Err(NoFit::Ambiguous(fits)),
    }
}

fn no_fit(content: &Content<'_>, kind: Kind, misfits: Vec<Misfit>) -> NoFit {
    let text = matches!(content, Content::Text(_));
    let planar = all_layouts(kind, text, 2)
        .into_iter()
        .find_map(|layout| measure(content, layout).ok().filter(|fit| fit.padding == 0 || is_sane(content, fit)));
    if let Some(fit) = planar {
        return NoFit::Planar(fit.layout);
    }
    let nearer = |a: &Misfit, b: &Misfit| b.stage.cmp(&a.stage).then(a.distance.total_cmp(&b.distance));
    let insane = Misfit {
        layout: all_layouts(kind, text, 3)[0],
        stage: Stage::Header,
        distance: 0.0,
        problem: "the numbers in it are not finite or beyond 1e30".to_owned(),
    };
    NoFit::Nearest(misfits.into_iter().min_by(nearer).unwrap_or(insane))
}

/// Whether all numbers are such as a grid or a flow has.
fn is_sane(content: &Content<'_>, fit: &Fit) -> bool {
    let sane = |block: &Block<f64>| {
        block.reference.iter().chain(&block.values).all(|value| value.abs() <= LARGEST_SANE)
            && block.iblank.iter().all(|value| value.unsigned_abs() <= LARGEST_SANE_IBLANK)
    };
    read_f64(content, fit).is_ok_and(|blocks| blocks.iter().all(sane))
}

/// Whether the last quantity of the last grid (iblank, z or energy) is 0 at every point.
fn ends_in_zeros(content: &Content<'_>, fit: &Fit) -> bool {
    let Ok(blocks) = read_f64(content, fit) else { return true };
    let Some(last) = blocks.last() else { return true };
    if fit.layout.iblank {
        last.iblank.iter().all(|&value| value == 0)
    } else {
        let points = last.values.len() / fit.layout.floats_per_point();
        last.values.iter().rev().take(points).all(|&value| value == 0.0)
    }
}

/// The numbers of either precision as f64.
fn read_f64(content: &Content<'_>, fit: &Fit) -> Result<Vec<Block<f64>>, RecordError> {
    if !matches!(fit.layout.encoding, Encoding::Binary { precision: Precision::Single, .. }) {
        return blocks::read::<f64>(content, fit);
    }
    let wide = |values: Vec<f32>| values.into_iter().map(f64::from).collect();
    let widened = |block: Block<f32>| Block {
        reference: wide(block.reference),
        values: wide(block.values),
        iblank: block.iblank,
    };
    Ok(blocks::read::<f32>(content, fit)?.into_iter().map(widened).collect())
}
