//! Tables and maps as pictures: the scalar at the front to the right, the scalar at the back upward.

use glam::DVec3;
use tetrascope::integrate::{
    IsosurfaceMap, Isosurfaces, RgbaAssoc, Segment, SmoothMaps, SurfaceRole, Table2d, Table3d, TableDomain,
    TableSettings,
};
use tetrascope::mesh::chord_lengths;
use tetrascope::{
    ArrayValues, Cells, DataArray, Dataset, Integration, LinearImage, Plan, Silent, StructuredBlock, Volume,
    render_volume,
};

use super::scene::{Drawing, read_scene};
use super::sheet;
use crate::Failure;

/// Texels along a side, of tables and of maps: those of [Röttger 2000], figure 13. A pixel shows one.
pub(super) const TEXELS: u32 = 256;

/// Samples along each axis of the table that is drawn as a volume.
const SAMPLES: u32 = 48;

/// What a scene looks up to mix its isosurfaces with its volume: the pass for the back faces, the table of the volume, and the
/// pass for the front faces, as in [Röttger 2000], figure 13.
pub(super) fn three(drawing: &Drawing) -> Result<LinearImage, Failure> {
    let plan = drawing.plan()?;
    let domain = domain(drawing)?;
    let maps = SmoothMaps::new(surfaces(&plan)?, domain.scalars, TEXELS)?;
    let volume = volume(&plan, &domain, None)?;
    Ok(sheet::grid(&[vec![of_map(maps.back(), domain.scalars), volume, of_map(maps.front(), domain.scalars)]]))
}

/// The table of the volume with the integral stopped at the isosurfaces, as in [Röttger 2000], figure 15.
pub(super) fn stopped(drawing: &Drawing) -> Result<LinearImage, Failure> {
    let plan = drawing.plan()?;
    volume(&plan, &domain(drawing)?, Some((surfaces(&plan)?, SurfaceRole::Stop)))
}

/// The opacity of the three-dimensional table with the integral stopped, drawn as a volume, as in [Röttger 2000], figure 12.
///
/// The volume is the cube from 0 to 1: x is the scalar at the front, y that at the back, z the length; its array is called `opacity`.
/// `name` is the scene that says how it is seen.
pub(super) fn stopped_opacity(drawing: &Drawing, name: &str, size: u32) -> Result<LinearImage, Failure> {
    let plan = drawing.plan()?;
    let domain = domain(drawing)?;
    let settings = TableSettings { scalars: SAMPLES, lengths: SAMPLES, ..table_settings(Integration::Table3d)? };
    let stops = Some((surfaces(&plan)?, SurfaceRole::Stop));
    let table = Table3d::build(&plan.transfer, plan.model, &domain, &settings, stops, &|_, _| {})?;
    let side = SAMPLES as usize;
    let at = |index: usize| index as f64 / (side - 1) as f64;
    let (mut points, mut opacity) = (Vec::new(), Vec::new());
    for length in 0..side {
        for back in 0..side {
            for front in 0..side {
                let point = DVec3::new(at(front), at(back), at(length));
                let chord_length = domain.max_length * point.z;
                opacity.push(table.look_up(&segment(&domain, point.x, point.y, chord_length)).opacity);
                points.push(point);
            }
        }
    }
    let dataset = Dataset {
        points,
        cells: Cells::Structured(vec![StructuredBlock { dims: [side; 3], first_point: 0, hidden_points: Vec::new() }]),
        point_arrays: vec![DataArray { name: "opacity".to_owned(), components: 1, values: ArrayValues::F64(opacity) }],
        cell_arrays: Vec::new(),
    };
    let mut scene = read_scene(name)?;
    (scene.image.width, scene.image.height) = (size, size);
    let picture = render_volume(&Volume::from_dataset(dataset, name)?, &scene, &Silent)?;
    Ok(sheet::over(&picture.image, picture.plan.background))
}

/// A map over a range of scalars, a pixel a texel, over black.
pub(super) fn of_map(map: &IsosurfaceMap, scalars: [f64; 2]) -> LinearImage {
    let domain = TableDomain { scalars, mean_length: 1.0, max_length: 1.0 };
    // Texels of maps have a width, and the center stands for them.
    let at = |texel: u32| (f64::from(texel) + 0.5) / f64::from(TEXELS);
    square(|front, back| map.look_up(&segment(&domain, at(front), at(back), 1.0)), 1.0)
}

/// The table at the mean length, divided by its largest opacity: what [Röttger 2000], section 4, keeps in the texture.
fn volume(
    plan: &Plan,
    domain: &TableDomain,
    stops: Option<(&Isosurfaces, SurfaceRole)>,
) -> Result<LinearImage, Failure> {
    let settings = TableSettings { scalars: TEXELS, ..table_settings(Integration::Table2d)? };
    let table = Table2d::build(&plan.transfer, plan.model, domain, &settings, stops, &|_, _| {})?;
    // Samples of tables lie on both ends of the range.
    let at = |texel: u32| f64::from(texel) / f64::from(TEXELS - 1);
    let look_up = |front, back| table.look_up(&segment(domain, at(front), at(back), domain.mean_length));
    Ok(square(look_up, 1.0 / table.scale()))
}

/// A picture of what is looked up for two texels, times a factor, over black.
fn square(look_up: impl Fn(u32, u32) -> RgbaAssoc, factor: f64) -> LinearImage {
    let mut image = LinearImage::transparent(TEXELS, TEXELS);
    for (row, pixels) in image.pixels_mut().chunks_exact_mut(TEXELS as usize).enumerate() {
        for (column, pixel) in pixels.iter_mut().enumerate() {
            let [r, g, b] = look_up(column as u32, TEXELS - 1 - row as u32).rgb.map(|light| (light * factor) as f32);
            *pixel = [r, g, b, 1.0];
        }
    }
    image
}

/// A segment whose ends are shares of the scalars' range.
fn segment(domain: &TableDomain, front: f64, back: f64, chord_length: f64) -> Segment {
    let [low, high] = domain.scalars;
    let scalar = |share: f64| low + share * (high - low);
    Segment { scalar_front: scalar(front), scalar_back: scalar(back), chord_length }
}

fn surfaces(plan: &Plan) -> Result<&Isosurfaces, Failure> {
    let isosurfaces = plan.isosurfaces.as_ref().ok_or("the scene has no isosurface")?;
    Ok(&isosurfaces.surfaces)
}

fn table_settings(integration: Integration) -> Result<TableSettings, Failure> {
    Ok(TableSettings::of(integration).ok_or_else(|| format!("{integration} has no table"))?)
}

/// What a table for this scene has to cover.
fn domain(drawing: &Drawing) -> Result<TableDomain, Failure> {
    let field = drawing.field()?;
    let chords = chord_lengths(field.on_mesh.mesh.as_ref()).ok_or("the mesh has no volume")?;
    let (low, high) = field.facts.scalar_range;
    Ok(TableDomain { scalars: [low, high], mean_length: chords.mean, max_length: chords.longest })
}
