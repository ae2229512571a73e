//! Isosurface maps on the device.

use tetrascope_integrate::surface::{IsosurfaceMap, SmoothMaps, TexelAxis};
use tetrascope_integrate::{Isosurfaces, SurfaceShading};
use tetrascope_scene::Mixing;
use tetrascope_shaders::layout::{MAP_AROUND, MAP_BEHIND, MAP_BOTH_BEHIND, MapAxis};
use wgpu::Buffer;

use crate::effects::{ScalarUnit, check_size, shading_code};
use crate::{Gpu, GpuError};

/// The maps of a plan's isosurfaces, and what they were made from.
#[derive(Debug)]
pub(crate) struct Maps {
    key: Key,
    drawn: Isosurfaces,
    passes: u32,
    buffer: Buffer,
}

#[derive(Clone, Debug, PartialEq)]
struct Key {
    surfaces: Isosurfaces,
    size: u32,
    mixing: Mixing,
    unit: ScalarUnit,
}

impl Maps {
    /// Builds the maps over the field's scalars and brings them to the device.
    ///
    /// - `surfaces`: in the renderer's unit
    ///
    /// # Errors
    /// [`GpuError::TooLarge`]; [`GpuError::Isosurfaces`] for a size out of range.
    pub(crate) fn new(
        gpu: &Gpu,
        surfaces: &Isosurfaces,
        size: u32,
        mixing: Mixing,
        unit: ScalarUnit,
    ) -> Result<Self, GpuError> {
        let is_smooth = surfaces.shading() == SurfaceShading::Smooth;
        let passes = match mixing {
            Mixing::Stopped if is_smooth => MAP_BOTH_BEHIND,
            Mixing::Stopped => MAP_BEHIND,
            Mixing::Smooth => MAP_AROUND,
        };
        let maps = if passes == MAP_BEHIND { 1 } else { 2 };
        let header = size_of::<MapAxis>() as u64;
        let bytes = u64::from(size) * u64::from(size) * size_of::<[f32; 4]>() as u64;
        let needed = header + maps * bytes;
        check_size(gpu, "a map of isosurfaces", needed)?;

        // One after the other to the device, which keeps a copy until it has them.
        let buffer = gpu.storage("maps", needed);
        let write = |map: &IsosurfaceMap, place: u64| {
            gpu.queue.write_buffer(&buffer, header + place * bytes, bytemuck::cast_slice(map.entries()));
            map.axis()
        };
        let axis: TexelAxis = if passes == MAP_BEHIND {
            write(&IsosurfaceMap::new(surfaces, unit.range, size)?, 0)
        } else {
            let maps = SmoothMaps::new(surfaces, unit.range, size)?;
            write(maps.back(), 1);
            write(maps.front(), 0)
        };
        let on_device = MapAxis {
            start: unit.to_lattice(axis.start),
            texels: axis.texels,
            per_scalar: axis.per_scalar.min(f64::from(f32::MAX)) as f32,
            shading: shading_code(surfaces.shading()),
        };
        gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&on_device));
        let drawn = surfaces.on_texels(&axis);
        Ok(Self { key: Key { surfaces: surfaces.clone(), size, mixing, unit }, drawn, passes, buffer })
    }

    /// Whether they are the maps of these surfaces.
    pub(crate) fn is_for(&self, surfaces: &Isosurfaces, size: u32, mixing: Mixing, unit: ScalarUnit) -> bool {
        let key = &self.key;
        key.surfaces == *surfaces && key.size == size && key.mixing == mixing && key.unit == unit
    }

    /// The surfaces where the maps have them.
    pub(crate) fn surfaces(&self) -> &Isosurfaces {
        &self.drawn
    }

    /// How a surface gets into a cell: a constant of the shaders.
    pub(crate) fn passes(&self) -> u32 {
        self.passes
    }

    /// Number of texels, of all maps together.
    pub(crate) fn entries(&self) -> u64 {
        (self.buffer.size() - size_of::<MapAxis>() as u64) / size_of::<[f32; 4]>() as u64
    }

    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }
}
