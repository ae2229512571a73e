//! Why a picture may show nothing.

use glam::DVec3;
use tetrascope_view::View;

use crate::text::short;
use crate::{IsosurfacePlan, MeshFacts, Plan};

/// Reasons for which a plan gives a picture with nothing to see, each with a remedy; empty when none is known.
///
/// Looks at the box around the mesh, the field's range, the isosurfaces and the transfer function, not at the mesh.
pub fn explain_blank(plan: &Plan, facts: &MeshFacts) -> Vec<String> {
    let mut reasons = Vec::new();
    if let Some(side) = side_out_of_view(&plan.view, facts) {
        reasons.push(format!(
            "the camera does not see the mesh, which is {side}: the mesh lies between ({}) and ({}); aim the camera at its \
             middle ({}), or leave eye and target out",
            place(facts.lowest),
            place(facts.highest),
            place(facts.center())
        ));
        return reasons;
    }
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
    let (low, high) = facts.scalar_range;
    let (first, last) = plan.transfer.domain();
    let range = format!(
        "the field goes from {} to {}, the transfer function's control points from {} to {}",
        short(low),
        short(high),
        short(first),
        short(last)
    );
    let extinction = plan.transfer.max_extinction(low, high);
    let emission = plan.transfer.max_emission(low, high);
    let adds_light = plan.model.color_is_per_length();
    if adds_light && emission * facts.diagonal() < 1.0 / 255.0 && (extinction == 0.0 || !plan.model.needs_extinction())
    {
        reasons.push(format!(
            "the color, which this optical model adds per length, is at most {} over the field's range: {range}",
            short(emission)
        ));
    } else if !adds_light && extinction == 0.0 {
        reasons.push(format!("the extinction is 0 over the field's whole range: {range}"));
    } else if !adds_light && extinction * facts.diagonal() < 1.0 / 255.0 {
        reasons.push(format!(
            "the extinction, at most {} per unit of length, is too small for a mesh of diagonal {}: a visible one is about {}",
            short(extinction),
            short(facts.diagonal()),
            short(crate::defaults::DIAGONAL_DEPTH / facts.diagonal())
        ));
    } else if let Some(reason) = too_thin(plan, facts, if adds_light { emission } else { extinction }) {
        reasons.push(reason);
    }
    reasons
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
    if opacity < 1.0 / 255.0 {
        return Surfaces::Unseen(format!("the opacities of the isosurfaces add up to {} only", short(opacity)));
    }
    Surfaces::Seen
}

/// Whether the mesh is so thin that hardly anything adds up across it, though its diagonal is long enough.
fn too_thin(plan: &Plan, facts: &MeshFacts, per_length: f64) -> Option<String> {
    let thinnest = (facts.highest - facts.lowest).min_element();
    if plan.model.color_is_per_length() && plan.model.needs_extinction() || per_length * thinnest >= 1.0 / 255.0 {
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
