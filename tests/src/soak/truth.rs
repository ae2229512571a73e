//! What a pixel may be: the reference's light of its ray, and of scenes a rounding away.
//!
//! Where a ray runs along a silhouette, meets an isosurface at a grazing angle, or where the transfer function is as steep as a cliff, the
//! picture is no continuous function of the scene: a last digit decides. A pixel is right there if it is right for a scene that differs by no
//! more than the renderer rounds, which is what numerical analysis calls backward stable. The reference is asked for such scenes: rays
//! are turned by small parts of a pixel, points moved by small parts of the cells about them, scalars and the control points of the transfer
//! function by small parts of the range, each by itself. Elsewhere all of these give the same light to many digits, so that nothing is hidden.

use glam::DVec3;
use tetrascope::cpu::rays::RayTracer;
use tetrascope::mesh::{CellId, TetMesh};
use tetrascope::{
    Backend, Isosurfaces, LinearImage, Plan, RgbaAssoc, SceneFile, Silent, TransferFunction, View, VolumeField,
};

use crate::meshes::Random;

/// How far a renderer's numbers are from the scene's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Of a ray, pixels.
    pub(super) pixels: f64,
    /// Of scalars and control points, share of the field's range.
    pub(super) scalars: f64,
    /// Of points, share of the longest edge of the cells that have them.
    pub(super) edges: f64,
    /// Of points, share of the mesh's size.
    pub(super) size: f64,
}

/// Scenes that are asked for, besides the one itself.
const SCENES: u32 = 64;
/// These are samples: as much as this share of their width may be missing at either end.
const MISSING: f64 = 0.5;

/// Lowest and highest value of each channel of the pixels asked for, over scenes within reach.
///
/// - `plan`: by which the pixels were drawn that are asked for
/// - `scene`: that it was made from, with its transfer function in numbers
/// - `range`: of the scalars
/// - `limit`: what light may be off by where one order is as good as another
///
/// `None` if the reference refuses.
pub(super) fn envelope(
    field: &VolumeField<'_>,
    plan: &Plan,
    scene: &SceneFile,
    pixels: &[[u32; 2]],
    range: [f64; 2],
    reach: Reach,
    limit: f64,
) -> Option<Vec<[[f64; 2]; 4]>> {
    let mut found = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 4]; pixels.len()];
    add_by_cells(field, plan, pixels, &mut found, reach, limit)?;
    let plan = Plan { backend: Backend::Reference, ..plan.clone() };
    let (mesh, scalars) = (field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars);
    // Scalars far from 0 are known to no more than their own last digits, from which the reference interpolates.
    let last_digits = 4.0 * f64::EPSILON * range[0].abs().max(range[1].abs());
    let shift = (reach.scalars * (range[1] - range[0])).max(last_digits);
    let steps = steps(mesh, reach);
    let mut random = Random::new(0x7A17);
    add(mesh, scalars, &plan, pixels, &mut found)?;
    for number in 0..SCENES {
        let [turn, points, values, transfer] = [(); 4].map(|()| share(&mut random));
        let turn = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)].map(|d| d * reach.pixels * turn);
        let mut moved = plan.clone();
        moved.view = turned(&plan.view, turn);
        if transfer > 0.0 {
            moved = with_transfer_moved(&moved, scene, shift * transfer, &mut random)?;
        }
        let all = random.between(-1.0, 1.0);
        let scalars: Vec<f64> = scalars
            .iter()
            .map(|scalar| scalar + shift * values * if number % 2 == 0 { all } else { random.between(-1.0, 1.0) })
            .collect();
        // A cell that has no volume there is no sample.
        let moved_mesh = if points > 0.0 { moved_mesh(mesh, &steps, points, &mut random) } else { None };
        add(moved_mesh.as_ref().unwrap_or(mesh), &scalars, &moved, pixels, &mut found)?;
    }
    for [low, high] in found.iter_mut().flatten() {
        let missing = MISSING * (*high - *low);
        (*low, *high) = (*low - missing, *high + missing);
    }
    Some(found)
}

/// How much of the reach one number is moved by: small shares too, since what is between two extremes may be neither and a needle is thinner
/// than the reach, and often nothing, since a ray that is turned by a thousandth of a pixel misses what lies within a lattice of points.
fn share(random: &mut Random) -> f64 {
    match random.unit() {
        choice if choice < 0.3 => 0.0,
        choice if choice < 0.5 => 1.0,
        _ => 10_f64.powf(random.between(-3.0, 0.0)),
    }
}

/// Rays next to one, of which nearly all must come out right in the order of whole cells for the one to be where cells meet.
const NEIGHBORS: u32 = 16;

/// Rays a rounding away whose light in that order a pixel may have as well.
const VARIANTS: u32 = 32;

/// Adds the light of rays whose cells are blended in the plan's order of whole cells, where that order is right for the rays about them.
///
/// A ray that runs along an edge, or in a face's plane, is in one or another of the cells about it as each of their faces rounds. No ray meets the inside
/// of two of these one behind the other, so that an order of whole cells says nothing of them: a part of the ray in one may be blended before a part in
/// another that lies nearer. Its neighbors have none of this. An order that is wrong is wrong for them too, and hides here behind nothing.
fn add_by_cells(
    field: &VolumeField<'_>,
    plan: &Plan,
    pixels: &[[u32; 2]],
    found: &mut [[[f64; 2]; 4]],
    reach: Reach,
    limit: f64,
) -> Option<()> {
    if !plan.order.sorts_cells() || plan.commutes() {
        return Some(());
    }
    let renderer = field.renderer().ok()?;
    let (cells, frame) = (renderer.cells(), field.on_mesh.mesh.frame());
    let viewpoint = plan.view.in_frame(frame.origin, frame.scale).viewpoint();
    let (mesh, scalars) = (field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars);
    let tracer = RayTracer::new(mesh, scalars, &plan.view).ok()?;
    let drawn: Vec<CellId> = tracer.seen().iter().map(|&(cell, _)| CellId(cell)).collect();
    let order = renderer.visibility().prepare(cells, plan.order).order(cells, viewpoint, &drawn);
    let mut ranks = vec![u32::MAX; cells.tetrahedra.len()];
    for (rank, cell) in (0..).zip(&order.front_to_back) {
        ranks[cell.index()] = rank;
    }
    let rank = |cell: u32| ranks[cell as usize];
    let mut right = vec![0; pixels.len()];
    let mut random = Random::new(0x0DDE);
    for _ in 0..NEIGHBORS {
        let turn = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)].map(|d| d * reach.pixels);
        let view = turned(&plan.view, turn);
        let tracer = RayTracer::new(mesh, scalars, &view).ok()?;
        let rays = tracer.trace(pixels);
        let shader = tracer.shader(plan, &Silent).ok()?;
        for (ray, right) in right.iter_mut().enumerate() {
            let [sorted, by_cells] = [shader.light(&rays, ray), shader.light_by_rank(&rays, ray, rank)];
            let off = (0..3).map(|c| (sorted.rgb[c] - by_cells.rgb[c]).abs()).fold(0.0, f64::max);
            *right += u32::from(off <= 0.5 * limit);
        }
    }
    let steps = steps(mesh, reach);
    // Such a ray may change sides anywhere on its way, by ever smaller roundings.
    for number in 0..=VARIANTS {
        let size = if number == 0 { 0.0 } else { 10_f64.powf(random.between(-6.0, 0.0)) };
        let turn = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)].map(|d| d * reach.pixels * size);
        let view = turned(&plan.view, turn);
        // Where cells were left out, ranks are of others.
        let is_whole = |moved: &TetMesh| moved.tetrahedra().len() == ranks.len();
        let moved = if number % 2 == 1 { moved_mesh(mesh, &steps, size, &mut random).filter(is_whole) } else { None };
        let tracer = RayTracer::new(moved.as_ref().unwrap_or(mesh), scalars, &view).ok()?;
        let rays = tracer.trace(pixels);
        let shader = tracer.shader(plan, &Silent).ok()?;
        for (ray, channels) in found.iter_mut().enumerate().filter(|(ray, _)| right[*ray] * 4 >= NEIGHBORS * 3) {
            widen(channels, shader.light_by_rank(&rays, ray, rank));
        }
    }
    Some(())
}

fn widen(channels: &mut [[f64; 2]; 4], light: RgbaAssoc) {
    for (channel, value) in channels.iter_mut().zip([light.rgb[0], light.rgb[1], light.rgb[2], light.opacity]) {
        *channel = [channel[0].min(value), channel[1].max(value)];
    }
}

/// For every point how far it may be moved, local units.
fn steps(mesh: &TetMesh, reach: Reach) -> Vec<f64> {
    let mut steps = vec![0.0_f64; mesh.positions().len()];
    for cell in mesh.tetrahedra() {
        let corners = cell.map(|v| mesh.positions()[v.index()]);
        let longest = (0..4).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| (corners[i] - corners[j]).length());
        let longest = longest.fold(0.0, f64::max);
        for v in cell {
            // No point of a mesh is farther than about 1 from the middle, in its own units.
            steps[v.index()] = steps[v.index()].max(longest * reach.edges).max(reach.size);
        }
    }
    steps
}

fn moved_mesh(mesh: &TetMesh, steps: &[f64], share: f64, random: &mut Random) -> Option<TetMesh> {
    let points: Vec<DVec3> = mesh
        .positions()
        .iter()
        .zip(steps)
        .map(|(&p, &step)| mesh.frame().to_world(p + random.point() * (step * share)))
        .collect();
    let cells: Vec<[u32; 4]> = mesh.tetrahedra().iter().map(|cell| cell.map(|v| v.0)).collect();
    Some(TetMesh::from_tetrahedra(&points, &cells).ok()?.mesh)
}

/// The reference's picture ray by ray: it draws fans of triangles too, which a clipped ray does not have.
///
/// `None` if it refuses.
pub(super) fn ray_by_ray(field: &VolumeField<'_>, plan: &Plan) -> Option<LinearImage> {
    let (width, height) = (plan.view.width, plan.view.height);
    let pixels: Vec<[u32; 2]> = (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
    let mut found = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 4]; pixels.len()];
    add(field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars, plan, &pixels, &mut found)?;
    let pixels = found.iter().map(|channels| channels.map(|[value, _]| value as f32)).collect();
    LinearImage::from_pixels(width, height, pixels)
}

fn add(mesh: &TetMesh, scalars: &[f64], plan: &Plan, pixels: &[[u32; 2]], found: &mut [[[f64; 2]; 4]]) -> Option<()> {
    let tracer = RayTracer::new(mesh, scalars, &plan.view).ok()?;
    let rays = tracer.trace(pixels);
    let shader = tracer.shader(plan, &Silent).ok()?;
    for (ray, channels) in found.iter_mut().enumerate() {
        widen(channels, shader.light(&rays, ray));
    }
    Some(())
}

/// The view with all rays moved by about so many pixels: a camera that is turned about its eye, or moved where rays are parallel.
fn turned(view: &View, [x, y]: [f64; 2]) -> View {
    let [dx, dy] =
        [x * 2.0 * view.half_width / f64::from(view.width), y * 2.0 * view.half_height / f64::from(view.height)];
    let mut view = *view;
    if !view.is_perspective {
        view.eye += view.right * dx + view.up * dy;
        return view;
    }
    let forward = (view.forward + view.right * dx + view.up * dy).normalize();
    let right = (view.right - forward * view.right.dot(forward)).normalize();
    (view.forward, view.right, view.up) = (forward, right, right.cross(forward));
    view
}

/// The plan with every control point and every surface's value moved by up to so much; what stood at one scalar still does.
fn with_transfer_moved(plan: &Plan, scene: &SceneFile, most: f64, random: &mut Random) -> Option<Plan> {
    let mut moved = |scalars: Vec<f64>| {
        let mut list: Vec<f64> = Vec::with_capacity(scalars.len());
        for (index, &scalar) in scalars.iter().enumerate() {
            let is_step = index > 0 && scalars[index - 1] == scalar;
            let next = if is_step { list[index - 1] } else { scalar + most * random.between(-1.0, 1.0) };
            list.push(list.last().map_or(next, |last| last.max(next)));
        }
        list
    };
    let mut color: Vec<[f64; 4]> = scene.transfer.color.clone().unwrap_or_default();
    let mut extinction: Vec<[f64; 2]> = scene.transfer.extinction.clone().unwrap_or_default();
    let scalars = moved(color.iter().map(|point| point[0]).collect());
    color.iter_mut().zip(scalars).for_each(|(point, scalar)| point[0] = scalar);
    let scalars = moved(extinction.iter().map(|point| point[0]).collect());
    extinction.iter_mut().zip(scalars).for_each(|(point, scalar)| point[0] = scalar);
    let mut plan = plan.clone();
    plan.transfer = TransferFunction::new(&color, &extinction).ok()?;
    if let Some(isosurfaces) = &mut plan.isosurfaces {
        let mut surfaces = isosurfaces.surfaces.as_slice().to_vec();
        surfaces.iter_mut().for_each(|surface| surface.value += most * random.between(-1.0, 1.0));
        isosurfaces.surfaces = Isosurfaces::new(surfaces).ok()?;
    }
    Some(plan)
}
