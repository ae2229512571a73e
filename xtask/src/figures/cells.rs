//! Single cells with an isosurface each, above the maps that it is looked up in: [Röttger 2000], figure 6.

use tetrascope::LinearImage;
use tetrascope::classify::{FanVertex, project};
use tetrascope::integrate::{Isosurface, IsosurfaceMap, Isosurfaces};
use tetrascope::mesh::CellId;

use super::scene::Drawing;
use super::{maps, sheet};
use crate::Failure;

/// Edges of cells and of triangles, linear RGB.
const INK: [f32; 3] = [0.85, 0.35, 0.1];

/// The opaque part of a map, linear gray: what is looked up is a silhouette, whose color the paper takes from the vertices.
const OPAQUE: [f64; 3] = [0.5; 3];

/// One column a cell: the cell with the edges of its fan, and below it the map of its isosurface with the fan's triangles, whose
/// corners there are pairs of scalars at front and back.
///
/// Scenes have one tetrahedron with scalars from 0 to 1, an orthographic camera, square pictures and isosurfaces.
pub(super) fn with_maps(cells: &[Drawing]) -> Result<LinearImage, Failure> {
    let columns: Vec<_> = cells.iter().map(column).collect::<Result<_, _>>()?;
    let (upper, lower) = columns.into_iter().unzip();
    Ok(sheet::grid(&[upper, lower]))
}

fn column(drawing: &Drawing) -> Result<(LinearImage, LinearImage), Failure> {
    let field = drawing.field()?;
    let plan = drawing.plan()?;
    let mut lower = maps::of_map(&map(&plan.isosurfaces.ok_or("no isosurface")?.surfaces)?, MAPPED);
    let mut upper = drawing.picture(lower.width())?;
    let side = f64::from(lower.width());

    let mesh = field.on_mesh.mesh.as_ref();
    let vertices = *mesh.tetrahedra().first().ok_or("no tetrahedron")?;
    let corners = mesh.corners(CellId(0));
    let scalars = vertices.map(|vertex| field.on_mesh.scalars[vertex.index()]);
    if plan.view.is_perspective {
        return Err("the attributes of a fan are linear in orthographic views only".into());
    }
    // Local coordinates differ from the world's by a shift and a scale.
    let view = plan.view.in_frame(mesh.frame().origin, mesh.frame().scale);
    let shown = project(&corners, &scalars, vertices.map(|vertex| vertex.index()), view.viewpoint());
    let thick = shown.thick.ok_or("the cell has no silhouette")?;
    let on_screen = |vertex| {
        let point = match vertex {
            FanVertex::Corner(corner) => corners[corner],
            FanVertex::Thick => thick.near,
        };
        let away = point - view.eye;
        let across = [away.dot(view.right) / view.half_width, -away.dot(view.up) / view.half_height];
        across.map(|share| (share + 1.0) / 2.0 * side)
    };
    let on_map = |vertex| {
        let [front, back] = match vertex {
            FanVertex::Corner(corner) => [scalars[corner]; 2],
            FanVertex::Thick => [thick.scalar_front, thick.scalar_back],
        };
        [front * side, (1.0 - back) * side]
    };
    for [a, b, c] in shown.fan.triangles() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            sheet::line(&mut upper, on_screen(from), on_screen(to), INK);
            sheet::line(&mut lower, on_map(from), on_map(to), INK);
        }
    }
    Ok((upper, lower))
}

/// The scalars that maps of cells cover.
const MAPPED: [f64; 2] = [0.0, 1.0];

/// Where surfaces are seen, without their color.
fn map(surfaces: &Isosurfaces) -> Result<IsosurfaceMap, Failure> {
    let opaque = |surface: &Isosurface| Isosurface { color: OPAQUE, back_color: OPAQUE, opacity: 1.0, ..*surface };
    let silhouettes = Isosurfaces::new(surfaces.as_slice().iter().map(opaque).collect())?;
    Ok(IsosurfaceMap::new(&silhouettes, MAPPED, maps::TEXELS)?)
}
