//! What effects have in both languages: isosurfaces, maps of them, and light. Names of fields are those of the shaders.

use bytemuck::{Pod, Zeroable};

use crate::constants::Constant;
use crate::layout::UNIT;

/// A [`Surface`] shows its color, everywhere.
pub const SHADING_NONE: u32 = 0;
/// It is lit with one normal a cell.
pub const SHADING_FLAT: u32 = 1;
/// It is lit with interpolated normals.
pub const SHADING_SMOOTH: u32 = 2;
/// One map, behind the volume.
pub const MAP_BEHIND: u32 = 0;
/// A map for front faces over one for back faces, both behind the volume.
pub const MAP_BOTH_BEHIND: u32 = 1;
/// The same with the volume between them.
pub const MAP_AROUND: u32 = 2;

/// Those that programs with effects have, besides `CARRIES_JOINTS` and `MAP_PASSES`.
pub const EFFECT_CONSTANTS: &[(&str, Constant)] = &[
    ("AXIS_STEP", Constant::F32((1.0 / UNIT) as f32)),
    ("SHADING_NONE", Constant::U32(SHADING_NONE)),
    ("SHADING_FLAT", Constant::U32(SHADING_FLAT)),
    ("SHADING_SMOOTH", Constant::U32(SHADING_SMOOTH)),
    ("MAP_BEHIND", Constant::U32(MAP_BEHIND)),
    ("MAP_BOTH_BEHIND", Constant::U32(MAP_BOTH_BEHIND)),
    ("MAP_AROUND", Constant::U32(MAP_AROUND)),
];

/// An isosurface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Surface {
    /// Linear color of the side that faces rising scalars.
    pub color: [f32; 3],
    /// Share of what lies behind that it hides.
    pub opacity: f32,
    /// Linear color of the other side.
    pub back_color: [f32; 3],
    /// Its scalar, lattice steps.
    pub value: i32,
    /// [`SHADING_NONE`], [`SHADING_FLAT`] or [`SHADING_SMOOTH`].
    pub shading: u32,
    /// Fills the stride.
    pub padding: [u32; 3],
}

/// What both axes of isosurface maps have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct MapAxis {
    /// Scalar of the coordinate 0, lattice steps.
    pub start: i32,
    /// Texels a side.
    pub texels: u32,
    /// Texels per unit of scalars.
    pub per_scalar: f32,
    /// How light falls on the surfaces, as in [`Surface`].
    pub shading: u32,
}

/// The light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Lamp {
    /// From the surface towards the light, along the mesh's axes, of length 1.
    pub direction: [f32; 3],
    /// 1 if the light is at the eye instead.
    pub is_at_eye: u32,
    /// Phong's coefficients.
    pub ambient: f32,
    /// Likewise.
    pub diffuse: f32,
    /// Likewise.
    pub specular: f32,
    /// Likewise.
    pub shininess: f32,
}
