//! What a pixel may be: the reference's light of its ray, and of rays and scalars a rounding away.
//!
//! Where a ray runs along a silhouette, meets an isosurface at a grazing angle, or where the transfer function is as steep as a cliff, the
//! picture is no continuous function of the scene: a last digit decides. A pixel is right there if it is right for a scene that differs by no
//! more than the renderer rounds, which is what numerical analysis calls backward stable. The reference is asked for those scenes: its
//! rays are turned by small parts of a pixel, and the scalars moved by small parts of their range. Elsewhere all of these give the same
//! light to many digits, so that nothing is hidden.

use tetrascope::cpu::rays::RayTracer;
use tetrascope::{Backend, Isosurfaces, LinearImage, Plan, SceneFile, Silent, TransferFunction, View, VolumeField};

/// How far a renderer's numbers are from the scene's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Pixels.
    pub(super) pixels: f64,
    /// Share of the field's range.
    pub(super) scalars: f64,
}

/// Lowest and highest value of each channel of the pixels asked for, over all scenes within reach.
///
/// - `plan`: as the reference draws it
/// - `scene`: that it was made from, with its transfer function in numbers
/// - `range`: of the scalars
///
/// `None` if the reference refuses.
pub(super) fn envelope(
    field: &VolumeField<'_>,
    plan: &Plan,
    scene: &SceneFile,
    pixels: &[[u32; 2]],
    range: [f64; 2],
    reach: Reach,
) -> Option<Vec<[[f64; 2]; 4]>> {
    let mut found = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 4]; pixels.len()];
    let plan = Plan { backend: Backend::Reference, ..plan.clone() };
    // Scalars far from 0 are known to no more than their own last digits, from which the reference interpolates.
    let last_digits = 4.0 * f64::EPSILON * range[0].abs().max(range[1].abs());
    let shift = (reach.scalars * (range[1] - range[0])).max(last_digits);
    // A ring, and a smaller one in it, as what is between two extremes may be neither.
    for [dx, dy] in RING {
        for size in [1.0, 0.25] {
            let turned = turned(&plan.view, [dx * reach.pixels * size, dy * reach.pixels * size]);
            let shifts: &[f64] = if [dx, dy] == [0.0; 2] { &[0.0, -1.0, 1.0, -0.25, 0.25] } else { &[0.0, -0.5, 0.5] };
            for &by in shifts {
                let plan = shifted(&Plan { view: turned, ..plan.clone() }, scene, by * shift)?;
                add(field, &plan, pixels, &mut found)?;
            }
            if [dx, dy] == [0.0; 2] {
                break;
            }
        }
    }
    Some(found)
}

/// The reference's picture ray by ray: it draws fans of triangles too, which a clipped ray does not have.
///
/// `None` if it refuses.
pub(super) fn ray_by_ray(field: &VolumeField<'_>, plan: &Plan) -> Option<LinearImage> {
    let (width, height) = (plan.view.width, plan.view.height);
    let pixels: Vec<[u32; 2]> = (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
    let mut found = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 4]; pixels.len()];
    add(field, plan, &pixels, &mut found)?;
    let pixels = found.iter().map(|channels| channels.map(|[value, _]| value as f32)).collect();
    LinearImage::from_pixels(width, height, pixels)
}

/// Directions in which rays are turned.
const RING: [[f64; 2]; 9] =
    [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [0.7, 0.7], [-0.7, 0.7], [0.7, -0.7], [-0.7, -0.7]];

fn add(field: &VolumeField<'_>, plan: &Plan, pixels: &[[u32; 2]], found: &mut [[[f64; 2]; 4]]) -> Option<()> {
    let (mesh, scalars) = (field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars);
    let tracer = RayTracer::new(mesh, scalars, &plan.view).ok()?;
    let rays = tracer.trace(pixels);
    let shader = tracer.shader(plan, &Silent).ok()?;
    for (ray, channels) in found.iter_mut().enumerate() {
        let light = shader.light(&rays, ray);
        for (channel, value) in channels.iter_mut().zip([light.rgb[0], light.rgb[1], light.rgb[2], light.opacity]) {
            *channel = [channel[0].min(value), channel[1].max(value)];
        }
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

/// The plan over scalars that are all higher by so much.
fn shifted(plan: &Plan, scene: &SceneFile, by: f64) -> Option<Plan> {
    if by == 0.0 {
        return Some(plan.clone());
    }
    let color: Vec<[f64; 4]> = scene.transfer.color.iter().flatten().map(|&[s, r, g, b]| [s + by, r, g, b]).collect();
    let extinction: Vec<[f64; 2]> = scene.transfer.extinction.iter().flatten().map(|&[s, e]| [s + by, e]).collect();
    let mut plan = plan.clone();
    plan.transfer = TransferFunction::new(&color, &extinction).ok()?;
    if let Some(isosurfaces) = &mut plan.isosurfaces {
        let mut surfaces = isosurfaces.surfaces.as_slice().to_vec();
        surfaces.iter_mut().for_each(|surface| surface.value += by);
        isosurfaces.surfaces = Isosurfaces::new(surfaces).ok()?;
    }
    Some(plan)
}
