//! Structures of both languages, field by field.

use std::mem::offset_of;

use naga::TypeInner;

use crate::layout::{Block, Frame, Lamp, MapAxis, OpticsUniform, PowerView, Surface, Work};
use crate::{Program, Slot};

/// Name and offset of every field that shaders know, and bytes of the whole.
type Fields = (Vec<(&'static str, u32)>, u32);

macro_rules! fields {
    ($type:ty: $($field:ident),* $(,)?) => {
        (vec![$((stringify!($field), offset_of!($type, $field) as u32)),*], size_of::<$type>() as u32)
    };
}

const SLOTS: &[Slot<'static>] = &[
    ("volume", "integrate/average.wgsl"),
    ("model", "integrate/density_emitter.wgsl"),
    ("volume_light", "effects/volume_plain.wgsl"),
    ("surface_light", "effects/surface_plain.wgsl"),
    ("gradient", "effects/gradient_cell.wgsl"),
];

/// The same of a structure in a file of the shaders.
fn of_shader(file: &str, name: &str) -> (Vec<(String, u32)>, u32) {
    let constants: Vec<_> = crate::layout::EFFECT_CONSTANTS
        .iter()
        .copied()
        .chain([("CARRIES_JOINTS", crate::Constant::Bool(true)), ("MAP_PASSES", crate::Constant::U32(0))])
        .collect();
    let program = Program::compose(file, SLOTS, &constants).unwrap();
    let (_, found) = program.module().types.iter().find(|(_, found)| found.name.as_deref() == Some(name)).unwrap();
    let TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no structure") };
    (members.iter().map(|member| (member.name.clone().unwrap(), member.offset)).collect(), *span)
}

#[test]
fn structures_are_the_same_in_both_languages() {
    let known: [(&str, &str, Fields); 8] = [
        (
            "include/frame.wgsl",
            "Frame",
            fields!(Frame: right, down, forward, eye, columns, rows, rest, slope, size, origin, extent, tiles,
                is_perspective, termination, cells, points, tangent),
        ),
        ("include/block.wgsl", "Block", fields!(Block: first, count, capacity, unused)),
        ("include/work.wgsl", "Work", fields!(Work: most, count_at, shift, unused)),
        (
            "order/power_keys.wgsl",
            "PowerView",
            fields!(PowerView: axis, lowest, constant_shift, has_constant, drop, unused),
        ),
        (
            "integrate/optics.wgsl",
            "OpticsUniform",
            fields!(OpticsUniform: piece_count, psi_start, table_scalars, table_lengths, table_start, table_step,
                table_rest, table_per_scalar, table_per_length, table_is_logarithmic, unused),
        ),
        // What follows is room up to the next one in the list.
        ("effects/surface_set.wgsl", "Surface", fields!(Surface: color, opacity, back_color, value, shading)),
        ("effects/maps.wgsl", "MapAxis", fields!(MapAxis: start, texels, per_scalar, shading)),
        ("effects/lamp.wgsl", "Lamp", fields!(Lamp: direction, is_at_eye, ambient, diffuse, specular, shininess)),
    ];
    for (file, name, (fields, bytes)) in known {
        let (shader_fields, shader_bytes) = of_shader(file, name);
        let own: Vec<(String, u32)> = fields.iter().map(|(field, offset)| ((*field).to_owned(), *offset)).collect();
        assert_eq!(own, shader_fields, "{name}");
        assert_eq!(bytes, shader_bytes, "{name}");
    }
}
