//! Why a picture may show nothing.

use glam::DVec3;
use tetrascope_view::View;

use crate::text::short;
use crate::{IsosurfacePlan, MeshFacts, Plan};

/// One step of an 8-bit channel: what is below in all channels is not seen.
const GRAY_LEVEL: f64 = 1.0 / 255.0;

/// Reasons for which a plan gives a picture with nothing to see, each with a remedy; empty when none is known.
///
/// Looks at the box around the mesh, the field's range, the isosurfaces and the transfer function, not at the mesh. For a picture that is
/// blank: some of these make one likely only. [`foresee_blank`] has those that are certain.
pub fn explain_blank(plan: &Plan, facts: &MeshFacts) -> Vec<String> {
    if let Some(side) = side_out_of_view(&plan.view, facts) {
        return vec![out_of_view(side, facts)];
    }
    let mut reasons = Vec::new();
    if let Some(pixels) = size_in_pixels(&plan.view, facts)
        && pixels < 2.0
    {
        reasons.push(format!("the mesh is {} pixels large: go nearer, or leave eye and target out", short(pixels)));
    }
    match surfaces_that_are_seen(plan, facts) {
        Surfaces::Seen => return reasons,
        Surfaces::Unseen(reason) => reasons.push(reason),
        Surfaces::None => {}
    }
    reasons.extend(unseen_volume(plan, facts).or_else(|| too_thin(plan, facts)));
    reasons
}

/// The reasons for which a plan is sure to give a picture with nothing to see, each with a remedy; empty where something may be seen.
///
/// Rests on bounds: on the box around the mesh, the longest way of a ray of this view through it, and the most that the transfer function has
/// over the field's range. A plan without such a reason may still show nothing, for what only the mesh tells.
pub fn foresee_blank(plan: &Plan, facts: &MeshFacts) -> Vec<String> {
    if let Some(side) = side_out_of_view(&plan.view, facts) {
        return vec![out_of_view(side, facts)];
    }
    let of_surfaces = match surfaces_that_are_seen(plan, facts) {
        Surfaces::Seen => return Vec::new(),
        Surfaces::Unseen(reason) => Some(reason),
        Surfaces::None => None,
    };
    match unseen_volume(plan, facts) {
        None => Vec::new(),
        Some(reason) => of_surfaces.into_iter().chain([reason]).collect(),
    }
}

fn out_of_view(side: &str, facts: &MeshFacts) -> String {
    format!(
        "the camera does not see the mesh, which is {side}: the mesh lies between ({}) and ({}); aim the camera at its middle ({}), or \
         leave eye and target out",
        place(facts.lowest),
        place(facts.highest),
        place(facts.center())
    )
}

/// Where the field lies, beside the control points of the transfer function.
fn ranges(plan: &Plan, facts: &MeshFacts) -> String {
    let (low, high) = facts.scalar_range;
    // Of what makes the volume seen: points of the other half may lie anywhere.
    let is_color = plan.model.color_is_per_length();
    let (first, last) = if is_color { plan.transfer.color_domain() } else { plan.transfer.extinction_domain() };
    let what = if is_color { "color" } else { "extinction" };
    let field = if low == high {
        format!("the field is {} everywhere", short(low))
    } else {
        format!("the field goes from {} to {}", short(low), short(high))
    };
    let outside = if high < first || low > last { ", and the field lies outside of them" } else { "" };
    format!("{field}, the control points of the {what} from {} to {}{outside}", short(first), short(last))
}

/// Why the volume is under one gray level on every ray, if that is sure.
fn unseen_volume(plan: &Plan, facts: &MeshFacts) -> Option<String> {
    let (low, high) = facts.scalar_range;
    let extinction = if plan.model.needs_extinction() { plan.transfer.max_extinction(low, high) } else { 0.0 };
    let adds_light = plan.model.color_is_per_length();
    let emission = if adds_light { plan.transfer.max_emission(low, high) } else { 0.0 };
    let longest = longest_way(&plan.view, facts);
    // Colors above 1 shine through more than they hide.
    let brightest =
        if adds_light || !plan.model.needs_emission() { 1.0 } else { plan.transfer.max_emission(low, high).max(1.0) };
    if (extinction * brightest).max(emission) * longest >= GRAY_LEVEL {
        return None;
    }
    Some(if adds_light {
        format!(
            "the color, which this optical model adds per length, is at most {} over the field's range, and a ray runs through at most {} \
             of the mesh: under one gray level; {}",
            short(emission),
            short(longest),
            ranges(plan, facts)
        )
    } else if extinction == 0.0 {
        format!("the extinction is 0 over the field's whole range: {}", ranges(plan, facts))
    } else {
        format!(
            "the extinction, at most {} per unit of length, is too small: a ray runs through at most {} of the mesh, which hides {} at \
             most, under one gray level; an extinction that shows is about {}",
            short(extinction),
            short(longest),
            short(extinction * longest),
            short(crate::defaults::DIAGONAL_DEPTH / longest)
        )
    })
}

/// A length that no ray of a view exceeds in the box around the mesh; world length.
fn longest_way(view: &View, facts: &MeshFacts) -> f64 {
    let sides = facts.highest - facts.lowest;
    let spread = if view.is_perspective { [view.half_width, view.half_height] } else { [0.0; 2] };
    let stretch = (1.0 + spread[0] * spread[0] + spread[1] * spread[1]).sqrt();
    // Along each axis a ray of direction d leaves the box after side / |d|; the least |d| of all rays of the picture.
    let least = view.forward.abs() - view.right.abs() * spread[0] - view.up.abs() * spread[1];
    let across = sides.to_array().into_iter().zip(least.to_array());
    let ways = across.filter(|(_, least)| *least > 0.0).map(|(side, least)| side * stretch / least);
    ways.fold(facts.diagonal(), f64::min)
}

/// What isosurfaces have to do with a blank picture.
enum Surfaces {
    /// There are none.
    None,
    /// They are not seen, and why.
    Unseen(String),
    /// Wherever a ray meets the mesh it may meet one of them, whatever the volume is.
    Seen,
}

fn surfaces_that_are_seen(plan: &Plan, facts: &MeshFacts) -> Surfaces {
    let Some(IsosurfacePlan { surfaces, .. }) = &plan.isosurfaces else { return Surfaces::None };
    let all = surfaces.as_slice();
    let (Some(first), Some(last)) = (all.first(), all.last()) else { return Surfaces::None };
    let (low, high) = facts.scalar_range;
    let crossed = &all[surfaces.between(low, high)];
    if crossed.is_empty() {
        return Surfaces::Unseen(format!(
            "the field goes from {} to {} and meets no isosurface: their values go from {} to {}",
            short(low),
            short(high),
            short(first.value),
            short(last.value)
        ));
    }
    // A ray that meets each of them once loses at most the sum of their opacities.
    let opacity: f64 = crossed.iter().map(|surface| surface.opacity).sum();
    if opacity < GRAY_LEVEL {
        return Surfaces::Unseen(format!("the opacities of the isosurfaces add up to {} only", short(opacity)));
    }
    Surfaces::Seen
}

/// Whether the mesh is so thin on one side that hardly anything adds up across it.
fn too_thin(plan: &Plan, facts: &MeshFacts) -> Option<String> {
    let (low, high) = facts.scalar_range;
    let adds_light = plan.model.color_is_per_length();
    let per_length =
        if adds_light { plan.transfer.max_emission(low, high) } else { plan.transfer.max_extinction(low, high) };
    let thinnest = (facts.highest - facts.lowest).min_element();
    if adds_light && plan.model.needs_extinction() || per_length * thinnest >= GRAY_LEVEL {
        return None;
    }
    Some(format!(
        "the mesh is only {} thick on one side, across which {} per unit of length adds up to nothing; raise it, or look along \
         the mesh",
        short(thinnest),
        short(per_length)
    ))
}

/// On which side of the view the whole box lies, if it does.
fn side_out_of_view(view: &View, facts: &MeshFacts) -> Option<&'static str> {
    let corners: Vec<DVec3> = (0..8)
        .map(|i| {
            let pick = |bit: usize, low, high| if i & bit == 0 { low } else { high };
            let (l, h) = (facts.lowest, facts.highest);
            let to_corner = DVec3::new(pick(1, l.x, h.x), pick(2, l.y, h.y), pick(4, l.z, h.z)) - view.eye;
            DVec3::new(to_corner.dot(view.right), to_corner.dot(view.up), to_corner.dot(view.forward))
        })
        .collect();
    // How far the picture's edge is at a corner's depth; behind the eye the sides cross, and only "behind" is asked.
    let reach = |half: f64, depth: f64| if view.is_perspective { half * depth } else { half };
    if corners.iter().all(|p| p.z <= 0.0) {
        Some("behind it")
    } else if corners.iter().all(|p| p.x > reach(view.half_width, p.z)) {
        Some("to its right")
    } else if corners.iter().all(|p| -p.x > reach(view.half_width, p.z)) {
        Some("to its left")
    } else if corners.iter().all(|p| p.y > reach(view.half_height, p.z)) {
        Some("above it")
    } else if corners.iter().all(|p| -p.y > reach(view.half_height, p.z)) {
        Some("below it")
    } else {
        None
    }
}

/// Diameter of the bounding sphere in pixels; `None` with the eye inside.
fn size_in_pixels(view: &View, facts: &MeshFacts) -> Option<f64> {
    let depth = (facts.center() - view.eye).dot(view.forward);
    let half_height = if view.is_perspective { view.half_height * depth } else { view.half_height };
    let inside = view.is_perspective && depth <= facts.diagonal() / 2.0;
    (!inside).then(|| facts.diagonal() / 2.0 / half_height * f64::from(view.height))
}

fn place(p: DVec3) -> String {
    format!("{}, {}, {}", short(p.x), short(p.y), short(p.z))
}
